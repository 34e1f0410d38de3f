//! Wall time per simulated second at the same error: our solvers against what a user could pick instead.

use geartrain::config::SolverChoice::{Exponential, Newmark};

use crate::clock::{Measure, in_rounds};
use crate::contest::{Contest, Found, SAMPLES, SPAN};
use crate::models::{MODES, case_four, odd_speed};
use crate::problem::{Problem, Run};
use crate::rivals::{cvode, diffsol, dopri5, numpy, rk4};
use crate::table::Table;

/// The errors that are asked for.
const ERRORS: [f64; 2] = [1e-3, 1e-5];
/// What the others are compared with.
const UNIT: &str = "exponential";

/// Measures and prints.
pub fn run() -> Result<(), String> {
    println!(
        "Wall time at the same error: three_stage, case 4, {SPAN} s from equilibrium, inputs held. Error: RMS of mesh\n\
         forces against the converged solution / RMS of their alternating part, worst mesh, {SAMPLES} times.\n"
    );
    let mut table = Table::new(&[
        "method",
        "modes",
        "asked",
        "setting",
        "error",
        "ms per simulated s",
        "steps per simulated s",
        "ns per step",
        "times exponential",
    ]);
    let mut contests = Vec::new();
    for modes in MODES {
        let contest = Contest::of(&case_four(modes))?;
        let odd = Contest::of(&odd_speed(&case_four(modes)))?;
        for (speed, contest) in [("3000 rpm", &contest), ("2961.7 rpm", &odd)] {
            println!(
                "{modes} modes, {speed}: our converged solution and fine Runge-Kutta steps differ by {:.1e}",
                contest.disagreement
            );
        }
        contests.push((modes, contest, odd));
    }
    let mut entries = Vec::new();
    for (modes, contest, odd) in &contests {
        for asked in ERRORS {
            let all = methods(contest, odd, asked).into_iter();
            entries.extend(all.map(|(name, found)| (name, *modes, asked, found)));
        }
    }
    let found = entries.iter().filter_map(|(.., found)| found.as_ref().ok());
    let mut costs: Vec<Measure<'_>> = found.map(Found::cost).collect();
    let times = in_rounds(&mut costs);
    let (mut best, mut unit, mut notes) = (times.best.iter(), f64::NAN, Vec::new());
    for (name, modes, asked, found) in &entries {
        let mut cells = vec![name.to_string(), modes.to_string(), format!("{asked:.0e}")];
        match found {
            Ok(found) => {
                let seconds = *best.next().ok_or("a time is missing")?;
                if *name == UNIT {
                    unit = seconds;
                }
                cells.extend(figures(found, seconds, unit));
            }
            Err(why) => {
                notes.push(format!("{name}, {modes} modes, {asked:.0e}: {why}"));
                cells.push("none".to_string());
            }
        }
        table.row(cells);
    }
    println!();
    table.print();
    println!("{}", times.quiet);
    for note in notes {
        println!("{note}");
    }
    println!();
    Ok(())
}

/// What each method needs to reach an error: ours at a mesh period that fits the times and at one that does not, from the start and
/// when it goes on, then others.
fn methods<'a>(
    contest: &'a Contest,
    odd: &'a Contest,
    asked: f64,
) -> Vec<(&'static str, Result<Found<'a>, String>)> {
    let problem = &contest.problem;
    let steps = contest.runge_kutta_steps(asked);
    let by_steps =
        |run: fn(&Problem, u64) -> Result<Run, String>| contest.by_steps(steps.clone()?, run);
    let dopri5 = move |tolerance| Ok(dopri5::run(problem, tolerance));
    let diffsol = |method| {
        contest.by_tolerance(asked, move |tolerance| {
            diffsol::run(contest.text(), method, tolerance)
        })
    };
    let cvode = |formulas| {
        contest.by_tolerance(asked, move |tolerance| {
            cvode::run(problem, formulas, tolerance)
        })
    };
    vec![
        (UNIT, contest.ours(Exponential, asked)),
        (
            "exponential, going on",
            contest.ours_going_on(Exponential, asked),
        ),
        ("exponential, 2961.7 rpm", odd.ours(Exponential, asked)),
        (
            "exponential, 2961.7 rpm, going on",
            odd.ours_going_on(Exponential, asked),
        ),
        ("newmark", contest.ours(Newmark, asked)),
        (
            "RK4, Rust",
            by_steps(|problem, steps| Ok(rk4::run(problem, steps))),
        ),
        ("DOPRI5, Rust", contest.by_tolerance(asked, dopri5)),
        ("diffsol tsit45", diffsol("tsit45")),
        ("diffsol BDF", diffsol("bdf")),
        ("diffsol TR-BDF2", diffsol("tr_bdf2")),
        ("CVODE Adams", cvode(cvode::Formulas::Adams)),
        ("CVODE BDF", cvode(cvode::Formulas::Bdf)),
        ("RK4, numpy loop", by_steps(numpy::run)),
    ]
}

fn figures(found: &Found<'_>, seconds: f64, unit: f64) -> Vec<String> {
    vec![
        found.setting.clone(),
        format!("{:.1e}", found.error),
        format!("{:.2}", 1e3 * seconds / SPAN),
        format!("{:.3e}", found.steps as f64 / SPAN),
        format!("{:.0}", 1e9 * seconds / found.steps as f64),
        format!("{:.1}", seconds / unit),
    ]
}
