//! What depends on the length of a step alone.
//!
//! Over a step the forces are cubic polynomials through four nodes, F(s) = sum of l_j(s/h) F_j (`polynomials`), and
//!
//! ```text
//!   eta(x h) = eta_0 + x h phi_1(B x h) (B eta_0 + load) + (x h)^2 phi_2(B x h) load' - sum over j of f_j(x) F_j
//!   f_j(x)   = sum over k of l_jk m_k(x),   m_k(x) = integral of e^(B (x h - s)) (s/h)^k ds b = k! x^(k+1) h phi_(k+1)(B x h) b
//! ```
//!
//! What the couplings see at x follows by the product with their rows. Lists run over parts or panels, then over what touches
//! them, then over their states.

use nalgebra::Complex;

use super::block_diagonal::BlockDiagonal;
use super::exchange::{Exchange, Influences};
use super::lanes::Quad;
use super::panel::{Panels, Place};
use super::part::Part;
use super::polynomials::{END, FACTORIAL, LAGRANGE, NODES, PLACES, POWERS};
use super::sight::{Readings, STILL, both};
use crate::linalg::{Group, Line, PHI_ORDERS, PhiFunctions, dot};

/// The coefficients of all parts for one step length.
#[derive(Debug, Clone)]
pub(super) struct Coefficients {
    /// h phi_1.
    pub(super) gain: BlockDiagonal,
    /// h^2 phi_2.
    pub(super) ramp_gain: BlockDiagonal,
    /// What sensors read per B eta + load: per panel, sensor and state.
    pub(super) free: Vec<Readings>,
    /// The same per change of the load.
    pub(super) ramp: Vec<Readings>,
    /// What the end takes from what acts on a part: per part and quad of states -f_j of every node of every actuator, then the
    /// responses to the cosine and to the sine of every harmonic.
    pub(super) columns: Vec<Quad>,
    /// What sensors read per cosine and sine of the angle of a harmonic: per panel, sensor and harmonic.
    pub(super) turning: Vec<[Readings; 2]>,
    /// e^(i w h) of every harmonic.
    pub(super) rotations: Vec<Complex<f64>>,
    pub(super) influences: Influences,
}

/// Room for computing coefficients.
#[derive(Debug, Clone)]
pub(super) struct Scratch {
    phi: PhiFunctions,
    /// m_k of every actuator, len each.
    moments: Vec<[f64; POWERS]>,
    /// The response to every harmonic of a part, len each.
    responses: Vec<Complex<f64>>,
    /// e^(i w x h) of all harmonics.
    turned: Vec<Complex<f64>>,
}

/// A node of the step: its number and x.
type Spot = (usize, f64);

/// One group of a part at a place of a step.
#[derive(Clone, Copy)]
struct Share<'a> {
    part: &'a Part,
    group: &'a Group,
    place: &'a Place,
    node: Spot,
    h: f64,
}

impl Scratch {
    pub(super) fn new(parts: &[Part], harmonics: usize) -> Scratch {
        let largest = |size: &dyn Fn(&Part) -> usize| parts.iter().map(size).max().unwrap_or(0);
        let group = largest(&|part| {
            let sizes = part.groups.iter().map(|group| group.matrix.nrows());
            sizes.max().unwrap_or(0)
        });
        let still = Complex::new(0.0, 0.0);
        Scratch {
            phi: PhiFunctions::new(group),
            moments: vec![[0.0; POWERS]; largest(&|part| part.len() * part.actuators.len())],
            responses: vec![still; largest(&|part| part.len() * part.harmonics.len())],
            turned: vec![still; harmonics],
        }
    }

    /// Zeros for the states that stay zero.
    fn clear(&mut self, part: &Part) {
        self.moments[..part.len() * part.actuators.len()].fill([0.0; POWERS]);
        self.responses[..part.len() * part.harmonics.len()].fill(Complex::new(0.0, 0.0));
    }
}

impl Coefficients {
    /// Room for the coefficients of these parts under so many harmonics.
    pub(super) fn unused(
        parts: &[Part],
        panels: &Panels,
        exchange: &Exchange,
        harmonics: usize,
    ) -> Coefficients {
        let columns = parts.iter().map(|part| part.columns() * part.quads().len());
        Coefficients {
            gain: BlockDiagonal::zero(parts),
            ramp_gain: BlockDiagonal::zero(parts),
            free: vec![STILL; panels.states],
            ramp: vec![STILL; panels.states],
            columns: vec![[0.0; 4]; columns.sum()],
            turning: vec![[STILL; 2]; panels.harmonics],
            rotations: vec![Complex::new(1.0, 0.0); harmonics],
            influences: Influences::unused(exchange),
        }
    }

