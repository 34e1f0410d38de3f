//! The static solution a simulation starts from.
//!
//! ```text
//!   K q + sum over couplings of b F(w q) = f - Z mu,   Z' q = 0
//! ```
//!
//! f holds the torques and the gearbox displacements; mesh forces are those of the mean mesh stiffness. Z spans the
//! rigid rotations that no mesh resists; torque that nothing balances is carried by their acceleration mu, and
//! the mean rotation (weighted with inertia) is zero. Without unilateral contact and radial bearings this is linear
//! (`linear`), otherwise Newton's method finds it (`contact`).

mod contact;
mod linear;

use core::fmt;

use super::{Inputs, Mesh, ModalModel};
use contact::Laws;
use linear::Held;

/// The static solution.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// q.
    pub position: Vec<f64>,
    /// Normal force of each mesh, negative where the back flank carries it [N].
    pub mesh_forces: Vec<f64>,
}

/// A rotor that nothing holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoEquilibrium {
    /// Its index; `None` when the rotors together are not held.
    pub rotor: Option<usize>,
}

/// Solves for the static displacement under the inputs' torques and gearbox displacements.
pub fn equilibrium(model: &ModalModel, inputs: &Inputs) -> Result<Equilibrium, NoEquilibrium> {
    let load = inputs.static_load(model);
    let laws = Laws::of(model, inputs);
    let position = if laws.are_linear() {
        let tangent = laws.tangent(&vec![0.0; model.system.size]);
        Held::of(model, &tangent, 0.0)?.solve(&load, &tangent)?
    } else {
        laws.settle(&load)?
    };
    let force = |mesh: &Mesh| laws.mesh_force(mesh, &position);
    let mesh_forces = model.meshes.iter().map(force).collect();
    Ok(Equilibrium {
        position,
        mesh_forces,
    })
}

/// How the static displacement changes when the inputs change along `direction`: the solution of the equations
/// linearized at `position`, the static displacement under `inputs`.
pub fn equilibrium_change(
    model: &ModalModel,
    inputs: &Inputs,
    position: &[f64],
    direction: &Inputs,
) -> Result<Vec<f64>, NoEquilibrium> {
    let tangent = Laws::of(model, inputs).tangent_change(position, direction);
    Held::of(model, &tangent, 0.0)?.solve(&direction.static_load(model), &tangent)
}

impl fmt::Display for NoEquilibrium {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let advice = "check its bearings, or use start = \"rest\"";
        match self.rotor {
            Some(rotor) => write!(
                f,
                "rotor {} has no static equilibrium: it can move freely; {advice}",
                rotor + 1
            ),
            None => write!(
                f,
                "the rotors together have no static equilibrium; {advice}"
            ),
        }
    }
}
