//! The claims of the paper, each measured with the library: what holds, with its three modes and with enough of them.
//!
//! ```text
//!   machine   the example in a variant        record   one variant in motion        spectrum   its lines
//!   family    all variants with one basis     claims   what the paper says of them  document   docs/validation.md
//! ```
//!
//! Amplitudes that the paper does not give are assumed ([`machine`]); the train is linear, so that lines of different
//! excitations scale independently of each other. Measures and prints; computes no physics.

pub mod claims;
pub mod document;
pub mod family;
pub mod machine;
pub mod record;
pub mod shapes;
pub mod spectrum;
