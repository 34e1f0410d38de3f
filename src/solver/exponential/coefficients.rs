//! What depends on the length of a step alone.
//!
//! Over a step the forces are cubic polynomials through four nodes, F(s) = sum of l_j(s/h) F_j (`polynomials`), and
//!
//! ```text
//!   eta(x h) = eta_0 + x h phi_1(B x h) (B eta_0 + load) + (x h)^2 phi_2(B x h) load' - sum over j of f_j(x) F_j
//!   f_j(x)   = sum over k of l_jk m_k(x),   m_k(x) = integral of e^(B (x h - s)) (s/h)^k ds b = k! x^(k+1) h phi_(k+1)(B x h) b
//! ```
//!
//! How couplings move follows by the product with their rows. How the lists run, `panel` says; the four numbers of a quad belong to
//! [`SEEN_AT`] where nothing else is said.

use nalgebra::Complex;

use super::block_diagonal::BlockDiagonal;
use super::exchange::{Exchange, Influences};
use super::lanes::{Quad, add_product, subtract_multiple, subtract_product};
use super::panel::{Panels, Place};
use super::part::Part;
use super::polynomials::{END, LAGRANGE, MOMENTS, NODES, POWERS, SEEN_AT};
use super::scratch::{Functions, Scratch, Share};
use super::sight::Moved;
use crate::linalg::SmallPhi;

/// The coefficients of all parts for one step length.
#[derive(Debug, Clone)]
pub(super) struct Coefficients {
    /// h phi_1.
    pub(super) gain: BlockDiagonal,
    /// h^2 phi_2.
    pub(super) ramp_gain: BlockDiagonal,
    /// What sensors read per B eta + load: per look and state.
    pub(super) free: Vec<Moved>,
    /// The same per change of the load.
    pub(super) ramp: Vec<Moved>,
    /// What the end takes from the forces at the nodes, -f_j: per push and quad of states.
    pub(super) pushes: Vec<[Quad; NODES]>,
    /// What it takes from cosine and sine of the angles of two harmonics: per response and quad of states.
    pub(super) responses: Vec<[Quad; 4]>,
    /// How sensors move per cosine and sine of the angles of two harmonics: per turn.
    pub(super) turning: Vec<[Moved; 4]>,
    /// e^(i w h) of every harmonic.
    pub(super) rotations: Vec<Complex<f64>>,
    pub(super) influences: Influences,
}

