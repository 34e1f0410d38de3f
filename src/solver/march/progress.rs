//! A call has to end: nobody goes on without end with steps that lead nowhere.

use super::super::StepError;

/// After so many steps of one call their average length must be at least this [s]: machines vibrate below the GHz, though
/// events may lie close for a while.
const PATIENCE: [(u64, f64); 2] = [(5_000, 1e-11), (50_000, 1e-9)];
/// No call takes more steps: some minutes of work.
const MOST_STEPS: u64 = 100_000_000;

/// How far a call has come.
#[derive(Debug, Clone, Copy)]
pub(super) struct Progress {
    /// The start of the call [s].
    since: f64,
    /// Steps tried since.
    tried: u64,
}

impl Progress {
    pub(super) fn since(since: f64) -> Progress {
        Progress { since, tried: 0 }
    }

    /// One more step, from this time: refuses where too many have led nowhere.
    #[inline]
    pub(super) fn try_another(&mut self, time: f64, step: f64) -> Result<(), StepError> {
        if self.tried >= PATIENCE[0].0 {
            self.check(time, step)?;
        }
        self.tried += 1;
        Ok(())
    }

    fn check(&self, time: f64, step: f64) -> Result<(), StepError> {
        let average = (time - self.since) / self.tried as f64;
        let lost = |&(tried, least): &(u64, f64)| self.tried >= tried && average < least;
        if PATIENCE.iter().any(lost) {
            return Err(StepError::StepTooSmall { time, step });
        }
        if self.tried >= MOST_STEPS {
            return Err(StepError::TooManySteps {
                time,
                steps: self.tried,
            });
        }
        Ok(())
    }
}
