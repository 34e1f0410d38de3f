//! The exponential collocation method: the linear blocks exactly, the forces between them as polynomials.
//!
//! ```text
//!   eta' = B eta + load(t) - sum over m of b_m F_m(t, d, d')       decoupled states of every block (`part`)
//!   F_m(s) = sum over j of l_j(s/h) F_m(s_j)                       cubic through four Lobatto nodes (`coefficients`)
//!   F_j = F(s_j, d(s_j), d'(s_j))                                  solved by iteration: the forces are few
//! ```
//!
//! However fast a mode of the blocks is, the step does not feel it: only the forces have to be followed. Torques,
//! held inputs, unbalance and gearbox vibration are exact. The method is of order six where forces are smooth, and
//! steps end where they are not. It keeps no memory of earlier steps but the control's mean squares.
//!
//! **Control.** At two further places of the step the true forces are evaluated; what they differ by from the cubic, as
//! quintic bubbles, moves the end of the step by e. The change of force that belongs to e is the error of one step; it adds up over the steps that the motion remembers, and is held below the tolerance:
//!
//! ```text
//!   SAFETY |F(d + e_d, d' + e_v) - F(d, d')| n <= tolerance x RMS of F over the run so far,   n = min(t, 1/(zeta w)) / h
//! ```
//!
//! w is the frequency of the force by itself, zeta the lightest damping ratio in it. Sources: Hochbruck, Ostermann, Acta
//! Numerica 19 (2010); collocation on Lobatto points: Hairer, Wanner, Solving Ordinary Differential Equations II, IV.5.

mod coefficients;
mod part;

use nalgebra::Complex;

use super::march::{March, Method, Outcome, Span, Task, canonical};
use super::{Block, Counts, Forcing, Harmonic, Instant, Monitor, Piece, State, StepError, System};
use crate::linalg::{add_scaled, dot};
use coefficients::{
    CHECKS, END, IN_TIME, LAGRANGE_AT_CHECKS, NODES, PLACES, POINTS, PartCoefficients, Scratch,
    add_product, multiply_groups,
};
use part::Part;

/// Coefficients are kept for this many step lengths at the most, and within this memory [bytes].
const LENGTHS: usize = 64;
const MEMORY: usize = 16 << 20;
/// Sweeps after which a step counts as too long.
const MOST_SWEEPS: usize = 25;
/// Change of the forces in the last sweep relative to the tolerance, and the smallest one above rounding.
const SWEEP_ACCURACY: (f64, f64) = (1e-4, 1e-13);
/// What errors of single steps amount to when they add up over n steps, as part of n times the largest: they have either
/// sign. Measured over tolerances from 1e-2 to 1e-8, with smooth and with stepped stiffness, the error is then 0.01 to
/// 0.8 of the tolerance.
const SAFETY: f64 = 0.25;
/// Accuracy of the time of an event, in parts of the way between two points.
const ROOT_ACCURACY: f64 = 1e-12;
/// Order of the accumulated error in the step.
const ORDER: f64 = 6.0;

/// The integrator with its workspace. It holds nothing that influences a result: everything that does is in the
/// [`State`].
#[derive(Debug, Clone)]
pub struct Exponential {
    march: March,
    kernel: Kernel,
    before: State,
}

/// Everything a step needs.
#[derive(Debug, Clone)]
struct Kernel {
    /// The blocks at the slow parameters in use.
    blocks: Vec<Block>,
    used_slow: Vec<f64>,
    slow: Vec<f64>,
    parts: Vec<Part>,
    frequencies: Vec<f64>,
    lengths: Vec<Coefficients>,
    next_length: usize,
    scratch: Scratch,
    motion: Vec<PartMotion>,
    sight: Sight,
    counts: Counts,
}

/// The coefficients of all parts for one step length.
#[derive(Debug, Clone)]
struct Coefficients {
    /// h [s]; 0 while unused.
    step: f64,
    parts: Vec<PartCoefficients>,
}

/// The states of one part.
#[derive(Debug, Clone)]
struct PartMotion {
    /// eta at the start of the step.
    states: Vec<f64>,
    /// eta at its end.
    next: Vec<f64>,
    /// B eta + load.
    derivative: Vec<f64>,
    /// V^-1 [0; held load].
    load: Vec<f64>,
}

