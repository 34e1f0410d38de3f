//! Few step lengths, whatever the communication points and the laws: coefficients are kept by length.

/// Breakpoints that need not be met exactly are met on this many parts of the call: so few lengths of steps occur, whatever
/// the period of the laws.
const PARTS: f64 = 64.0;
/// Whatever is left of some of these parts after some of their equal steps (at most 24, or 48) is a whole number of so many parts
/// of one.
const FRACTIONS: f64 = 48.0;

/// Equal parts of a call.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    start: f64,
    width: f64,
    /// By how much lengths of the grid differ from what they are computed as: times are rounded, and so is the width.
    rounding: f64,
}

impl Grid {
    /// From one time to another.
    pub(super) fn over(start: f64, end: f64) -> Grid {
        let length = canonical(end - start);
        let of_times = 8.0 * f64::EPSILON * start.abs().max(end.abs());
        Grid {
            start,
            width: length / PARTS,
            rounding: of_times + (end - start - length).abs(),
        }
    }

    /// The point of the grid next to a time.
    pub(super) fn near(&self, time: f64) -> f64 {
        self.start + nearest_integer((time - self.start) / self.width) * self.width
    }

    /// A length without rounding, where it is one of the grid or what steps have left of one. Any other one is kept as it is: the
    /// motion would otherwise fall behind time.
    pub(super) fn length(&self, length: f64) -> f64 {
        let fraction = self.width / FRACTIONS;
        let parts = nearest_integer(length / fraction);
        let exact = parts * fraction;
        if parts >= 1.0 && (length - exact).abs() <= self.rounding {
            exact
        } else {
            length
        }
    }
}

/// The integer next to a number below 2^51, without the call that CPUs of every age need for it: there numbers have no digits for
/// more.
fn nearest_integer(number: f64) -> f64 {
    const NO_DIGITS: f64 = 1.5 * (1_u64 << 52) as f64;
    (number + NO_DIGITS) - NO_DIGITS
}

/// The step length with its last 22 bits rounded away (relative 1e-9): communication points computed by
/// additions then lead to the same coefficients, whatever was computed before.
pub(super) fn canonical(step: f64) -> f64 {
    const DROPPED: u32 = 22;
    let bits = step.to_bits() + (1 << (DROPPED - 1));
    f64::from_bits(bits >> DROPPED << DROPPED)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn canonical_steps_absorb_rounding_of_communication_points() {
        let exact = canonical(2e-5);
        // At 10 s a difference of times carries errors of 1e-15 s.
        assert_eq!(canonical((10.0 + 2e-5) - 10.0), exact);
        assert!((exact / 2e-5 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn lengths_between_points_of_the_grid_are_multiples_of_its_width() {
        // At 10 s differences of times carry errors of 1e-15 s.
        let grid = Grid::over(10.0, 10.0 + 2e-5);
        let (one, two) = (grid.near(10.0 + 3.1e-6), grid.near(10.0 + 1.27e-5));
        assert_eq!(grid.length(two - one), 31.0 * grid.width);
        // Of seven parts in two steps one step is left.
        let half = grid.length(0.5 * (grid.near(10.0 + 5.0 / 64.0 * 2e-5) - 10.0));
        assert!(
            (half / grid.width - 2.5).abs() < 4.0 * f64::EPSILON,
            "{half:e}"
        );
        // A picosecond beside the grid is no rounding.
        for other in [3.3 * grid.width, 3.0 * grid.width + 1e-12] {
            assert_eq!(grid.length(other), other);
        }
    }
}
