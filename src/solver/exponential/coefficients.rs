//! What depends on the length of a step alone.
//!
//! Over a step the forces are cubic polynomials through four Lobatto nodes, F(s) = sum of l_j(s/h) F_j, and
//!
//! ```text
//!   eta(x h) = eta_0 + x h phi_1(B x h) (B eta_0 + load) - sum over j of f_j(x) F_j
//!   f_j(x)   = sum over k of l_jk m_k(x),   m_k(x) = integral of e^(B (x h - s)) (s/h)^k ds b = k! x^(k+1) h phi_(k+1)(B x h) b
//! ```
//!
//! What the couplings see at x follows by the product with their rows. At two further places, near both ends, the true
//! forces are compared with the cubic; the quintic through all six places says what the cubic leaves out. Two places,
//! because forces that pass from one level to another are odd about the middle of the step.

use nalgebra::{Complex, DMatrix};

use super::part::Part;
use crate::linalg::{PhiFunctions, add_scaled, dot};

/// Nodes of the force polynomial.
pub(super) const NODES: usize = 4;
/// Places where forces are evaluated: the nodes behind the first one, and two for comparison.
pub(super) const POINTS: usize = 5;
/// Where they are in the step: a, b, 1, and a/2, 1 - a/2 with a = (1 - 1/sqrt 5)/2, b = 1 - a.
pub(super) const PLACES: [f64; POINTS] = [INNER, 1.0 - INNER, 1.0, 0.5 * INNER, 1.0 - 0.5 * INNER];
const INNER: f64 = 0.276_393_202_250_021_03;
const SQRT_5: f64 = 2.236_067_977_499_79;
/// The point at the end of the step, and those for comparison.
pub(super) const END: usize = 2;
pub(super) const CHECKS: [usize; 2] = [3, 4];
/// All points in the order of time.
pub(super) const IN_TIME: [usize; POINTS] = [3, 0, 1, 4, 2];
/// l_jk: coefficients of the Lagrange polynomials on the nodes 0, a, b, 1 (a + b = 1, a b = 1/5).
const LAGRANGE: [[f64; NODES]; NODES] = [
    [1.0, -6.0, 10.0, -5.0],
    [
        0.0,
        5.0 * SQRT_5 * (1.0 - INNER),
        -5.0 * SQRT_5 * (2.0 - INNER),
        5.0 * SQRT_5,
    ],
    [
        0.0,
        -5.0 * SQRT_5 * INNER,
        5.0 * SQRT_5 * (1.0 + INNER),
        -5.0 * SQRT_5,
    ],
    [0.0, 1.0, -5.0, 5.0],
];
/// l_j at the points for comparison.
pub(super) const LAGRANGE_AT_CHECKS: [[f64; NODES]; 2] = [
    [
        0.348_606_797_749_978_97,
        0.779_508_497_187_473_7,
        -0.184_016_994_374_947_42,
        0.055_901_699_437_494_74,
    ],
    [
        0.055_901_699_437_494_74,
        -0.184_016_994_374_947_42,
        0.779_508_497_187_473_7,
        0.348_606_797_749_978_97,
    ],
];
/// Powers of s/h in use.
const POWERS: usize = 6;
/// The quintics that are one at one point for comparison and zero at the other and at the nodes.
const BUBBLES: [[f64; POWERS]; 2] = [
    [
        0.0,
        24.721_359_549_995_794,
        -177.013_771_190_877_74,
        419.327_278_845_375_8,
        -410.462_936_659_008_7,
        143.428_069_454_514_87,
    ],
    [
        0.0,
        -3.964_254_340_907_179,
        52.471_139_936_346_05,
        -211.756_226_754_489_63,
        306.677_410_613_565_6,
        -143.428_069_454_514_87,
    ],
];
/// k!.
const FACTORIAL: [f64; POWERS] = [1.0, 1.0, 2.0, 6.0, 24.0, 120.0];

