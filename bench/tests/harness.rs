//! The benchmark measures what it says: everybody solves the equations of the library.

use bench::contest::Contest;
use bench::equations::Equations;
use bench::models::{MODES, Phases, case_four, chain, odd_speed};
use bench::problem::{Problem, loaded, started, torques};
use bench::rivals::{dopri5, ours, rk4};
use geartrain::config::SolverChoice;

/// Simulated time [s]: nine mesh periods of the example.
const SPAN: f64 = 0.005;

#[test]
fn the_equations_for_everybody_are_those_of_the_library() {
    for text in [
        case_four(MODES[0]),
        case_four(MODES[1]),
        odd_speed(&case_four(MODES[0])),
        chain(4, MODES[0], Phases::Anywhere),
    ] {
        let (train, settings) = loaded(&text);
        let mut simulation = started(&train, &settings, 1e-4);
        let torques = torques(&train);
        let equations = Equations::of(&train, simulation.model(), &torques);
        // Times at which no stiffness changes its piece: there the library looks ahead.
        for time in [0.0, 1.234_567e-3, 4.321e-3] {
            simulation.advance_to(time).expect("the model is stable");
            let state = simulation.motion().state;
            let x = [state.position(), state.velocity()].concat();
            let mut derivative = vec![0.0; x.len()];
            equations.evaluate(time, &x, &mut derivative);
            let (rates, found) = derivative.split_at(x.len() / 2);
            assert_eq!(rates, state.velocity());
            let expected = simulation.acceleration();
            let largest = expected.iter().map(|value| value.abs()).fold(0.0, f64::max);
            for (found, expected) in found.iter().zip(&expected) {
                // Large forces cancel near equilibrium: rounding of a million times the result's own.
                assert!(
                    (found - expected).abs() < 1e-9 * largest,
                    "{found}, not {expected}"
                );
            }
        }
    }
}

#[test]
fn a_jacobian_is_the_change_of_the_equations() {
    let problem = Problem::of(&case_four(MODES[0]), SPAN, 1);
    let (equations, time) = (&problem.equations, 1e-4);
    let at = |x: &[f64]| {
        let mut derivative = vec![0.0; x.len()];
        equations.evaluate(time, x, &mut derivative);
        derivative
    };
    let here = at(&problem.start);
    for column in 0..equations.order() {
        let mut x = problem.start.clone();
        x[column] += 1.0;
        let change = at(&x);
        let change = change.iter().zip(&here).map(|(there, here)| there - here);
        let exact = equations.jacobian_column(time, column);
        let largest = exact.iter().map(|value| value.abs()).fold(0.0, f64::max);
        for (change, exact) in change.zip(exact) {
            // The equations are linear in x: only rounding, of the forces that are there as well.
            assert!((change - exact).abs() <= 1e-9 * (1.0 + largest));
        }
    }
}

#[test]
fn our_solvers_and_the_rivals_find_the_same_forces() {
    let text = case_four(MODES[0]);
    let problem = Problem::of(&text, SPAN, 10);
    let converged = ours::run(&problem, &text, SolverChoice::Exponential, 1e-10).forces;
    let of = |run: bench::problem::Run| problem.error(&run.forces, &converged);
    // Steps of 2 us: the error of fourth order is 1e-3 at 20 us.
    assert!(of(rk4::run(&problem, 250)) < 1e-6);
    assert!(of(dopri5::run(&problem, 1e-8)) < 1e-6);
    assert!(of(ours::run(&problem, &text, SolverChoice::Newmark, 1e-7)) < 1e-6);
}

#[test]
fn other_equations_are_noticed() {
    let text = case_four(MODES[0]);
    let problem = |text: &str| Problem::of(text, SPAN, 10);
    assert!(Contest::between(&text, problem(&text)).is_ok());
    let other = text.replace("pair = 5.0e+08", "pair = 5.001e+08");
    assert!(Contest::between(&text, problem(&other)).is_err());
}
