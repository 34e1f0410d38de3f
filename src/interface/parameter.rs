//! The numbers of a model that a master may change until initialization ends.

use crate::config::{
    Config, GearboxVibration, Housing, HousingMode, KnownBearing, Planar, RadialForce,
};

/// A parameter, by the place of its number in the configuration. Indices count from zero.
#[expect(
    missing_docs,
    reason = "the fields are indices of what they are named after"
)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parameter {
    /// `<rotor>.mean_speed`, of the first rotor of a meshed train.
    MeanSpeed { rotor: usize },
    /// `<rotor>.lateral_damping_ratio`
    LateralDampingRatio { rotor: usize },
    /// `<rotor>.torsional_damping_ratio`
    TorsionalDampingRatio { rotor: usize },
    /// `<rotor>.<bearing>.stiffness.xx` and so on.
    BearingStiffness {
        rotor: usize,
        bearing: usize,
        entry: PlanarEntry,
    },
    /// `<rotor>.<bearing>.damping.xx` and so on.
    BearingDamping {
        rotor: usize,
        bearing: usize,
        entry: PlanarEntry,
    },
    /// `<rotor>.<unbalance>.moment`
    UnbalanceMoment { rotor: usize, unbalance: usize },
    /// `<rotor>.<unbalance>.phase`
    UnbalancePhase { rotor: usize, unbalance: usize },
    /// `<mesh>.stiffness_factor`
    StiffnessFactor { mesh: usize },
    /// `<mesh>.backlash`, of unilateral contact.
    Backlash { mesh: usize },
    /// `<rotor>.<bearing>.clearance`, of a radial force.
    Clearance { rotor: usize, bearing: usize },
    /// `gearbox_vibration.*`
    Vibration(VibrationEntry),
    /// `housing.frequency[i]`
    HousingFrequency { mode: usize },
    /// `housing.damping_ratio[i]`
    HousingDampingRatio { mode: usize },
    /// `<point>.stiffness.xx` and so on, of a bearing that a housing knows.
    PointStiffness { point: usize, entry: PlanarEntry },
    /// `<point>.damping.xx` and so on.
    PointDamping { point: usize, entry: PlanarEntry },
    /// `simulation.tolerance`
    Tolerance,
    /// `simulation.input_extrapolation`
    InputExtrapolation,
    /// `simulation.known_bearings`, of a housing whose points name bearings.
    KnownBearings,
}

/// One entry of a 2 x 2 coefficient matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlanarEntry {
    /// x force per x motion.
    Xx,
    /// x force per y motion.
    Xy,
    /// y force per x motion.
    Yx,
    /// y force per y motion.
    Yy,
}

/// One number of the gearbox vibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VibrationEntry {
    /// Amplitude in x.
    AmplitudeX,
    /// Amplitude in y.
    AmplitudeY,
    /// Phase of y.
    PhaseY,
    /// Frequency.
    Frequency,
}

impl Parameter {
    /// The parameter's number in a configuration. The configuration must be the one (or of the same shape
    /// as the one) that the interface was made for.
    pub fn slot(self, config: &mut Config) -> &mut f64 {
        match self {
            Parameter::MeanSpeed { rotor } => &mut config.rotors[rotor].speed,
            Parameter::LateralDampingRatio { rotor } => {
                &mut config.rotors[rotor].lateral_damping_ratio
            }
            Parameter::TorsionalDampingRatio { rotor } => {
                &mut config.rotors[rotor].torsional_damping_ratio
            }
            Parameter::BearingStiffness {
                rotor,
                bearing,
                entry,
            } => entry.slot(&mut config.rotors[rotor].bearings[bearing].stiffness),
            Parameter::BearingDamping {
                rotor,
                bearing,
                entry,
            } => entry.slot(&mut config.rotors[rotor].bearings[bearing].damping),
            Parameter::UnbalanceMoment { rotor, unbalance } => {
                &mut config.rotors[rotor].unbalances[unbalance].moment
            }
            Parameter::UnbalancePhase { rotor, unbalance } => {
                &mut config.rotors[rotor].unbalances[unbalance].phase
            }
            Parameter::StiffnessFactor { mesh } => &mut config.meshes[mesh].stiffness_factor,
            Parameter::Backlash { mesh } => &mut config.meshes[mesh].backlash,
            Parameter::Clearance { rotor, bearing } => {
                let bearing = &mut config.rotors[rotor].bearings[bearing];
                &mut bearing.nonlinear.get_or_insert(RadialForce::NONE).clearance
            }
            Parameter::Vibration(entry) => entry.slot(&mut config.gearbox_vibration),
            Parameter::HousingFrequency { mode } => &mut housing_mode(config, mode).frequency,
            Parameter::HousingDampingRatio { mode } => {
                &mut housing_mode(config, mode).damping_ratio
            }
            Parameter::PointStiffness { point, entry } => {
                entry.slot(&mut known_bearing(config, point).stiffness)
            }
            Parameter::PointDamping { point, entry } => {
                entry.slot(&mut known_bearing(config, point).damping)
            }
            Parameter::Tolerance => &mut config.simulation.tolerance,
            Parameter::InputExtrapolation => &mut config.simulation.input_extrapolation,
            Parameter::KnownBearings => &mut config.simulation.known_bearings,
        }
    }
}

fn housing(config: &mut Config) -> &mut Housing {
    let housing = config.housing.as_mut();
    housing.expect("only a housing has these parameters")
}

fn housing_mode(config: &mut Config, mode: usize) -> &mut HousingMode {
    &mut housing(config).modes[mode]
}

fn known_bearing(config: &mut Config, point: usize) -> &mut KnownBearing {
    let bearing = &mut housing(config).points[point].bearing;
    bearing.get_or_insert(KnownBearing::NONE)
}

impl PlanarEntry {
    /// All entries with their names.
    pub const NAMED: [(&'static str, PlanarEntry); 4] = [
        ("xx", PlanarEntry::Xx),
        ("xy", PlanarEntry::Xy),
        ("yx", PlanarEntry::Yx),
        ("yy", PlanarEntry::Yy),
    ];

    fn slot(self, planar: &mut Planar) -> &mut f64 {
        match self {
            PlanarEntry::Xx => &mut planar.xx,
            PlanarEntry::Xy => &mut planar.xy,
            PlanarEntry::Yx => &mut planar.yx,
            PlanarEntry::Yy => &mut planar.yy,
        }
    }
}

impl VibrationEntry {
    fn slot(self, vibration: &mut GearboxVibration) -> &mut f64 {
        match self {
            VibrationEntry::AmplitudeX => &mut vibration.amplitude_x,
            VibrationEntry::AmplitudeY => &mut vibration.amplitude_y,
            VibrationEntry::PhaseY => &mut vibration.phase_y,
            VibrationEntry::Frequency => &mut vibration.frequency,
        }
    }
}