    /// Makes room for parts taken apart anew: what depends on their groups; everything else is overwritten when computed.
    pub(super) fn forget(&mut self, parts: &[Part]) {
        self.gain = BlockDiagonal::zero(parts);
        self.ramp_gain = BlockDiagonal::zero(parts);
    }

    /// Memory in use [bytes].
    pub(super) fn bytes(&self) -> usize {
        let readings = 2 * (self.free.len() + self.turning.len()) * size_of::<Readings>();
        let numbers = 4 * self.columns.len() + 2 * self.rotations.len();
        let matrices = self.gain.bytes() + self.ramp_gain.bytes();
        readings + numbers * size_of::<f64>() + matrices + self.influences.bytes()
    }

    /// Computes everything for steps of length h; `frequencies` are those of all harmonics [rad/s].
    pub(super) fn compute(
        &mut self,
        (parts, panels, exchange): (&[Part], &Panels, &Exchange),
        h: f64,
        frequencies: &[f64],
        scratch: &mut Scratch,
    ) {
        self.influences.clear();
        for (point, x) in PLACES.into_iter().enumerate().skip(1) {
            let time = x * h;
            for (turned, frequency) in scratch.turned.iter_mut().zip(frequencies) {
                let (sine, cosine) = libm::sincos(frequency * time);
                *turned = Complex::new(cosine, sine);
            }
            if point == END {
                self.rotations.copy_from_slice(&scratch.turned);
            }
            let mut columns = 0;
            for (number, (part, place)) in parts.iter().zip(&panels.of_parts).enumerate() {
                self.compute_linear(part, place, h, (point, x), (frequencies, scratch));
                if point == END {
                    self.combine_columns(part, &mut columns, scratch);
                }
                let influences = &mut self.influences;
                add_influences(part, number, point, (exchange, influences), scratch);
                self.compute_turning(part, place, point, scratch);
            }
        }
    }

    /// At a point: the response without forces, the moments, and the responses to the harmonics.
    fn compute_linear(
        &mut self,
        part: &Part,
        place: &Place,
        h: f64,
        (point, x): Spot,
        (frequencies, scratch): (&[f64], &mut Scratch),
    ) {
        scratch.clear(part);
        for (group, matrix) in part.groups.iter().map(|group| (group, &group.matrix)) {
            let share = Share {
                part,
                group,
                place,
                node: (point, x),
                h,
            };
            match scratch.phi.evaluate_small(matrix, x * h) {
                Some(lines) => self.follow_lines(share, &lines, scratch),
                None => {
                    scratch.phi.evaluate(matrix, x * h);
                    self.follow_block(share, scratch);
                }
            }
            let (first, m) = (group.first, matrix.nrows());
            for (number, (harmonic, load)) in part.harmonics.iter().enumerate() {
                let driven = (frequencies[*harmonic], scratch.turned[*harmonic]);
                let response = &mut scratch.responses[number * part.len() + first..][..m];
                let load = &load[first..first + m];
                let block = (matrix, x * h);
                scratch
                    .phi
                    .oscillator_response(block, driven, load, response);
            }
        }
    }

    /// Responses and moments of a group of one or two states, whose phi_k are level + slope S.
    fn follow_lines(&mut self, share: Share<'_>, phi: &[Line; PHI_ORDERS], scratch: &mut Scratch) {
        let Share {
            part,
            group,
            place,
            node: (point, x),
            h,
        } = share;
        let (states, own) = (part.len(), group.first..group.first + group.matrix.nrows());
        let time = x * h;
        let responses = [
            (time, phi[1], &mut self.gain, &mut self.free),
            (time * time, phi[2], &mut self.ramp_gain, &mut self.ramp),
        ];
        for (factor, phi, gain, seen) in responses {
            let (level, slope) = (factor * phi.level, factor * phi.slope);
            if point == END {
                gain.set_line(part, group, level, slope);
            }
            for sensor in 0..part.sensors.len() {
                for state in own.clone() {
                    let readings = &mut seen[place.states(sensor) + state];
                    let state = sensor * states + state;
                    let (rows, slopes) = (part.sensor_rows[state], part.sensor_slopes[state]);
                    for (what, (row, along)) in rows.into_iter().zip(slopes).enumerate() {
                        readings[what][point] = level * row + slope * along;
                    }
                }
            }
        }
        let (factors, mut power) = (FACTORIAL, h);
        let phi: [Line; POWERS] = core::array::from_fn(|k| {
            power *= x;
            let factor = factors[k] * power;
            Line {
                level: factor * phi[k + 1].level,
                slope: factor * phi[k + 1].slope,
            }
        });
        let columns = part.actuator_columns.as_slice();
        let slopes = part.actuator_slopes.as_slice();
        for actuator in 0..part.actuators.len() {
            for state in own.clone().map(|state| actuator * states + state) {
                let (column, along) = (columns[state], slopes[state]);
                for (moment, phi) in scratch.moments[state].iter_mut().zip(&phi) {
                    *moment = phi.level * column + phi.slope * along;
                }
            }
        }
    }

