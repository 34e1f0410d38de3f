//! The 34 functions of an FMI 2.0 co-simulation slave. Each is a guard call and one method call; arguments
//! are turned into slices and strings by `arguments`.

pub mod capabilities;
pub mod common;
pub mod state;
pub mod stepping;
pub mod variables;
