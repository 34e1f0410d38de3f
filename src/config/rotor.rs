//! What a model file says of a rotor and of everything on it.

use serde::{Deserialize, Serialize};

/// `[[rotor]]`: one shaft and everything on it. Positions are distances from the left end [m].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rotor {
    /// Unique identifier.
    pub name: String,
    /// Mean speed, positive about +z [rad/s]. At most 1e6 either way
    pub speed: f64,
    /// Rotation angle at time 0 [rad].
    pub angle: f64,
    /// Longest finite element [m]; a twentieth of the shaft when absent. > 0
    pub max_element_length: Option<f64>,
    /// Modal damping ratio of all elastic lateral modes. >= 0
    pub lateral_damping_ratio: f64,
    /// Modal damping ratio of all elastic torsional modes. >= 0
    pub torsional_damping_ratio: f64,
    /// Shaft sections from left to right.
    pub segments: Vec<Segment>,
    /// Rigid disks without teeth.
    pub disks: Vec<Disk>,
    /// Gears.
    pub gears: Vec<Gear>,
    /// Bearings to the gearbox.
    pub bearings: Vec<Bearing>,
    /// Mass unbalances.
    pub unbalances: Vec<Unbalance>,
    /// Residual bows.
    pub bows: Vec<Bow>,
    /// Places where an external torque acts.
    pub torques: Vec<Torque>,
    /// Nominal supports used to compute the modes only.
    pub basis_supports: Vec<BasisSupport>,
    /// Further places where displacement is output.
    pub probes: Vec<Probe>,
}

/// `[[rotor.segment]]`: a cylindrical shaft section.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Segment {
    /// Length [m]. > 0
    pub length: f64,
    /// Outer diameter [m]. > inner diameter
    pub outer_diameter: f64,
    /// Inner diameter [m]. >= 0
    pub inner_diameter: f64,
    /// Name of the material.
    pub material: String,
}

/// Position and inertia shared by disks and gears: a thin rigid body on the shaft.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Disk {
    /// Distance from the shaft's left end [m].
    pub position: f64,
    /// Mass [kg]. >= 0
    pub mass: f64,
    /// Moment of inertia about the shaft axis [kg m^2]. >= 0
    pub polar_inertia: f64,
    /// Moment of inertia about a diameter [kg m^2]. >= 0
    pub diametral_inertia: f64,
}

/// `[[rotor.gear]]`: a disk with teeth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Gear {
    /// Unique identifier on its rotor.
    pub name: String,
    /// The gear as a rigid body.
    pub body: Disk,
    /// Number of teeth. >= 1
    pub teeth: u32,
    /// Size of the base circle.
    pub base: BaseCircle,
}

/// The base circle of a gear, given directly or by the reference rack.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum BaseCircle {
    /// Base radius R [m]. > 0
    Radius(f64),
    /// R = teeth x module x cos(pressure angle) / 2.
    Rack {
        /// Module [m]. > 0
        module: f64,
        /// Reference pressure angle [rad]. (0, pi/2)
        pressure_angle: f64,
    },
}

/// `[[rotor.bearing]]`: a linear spring and damper between shaft and gearbox.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Bearing {
    /// Unique identifier on its rotor.
    pub name: String,
    /// Distance from the shaft's left end [m].
    pub position: f64,
    /// Stiffness [N/m]; direct terms >= 0. Not used where `at_speed` gives it.
    pub stiffness: Planar,
    /// Damping [N s/m]. Not used where `at_speed` gives it.
    pub damping: Planar,
    /// Coefficients that depend on the rotor's speed.
    pub at_speed: Option<SpeedTable>,
    /// A radial force in addition.
    pub nonlinear: Option<RadialForce>,
}

/// `[rotor.bearing.nonlinear]`: F_r over the radial displacement r of the shaft relative to the gearbox, in addition to the
/// linear spring and damper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RadialForce {
    /// Radial clearance [m]: no force below it. >= 0
    pub clearance: f64,
    /// Force per (r - clearance)^exponent [N/m^exponent]. >= 0
    pub coefficient: f64,
    /// 1: a spring behind a clearance; 3: a cubic spring; 10/9 or 3/2: rollers or balls after Hertz. [1, 3]
    pub exponent: f64,
}

