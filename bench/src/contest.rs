//! The cheapest setting of a method that reaches an error, and what it costs.

use geartrain::config::SolverChoice;

use crate::clock::Measure;
use crate::problem::{Problem, Run};
use crate::rivals::{ours, rk4};

/// Simulated time [s].
pub const SPAN: f64 = 0.05;
/// At how many times in it forces are compared.
pub const SAMPLES: u32 = 100;
/// Our converged solution, and the Runge-Kutta step [s] that has to agree with it.
const CONVERGED: f64 = 1e-10;
const FINE: f64 = 5e-7;
/// They agree better than the smallest error that is measured, by a factor of ten.
const AGREEMENT: f64 = 1e-6;
/// Most steps that are tried in an interval.
const MOST_STEPS: u64 = 10_000;

/// A problem with its answer.
pub struct Contest {
    text: String,
    /// Start and times.
    pub problem: Problem,
    converged: Vec<f64>,
    /// By how much Runge-Kutta differs from our answer.
    pub disagreement: f64,
}

/// What reached the error.
pub struct Found<'a> {
    /// The tolerance or step that did.
    pub setting: String,
    /// The error reached.
    pub error: f64,
    /// Steps taken.
    pub steps: u64,
    again: Box<dyn Fn() -> Result<Run, String> + 'a>,
}

impl Found<'_> {
    /// Runs it again and gives the wall time [s]; infinity where it fails.
    pub fn cost(&self) -> Measure<'_> {
        Box::new(|| (self.again)().map_or(f64::INFINITY, |run| run.seconds))
    }
}

impl Contest {
    /// A model with its converged forces; an error where Runge-Kutta does not get the same.
    pub fn of(text: &str) -> Result<Contest, String> {
        Contest::between(text, Problem::of(text, SPAN, SAMPLES))
    }

    /// A model file and the problem made from it.
    pub fn between(text: &str, problem: Problem) -> Result<Contest, String> {
        let converged = ours::run(&problem, text, SolverChoice::Exponential, CONVERGED).forces;
        let interval = problem.times[0];
        let fine = rk4::run(&problem, (interval / FINE).ceil() as u64);
        let disagreement = problem.error(&fine.forces, &converged);
        // Written so that a NaN is refused.
        if disagreement <= AGREEMENT {
            Ok(Contest {
                text: text.to_string(),
                problem,
                converged,
                disagreement,
            })
        } else {
            Err(format!(
                "Runge-Kutta with steps of {FINE:e} s and our solver at {CONVERGED:e} differ by {disagreement:e}: the \
                 equations are not the same, or one of them is wrong"
            ))
        }
    }

    /// The model file.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// One of our solvers.
    pub fn ours(&self, solver: SolverChoice, asked: f64) -> Result<Found<'_>, String> {
        self.by_tolerance(asked, move |tolerance| {
            Ok(ours::run(&self.problem, &self.text, solver, tolerance))
        })
    }

    /// The same when it goes on for as long again.
    pub fn ours_going_on(&self, solver: SolverChoice, asked: f64) -> Result<Found<'_>, String> {
        self.by_tolerance(asked, move |tolerance| {
            Ok(ours::run_on(&self.problem, &self.text, solver, tolerance))
        })
    }

    /// A method with the loosest tolerance of a ladder that reaches the error; words for why none does.
    pub fn by_tolerance<'a>(
        &self,
        asked: f64,
        run: impl Fn(f64) -> Result<Run, String> + 'a,
    ) -> Result<Found<'a>, String> {
        let decades = (1..=9).map(|decade| 1.0 / f64::from(10u32.pow(decade)));
        let mut why = "not reached".to_string();
        for tolerance in decades.flat_map(|decade| [decade, 0.3 * decade]) {
            match run(tolerance) {
                Ok(first) if self.error(&first) <= asked => {
                    let setting = format!("tol {tolerance:.0e}");
                    return Ok(self.found(setting, &first, move || run(tolerance)));
                }
                Ok(_) => {}
                // A smaller tolerance may do.
                Err(words) => why = words,
            }
        }
        Err(why)
    }

    /// The fewest Runge-Kutta steps in an interval that reach the error, within 3 %.
    pub fn runge_kutta_steps(&self, asked: f64) -> Result<u64, String> {
        let mut steps = 1;
        while self.error(&rk4::run(&self.problem, steps)) > asked {
            steps += 1 + steps / 32;
            if steps > MOST_STEPS {
                return Err("not reached".to_string());
            }
        }
        Ok(steps)
    }

    /// A method with so many steps in an interval.
    pub fn by_steps<'a>(
        &'a self,
        steps: u64,
        run: impl Fn(&Problem, u64) -> Result<Run, String> + 'a,
    ) -> Result<Found<'a>, String> {
        let interval = SPAN / f64::from(SAMPLES);
        let setting = format!("{:.2} us", 1e6 * interval / steps as f64);
        let first = run(&self.problem, steps)?;
        Ok(self.found(setting, &first, move || run(&self.problem, steps)))
    }

    fn found<'a>(
        &self,
        setting: String,
        run: &Run,
        again: impl Fn() -> Result<Run, String> + 'a,
    ) -> Found<'a> {
        Found {
            setting,
            error: self.error(run),
            steps: run.steps,
            again: Box::new(again),
        }
    }

    /// Infinite where there are no numbers.
    fn error(&self, run: &Run) -> f64 {
        let error = self.problem.error(&run.forces, &self.converged);
        if error.is_nan() { f64::INFINITY } else { error }
    }
}
