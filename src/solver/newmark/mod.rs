//! The Newmark-beta method of the paper with variable steps: average acceleration (beta 1/4, gamma 1/2),
//! implicit in the blocks and in the couplings.
//!
//! ```text
//!   q1 = q~ + h^2/4 a1        q~ = q0 + h v0 + h^2/4 a0
//!   v1 = v~ + h/2 a1          v~ = v0 + h/2 a0
//!   a1 = y - sum over m of z_m F_m         y = A^-1 (f1 - D v~ - K q~)
//!   A  = I + h/2 D + h^2/4 K               z_m = A^-1 b_m
//!   F = F(w q~ + h^2/4 (w y - Z F), w v~ + h/2 (w y - Z F))        Z_ml = w_m z_l
//! ```
//!
//! A depends on h alone and is inverted block by block once per step length; a step then costs products
//! with small matrices and few linear systems with as many unknowns as there are couplings: Newton's method with the
//! tangents kappa = h^2/4 dF/dd + h/2 dF/dd', one iteration where forces are linear.
//!
//! **Two solutions.** The equations are solved twice side by side, with steps h (coarse) and h/2 (fine). The
//! method is symmetric, its error has even powers of h only, so that
//!
//! ```text
//!   q = (4 q_fine - q_coarse) / 3
//! ```
//!
//! is of fourth order. The extrapolation is passive: neither solution is changed by it, and the method stays
//! A-stable and without numerical damping. Only where the motion ends the piece of a law do both solutions go on from
//! the extrapolated one. `control` says how long a step may be.
//!
//! Sources: Newmark, J. Eng. Mech. Div. ASCE 85 (1959); extrapolation: Hairer, Norsett, Wanner, Solving
//! Ordinary Differential Equations I, II.9.

mod control;
mod kernel;

use super::march::{Ending, March, Method, Outcome, Span, Task};
use super::{
    Control, Counts, Forcing, Instant, Piece, State, StepError, System, Track, copy_tracks,
};
use control::{control_error, differentiate};
use kernel::{Kernel, Work, accept};

/// Part of a step that is tried when the forces of the whole one are not found.
const SHORTER: f64 = 0.4;

/// The integrator with its workspace. It holds nothing that influences a result: everything that does
/// is in the [`State`].
#[derive(Debug, Clone)]
pub struct Newmark {
    march: March,
    pair: Pair,
    before: State,
}

/// Both solutions.
#[derive(Debug, Clone)]
struct Pair {
    kernel: Kernel,
    work: [Work; 2],
    retry: Vec<Track>,
    differences: Vec<f64>,
    next_control: Control,
    /// What the couplings see: deflections and rates at the start and at the end of a step.
    sight: [[Vec<f64>; 2]; 2],
    counts: Counts,
}

impl Newmark {
    /// A workspace for this system.
    pub fn new(system: &System) -> Newmark {
        let work = Work::new(system);
        let zeros = || vec![0.0; system.size];
        let before = Newmark::state_at(system, 0.0, zeros(), zeros());
        let seen = || {
            [
                vec![0.0; system.couplings.len()],
                vec![0.0; system.couplings.len()],
            ]
        };
        Newmark {
            march: March::new(system),
            pair: Pair {
                kernel: Kernel::new(system),
                work: [work.clone(), work],
                retry: before.tracks.clone(),
                next_control: before.control.clone(),
                differences: vec![0.0; system.monitors.len()],
                sight: [seen(), seen()],
                counts: Counts::default(),
            },
            before,
        }
    }

    /// The state with these displacements and velocities at `time`, one entry per coordinate.
    pub fn state_at(system: &System, time: f64, position: Vec<f64>, velocity: Vec<f64>) -> State {
        system.state_at(time, Track { position, velocity }, (2, 0))
    }

    /// Work done since the workspace was made.
    pub fn counts(&self) -> Counts {
        self.march.counts(Counts {
            factorizations: self.pair.kernel.factorizations(),
            evaluations: self.pair.kernel.evaluations(),
            ..self.pair.counts
        })
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
        let result = self.march.advance(&mut self.pair, task, state, until);
        let result = result.and_then(|()| extrapolate(state));
        match result {
            Ok(()) => state.read_off(system),
            Err(_) => state.copy_from(&self.before),
        }
        result
    }
}