impl Planar {
    /// No coefficient.
    pub const ZERO: Planar = Planar {
        xx: 0.0,
        xy: 0.0,
        yx: 0.0,
        yy: 0.0,
    };

    /// A multiple of all coefficients.
    pub fn times(&self, factor: f64) -> Planar {
        Planar {
            xx: factor * self.xx,
            xy: factor * self.xy,
            yx: factor * self.yx,
            yy: factor * self.yy,
        }
    }
}

impl RadialForce {
    /// No force.
    pub const NONE: RadialForce = RadialForce {
        clearance: 0.0,
        coefficient: 0.0,
        exponent: 1.0,
    };
}

/// Bearing coefficients over the speed of the rotor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpeedTable {
    /// `[[rotor.bearing.at_speed]]`, ascending in speed; at least two.
    pub points: Vec<SpeedPoint>,
    /// `outside_speeds`: what holds below the first and above the last speed.
    pub outside: OutsideSpeeds,
}

/// `[[rotor.bearing.at_speed]]`: the coefficients at one speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SpeedPoint {
    /// Magnitude of the rotor's speed [rad/s]. >= 0
    pub speed: f64,
    /// Stiffness [N/m]; direct terms >= 0.
    pub stiffness: Planar,
    /// Damping [N s/m].
    pub damping: Planar,
}

/// What a speed table says outside its speeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum OutsideSpeeds {
    /// Nothing: such a speed is refused.
    Refuse,
    /// The coefficients at the nearest speed of the table.
    Hold,
}

/// A 2 x 2 coefficient matrix in the x-y plane: force in the first direction per motion in the second.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Planar {
    /// x force per x motion.
    pub xx: f64,
    /// x force per y motion.
    pub xy: f64,
    /// y force per x motion.
    pub yx: f64,
    /// y force per y motion.
    pub yy: f64,
}

/// `[[rotor.unbalance]]`: an eccentric mass turning with the shaft.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Unbalance {
    /// Unique identifier on its rotor.
    pub name: String,
    /// Distance from the shaft's left end [m].
    pub position: f64,
    /// Mass times eccentricity m e [kg m]. >= 0
    pub moment: f64,
    /// Direction relative to the shaft's rotation angle [rad].
    pub phase: f64,
}

/// `[[rotor.bow]]`: offsets of the unloaded shaft's centre line from a straight line, turning with the shaft.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Bow {
    /// Distances from the shaft's left end [m], all different.
    pub positions: Vec<f64>,
    /// Offset at each position [m].
    pub amplitudes: Vec<f64>,
    /// Direction of positive offsets relative to the shaft's rotation angle [rad].
    pub phase: f64,
}

/// `[[rotor.torque]]`: a place where an external torque acts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Torque {
    /// Unique identifier on its rotor.
    pub name: String,
    /// Distance from the shaft's left end [m].
    pub position: f64,
    /// Start value of the torque input [N m].
    pub value: f64,
    /// Resisting torque per angular velocity relative to the mean rotation [N m s/rad]. >= 0
    pub slope: f64,
}

/// `[[rotor.basis_support]]`: a spring to ground used to compute the modes and subtracted again.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BasisSupport {
    /// Distance from the shaft's left end [m].
    pub position: f64,
    /// Lateral stiffness in both planes [N/m]. >= 0
    pub lateral: f64,
    /// Torsional stiffness [N m/rad]. >= 0
    pub torsional: f64,
}

/// `[[rotor.probe]]`: a further place where displacement is output.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Probe {
    /// Unique identifier on its rotor.
    pub name: String,
    /// Distance from the shaft's left end [m].
    pub position: f64,
}

impl Planar {
    /// The coefficients as rows: `[[xx, xy], [yx, yy]]`.
    pub fn rows(&self) -> [[f64; 2]; 2] {
        [[self.xx, self.xy], [self.yx, self.yy]]
    }
}

impl BaseCircle {
    /// Base radius R [m] of a gear with this number of teeth.
    pub fn radius(&self, teeth: u32) -> f64 {
        match *self {
            BaseCircle::Radius(radius) => radius,
            BaseCircle::Rack {
                module,
                pressure_angle,
            } => f64::from(teeth) * module * libm::cos(pressure_angle) / 2.0,
        }
    }
}
