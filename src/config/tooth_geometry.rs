//! `[mesh.stiffness]` with `law = "tooth_geometry"` as plain data.

use serde::{Deserialize, Serialize};

/// The shape of the teeth of two spur gears; numbers of teeth, base radii and the operating pressure angle stand elsewhere.
/// Pairs belong to gears a and b; lengths on the basic rack are in modules.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ToothGeometry {
    /// Length of the teeth in contact [m]. > 0
    pub face_width: f64,
    /// Module [m]. > 0
    pub module: f64,
    /// Pressure angle of the basic rack [rad]. (0, pi/2)
    pub rack_pressure_angle: f64,
    /// Addendum of the basic rack [modules]. > 0
    pub addendum: [f64; 2],
    /// Dedendum of the basic rack [modules]. > 0
    pub dedendum: [f64; 2],
    /// Profile shift [modules].
    pub profile_shift: [f64; 2],
    /// Radius at which the gear body is held [m]; absent: that of the shaft. > 0
    pub bore_radius: Option<[f64; 2]>,
    /// Names of the materials.
    pub material: [String; 2],
}
