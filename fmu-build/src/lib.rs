//! Builds a shared library for several platforms and packs FMUs: knows files and folders, not gears.
//!
//! ```text
//!   platform   what an FMU can run on, with its folder, its file ending and its targets of the compiler
//!   library    cargo -> a shared library for a platform, the same bytes in whatever folder it is built
//!   binary     that library with something written into it: one file again, signed where macOS asks for it
//!   fmu        the parts of an FMU                      archive   its files by their paths, and the zip file
//!   merge      FMUs packed on different machines -> one
//!   ssp        several FMUs and their connections in one file
//!   licenses   the crates that are linked into the library, and their licences
//! ```

mod archive;
mod binary;
mod fmu;
mod library;
mod licenses;
mod macho;
mod merge;
mod metadata;
mod platform;
mod ssp;

pub use archive::{Archive, ArchiveError};
pub use binary::{Binary, BinaryError};
pub use fmu::Fmu;
pub use library::{BuildError, Builder, Library, OLDEST_GLIBC};
pub use licenses::linked_crates;
pub use merge::{MergeError, merge};
pub use platform::Platform;
pub use ssp::Ssp;