/// What the couplings see and exert in one step: one entry per coupling in every list.
#[derive(Debug, Clone)]
struct Sight {
    deflection: Vec<f64>,
    rate: Vec<f64>,
    /// Deflections and rates at the points as far as the forces at the later nodes do not change them.
    base: [[Vec<f64>; 2]; POINTS],
    /// Deflections and rates at the points.
    point: [[Vec<f64>; 2]; POINTS],
    forces: [Vec<f64>; NODES],
    trial: Vec<f64>,
    missing: Vec<f64>,
    /// Deflections and rates between two points.
    between: [Vec<f64>; 2],
    /// e^(i angle) of every harmonic at the start of the step.
    angles: Vec<Complex<f64>>,
}

impl Exponential {
    /// A workspace for this system under harmonics like these.
    pub fn new(system: &System, harmonics: &[Harmonic]) -> Exponential {
        let before = system.state_at(0.0, vec![0.0; system.size], vec![0.0; system.size], 0);
        Exponential {
            march: March::new(system),
            kernel: Kernel::new(system, harmonics),
            before,
        }
    }

    /// The state with these displacements and velocities at `time`, one entry per coordinate.
    pub fn state_at(system: &System, time: f64, position: Vec<f64>, velocity: Vec<f64>) -> State {
        system.state_at(time, position, velocity, 0)
    }

    /// Work done since the workspace was made.
    pub fn counts(&self) -> Counts {
        self.march.counts(self.kernel.counts)
    }

    /// Advances the state to exactly `until`; a time that is not ahead changes nothing. After an error the
    /// state is the one before the call.
    pub fn advance_to(
        &mut self,
        system: &System,
        forcing: &impl Forcing,
        state: &mut State,
        until: f64,
        tolerance: f64,
    ) -> Result<(), StepError> {
        if until <= state.time {
            return Ok(());
        }
        self.before.copy_from(state);
        let task = Task {
            system,
            forcing,
            tolerance,
        };
        self.kernel.take_over(task, state);
        let result = self
            .march
            .advance(&mut self.kernel, task, state, until)
            .and_then(|()| self.kernel.hand_back(state));
        if result.is_err() {
            state.copy_from(&self.before);
        }
        result
    }
}

impl Kernel {
    fn new(system: &System, harmonics: &[Harmonic]) -> Kernel {
        let parts = take_apart(system, &system.blocks, harmonics);
        let count = system.couplings.len();
        let zeros = || vec![0.0; count];
        let pair = || [zeros(), zeros()];
        let coefficients = Coefficients {
            step: 0.0,
            parts: parts.iter().map(PartCoefficients::unused).collect(),
        };
        let bytes: usize = coefficients.parts.iter().map(PartCoefficients::bytes).sum();
        let affordable = (MEMORY / bytes.max(1)).clamp(4, LENGTHS);
        Kernel {
            blocks: system.blocks.clone(),
            used_slow: system.slow.clone(),
            slow: system.slow.clone(),
            frequencies: harmonics
                .iter()
                .map(|harmonic| harmonic.frequency)
                .collect(),
            lengths: vec![coefficients; affordable],
            next_length: 0,
            scratch: Scratch::new(&parts),
            motion: parts
                .iter()
                .map(|part| PartMotion::at_rest(part.len()))
                .collect(),
            sight: Sight {
                deflection: zeros(),
                rate: zeros(),
                base: core::array::from_fn(|_| pair()),
                point: core::array::from_fn(|_| pair()),
                forces: core::array::from_fn(|_| zeros()),
                trial: zeros(),
                missing: zeros(),
                between: pair(),
                angles: vec![Complex::new(0.0, 0.0); harmonics.len()],
            },
            counts: Counts::default(),
            parts,
        }
    }

    /// Decoupled states from displacements and velocities.
    fn take_over<F: Forcing>(&mut self, task: Task<'_, F>, state: &mut State) {
        self.use_slow(task, state);
        for (part, motion) in self.parts.iter().zip(&mut self.motion) {
            let (range, n) = (part.coordinates.clone(), part.len() / 2);
            let inverse = part.inverse.as_slice().split_at(n * part.len());
            motion.states.fill(0.0);
            add_product(
                inverse.0,
                &state.position[range.clone()],
                &mut motion.states,
            );
            add_product(
                inverse.1,
                &state.velocity[range.clone()],
                &mut motion.states,
            );
            motion.load.fill(0.0);
            add_product(inverse.1, &task.forcing.held()[range], &mut motion.load);
        }
    }