/// Coefficients of one part for one step length. Matrices column by column.
#[derive(Debug, Clone)]
pub(super) struct PartCoefficients {
    /// h phi_1 of every group, one after the other.
    pub(super) gain: Vec<f64>,
    /// Deflection (0) and rate (1) at a point per B eta + load: a row of 2n for every sensor.
    pub(super) free: [[Vec<f64>; 2]; POINTS],
    /// f_j at the end: a column of 2n for every actuator.
    pub(super) columns: [Vec<f64>; NODES],
    /// Deflection and rate at a point per force at a node: sensors x actuators.
    pub(super) node: [[[Vec<f64>; NODES]; 2]; POINTS],
    /// Deflection and rate at the end per bubble of a force at either check: sensors x actuators.
    pub(super) bubble: [[Vec<f64>; 2]; 2],
    /// Deflection and rate at a point per harmonic: one number for every sensor, harmonic after harmonic.
    pub(super) turning: [[Vec<Complex<f64>>; 2]; POINTS],
    /// eta at the end per harmonic: 2n numbers, harmonic after harmonic.
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

impl PartCoefficients {
    /// Room for the coefficients of a part.
    pub(super) fn unused(part: &Part) -> PartCoefficients {
        let (states, sensors, actuators) = (part.len(), part.sensors.len(), part.actuators.len());
        let zeros = |count: usize| vec![0.0; count];
        let still = |count: usize| vec![Complex::new(0.0, 0.0); count];
        let gain = part.groups.iter().map(|group| group.matrix.len()).sum();
        PartCoefficients {
            gain: zeros(gain),
            free: core::array::from_fn(|_| [0, 1].map(|_| zeros(states * sensors))),
            columns: core::array::from_fn(|_| zeros(states * actuators)),
            node: core::array::from_fn(|_| {
                [0, 1].map(|_| core::array::from_fn(|_| zeros(sensors * actuators)))
            }),
            bubble: [0, 1].map(|_| [0, 1].map(|_| zeros(sensors * actuators))),
            turning: core::array::from_fn(|_| {
                [0, 1].map(|_| still(sensors * part.harmonics.len()))
            }),
            turning_end: still(states * part.harmonics.len()),
        }
    }

    /// Memory in use [bytes].
    pub(super) fn bytes(&self) -> usize {
        let free: usize = self.free.iter().flatten().map(Vec::len).sum();
        let node: usize = self.node.iter().flatten().flatten().map(Vec::len).sum();
        let columns: usize = self.columns.iter().map(Vec::len).sum();
        (self.gain.len() + free + node + columns) * size_of::<f64>()
    }

    /// Computes everything for steps of length h; `frequencies` are those of all harmonics [rad/s].
    pub(super) fn compute(
        &mut self,
        part: &Part,
        h: f64,
        frequencies: &[f64],
        scratch: &mut Scratch,
    ) {
        for (point, place) in PLACES.into_iter().enumerate() {
            self.compute_linear(part, h, (point, place), scratch);
            self.combine_moments(part, point, scratch);
            self.compute_turning(part, h, (point, place), frequencies, scratch);
        }
    }

