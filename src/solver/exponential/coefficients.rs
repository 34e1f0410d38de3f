//! What depends on the length of a step alone.
//!
//! Over a step the forces are cubic polynomials through four nodes, F(s) = sum of l_j(s/h) F_j (`polynomials`), and
//!
//! ```text
//!   eta(x h) = eta_0 + x h phi_1(B x h) (B eta_0 + load) + (x h)^2 phi_2(B x h) load' - sum over j of f_j(x) F_j
//!   f_j(x)   = sum over k of l_jk m_k(x),   m_k(x) = integral of e^(B (x h - s)) (s/h)^k ds b = k! x^(k+1) h phi_(k+1)(B x h) b
//! ```
//!
//! What the couplings see at x follows by the product with their rows. Lists run over parts, then over what touches the
//! part, then over its states.

use nalgebra::Complex;

use super::block_diagonal::BlockDiagonal;
use super::exchange::{Exchange, Influences};
use super::part::Part;
use super::polynomials::{END, FACTORIAL, LAGRANGE, NODES, PLACES, POINTS, POWERS};
use super::sight::{Readings, both};
use crate::linalg::{PhiFunctions, add_scaled, multiply_add};

/// The coefficients of all parts for one step length.
#[derive(Debug, Clone)]
pub(super) struct Coefficients {
    /// h phi_1.
    pub(super) gain: BlockDiagonal,
    /// h^2 phi_2.
    pub(super) ramp_gain: BlockDiagonal,
    /// What sensors read per B eta + load: per part, sensor and state.
    pub(super) free: Vec<Readings>,
    /// The same per change of the load.
    pub(super) ramp: Vec<Readings>,
    /// f_j at the end: per part, actuator and state.
    pub(super) columns: [Vec<f64>; NODES],
    /// What sensors read per cosine and sine of the angle of a harmonic: per part, harmonic and sensor.
    pub(super) turning: Vec<[Readings; 2]>,
    /// eta at the end, likewise: per part, harmonic and state.
    pub(super) turning_end: [Vec<f64>; 2],
    /// e^(i w h) of every harmonic.
    pub(super) rotations: Vec<Complex<f64>>,
    pub(super) influences: Influences,
}

/// Room for computing coefficients.
#[derive(Debug, Clone)]
pub(super) struct Scratch {
    phi: PhiFunctions,
    /// m_k of every actuator, 2n each.
    moments: [Vec<f64>; POWERS],
    /// The response to every harmonic of a part, 2n each.
    responses: Vec<Complex<f64>>,
    /// e^(i w x h) of all harmonics.
    turned: Vec<Complex<f64>>,
}

/// Where the lists of a part begin.
#[derive(Debug, Clone, Copy, Default)]
struct Begin {
    free: usize,
    columns: usize,
    turning: usize,
    turning_end: usize,
}

/// A place of the step: its number and x.
type Place = (usize, f64);

impl Scratch {
    pub(super) fn new(parts: &[Part], harmonics: usize) -> Scratch {
        let largest = |size: &dyn Fn(&Part) -> usize| parts.iter().map(size).max().unwrap_or(0);
        let group = largest(&|part| {
            let sizes = part.groups.iter().map(|group| group.matrix.nrows());
            sizes.max().unwrap_or(0)
        });
        let still = Complex::new(0.0, 0.0);
        let moment = vec![0.0; largest(&|part| part.len() * part.actuators.len())];
        Scratch {
            phi: PhiFunctions::new(group),
            moments: core::array::from_fn(|_| moment.clone()),
            responses: vec![still; largest(&|part| part.len() * part.harmonics.len())],
            turned: vec![still; harmonics],
        }
    }
}

impl Begin {
    /// Where those of the next part begin.
    fn after(self, part: &Part) -> Begin {
        let harmonics = part.harmonics.len();
        Begin {
            free: self.free + part.sensors.len() * part.len(),
            columns: self.columns + part.actuators.len() * part.len(),
            turning: self.turning + harmonics * part.sensors.len(),
            turning_end: self.turning_end + harmonics * part.len(),
        }
    }
}