    /// Displacements and velocities from decoupled states.
    fn hand_back(&self, state: &mut State) -> Result<(), StepError> {
        for (part, motion) in self.parts.iter().zip(&self.motion) {
            let (range, n) = (part.coordinates.clone(), part.len() / 2);
            let position = &mut state.position[range.clone()];
            let velocity = &mut state.velocity[range];
            position.fill(0.0);
            velocity.fill(0.0);
            for (shape, value) in part.shapes.column_iter().zip(&motion.states) {
                add_scaled(*value, &shape.as_slice()[..n], position);
                add_scaled(*value, &shape.as_slice()[n..], velocity);
            }
        }
        let mut values = state.position.iter().chain(&state.velocity);
        if values.all(|value| value.is_finite()) {
            Ok(())
        } else {
            Err(StepError::NotFinite { time: state.time })
        }
    }

    /// The blocks of the slow parameters that the state asks for.
    fn use_slow<F: Forcing>(&mut self, task: Task<'_, F>, state: &mut State) {
        task.forcing
            .slow_into(&state.position, &state.velocity, &mut self.slow);
        if task.forcing.is_stale(&state.slow, &self.slow) {
            state.slow.clone_from(&self.slow);
        }
        if self.used_slow != state.slow {
            self.used_slow.clone_from(&state.slow);
            task.forcing.blocks_into(&self.used_slow, &mut self.blocks);
            self.parts = take_apart(task.system, &self.blocks, task.forcing.harmonics());
            self.scratch = Scratch::new(&self.parts);
            for length in &mut self.lengths {
                length.step = 0.0;
                length.parts = self.parts.iter().map(PartCoefficients::unused).collect();
            }
            self.counts.refreshes += 1;
        }
    }

    /// The coefficients for this step length, computed unless they are kept from earlier steps.
    fn coefficients_for(&mut self, h: f64) -> usize {
        if let Some(index) = self.lengths.iter().position(|length| length.step == h) {
            return index;
        }
        let index = self.next_length;
        self.next_length = (index + 1) % self.lengths.len();
        self.counts.factorizations += 1;
        let length = &mut self.lengths[index];
        length.step = h;
        for (part, coefficients) in self.parts.iter().zip(&mut length.parts) {
            coefficients.compute(part, h, &self.frequencies, &mut self.scratch);
        }
        index
    }

    /// What the couplings see at the points without the forces at the later nodes.
    fn look_ahead(&mut self, index: usize) {
        let sight = &mut self.sight;
        for base in &mut sight.base {
            base[0].copy_from_slice(&sight.deflection);
            base[1].copy_from_slice(&sight.rate);
        }
        let parts = self.parts.iter().zip(&self.lengths[index].parts);
        for ((part, coefficients), motion) in parts.zip(&mut self.motion) {
            multiply_groups(part, &motion.states, &mut motion.derivative);
            add_scaled(1.0, &motion.load, &mut motion.derivative);
            let (states, sensors) = (part.len(), part.sensors.len());
            for (point, base) in sight.base.iter_mut().enumerate() {
                for (what, base) in base.iter_mut().enumerate() {
                    let free = coefficients.free[point][what].chunks_exact(states);
                    for (row, &sensor) in free.zip(&part.sensors) {
                        base[sensor] += dot(row, &motion.derivative);
                    }
                    let turning = &coefficients.turning[point][what];
                    for (number, (harmonic, _)) in part.harmonics.iter().enumerate() {
                        let angle = sight.angles[*harmonic];
                        let seen = &turning[number * sensors..(number + 1) * sensors];
                        for (turned, &sensor) in seen.iter().zip(&part.sensors) {
                            base[sensor] += (angle * turned).re;
                        }
                    }
                    let node = &coefficients.node[point][what][0];
                    exert(part, node, &sight.forces[0], base);
                }
            }
        }
    }

    /// Deflections and rates at a point under the present forces at the later nodes.
    fn look(&mut self, index: usize, point: usize) {
        let sight = &mut self.sight;
        for (what, (target, base)) in sight.point[point]
            .iter_mut()
            .zip(&sight.base[point])
            .enumerate()
        {
            target.copy_from_slice(base);
            for (part, coefficients) in self.parts.iter().zip(&self.lengths[index].parts) {
                for (node, forces) in coefficients.node[point][what]
                    .iter()
                    .zip(&sight.forces)
                    .skip(1)
                {
                    exert(part, node, forces, target);
                }
            }
        }
    }