impl Coefficients {
    /// Room for the coefficients of these parts under so many harmonics.
    pub(super) fn unused(
        parts: &[Part],
        panels: &Panels,
        exchange: &Exchange,
        harmonics: usize,
    ) -> Coefficients {
        Coefficients {
            gain: BlockDiagonal::zero(parts),
            ramp_gain: BlockDiagonal::zero(parts),
            free: vec![[0.0; 4]; panels.states()],
            ramp: vec![[0.0; 4]; panels.states()],
            pushes: vec![[[0.0; 4]; NODES]; panels.pushed()],
            responses: vec![[[0.0; 4]; 4]; panels.answering()],
            turning: vec![[[0.0; 4]; 4]; panels.turns.len()],
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
        let rows = 2 * self.free.len() + 4 * self.turning.len();
        let columns = NODES * self.pushes.len() + 4 * self.responses.len();
        let matrices = self.gain.bytes() + self.ramp_gain.bytes();
        (rows + columns) * size_of::<Quad>() + matrices + self.influences.bytes()
    }

    /// Computes everything for steps of length h; `frequencies` are those of all harmonics [rad/s].
    #[inline(always)]
    pub(super) fn compute(
        &mut self,
        (parts, panels, exchange): (&[Part], &Panels, &Exchange),
        h: f64,
        frequencies: &[f64],
        scratch: &mut Scratch,
    ) {
        self.influences.clear();
        scratch.turn(frequencies, h);
        for (rotation, turned) in self.rotations.iter_mut().zip(&scratch.turned) {
            *rotation = turned.get(END);
        }
        for (number, (part, place)) in parts.iter().zip(&panels.of_parts).enumerate() {
            scratch.clear(part);
            for group in &part.groups {
                let share = Share {
                    part,
                    group,
                    place,
                    h,
                };
                self.follow(share, frequencies, scratch);
            }
            self.follow_small(part, place, scratch);
            self.combine_pushes(part, place, scratch);
            self.combine_responses(part, place, scratch);
            add_influences(part, number, (exchange, &mut self.influences), scratch);
            self.compute_turning(part, place, scratch);
        }
        self.influences.complete(h);
    }

    /// The responses and moments of a group where they are looked at.
    #[inline(always)]
    fn follow(&mut self, share: Share<'_>, frequencies: &[f64], scratch: &mut Scratch) {
        let matrix = &share.group.matrix;
        let times = SEEN_AT.map(|x| x * share.h);
        if let Some(small) = SmallPhi::of(matrix, times, &mut scratch.phi) {
            let functions = Functions::of(&small.phi, share.h);
            let Share { part, group, .. } = share;
            let matrices = [&mut self.gain, &mut self.ramp_gain];
            for (matrix, [level, slope]) in matrices.into_iter().zip(&functions.responses) {
                matrix.set_line(part, group, level[END], slope[END]);
            }
            scratch.functions[group.first..][..matrix.nrows()].fill(functions);
            scratch.respond_small(share, frequencies, &small);
            return;
        }
        for (place, x) in SEEN_AT.into_iter().enumerate() {
            scratch.phi.evaluate(matrix, x * share.h);
            self.follow_block(share, place, scratch);
        }
        for number in 0..share.part.harmonics.len() {
            scratch.respond(share, frequencies, number);
        }
    }

    /// Responses and moments of all groups of one or two states.
    #[inline(always)]
    fn follow_small(&mut self, part: &Part, place: &Place, scratch: &mut Scratch) {
        let states = part.len().max(1);
        let functions = &scratch.functions[..part.in_small_groups()];
        let sensors = part.sensor_rows.chunks_exact(states);
        let sensors = sensors.zip(part.sensor_slopes.chunks_exact(states));
        for (sensor, (rows, slopes)) in sensors.enumerate() {
            let first = place.states(sensor);
            let seen = self.free[first..].iter_mut().zip(&mut self.ramp[first..]);
            for ((seen, functions), (row, along)) in
                seen.zip(functions).zip(rows.iter().zip(slopes))
            {
                let seen = [seen.0, seen.1].into_iter().zip(&functions.responses);
                for (seen, [level, slope]) in seen {
                    *seen = combination(row, level, along, slope);
                }
            }
        }
        let columns = part.actuator_columns.as_slice().chunks_exact(states);
        let columns = columns.zip(part.actuator_slopes.as_slice().chunks_exact(states));
        let moments = scratch.moments.chunks_exact_mut(states);
        for (moments, (columns, slopes)) in moments.zip(columns) {
            let columns = columns.iter().zip(slopes);
            for ((moments, functions), (&column, &along)) in
                moments.iter_mut().zip(functions).zip(columns)
            {
                for (moment, [level, slope]) in moments.iter_mut().zip(&functions.moments) {
                    *moment = combination(&[column; 4], level, &[along; 4], slope);
                }
            }
        }
    }

    /// Responses and moments of a larger group at one of the places.
    fn follow_block(&mut self, share: Share<'_>, at: usize, scratch: &mut Scratch) {
        let Share {
            part,
            group,
            place,
            h,
        } = share;
        let (states, first, m) = (part.len(), group.first, group.matrix.nrows());
        let time = SEEN_AT[at] * h;
        let responses = [
            (time, 1, &mut self.gain, &mut self.free),
            (time * time, 2, &mut self.ramp_gain, &mut self.ramp),
        ];
        for (factor, k, gain, seen) in responses {
            let phi = scratch.phi.get(k);
            if at == END {
                gain.set(part, group, factor, phi);
            }
            for sensor in 0..part.sensors.len() {
                let rows = &part.sensor_rows[sensor * states + first..][..m];
                let own = &mut seen[place.states(sensor) + first..][..m];
                for (seen, phi) in own.iter_mut().zip(phi.chunks_exact(m)) {
                    let terms = rows.iter().zip(phi).map(|(row, phi)| row[at] * phi);
                    seen[at] = factor * terms.sum::<f64>();
                }
            }
        }
        for (k, moments) in MOMENTS.iter().enumerate() {
            let factor = moments[at] * h;
            let phi = scratch.phi.get(k + 1);
            for (actuator, column) in part.actuator_columns.column_iter().enumerate() {
                let own = &column.as_slice()[first..first + m];
                let moments = &mut scratch.moments[actuator * states + first..][..m];
                for (i, moment) in moments.iter_mut().enumerate() {
                    let terms = own.iter().enumerate().map(|(j, own)| phi[i + j * m] * own);
                    moment[k][at] = factor * terms.sum::<f64>();
                }
            }
        }
    }

    /// What a part takes from the forces at the nodes, from its moments at the end.
    #[inline(always)]
    fn combine_pushes(&mut self, part: &Part, place: &Place, scratch: &Scratch) {
        let quads = part.quads().len();
        let mut moments = scratch.moments.as_chunks::<4>().0;
        for actuator in 0..part.actuators.len() {
            let own = &mut self.pushes[place.pushes(actuator)..][..quads];
            for (columns, moments) in own.iter_mut().zip(moments) {
                for (column, l) in columns.iter_mut().zip(&LAGRANGE) {
                    *column = [0.0; 4];
                    for (k, l) in l.iter().enumerate() {
                        let ends = moments.each_ref().map(|moment| moment[k][END]);
                        subtract_multiple(column, *l, &ends);
                    }
                }
            }
            moments = &moments[quads..];
        }
    }

    /// What a part takes from the harmonics, from its responses at the end.
    #[inline(always)]
    fn combine_responses(&mut self, part: &Part, place: &Place, scratch: &Scratch) {
        let quads = part.quads().len();
        let mut responses = scratch.responses.as_chunks::<4>().0;
        for harmonic in 0..part.harmonics.len() {
            let (twos, which) = (harmonic / 2, 2 * (harmonic % 2));
            let own = &mut self.responses[place.responses(twos)..][..quads];
            for (columns, responses) in own.iter_mut().zip(responses) {
                columns[which] = responses.each_ref().map(|[re, _]| re[END]);
                columns[which + 1] = responses.each_ref().map(|[_, im]| -im[END]);
            }
            responses = &responses[quads..];
        }
    }

    /// The response to the harmonics: Re of it times e^(i angle) at the start of the step.
    #[inline(always)]
    fn compute_turning(&mut self, part: &Part, place: &Place, scratch: &Scratch) {
        let states = part.len();
        let responses = scratch.responses.chunks_exact(states.max(1));
        for (number, response) in responses.take(part.harmonics.len()).enumerate() {
            for (sensor, rows) in part.sensor_rows.chunks_exact(states).enumerate() {
                let (mut cosine, mut sine) = ([0.0; 4], [0.0; 4]);
                for ([re, im], row) in response.iter().zip(rows) {
                    add_product(&mut cosine, row, re);
                    subtract_product(&mut sine, row, im);
                }
                let (twos, which) = (number / 2, 2 * (number % 2));
                let moved = &mut self.turning[place.turns(sensor) + twos];
                (moved[which], moved[which + 1]) = (cosine, sine);
            }
        }
    }
}

/// Forces, through the moments, to how the sensors move.
#[inline(always)]
fn add_influences(
    part: &Part,
    number: usize,
    (exchange, influences): (&Exchange, &mut Influences),
    scratch: &Scratch,
) {
    let states = part.len();
    let moments = scratch.moments.chunks_exact(states.max(1));
    for (actuator, moments) in moments.take(part.actuators.len()).enumerate() {
        for (sensor, rows) in part.sensor_rows.chunks_exact(states).enumerate() {
            let entry = (number, actuator * part.sensors.len() + sensor);
            influences.add(exchange, entry, &read(rows, moments));
        }
    }
}

/// How a sensor moves with moments.
#[inline(always)]
fn read(rows: &[Quad], moments: &[[Quad; POWERS]]) -> [Quad; POWERS] {
    let mut seen = [[0.0; 4]; POWERS];
    for (row, moment) in rows.iter().zip(moments) {
        for (seen, moment) in seen.iter_mut().zip(moment) {
            add_product(seen, row, moment);
        }
    }
    seen
}

/// a x + b y, element by element.
#[inline(always)]
fn combination(a: &Quad, x: &Quad, b: &Quad, y: &Quad) -> Quad {
    core::array::from_fn(|i| a[i] * x[i] + b[i] * y[i])
}