impl Coefficients {
    /// Room for the coefficients of these parts under so many harmonics.
    pub(super) fn unused(parts: &[Part], exchange: &Exchange, harmonics: usize) -> Coefficients {
        let end = parts.iter().fold(Begin::default(), Begin::after);
        let readings = [0.0; 2 * POINTS];
        Coefficients {
            gain: BlockDiagonal::zero(parts),
            ramp_gain: BlockDiagonal::zero(parts),
            free: vec![readings; end.free],
            ramp: vec![readings; end.free],
            columns: core::array::from_fn(|_| vec![0.0; end.columns]),
            turning: vec![[readings; 2]; end.turning],
            turning_end: core::array::from_fn(|_| vec![0.0; end.turning_end]),
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
        let columns: usize = self.columns.iter().map(Vec::len).sum();
        let numbers = columns + 2 * (self.turning_end[0].len() + self.rotations.len());
        let matrices = self.gain.bytes() + self.ramp_gain.bytes();
        readings + numbers * size_of::<f64>() + matrices + self.influences.bytes()
    }

    /// Computes everything for steps of length h; `frequencies` are those of all harmonics [rad/s].
    pub(super) fn compute(
        &mut self,
        (parts, exchange): (&[Part], &Exchange),
        h: f64,
        frequencies: &[f64],
        scratch: &mut Scratch,
    ) {
        self.influences.clear();
        for (point, place) in PLACES.into_iter().enumerate() {
            let time = place * h;
            for (turned, frequency) in scratch.turned.iter_mut().zip(frequencies) {
                let (sine, cosine) = libm::sincos(frequency * time);
                *turned = Complex::new(cosine, sine);
            }
            if point == END {
                self.rotations.copy_from_slice(&scratch.turned);
            }
            let mut begin = Begin::default();
            for (number, part) in parts.iter().enumerate() {
                self.compute_linear(part, begin, h, (point, place), (frequencies, scratch));
                if point == END {
                    self.combine_columns(part, begin, scratch);
                }
                let influences = &mut self.influences;
                add_influences(part, number, point, (exchange, influences), scratch);
                self.compute_turning(part, begin, point, scratch);
                begin = begin.after(part);
            }
        }
    }

    /// At a point: the response without forces, the moments, and the responses to the harmonics.
    fn compute_linear(
        &mut self,
        part: &Part,
        begin: Begin,
        h: f64,
        (point, x): Place,
        (frequencies, scratch): (&[f64], &mut Scratch),
    ) {
        let states = part.len();
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
                    gain.set(part, group, factor, phi);
                }
                for sensor in 0..part.sensors.len() {
                    let rows = &part.sensor_rows[sensor * states + first..][..m];
                    let own = &mut seen[begin.free + sensor * states + first..][..m];
                    for (readings, phi) in own.iter_mut().zip(phi.chunks_exact(m)) {
                        let [deflection, rate] = match (rows, phi) {
                            // Nearly all blocks are pairs: no loop.
                            ([one, two], [x, y]) => [0, 1].map(|i| one[i] * x + two[i] * y),
                            _ => both(rows, phi),
                        };
                        readings[point] = factor * deflection;
                        readings[POINTS + point] = factor * rate;
                    }
                }
            }
            let mut power = h;
            for (k, moments) in scratch.moments.iter_mut().enumerate() {
                power *= x;
                let (phi, factor) = (scratch.phi.get(k + 1), FACTORIAL[k] * power);
                for (actuator, column) in part.actuator_columns.column_iter().enumerate() {
                    let start = actuator * states + first;
                    let own = &column.as_slice()[first..first + m];
                    product_into(factor, phi, own, &mut moments[start..start + m]);
                }
            }
            for (number, (harmonic, load)) in part.harmonics.iter().enumerate() {
                let driven = (frequencies[*harmonic], scratch.turned[*harmonic]);
                let response = &mut scratch.responses[number * states + first..][..m];
                let load = &load[first..first + m];
                let block = (&group.matrix, x * h);
                scratch
                    .phi
                    .oscillator_response(block, driven, load, response);
            }
        }
    }

    /// f_j at the end from the moments there.
    fn combine_columns(&mut self, part: &Part, begin: Begin, scratch: &Scratch) {
        let used = part.len() * part.actuators.len();
        for (columns, l) in self.columns.iter_mut().zip(&LAGRANGE) {
            let own = &mut columns[begin.columns..begin.columns + used];
            own.fill(0.0);
            for (l, moment) in l.iter().zip(&scratch.moments) {
                add_scaled(*l, &moment[..used], own);
            }
        }
    }

    /// The response to the harmonics at a point: Re of it times e^(i angle) at the start of the step.
    fn compute_turning(&mut self, part: &Part, begin: Begin, point: usize, scratch: &Scratch) {
        let (states, sensors) = (part.len(), part.sensors.len());
        let responses = scratch.responses.chunks_exact(states.max(1));
        for (number, response) in responses.take(part.harmonics.len()).enumerate() {
            let own = &mut self.turning[begin.turning + number * sensors..][..sensors];
            for (rows, readings) in part.sensor_rows.chunks_exact(states).zip(&mut *own) {
                let mut seen = [Complex::new(0.0, 0.0); 2];
                for (response, row) in response.iter().zip(rows) {
                    seen[0] += response * row[0];
                    seen[1] += response * row[1];
                }
                for (what, seen) in seen.into_iter().enumerate() {
                    readings[0][what * POINTS + point] = seen.re;
                    readings[1][what * POINTS + point] = -seen.im;
                }
            }
            if point == END {
                let first = begin.turning_end + number * states;
                let [cosine, sine] = &mut self.turning_end;
                let both = cosine[first..].iter_mut().zip(&mut sine[first..]);
                for (response, (cosine, sine)) in response.iter().zip(both) {
                    (*cosine, *sine) = (response.re, -response.im);
                }
            }
        }
    }
}

/// target = scale A x for a small matrix, column by column.
fn product_into(scale: f64, matrix: &[f64], x: &[f64], target: &mut [f64]) {
    if let ([a, b, c, d], [x, y], [one, two]) = (matrix, x, &mut *target) {
        // Nearly all are pairs: no loop.
        *one = scale * (a * x + c * y);
        *two = scale * (b * x + d * y);
    } else {
        target.fill(0.0);
        multiply_add(scale, matrix, x, target);
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
    for actuator in 0..part.actuators.len() {
        let range = actuator * states..(actuator + 1) * states;
        for sensor in 0..sensors {
            let rows = &part.sensor_rows[sensor * states..][..states];
            let entry = (number, actuator * sensors + sensor);
            let mut seen = [[0.0; POWERS]; 2];
            for (k, moment) in scratch.moments[..powers].iter().enumerate() {
                [seen[0][k], seen[1][k]] = both(rows, &moment[range.clone()]);
            }
            for (what, seen) in seen.iter().enumerate() {
                influences.add(exchange, entry, (point, what), seen);
                if point == END {
                    influences.add_bubbles(exchange, entry, what, seen);
                }
            }
        }
    }
}