    /// Solves for the forces at the nodes. Gives whether they were found.
    fn sweep<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &State,
        span: Span,
        pieces: &[Piece],
        index: usize,
    ) -> bool {
        let accuracy = (SWEEP_ACCURACY.0 * task.tolerance).max(SWEEP_ACCURACY.1);
        let (first, later) = self.sight.forces.split_at_mut(1);
        later
            .iter_mut()
            .for_each(|forces| forces.copy_from_slice(&first[0]));
        for _ in 0..MOST_SWEEPS {
            // Changes of one coupling count relative to its own force, those of all to the largest.
            let (mut settled, mut largest) = (true, 0.0_f64);
            for forces in &self.sight.forces {
                largest = forces
                    .iter()
                    .fold(largest, |largest, force| largest.max(force.abs()));
            }
            for point in 0..=END {
                self.look(index, point);
            }
            for point in 0..=END {
                let sight = &mut self.sight;
                let at = sight_at(&sight.point[point], span.at(PLACES[point]), &state.slow);
                task.forcing.forces_into(at, pieces, &mut sight.trial);
                let forces = &mut sight.forces[point + 1];
                for (force, trial) in forces.iter().zip(&sight.trial) {
                    let change = (trial - force).abs();
                    let size = trial.abs().max(force.abs());
                    // Written so that a NaN is not settled.
                    settled &= change <= accuracy * size.max(SWEEP_ACCURACY.1 * largest);
                }
                core::mem::swap(forces, &mut sight.trial);
            }
            self.counts.evaluations += NODES as u64 - 1;
            if settled {
                // The points follow the last forces.
                for point in 0..POINTS {
                    self.look(index, point);
                }
                return true;
            }
        }
        false
    }

    /// The law whose piece the motion ends first, and when.
    fn interruption<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &State,
        span: Span,
        pieces: &[Piece],
        landing: Option<usize>,
    ) -> Option<(usize, f64)> {
        let mut earliest: Option<(usize, f64)> = None;
        for (law, &piece) in pieces
            .iter()
            .enumerate()
            .filter(|(law, _)| Some(*law) != landing)
        {
            let mut previous = None;
            for point in IN_TIME {
                let at = sight_at(
                    &self.sight.point[point],
                    span.at(PLACES[point]),
                    &state.slow,
                );
                // Written so that a NaN ends the piece.
                if !(task.forcing.margin(law, piece, at) >= 0.0) {
                    let time = self.root(task, state, span, (law, piece), (previous, point));
                    if earliest.is_none_or(|(_, other)| time < other) {
                        earliest = Some((law, time));
                    }
                    break;
                }
                previous = Some(point);
            }
        }
        earliest
    }

    /// When the margin of a law becomes negative between two points, by bisection on cubic interpolants.
    fn root<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &State,
        span: Span,
        (law, piece): (usize, Piece),
        (previous, point): (Option<usize>, usize),
    ) -> f64 {
        let Sight {
            deflection,
            rate,
            point: points,
            between,
            ..
        } = &mut self.sight;
        let [right, right_rate] = &points[point];
        let (left, left_rate, from) = match previous {
            Some(previous) => (&points[previous][0], &points[previous][1], PLACES[previous]),
            None => (&*deflection, &*rate, 0.0),
        };
        let width = (PLACES[point] - from) * span.step;
        let (mut low, mut high) = (0.0, 1.0);
        while high - low > ROOT_ACCURACY {
            let middle = 0.5 * (low + high);
            for coupling in 0..left.len() {
                let (value, slope) = hermite(
                    [left[coupling], left_rate[coupling] * width],
                    [right[coupling], right_rate[coupling] * width],
                    middle,
                );
                (between[0][coupling], between[1][coupling]) = (value, slope / width);
            }
            let time = span.start + from * span.step + middle * width;
            if task
                .forcing
                .margin(law, piece, sight_at(between, time, &state.slow))
                >= 0.0
            {
                low = middle;
            } else {
                high = middle;
            }
        }
        span.start + from * span.step + high * width
    }

    /// Error of the step in units of the bound; keeps the mean squares for when it is accepted.
    fn error<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &State,
        span: Span,
        pieces: &[Piece],
        index: usize,
    ) -> f64 {
        let sight = &mut self.sight;
        // What the end would be with the missing part of the forces.
        let [deflection, rate] = &mut sight.base[END];
        deflection.copy_from_slice(&sight.point[END][0]);
        rate.copy_from_slice(&sight.point[END][1]);
        for (check, (point, weights)) in CHECKS.into_iter().zip(LAGRANGE_AT_CHECKS).enumerate() {
            let at = sight_at(&sight.point[point], span.at(PLACES[point]), &state.slow);
            task.forcing.forces_into(at, pieces, &mut sight.missing);
            for (forces, weight) in sight.forces.iter().zip(weights) {
                add_scaled(-weight, forces, &mut sight.missing);
            }
            for (part, coefficients) in self.parts.iter().zip(&self.lengths[index].parts) {
                let [on_deflection, on_rate] = &coefficients.bubble;
                exert(part, &on_deflection[check], &sight.missing, deflection);
                exert(part, &on_rate[check], &sight.missing, rate);
            }
        }
        let at = sight_at(&sight.base[END], span.end, &state.slow);
        task.forcing.forces_into(at, pieces, &mut sight.trial);
        self.counts.evaluations += 3;

        let control = &state.control;
        let elapsed = control.elapsed + span.step;
        let mut worst: f64 = 0.0;
        for (monitor, squares) in task.system.monitors.iter().zip(&control.squares) {
            let couplings = monitor.couplings.clone();
            if couplings.is_empty() {
                continue;
            }
            let mean = (squares + span.step * mean_square(&sight.forces, monitor)) / elapsed;
            let reference = mean.sqrt().max(monitor.floor);
            let decay = monitor.damping_ratio * monitor.frequency;
            let remembered = (1.0 / decay.max(f64::MIN_POSITIVE)).min(elapsed);
            let steps = (remembered / span.step).max(1.0);
            for coupling in couplings {
                let change = (sight.trial[coupling] - sight.forces[NODES - 1][coupling]).abs();
                let relative = SAFETY * change * steps / (reference * task.tolerance);
                // f64::max would drop a NaN.
                worst = if relative <= worst { worst } else { relative };
            }
        }
        worst
    }

    /// Moves to the end of the step.
    fn accept(&mut self, system: &System, state: &mut State, span: Span, index: usize) {
        let parts = self.parts.iter().zip(&self.lengths[index].parts);
        for ((part, coefficients), motion) in parts.zip(&mut self.motion) {
            let PartMotion {
                states,
                next,
                derivative,
                ..
            } = motion;
            next.copy_from_slice(states);
            let mut gain = coefficients.gain.as_slice();
            for group in &part.groups {
                let range = group.first..group.first + group.matrix.nrows();
                let (own, rest) = gain.split_at(group.matrix.len());
                add_product(own, &derivative[range.clone()], &mut next[range]);
                gain = rest;
            }
            for (columns, forces) in coefficients.columns.iter().zip(&self.sight.forces) {
                for (column, &actuator) in columns.chunks_exact(part.len()).zip(&part.actuators) {
                    add_scaled(-forces[actuator], column, next);
                }
            }
            for (number, (harmonic, _)) in part.harmonics.iter().enumerate() {
                let angle = self.sight.angles[*harmonic];
                let turned = &coefficients.turning_end[number * part.len()..];
                for (next, turned) in next.iter_mut().zip(turned) {
                    *next += (angle * turned).re;
                }
            }
            core::mem::swap(states, next);
        }
        let sight = &mut self.sight;
        sight.deflection.copy_from_slice(&sight.point[END][0]);
        sight.rate.copy_from_slice(&sight.point[END][1]);
        for (monitor, squares) in system.monitors.iter().zip(&mut state.control.squares) {
            *squares += span.step * mean_square(&sight.forces, monitor);
        }
        sight.forces.swap(0, NODES - 1);
        state.control.elapsed += span.step;
        state.time = span.end;
        self.counts.steps += 1;
    }
}