    /// The free response and the moments at a point.
    fn compute_linear(
        &mut self,
        part: &Part,
        h: f64,
        (point, place): (usize, f64),
        scratch: &mut Scratch,
    ) {
        let (states, x) = (part.len(), place);
        let mut gain_offset = 0;
        for group in &part.groups {
            let (first, m) = (group.first, group.matrix.nrows());
            scratch.phi.evaluate(&group.matrix, x * h);
            let phi_1 = scratch.phi.get(1);
            if point == END {
                let gain = &mut self.gain[gain_offset..gain_offset + m * m];
                gain.iter_mut()
                    .zip(phi_1)
                    .for_each(|(gain, phi)| *gain = h * phi);
                gain_offset += m * m;
            }
            for (free, rows) in self.free[point].iter_mut().zip(&part.sensor_rows) {
                for (sensor, row) in rows.column_iter().enumerate() {
                    let row = &row.as_slice()[first..first + m];
                    for j in 0..m {
                        free[sensor * states + first + j] =
                            x * h * dot(row, &phi_1[j * m..(j + 1) * m]);
                    }
                }
            }
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

    /// Forces at the nodes, through the moments, to what the sensors see at a point and the states at the end.
    fn combine_moments(&mut self, part: &Part, point: usize, scratch: &Scratch) {
        let (states, sensors) = (part.len(), part.sensors.len());
        for (what, rows) in part.sensor_rows.iter().enumerate() {
            for node in &mut self.node[point][what] {
                node.fill(0.0);
            }
            if point == END {
                self.bubble[what]
                    .iter_mut()
                    .for_each(|bubble| bubble.fill(0.0));
            }
            for actuator in 0..part.actuators.len() {
                let range = actuator * states..(actuator + 1) * states;
                for (sensor, row) in rows.column_iter().enumerate() {
                    let entry = actuator * sensors + sensor;
                    let powers = if point == END { POWERS } else { NODES };
                    for (k, moment) in scratch.moments[..powers].iter().enumerate() {
                        let seen = dot(row.as_slice(), &moment[range.clone()]);
                        if k < NODES {
                            for (node, l) in self.node[point][what].iter_mut().zip(&LAGRANGE) {
                                node[entry] += l[k] * seen;
                            }
                        }
                        if point == END {
                            for (bubble, b) in self.bubble[what].iter_mut().zip(&BUBBLES) {
                                bubble[entry] += b[k] * seen;
                            }
                        }
                    }
                }
            }
        }
        if point == END {
            let used = states * part.actuators.len();
            for (column, l) in self.columns.iter_mut().zip(&LAGRANGE) {
                column.fill(0.0);
                for (l, moment) in l.iter().zip(&scratch.moments) {
                    add_scaled(*l, &moment[..used], column);
                }
            }
        }
    }

    /// The response to the harmonics at a point, per unit of e^(i angle) at the start of the step.
    fn compute_turning(
        &mut self,
        part: &Part,
        h: f64,
        (point, place): (usize, f64),
        frequencies: &[f64],
        scratch: &mut Scratch,
    ) {
        let (states, sensors) = (part.len(), part.sensors.len());
        for (number, (harmonic, load)) in part.harmonics.iter().enumerate() {
            let response = &mut scratch.response[..states];
            for group in &part.groups {
                let range = group.first..group.first + group.matrix.nrows();
                scratch.phi.oscillator_response(
                    &group.matrix,
                    place * h,
                    frequencies[*harmonic],
                    &load[range.clone()],
                    &mut response[range],
                );
            }
            for (turning, rows) in self.turning[point].iter_mut().zip(&part.sensor_rows) {
                let target = &mut turning[number * sensors..(number + 1) * sensors];
                for (seen, row) in target.iter_mut().zip(rows.column_iter()) {
                    *seen = response.iter().zip(row.iter()).map(|(r, w)| r * *w).sum();
                }
            }
            if point == END {
                self.turning_end[number * states..(number + 1) * states].copy_from_slice(response);
            }
        }
    }
}

/// y += A x for A column by column with `y.len()` rows.
pub(super) fn add_product(matrix: &[f64], x: &[f64], y: &mut [f64]) {
    if y.is_empty() {
        return;
    }
    for (column, factor) in matrix.chunks_exact(y.len()).zip(x) {
        add_scaled(*factor, column, y);
    }
}

/// The groups' matrices times the states.
pub(super) fn multiply_groups(part: &Part, states: &[f64], result: &mut [f64]) {
    for group in &part.groups {
        let (first, m) = (group.first, group.matrix.nrows());
        let target = &mut result[first..first + m];
        target.fill(0.0);
        let matrix: &DMatrix<f64> = &group.matrix;
        add_product(matrix.as_slice(), &states[first..first + m], target);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(polynomial: &[f64], x: f64) -> f64 {
        polynomial.iter().rev().fold(0.0, |sum, c| sum * x + c)
    }

    #[test]
    fn polynomials_are_one_at_their_own_place_and_zero_at_the_others() {
        let nodes = [0.0, PLACES[0], PLACES[1], PLACES[2]];
        let checks = CHECKS.map(|point| PLACES[point]);
        // 1e-12: rounding of coefficients of some hundreds.
        let is = |found: f64, expected: f64| (found - expected).abs() < 1e-12;
        for (j, polynomial) in LAGRANGE.iter().enumerate() {
            for (i, &node) in nodes.iter().enumerate() {
                assert!(is(value(polynomial, node), f64::from(u8::from(i == j))));
            }
            for (check, values) in checks.iter().zip(LAGRANGE_AT_CHECKS) {
                assert!(is(value(polynomial, *check), values[j]));
            }
        }
        for (j, polynomial) in BUBBLES.iter().enumerate() {
            for (i, &check) in checks.iter().enumerate() {
                assert!(is(value(polynomial, check), f64::from(u8::from(i == j))));
            }
            for node in nodes {
                assert!(is(value(polynomial, node), 0.0));
            }
        }
    }
}
