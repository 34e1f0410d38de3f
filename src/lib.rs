//! geartrain turns a text description of a geared rotor system into an FMI 2.0 co-simulation FMU.
//!
//! Shafts, each reduced to its vibration modes, shake each other through their gear meshes while the
//! gearbox shakes their bearings (Choy, Tu, Zakrajsek, Townsend, NASA 1991). This library is both halves:
//! the compiled shared library inside every FMU, and the compiler's understanding of model files.
//!
//! The house has floors; a module imports only from floors below its own (`ARCHITECTURE.md`):
//!
//! | floor | modules |
//! |---|---|
//! | 9 | [`package`]: the parts of an FMU |
//! | 8 | [`fmi2`]: the C ABI, the only unsafe code |
//! | 7 | [`slave`]: FMI life cycle · [`description`]: XML and HTML |
//! | 6 | [`interface`]: the one table of variables · [`drawing`]: pictures of a train |
//! | 5 | [`simulation`]: model + state + inputs + solver · [`analysis`]: what engineers ask before simulating |
//! | 4 | [`model`]: the assembled modal system |
//! | 3 | [`rotor`]: one shaft in modal coordinates |
//! | 2 | [`train`]: the validated description |
//! | 1 | [`config`]: the model file · [`element`]: shaft elements · [`mesh`]: gear meshes |
//! | 0 | [`linalg`], [`interpolation`], [`solver`] |

pub mod analysis;
pub mod config;
pub mod description;
pub mod drawing;
pub mod element;
#[allow(unsafe_code)] // the C ABI needs pointers; every other module is safe Rust
pub mod fmi2;
pub mod interface;
pub mod interpolation;
pub mod linalg;
pub mod mesh;
pub mod model;
pub mod package;
pub mod rotor;
pub mod simulation;
pub mod slave;
pub mod solver;
pub mod train;