impl Method for Kernel {
    fn observe<F: Forcing>(&mut self, _: Task<'_, F>, _: &mut State) {
        self.sight.deflection.fill(0.0);
        self.sight.rate.fill(0.0);
        for (part, motion) in self.parts.iter().zip(&self.motion) {
            let targets = [&mut self.sight.deflection, &mut self.sight.rate];
            for (rows, target) in part.sensor_rows.iter().zip(targets) {
                for (row, &sensor) in rows.column_iter().zip(&part.sensors) {
                    target[sensor] += dot(row.as_slice(), &motion.states);
                }
            }
        }
    }

    fn instant<'a>(&'a self, state: &'a State) -> Instant<'a> {
        Instant {
            time: state.time,
            deflection: &self.sight.deflection,
            rate: &self.sight.rate,
            slow: &state.slow,
        }
    }

    fn begin<F: Forcing>(&mut self, task: Task<'_, F>, state: &State, pieces: &[Piece]) {
        let Sight {
            deflection,
            rate,
            forces,
            ..
        } = &mut self.sight;
        let at = Instant {
            time: state.time,
            deflection,
            rate,
            slow: &state.slow,
        };
        task.forcing.forces_into(at, pieces, &mut forces[0]);
        self.counts.evaluations += 1;
    }

    fn try_step<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &mut State,
        span: Span,
        pieces: &[Piece],
        landing: Option<usize>,
    ) -> Result<Outcome, StepError> {
        let index = self.coefficients_for(canonical(span.step));
        for (angle, harmonic) in self.sight.angles.iter_mut().zip(task.forcing.harmonics()) {
            let (sine, cosine) = libm::sincos(harmonic.angle(span.start));
            *angle = Complex::new(cosine, sine);
        }
        self.look_ahead(index);
        if !self.sweep(task, state, span, pieces, index) {
            self.counts.rejected += 1;
            if !self.sight.forces[0].iter().all(|force| force.is_finite()) {
                return Err(StepError::NotFinite { time: span.start });
            }
            return Ok(Outcome::Rejected { ratio: 0.4 });
        }
        if let Some((law, time)) = self.interruption(task, state, span, pieces, landing) {
            return Ok(Outcome::Interrupted { law, time });
        }
        let error = self.error(task, state, span, pieces, index);
        if !error.is_finite() {
            return Err(StepError::NotFinite { time: span.end });
        }
        let ratio = libm::pow(0.8 / error.max(1e-12), 1.0 / ORDER).clamp(0.2, 2.0);
        if error > 1.5 {
            self.counts.rejected += 1;
            return Ok(Outcome::Rejected { ratio });
        }
        self.accept(task.system, state, span, index);
        Ok(Outcome::Accepted {
            ratio: if error > 1.0 {
                ratio.min(0.99)
            } else {
                ratio.max(1.0)
            },
        })
    }
}