    /// Responses and moments of a larger group.
    fn follow_block(&mut self, share: Share<'_>, scratch: &mut Scratch) {
        let Share {
            part,
            group,
            place,
            node: (point, x),
            h,
        } = share;
        let (states, first, m) = (part.len(), group.first, group.matrix.nrows());
        let time = x * h;
        let responses = [
            (time, 1, &mut self.gain, &mut self.free),
            (time * time, 2, &mut self.ramp_gain, &mut self.ramp),
        ];
        for (factor, k, gain, seen) in responses {
            let phi = scratch.phi.get(k);
            if point == END {
                gain.set(part, group, factor, phi);
            }
            for sensor in 0..part.sensors.len() {
                let start = sensor * states + first;
                let rows = &part.sensor_rows[start..start + m];
                let own = &mut seen[place.states(sensor) + first..][..m];
                for (readings, phi) in own.iter_mut().zip(phi.chunks_exact(m)) {
                    let [deflection, rate] = both(rows, phi);
                    readings[0][point] = factor * deflection;
                    readings[1][point] = factor * rate;
                }
            }
        }
        let mut power = h;
        for (k, factor) in FACTORIAL.into_iter().enumerate() {
            power *= x;
            let phi = scratch.phi.get(k + 1);
            for (actuator, column) in part.actuator_columns.column_iter().enumerate() {
                let own = &column.as_slice()[first..first + m];
                let moments = &mut scratch.moments[actuator * states + first..][..m];
                for (i, moment) in moments.iter_mut().enumerate() {
                    let terms = own.iter().enumerate().map(|(j, own)| phi[i + j * m] * own);
                    moment[k] = factor * power * terms.sum::<f64>();
                }
            }
        }
    }

    /// The columns of the part, which begin at `begin`, from moments and responses at the end.
    fn combine_columns(&mut self, part: &Part, begin: &mut usize, scratch: &Scratch) {
        let (states, width) = (part.len(), part.columns());
        let own = &mut self.columns[*begin..][..width * part.quads().len()];
        *begin += own.len();
        let turning = NODES * part.actuators.len();
        for state in 0..states {
            let (row, lane) = (&mut own[state / 4 * width..][..width], state % 4);
            let (forces, angles) = row.split_at_mut(turning);
            for (actuator, columns) in forces.chunks_exact_mut(NODES).enumerate() {
                let moment = &scratch.moments[actuator * states + state];
                for (column, l) in columns.iter_mut().zip(&LAGRANGE) {
                    column[lane] = -dot(l, &moment[..NODES]);
                }
            }
            for (number, columns) in angles.chunks_exact_mut(2).enumerate() {
                let response = scratch.responses[number * states + state];
                (columns[0][lane], columns[1][lane]) = (response.re, -response.im);
            }
        }
    }

    /// The response to the harmonics at a point: Re of it times e^(i angle) at the start of the step.
    fn compute_turning(&mut self, part: &Part, place: &Place, point: usize, scratch: &Scratch) {
        let states = part.len();
        let responses = scratch.responses.chunks_exact(states.max(1));
        for (number, response) in responses.take(part.harmonics.len()).enumerate() {
            for (sensor, rows) in part.sensor_rows.chunks_exact(states).enumerate() {
                let readings = &mut self.turning[place.harmonics(sensor) + number];
                let mut seen = [Complex::new(0.0, 0.0); 2];
                for (response, row) in response.iter().zip(rows) {
                    seen[0] += response * row[0];
                    seen[1] += response * row[1];
                }
                for (what, seen) in seen.into_iter().enumerate() {
                    readings[0][what][point] = seen.re;
                    readings[1][what][point] = -seen.im;
                }
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
    let states = part.len();
    let moments = scratch.moments.chunks_exact(states.max(1));
    for (actuator, moments) in moments.take(part.actuators.len()).enumerate() {
        for sensor in 0..part.sensors.len() {
            let rows = &part.sensor_rows[sensor * states..][..states];
            let mut seen = [[0.0; POWERS]; 2];
            for (row, moment) in rows.iter().zip(moments) {
                for (seen, entry) in seen.iter_mut().zip(row) {
                    for (seen, moment) in seen.iter_mut().zip(moment) {
                        *seen += entry * moment;
                    }
                }
            }
            let entry = (number, actuator * part.sensors.len() + sensor);
            for (what, seen) in seen.iter().enumerate() {
                influences.add(exchange, entry, (point, what), seen);
                if point == END {
                    influences.add_bubbles(exchange, entry, what, seen);
                }
            }
        }
    }
}
