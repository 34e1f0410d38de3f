//! The forces of a run at every communication point, and how far they are from those of another run.

use geartrain::interface::{Interface, Quantity};
use geartrain::model::Inputs;
use geartrain::simulation::Simulation;

use crate::series;

/// A bearing whose force alternates by less than this part of the largest is judged by that part.
const SMALL: f64 = 1e-3;

/// Forces at every communication point.
#[derive(Debug)]
pub struct Forces {
    /// Communication step [s].
    pub step: f64,
    /// One series per mesh.
    pub meshes: Vec<Vec<f64>>,
    /// One series per bearing, both components.
    pub bearings: Vec<[Vec<f64>; 2]>,
    /// Steps taken, those repeated included.
    pub steps: u64,
}

impl Forces {
    /// Those that a simulation comes to in `count` communication steps, its inputs changing by `rate` per second, where given.
    pub fn of(
        mut simulation: Simulation,
        interface: &Interface,
        (step, count): (f64, u32),
        rate: Option<&Inputs>,
    ) -> Result<Forces, String> {
        let quantities = || interface.variables.iter().map(|variable| variable.quantity);
        let meshes: Vec<Quantity> = quantities()
            .filter(|quantity| matches!(quantity, Quantity::MeshForce { .. }))
            .collect();
        let bearings: Vec<Quantity> = quantities()
            .filter(|quantity| matches!(quantity, Quantity::BearingForce { .. }))
            .collect();
        let mut forces = Forces {
            step,
            meshes: vec![Vec::new(); meshes.len()],
            bearings: vec![[Vec::new(), Vec::new()]; bearings.len() / 2],
            steps: 0,
        };
        for index in 1..=count {
            let reached = simulation.advance_along(f64::from(index) * step, rate);
            reached.map_err(|error| error.to_string())?;
            let motion = simulation.motion();
            for (series, mesh) in forces.meshes.iter_mut().zip(&meshes) {
                series.push(mesh.evaluate(&motion));
            }
            let components = forces.bearings.iter_mut().flatten();
            for (series, bearing) in components.zip(&bearings) {
                series.push(bearing.evaluate(&motion));
            }
        }
        let counts = simulation.counts();
        forces.steps = counts.steps + counts.rejected;
        Ok(forces)
    }

    /// Relative to the alternating part, the worst mesh.
    pub fn mesh_error(&self, converged: &Forces) -> f64 {
        let pairs = self.meshes.iter().zip(&converged.meshes);
        series::worst(
            pairs.map(|(found, right)| {
                series::difference(found, right) / series::alternating(right)
            }),
        )
    }

    /// Relative to the RMS, the worst mesh that carries anything.
    pub fn promised_error(&self, converged: &Forces) -> f64 {
        let pairs = self.meshes.iter().zip(&converged.meshes);
        let carrying = pairs.filter(|(_, right)| series::rms(right) > 0.0);
        series::worst(
            carrying.map(|(found, right)| series::difference(found, right) / series::rms(right)),
        )
    }

    /// Relative to the alternating part of both components, the worst bearing.
    pub fn bearing_error(&self, converged: &Forces) -> f64 {
        let both = |parts: [f64; 2]| libm::hypot(parts[0], parts[1]);
        let size =
            |right: &[Vec<f64>; 2]| both([0, 1].map(|axis| series::alternating(&right[axis])));
        let largest = converged.bearings.iter().map(size).fold(0.0, f64::max);
        let pairs = self.bearings.iter().zip(&converged.bearings);
        series::worst(pairs.map(|(found, right)| {
            let difference =
                both([0, 1].map(|axis| series::difference(&found[axis], &right[axis])));
            difference / size(right).max(SMALL * largest)
        }))
    }
}
