//! The FMI 2.0 C interface: the only unsafe code, and the place where panics stop.
//!
//! ```text
//!   exports   34 functions, one guard call each
//!   guard     null check, legality, panic, error -> message + status
//!   arguments pointers -> slices and strings       life   instantiate, free
//!   logger    messages to the master               payload   the model inside the library
//! ```

pub mod abi;
mod arguments;
pub mod exports;
mod guard;
mod life;
mod logger;
pub mod payload;
