//! A rotor whose rotation is free: everything lateral that depends on its angle, speed and acceleration.
//!
//! ```text
//!   phi = phi_0 + (1'J th)/(1'J 1),   Om = phi',   Om' = (torques + mesh torques - drag) / (1'J 1)
//!   on [A, B]:   (Om - Om_0) G' [B', -A'] + Om' G' [B, -A],   G' = Phi'G Phi        Om_0: speed of the block in use
//!              + (K(Om) - K(Om_0)) (u - u_b) + ... at bearings that depend on the speed; the reverse on the housing under them
//!              - m e (Om^2 cos + Om' sin, Om^2 sin - Om' cos)(phi + d)               unbalance
//!              - Phi'K_s r (cos, sin)(phi + psi)                                     bow
//! ```
//!
//! The angle enters through an observing coupling, the forces leave through one coupling per lateral coordinate.

use nalgebra::DMatrix;

use super::BaseMotion;
use super::inputs::product;
use crate::config::Planar;
use crate::linalg::dot;
use crate::rotor::BowLoad;
use crate::solver::Instant;
use crate::train::Bearing;

/// The speed may leave that of the block in use by this part of it, and this much [rad/s].
const STALE: (f64, f64) = (0.05, 2.0);

/// What a free rotation adds to one rotor.
#[derive(Debug, Clone)]
pub(super) struct Spin {
    /// Index of the rotor.
    pub(super) rotor: usize,
    /// The coupling that observes phi - phi_0 and Om.
    pub(super) turn: usize,
    /// The coupling whose rate is the drag of load slopes on the rigid coordinate.
    pub(super) drag: usize,
    /// The first of the couplings on the lateral coordinates.
    pub(super) first: usize,
    /// Number of lateral coordinates in one plane.
    pub(super) n: usize,
    /// Index of the rigid coordinate.
    pub(super) rigid: usize,
    /// Om' per acceleration of the rigid coordinate: 1 / sqrt(1'J 1).
    pub(super) rotation: f64,
    /// How the forces of other couplings act on the rigid coordinate.
    pub(super) torques: Vec<(usize, f64)>,
    /// How the loads from outside act on it.
    pub(super) loads: Vec<(usize, f64)>,
    /// phi_0 [rad].
    pub(super) angle: f64,
    /// Phi'G Phi.
    pub(super) gyroscopic: DMatrix<f64>,
    /// Shape at the unbalance, moment [kg m], phase [rad].
    pub(super) unbalances: Vec<(Vec<f64>, f64, f64)>,
    /// Residual bow.
    pub(super) bows: Vec<BowLoad>,
    /// Bearings that depend on the speed.
    pub(super) bearings: Vec<SpeedBearing>,
}

/// A bearing that depends on the speed.
#[derive(Debug, Clone)]
pub(super) struct SpeedBearing {
    /// Shape of the lateral modes there.
    pub(super) shape: Vec<f64>,
    /// Its place among the inputs.
    pub(super) input: usize,
    /// The first of the two couplings at the point of the housing that it stands on.
    pub(super) held: Option<usize>,
    /// Its coefficients.
    pub(super) law: Bearing,
}

impl Spin {
    /// Whether the block should follow the speed.
    pub(super) fn is_stale(used: f64, now: f64) -> bool {
        (now - used).abs() > STALE.1.max(STALE.0 * used.abs())
    }

    /// Overwrites the forces of the rotor's couplings; those of meshes must be known. `load` gives a load from
    /// outside, `base` the motion of the gearbox at a bearing.
    pub(super) fn forces_into(
        &self,
        at: Instant<'_>,
        load: impl Fn(usize) -> f64,
        base: impl Fn(usize) -> BaseMotion,
        forces: &mut [f64],
    ) {
        let (turned, speed) = (at.deflection[self.turn], at.rate[self.turn]);
        let mesh_load: f64 = self
            .torques
            .iter()
            .map(|&(coupling, entry)| entry * forces[coupling])
            .sum();
        let drive: f64 = self
            .loads
            .iter()
            .map(|&(number, entry)| entry * load(number))
            .sum();
        let acceleration = self.rotation * (drive - mesh_load - at.rate[self.drag]);
        (forces[self.turn], forces[self.drag]) = (0.0, 0.0);

        let lateral = self.first..self.first + 2 * self.n;
        let (x, y) = at.deflection[lateral.clone()].split_at(self.n);
        let (vx, vy) = at.rate[lateral.clone()].split_at(self.n);
        let (on_rotor, on_housing) = forces[lateral.start..].split_at_mut(lateral.len());
        on_rotor.fill(0.0);
        let (on_x, on_y) = on_rotor.split_at_mut(self.n);
        let excess = speed - at.slow[self.rotor];
        for (j, column) in self.gyroscopic.column_iter().enumerate() {
            let by_y = excess * vy[j] + acceleration * y[j];
            let by_x = excess * vx[j] + acceleration * x[j];
            let both = on_x.iter_mut().zip(&mut *on_y);
            for ((on_x, on_y), entry) in both.zip(column.as_slice()) {
                *on_x += entry * by_y;
                *on_y -= entry * by_x;
            }
        }
        let mut push = |shape: &[f64], force: [f64; 2]| {
            for (i, shape) in shape.iter().enumerate() {
                on_x[i] += shape * force[0];
                on_y[i] += shape * force[1];
            }
        };
        let angle = self.angle + turned;
        for (shape, moment, phase) in &self.unbalances {
            let (sine, cosine) = libm::sincos(angle + phase);
            let [radial, tangential] = [moment * speed * speed, moment * acceleration];
            push(
                shape,
                [
                    -(radial * cosine + tangential * sine),
                    -(radial * sine - tangential * cosine),
                ],
            );
        }
        for bow in &self.bows {
            let (sine, cosine) = libm::sincos(angle + bow.phase);
            push(&bow.load, [-cosine, -sine]);
        }
        for bearing in &self.bearings {
            let now = bearing.law.coefficients(speed);
            let used = bearing.law.coefficients(at.slow[self.rotor]);
            let base = base(bearing.input);
            // The block holds K(Om_0) (u - psi eta) + C(Om_0) (u' - psi eta'); the gearbox's motion from outside is not among
            // the loads.
            let under = |seen: &[f64]| {
                bearing
                    .held
                    .map_or([0.0; 2], |first| [seen[first], seen[first + 1]])
            };
            let relative = |shaft: [&[f64]; 2], under: [f64; 2]| {
                [0, 1].map(|axis| dot(&bearing.shape, shaft[axis]) - under[axis])
            };
            let displacement = relative([x, y], under(at.deflection));
            let velocity = relative([vx, vy], under(at.rate));
            let parts = [
                product(&difference(&now.stiffness, &used.stiffness), displacement),
                product(&difference(&now.damping, &used.damping), velocity),
                product(&now.stiffness, base.displacement).map(|force| -force),
                product(&now.damping, base.velocity).map(|force| -force),
            ];
            let force = [0, 1].map(|axis| parts.iter().map(|part| part[axis]).sum());
            push(&bearing.shape, force);
            if let Some(first) = bearing.held {
                for (axis, force) in force.into_iter().enumerate() {
                    on_housing[first - lateral.end + axis] = -force;
                }
            }
        }
    }
}

fn difference(one: &Planar, two: &Planar) -> Planar {
    Planar {
        xx: one.xx - two.xx,
        xy: one.xy - two.xy,
        yx: one.yx - two.yx,
        yy: one.yy - two.yy,
    }
}
