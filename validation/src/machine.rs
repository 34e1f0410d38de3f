//! The example in the variants that are compared: excitation, basis, torque of the mesh.

use std::path::Path;

use geartrain::config::{Basis, BasisModes, Config, Start, TorqueCoupling};
use geartrain::model::ModalModel;
use geartrain::simulation::Simulation;
use geartrain::train::{GearTrain, load, validate};

/// Frequency of the gearbox vibration [Hz]; from the paper.
pub const VIBRATION: f64 = 1200.0;
/// Amplitude of the gearbox vibration in x and y, a quarter period apart [m]; assumed.
pub const VIBRATION_AMPLITUDE: f64 = 25e-6;
/// Small and large imbalance of each gear [kg m]; assumed.
pub const IMBALANCES: [f64; 2] = [5e-6, 1.5e-4];

/// The paper's four cases of excitation, 1 to 4.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Case(pub usize);

/// What represents each rotor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shapes {
    /// Three modes, as in the paper.
    Three,
    /// Every mode up to 5400 Hz, three times the mesh frequency, and static shapes: what `inspect` recommends.
    Converged,
    /// Every mode up to 16 kHz and static shapes, to see that the former has converged.
    Finer,
}

/// One variant of the example.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variant {
    /// The excitation.
    pub case: Case,
    /// What represents each rotor.
    pub shapes: Shapes,
    /// Which motions the mesh torques follow.
    pub torque: TorqueCoupling,
    /// What the simulation starts from.
    pub start: Start,
    /// A rotor whose shaft is stiffer by a factor: Young's modulus of all its segments.
    pub stiffened: Option<(usize, f64)>,
}

impl Variant {
    /// A case with consistent mesh torques.
    pub fn of(case: usize, shapes: Shapes) -> Variant {
        Variant {
            case: Case(case),
            shapes,
            torque: TorqueCoupling::Consistent,
            start: Start::Equilibrium,
            stiffened: None,
        }
    }

    /// The valid train.
    pub fn train(&self) -> GearTrain {
        let (train, _) = validate(&self.config()).expect("the example stays valid");
        train
    }

    /// A simulation at its start.
    pub fn simulation(&self) -> Simulation {
        let train = self.train();
        let model = ModalModel::assemble(&train, None).expect("the example has modes");
        let torques = train.rotors.iter().flat_map(|rotor| &rotor.torques);
        let inputs =
            model.inputs_at_rest(&torques.map(|torque| torque.value).collect::<Vec<f64>>());
        Simulation::start(model, inputs, &train.simulation, 0.0).expect("it has an equilibrium")
    }

    fn config(&self) -> Config {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/three_stage.toml");
        let text = std::fs::read_to_string(path).expect("the example is part of the repository");
        let mut config = load(&text).expect("the example is valid").config;
        config.simulation.start = self.start;
        let Case(case) = self.case;
        let shaken = if case.is_multiple_of(2) {
            VIBRATION_AMPLITUDE
        } else {
            0.0
        };
        config.gearbox_vibration.amplitude_x = shaken;
        config.gearbox_vibration.amplitude_y = shaken;
        for rotor in &mut config.rotors {
            rotor.unbalances[0].moment = IMBALANCES[usize::from(case > 2)];
        }
        config.basis = Some(match self.shapes {
            Shapes::Three => Basis {
                modes: Some(BasisModes::Counts {
                    lateral_modes: 3,
                    torsional_modes: 3,
                }),
                static_shapes: false,
            },
            Shapes::Converged => up_to(5400.0),
            Shapes::Finer => up_to(16_000.0),
        });
        for mesh in &mut config.meshes {
            mesh.torque_coupling = self.torque;
        }
        if let Some((rotor, factor)) = self.stiffened {
            let mut stiff = config.materials["default"];
            stiff.youngs_modulus *= factor;
            config.materials.insert("stiffened".to_string(), stiff);
            for segment in &mut config.rotors[rotor].segments {
                segment.material = "stiffened".to_string();
            }
        }
        config
    }
}

fn up_to(frequency: f64) -> Basis {
    Basis {
        modes: Some(BasisModes::MaxFrequency(frequency)),
        static_shapes: true,
    }
}
