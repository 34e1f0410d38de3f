//! The loops that run over all states, two in a step and two around a call.
//!
//! ```text
//!   take loads     load = sum of columns times inputs
//!   look ahead     free responses at the points = rows (B eta + load) + rows load' + response to the harmonics
//!   move           eta + h phi_1 (B eta + load) + h^2 phi_2 load' - sum over j of f_j F_j + response to the harmonics
//!   put together   [q; q'] = V eta
//! ```
//!
//! Each is one operation for `pulp`, compiled once for every width of vectors.

use pulp::{Simd, WithSimd};

use super::super::{Ramp, State};
use super::coefficients::Coefficients;
use super::motion::Motion;
use super::part::Part;
use super::polynomials::NODES;
use super::sight::{Sight, accumulate};
use super::turning::Turning;

/// The loads of a call.
pub(super) struct TakeLoads<'a> {
    pub(super) parts: &'a [Part],
    pub(super) motion: &'a mut Motion,
    pub(super) ramps: &'a [Ramp],
}

/// What the couplings see at the points without forces.
pub(super) struct LookAhead<'a> {
    pub(super) parts: &'a [Part],
    pub(super) coefficients: &'a Coefficients,
    pub(super) motion: &'a mut Motion,
    pub(super) sight: &'a mut Sight,
    pub(super) turning: &'a Turning,
    /// Seconds since the start of the call.
    pub(super) elapsed: f64,
}

/// From the start of the step to its end.
pub(super) struct Move<'a> {
    pub(super) parts: &'a [Part],
    pub(super) coefficients: &'a Coefficients,
    pub(super) motion: &'a mut Motion,
    pub(super) sight: &'a Sight,
    pub(super) turning: &'a Turning,
    /// Room for what acts on one part.
    pub(super) acting: &'a mut [[f64; 2]],
}

/// Displacements and velocities at the end of a call. Gives whether the states are numbers.
pub(super) struct PutTogether<'a> {
    pub(super) parts: &'a [Part],
    pub(super) motion: &'a mut Motion,
    pub(super) state: &'a mut State,
}

impl WithSimd for TakeLoads<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.motion.set_loads(self.parts, self.ramps);
    }
}

impl WithSimd for PutTogether<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        self.motion.put_together(self.parts, self.state);
        self.motion.is_finite()
    }
}

impl WithSimd for LookAhead<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (motion, sight) = (self.motion, self.sight);
        motion.differentiate(self.elapsed);
        sight.stand_still();
        let derivative = motion.derivative.as_flattened();
        let load_rate = motion.load_rate.as_flattened();
        let Coefficients {
            free,
            ramp,
            turning,
            ..
        } = self.coefficients;
        let (mut first, mut turned) = (0, turning.iter());
        for part in self.parts {
            let (states, own) = (part.len(), part.states());
            for &sensor in &part.sensors {
                let (rows, seen) = (first..first + states, &mut sight.free[sensor]);
                accumulate(seen, &free[rows.clone()], &derivative[own.clone()]);
                if motion.ramps {
                    accumulate(seen, &ramp[rows], &load_rate[own.clone()]);
                }
                first += states;
            }
            for (harmonic, _) in &part.harmonics {
                let angle = &self.turning.angles[*harmonic];
                for (&sensor, turned) in part.sensors.iter().zip(&mut turned) {
                    accumulate(&mut sight.free[sensor], turned, angle);
                }
            }
        }
    }
}

impl WithSimd for Move<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Coefficients {
            gain,
            ramp_gain,
            columns,
            ..
        } = self.coefficients;
        let mut columns = columns.as_slice();
        for part in self.parts {
            let acting = &mut self.acting[..part.columns() / 2];
            let (forces, angles) = acting.split_at_mut(NODES / 2 * part.actuators.len());
            for (target, &actuator) in forces.chunks_exact_mut(2).zip(&part.actuators) {
                let [a, b, c, d] = self.sight.forces[actuator];
                target.copy_from_slice(&[[-a, -b], [-c, -d]]);
            }
            for (target, (harmonic, _)) in angles.iter_mut().zip(&part.harmonics) {
                *target = self.turning.angles[*harmonic];
            }
            let (own, others) = columns.split_at(part.columns() * part.quads().len());
            self.motion.advance(part, [gain, ramp_gain], own, acting);
            columns = others;
        }
        self.motion.advance_others(gain, ramp_gain);
    }
}