impl PartMotion {
    fn at_rest(states: usize) -> PartMotion {
        let zeros = || vec![0.0; states];
        PartMotion {
            states: zeros(),
            next: zeros(),
            derivative: zeros(),
            load: zeros(),
        }
    }
}

fn take_apart(system: &System, blocks: &[Block], harmonics: &[Harmonic]) -> Vec<Part> {
    let part = |(index, block): (usize, &Block)| {
        let own: Vec<_> = harmonics
            .iter()
            .enumerate()
            .filter_map(|(number, harmonic)| {
                let [cosine, sine] = harmonic.on_block(block)?;
                Some((number, cosine, sine))
            })
            .collect();
        Part::new(system, index, block, &own)
    };
    blocks.iter().enumerate().map(part).collect()
}

/// What the couplings see at one point of a step.
fn sight_at<'a>(seen: &'a [Vec<f64>; 2], time: f64, slow: &'a [f64]) -> Instant<'a> {
    Instant {
        time,
        deflection: &seen[0],
        rate: &seen[1],
        slow,
    }
}

/// The sensors' readings change by -matrix F: sensors x actuators of one part.
fn exert(part: &Part, matrix: &[f64], forces: &[f64], readings: &mut [f64]) {
    let sensors = part.sensors.len();
    if sensors == 0 {
        return;
    }
    for (column, &actuator) in matrix.chunks_exact(sensors).zip(&part.actuators) {
        let force = forces[actuator];
        for (entry, &sensor) in column.iter().zip(&part.sensors) {
            readings[sensor] -= entry * force;
        }
    }
}

/// Mean over the step of the squared force of a monitor, by the Lobatto weights 1/12, 5/12, 5/12, 1/12.
fn mean_square(forces: &[Vec<f64>; NODES], monitor: &Monitor) -> f64 {
    let square = |forces: &Vec<f64>| -> f64 {
        forces[monitor.couplings.clone()]
            .iter()
            .map(|force| force * force)
            .sum()
    };
    let [first, second, third, last] = forces.each_ref().map(square);
    (first + last + 5.0 * (second + third)) / 12.0
}

/// The cubic with these values and derivatives at 0 and 1: its value and derivative at s.
fn hermite([left, left_slope]: [f64; 2], [right, right_slope]: [f64; 2], s: f64) -> (f64, f64) {
    let difference = right - left;
    let quadratic = 3.0 * difference - 2.0 * left_slope - right_slope;
    let cubic = left_slope + right_slope - 2.0 * difference;
    (
        left + s * (left_slope + s * (quadratic + s * cubic)),
        left_slope + s * (2.0 * quadratic + 3.0 * s * cubic),
    )
}