impl Pair {
    /// One coarse step and two fine ones. Gives the error relative to the bound.
    fn take_both<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &mut State,
        span: Span,
        pieces: &[Piece],
    ) -> Result<f64, StepError> {
        let Task {
            system, tolerance, ..
        } = task;
        let [coarse, fine] = &mut self.work;
        let step = span.step;
        self.kernel
            .step(task, (&state.tracks[0], &state.slow), span, pieces, coarse)?;
        accept(&mut state.tracks[0], coarse, step);
        let (middle, half) = (0.5 * (span.start + span.end), 0.5 * step);
        self.differences.fill(0.0);
        differentiate(system, &mut self.differences, fine.acceleration(), 1.0);
        let first = Span {
            end: middle,
            step: half,
            ..span
        };
        let second = Span {
            start: middle,
            step: half,
            ..span
        };
        for (half, weight) in [(first, -2.0), (second, 1.0)] {
            self.kernel
                .step(task, (&state.tracks[1], &state.slow), half, pieces, fine)?;
            accept(&mut state.tracks[1], fine, half.step);
            differentiate(system, &mut self.differences, fine.acceleration(), weight);
        }
        let next = &mut self.next_control;
        let error = control_error(system, state, fine, &self.differences, step, next) / tolerance;
        if error.is_finite() {
            Ok(error)
        } else {
            Err(StepError::NotFinite { time: span.end })
        }
    }

    /// The law whose piece has ended at the end of the step, and when.
    fn interruption<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &State,
        span: Span,
        pieces: &[Piece],
        endings: &mut [Ending],
    ) -> Option<(usize, f64)> {
        let mut earliest: Option<(usize, f64)> = None;
        for (law, &piece) in pieces
            .iter()
            .enumerate()
            .filter(|(law, _)| endings[*law] == Ending::Watched)
        {
            let margin = |[deflection, rate]: &[Vec<f64>; 2], time: f64| {
                let at = Instant {
                    time,
                    deflection,
                    rate,
                    slow: &state.slow,
                };
                task.forcing.margin(law, piece, at)
            };
            let after = margin(&self.sight[1], span.end);
            if after < 0.0 || after.is_nan() {
                // The margin as a straight line: the step is short.
                let before = margin(&self.sight[0], span.start).max(0.0);
                let part = if before.is_finite() && after.is_finite() {
                    before / (before - after)
                } else {
                    0.5
                };
                let time = span.at(part);
                if earliest.is_none_or(|(_, other)| time < other) {
                    earliest = Some((law, time));
                }
            }
        }
        earliest
    }

    fn take_back<F: Forcing>(&mut self, task: Task<'_, F>, state: &mut State, pieces: &[Piece]) {
        copy_tracks(&mut state.tracks, &self.retry);
        self.evaluate_accelerations(task, state, pieces);
    }

    fn evaluate_accelerations<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &State,
        pieces: &[Piece],
    ) {
        for (track, work) in state.tracks.iter().zip(&mut self.work) {
            self.kernel
                .evaluate_acceleration(task, track, (state.time, &state.slow), pieces, work);
        }
    }
}

impl Method for Pair {
    fn observe<F: Forcing>(&mut self, task: Task<'_, F>, state: &mut State) {
        // A solution beyond all numbers is refused at the end of the call.
        let _ = extrapolate(state);
        let [deflection, rate] = &mut self.sight[0];
        task.system
            .deflections_into(state.position(), state.velocity(), deflection, rate);
    }

    fn instant<'a>(&'a self, state: &'a State) -> Instant<'a> {
        Instant {
            time: state.time,
            deflection: &self.sight[0][0],
            rate: &self.sight[0][1],
            slow: &state.slow,
        }
    }

    fn begin<F: Forcing>(&mut self, task: Task<'_, F>, state: &State, pieces: &[Piece]) {
        self.evaluate_accelerations(task, state, pieces);
    }

    fn try_step<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &mut State,
        span: Span,
        pieces: &[Piece],
        endings: &mut [Ending],
    ) -> Result<Outcome, StepError> {
        copy_tracks(&mut self.retry, &state.tracks);
        let error = match self.take_both(task, state, span, pieces) {
            // Newton's method does not find the forces of a long step; those of a short one are almost explicit.
            Err(StepError::Singular { .. }) => {
                self.counts.rejected += 1;
                self.take_back(task, state, pieces);
                return Ok(Outcome::Rejected { ratio: SHORTER });
            }
            error => error?,
        };
        // The estimate grows with h^4; the factor aims a little below the bound.
        let ratio = (0.8 / error.sqrt().sqrt()).clamp(0.2, 1.5);
        if error > 1.5 {
            self.counts.rejected += 1;
            self.take_back(task, state, pieces);
            return Ok(Outcome::Rejected { ratio });
        }
        if !pieces.is_empty() {
            let _ = extrapolate(state);
            let [deflection, rate] = &mut self.sight[1];
            task.system
                .deflections_into(state.position(), state.velocity(), deflection, rate);
            if let Some((law, time)) = self.interruption(task, state, span, pieces, endings) {
                self.take_back(task, state, pieces);
                return Ok(Outcome::Interrupted { law, time });
            }
            self.sight.swap(0, 1);
        }
        if endings.contains(&Ending::Landing) {
            for track in &mut state.tracks {
                track.copy_from(state.pose.whole());
            }
        }
        self.counts.steps += 1;
        state.time = span.end;
        // After an event nobody sets it anew.
        self.next_control.go_on_like(&state.control);
        core::mem::swap(&mut state.control, &mut self.next_control);
        Ok(Outcome::Accepted {
            ratio: if error > 1.0 { ratio.min(0.99) } else { ratio },
        })
    }
}

/// q = (4 q_fine - q_coarse) / 3.
fn extrapolate(state: &mut State) -> Result<(), StepError> {
    let ([coarse, fine], Some(whole)) = (state.tracks.as_slice(), state.pose.whole_mut()) else {
        return Ok(()); // a state of this method has two tracks, and is always whole
    };
    for (result, fine, coarse) in [
        (&mut whole.position, &fine.position, &coarse.position),
        (&mut whole.velocity, &fine.velocity, &coarse.velocity),
    ] {
        for ((value, fine), coarse) in result.iter_mut().zip(fine).zip(coarse) {
            *value = fine + (fine - coarse) / 3.0;
        }
    }
    let mut values = whole.position.iter().chain(&whole.velocity);
    if values.all(|value| value.is_finite()) {
        Ok(())
    } else {
        Err(StepError::NotFinite { time: state.time })
    }
}
