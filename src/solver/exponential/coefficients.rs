//! What depends on the length of a step alone.
//!
//! Over a step the forces are cubic polynomials through four nodes, F(s) = sum of l_j(s/h) F_j (`polynomials`), and
//!
//! ```text
//!   eta(x h) = eta_0 + x h phi_1(B x h) (B eta_0 + load) + (x h)^2 phi_2(B x h) load' - sum over j of f_j(x) F_j
//!   f_j(x)   = sum over k of l_jk m_k(x),   m_k(x) = integral of e^(B (x h - s)) (s/h)^k ds b = k! x^(k+1) h phi_(k+1)(B x h) b
//! ```
//!
//! What the couplings see at x follows by the product with their rows.

use nalgebra::Complex;

use super::exchange::{Exchange, Influences};
use super::part::Part;
use super::polynomials::{END, FACTORIAL, LAGRANGE, NODES, PLACES, POWERS};
use crate::linalg::{PhiFunctions, add_scaled, dot};

/// The coefficients of all parts for one step length.
#[derive(Debug, Clone)]
pub(super) struct Coefficients {
    /// h [s]; 0 while unused.
    pub(super) step: f64,
    pub(super) parts: Vec<PartCoefficients>,
    pub(super) influences: Influences,
}

/// Coefficients of one part. Matrices column by column.
#[derive(Debug, Clone)]
pub(super) struct PartCoefficients {
    /// h phi_1 of every group, one after the other.
    pub(super) gain: Vec<f64>,
    /// h^2 phi_2 of every group.
    pub(super) ramp_gain: Vec<f64>,
    /// Deflections and rates at the points per B eta + load: [`Part::readings`] x 2n.
    pub(super) free: Vec<f64>,
    /// The same per change of the load.
    pub(super) ramp: Vec<f64>,
    /// f_j at the end: 2n x actuators, node after node.
    pub(super) columns: [Vec<f64>; NODES],
    /// Deflections and rates at the points per harmonic: readings x harmonics.
    pub(super) turning: Vec<Complex<f64>>,
    /// eta at the end per harmonic: 2n x harmonics.
    pub(super) turning_end: Vec<Complex<f64>>,
}

/// Room for computing coefficients.
#[derive(Debug, Clone)]
pub(super) struct Scratch {
    phi: PhiFunctions,
    /// m_k of every actuator, 2n each.
    moments: [Vec<f64>; POWERS],
    response: Vec<Complex<f64>>,
}

impl Scratch {
    pub(super) fn new(parts: &[Part]) -> Scratch {
        let largest = |size: &dyn Fn(&Part) -> usize| parts.iter().map(size).max().unwrap_or(0);
        let group = largest(&|part| {
            let sizes = part.groups.iter().map(|group| group.matrix.nrows());
            sizes.max().unwrap_or(0)
        });
        let moment = vec![0.0; largest(&|part| part.len() * part.actuators.len())];
        Scratch {
            phi: PhiFunctions::new(group),
            moments: core::array::from_fn(|_| moment.clone()),
            response: vec![Complex::new(0.0, 0.0); largest(&Part::len)],
        }
    }
}

impl Coefficients {
    /// Room for the coefficients of these parts.
    pub(super) fn unused(parts: &[Part], exchange: &Exchange) -> Coefficients {
        Coefficients {
            step: 0.0,
            parts: parts.iter().map(PartCoefficients::unused).collect(),
            influences: Influences::unused(exchange),
        }
    }

    /// Memory in use [bytes].
    pub(super) fn bytes(&self) -> usize {
        let parts: usize = self.parts.iter().map(PartCoefficients::bytes).sum();
        parts + self.influences.bytes()
    }

    /// Computes everything for steps of length h; `frequencies` are those of all harmonics [rad/s].
    pub(super) fn compute(
        &mut self,
        (parts, exchange): (&[Part], &Exchange),
        h: f64,
        frequencies: &[f64],
        scratch: &mut Scratch,
    ) {
        self.step = h;
        self.influences.clear();
        for (number, (part, coefficients)) in parts.iter().zip(&mut self.parts).enumerate() {
            for (point, place) in PLACES.into_iter().enumerate() {
                coefficients.compute_linear(part, h, (point, place), scratch);
                if point == END {
                    coefficients.combine_columns(part, scratch);
                }
                let influences = &mut self.influences;
                add_influences(part, number, point, (exchange, influences), scratch);
                coefficients.compute_turning(part, h, (point, place), frequencies, scratch);
            }
        }
    }
}

impl PartCoefficients {
    fn unused(part: &Part) -> PartCoefficients {
        let (states, actuators) = (part.len(), part.actuators.len());
        let zeros = |count: usize| vec![0.0; count];
        let still = |count: usize| vec![Complex::new(0.0, 0.0); count];
        PartCoefficients {
            gain: zeros(part.groups.iter().map(|group| group.matrix.len()).sum()),
            ramp_gain: zeros(part.groups.iter().map(|group| group.matrix.len()).sum()),
            free: zeros(part.readings() * states),
            ramp: zeros(part.readings() * states),
            columns: core::array::from_fn(|_| zeros(states * actuators)),
            turning: still(part.readings() * part.harmonics.len()),
            turning_end: still(states * part.harmonics.len()),
        }
    }

