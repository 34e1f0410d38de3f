//! A slave as a master has it, in safe Rust.

use geartrain::interface::{Causality, Interface};
use geartrain::slave::{Experiment, Slave};

use super::{assembled, valid};

/// A slave just instantiated.
pub fn born(text: &str) -> Slave {
    Slave::new(&valid(text).config.to_bytes()).expect("a packed model is valid")
}

/// A slave in initialization mode, with its variables.
pub fn initializing(text: &str, tolerance: f64) -> (Slave, Interface) {
    let loaded = valid(text);
    let interface = Interface::of(&loaded.config, &loaded.train, &assembled(text));
    let mut slave = born(text);
    let experiment = Experiment {
        tolerance: Some(tolerance),
        start: 0.0,
        stop: None,
    };
    slave.setup_experiment(experiment).unwrap();
    slave.enter_initialization().unwrap();
    (slave, interface)
}

/// A slave that takes steps, with its variables.
pub fn stepping(text: &str, tolerance: f64) -> (Slave, Interface) {
    let (mut slave, interface) = initializing(text, tolerance);
    slave.exit_initialization().unwrap();
    (slave, interface)
}

/// The value references of all variables with a causality.
pub fn references(interface: &Interface, causality: Causality) -> Vec<u32> {
    let numbered = interface.variables.iter().enumerate();
    numbered
        .filter(|(_, variable)| variable.causality() == causality)
        .map(|(index, _)| u32::try_from(index).unwrap())
        .collect()
}

/// The values of variables.
pub fn read(slave: &mut Slave, references: &[u32]) -> Vec<f64> {
    let mut values = vec![0.0; references.len()];
    slave.get_real(references, &mut values).unwrap();
    values
}
