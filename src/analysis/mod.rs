//! What an engineer asks of a train before simulating it.
//!
//! | question | here |
//! |---|---|
//! | how does it vibrate at speed, and what kind of vibration is that? | [`vibrations`] |
//! | how does that change with speed, and at which speeds does something resonate? | [`campbell`] |
//! | are the modes kept enough, and if not, how many are? | [`Reference`] |
//! | how large may a communication step be? | [`suggested_step`] |
//!
//! Everything is linear: meshes have their mean stiffness, bearings their linear coefficients, and contact is never
//! lost. Reads models; moves nothing. `docs/inspect.md` defines every number.

mod basis_check;
mod basis_errors;
mod branches;
mod campbell;
mod compliance;
mod critical;
mod family;
mod recommend;
mod response;
mod step;
mod vibration;

pub use basis_check::{Reference, VibrationErrors, range_of_interest};
pub use basis_errors::{Answers, BandErrors, BasisErrors, CHANNELS, Excites, LIMIT};
pub use campbell::{Campbell, CriticalSpeed, Excitation, NoCampbell, Point, SpeedRange, campbell};
pub use compliance::{Compliance, Place, Spot, static_compliances};
pub use recommend::{Recommendation, recommend};
pub use response::{Force, ForceResponse, Source};
pub use step::{SuggestedStep, suggested_step};
pub use vibration::{Kind, Vibration, Vibrations, Whirl, vibrations};