    fn bytes(&self) -> usize {
        let columns: usize = self.columns.iter().map(Vec::len).sum();
        let complex = 2 * (self.turning.len() + self.turning_end.len());
        (2 * (self.gain.len() + self.free.len()) + columns + complex) * size_of::<f64>()
    }

    /// The free response and the moments at a point.
    fn compute_linear(
        &mut self,
        part: &Part,
        h: f64,
        (point, x): (usize, f64),
        scratch: &mut Scratch,
    ) {
        let states = part.len();
        let mut before = 0;
        for group in &part.groups {
            let (first, m) = (group.first, group.matrix.nrows());
            scratch.phi.evaluate(&group.matrix, x * h);
            let responses = [
                (x * h, 1, &mut self.gain, &mut self.free),
                (x * h * x * h, 2, &mut self.ramp_gain, &mut self.ramp),
            ];
            for (factor, k, gain, seen) in responses {
                let phi = scratch.phi.get(k);
                if point == END {
                    let own = gain[before..before + m * m].iter_mut();
                    own.zip(phi).for_each(|(gain, phi)| *gain = factor * phi);
                }
                for (what, rows) in part.sensor_rows.iter().enumerate() {
                    for (sensor, row) in rows.column_iter().enumerate() {
                        let row = &row.as_slice()[first..first + m];
                        let reading = part.reading(point, what, sensor);
                        for (j, phi) in phi.chunks_exact(m).enumerate() {
                            seen[(first + j) * part.readings() + reading] = factor * dot(row, phi);
                        }
                    }
                }
            }
            before += m * m;
            let mut power = h;
            for (k, moments) in scratch.moments.iter_mut().enumerate() {
                power *= x;
                let (phi, factor) = (scratch.phi.get(k + 1), FACTORIAL[k] * power);
                for (actuator, column) in part.actuator_columns.column_iter().enumerate() {
                    let start = actuator * states + first;
                    let target = &mut moments[start..start + m];
                    target.fill(0.0);
                    for (phi, value) in phi.chunks_exact(m).zip(&column.as_slice()[first..]) {
                        add_scaled(factor * value, phi, target);
                    }
                }
            }
        }
    }

    /// f_j at the end from the moments there.
    fn combine_columns(&mut self, part: &Part, scratch: &Scratch) {
        let used = part.len() * part.actuators.len();
        for (column, l) in self.columns.iter_mut().zip(&LAGRANGE) {
            column.fill(0.0);
            for (l, moment) in l.iter().zip(&scratch.moments) {
                add_scaled(*l, &moment[..used], column);
            }
        }
    }

    /// The response to the harmonics at a point, per unit of e^(i angle) at the start of the step.
    fn compute_turning(
        &mut self,
        part: &Part,
        h: f64,
        (point, x): (usize, f64),
        frequencies: &[f64],
        scratch: &mut Scratch,
    ) {
        let states = part.len();
        for (number, (harmonic, load)) in part.harmonics.iter().enumerate() {
            let response = &mut scratch.response[..states];
            for group in &part.groups {
                let range = group.first..group.first + group.matrix.nrows();
                scratch.phi.oscillator_response(
                    &group.matrix,
                    x * h,
                    frequencies[*harmonic],
                    &load[range.clone()],
                    &mut response[range],
                );
            }
            let own = &mut self.turning[number * part.readings()..(number + 1) * part.readings()];
            for (what, rows) in part.sensor_rows.iter().enumerate() {
                for (sensor, row) in rows.column_iter().enumerate() {
                    let seen = response.iter().zip(row.iter()).map(|(r, w)| r * *w).sum();
                    own[part.reading(point, what, sensor)] = seen;
                }
            }
            if point == END {
                self.turning_end[number * states..(number + 1) * states].copy_from_slice(response);
            }
        }
    }
}

/// Forces, through the moments, to what the sensors see at a point.
fn add_influences(
    part: &Part,
    number: usize,
    point: usize,
    (exchange, influences): (&Exchange, &mut Influences),
    scratch: &Scratch,
) {
    let (states, sensors) = (part.len(), part.sensors.len());
    // Only the bubbles, at the end, need the higher powers.
    let powers = if point == END { POWERS } else { NODES };
    for (what, rows) in part.sensor_rows.iter().enumerate() {
        for actuator in 0..part.actuators.len() {
            let range = actuator * states..(actuator + 1) * states;
            for (sensor, row) in rows.column_iter().enumerate() {
                let entry = (number, actuator * sensors + sensor);
                let mut seen = [0.0; POWERS];
                for (seen, moment) in seen.iter_mut().zip(&scratch.moments[..powers]) {
                    *seen = dot(row.as_slice(), &moment[range.clone()]);
                }
                influences.add(exchange, entry, (point, what), &seen);
                if point == END {
                    influences.add_bubbles(exchange, entry, what, &seen);
                }
            }
        }
    }
}
