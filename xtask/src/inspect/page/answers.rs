//! What the page says in words: verdicts, steps, and the pictures of vibrations and basis.

use std::f64::consts::TAU;

use geartrain::analysis::{Campbell, SuggestedStep};
use geartrain::description::html::{Cell, Html};
use geartrain::drawing::{basis_check, campbell_diagram};
use geartrain::rotor::ModeCounts;

use super::super::Inspection;
use super::super::basis::percent;
use super::tables;

/// The short answers at the top.
pub fn cards(inspection: &Inspection) -> Vec<[String; 4]> {
    let card = |class: &str, what: &str, value: String, more: String| {
        [class.to_string(), what.to_string(), value, more]
    };
    let (train, model) = (&inspection.train, &inspection.model);
    let count = |number: usize, what: &str| match number {
        1 => format!("1 {what}"),
        more if what.ends_with("sh") => format!("{more} {what}es"),
        more => format!("{more} {what}s"),
    };
    let hertz = model.meshes.iter().map(geartrain::model::Mesh::frequency);
    let highest = hertz.reduce(f64::max).filter(|hertz| *hertz > 0.0);
    let mut cards = vec![card(
        "",
        "Train",
        format!(
            "{}, {}",
            count(train.rotors.len(), "rotor"),
            count(train.meshes.len(), "mesh")
        ),
        highest.map_or(String::new(), |hertz| {
            format!("highest mesh frequency {hertz:.1} Hz")
        }),
    )];
    let errors = &inspection.basis.errors;
    let (class, verdict) = if errors.sufficient() {
        ("good", "Large enough")
    } else {
        ("bad", "Not large enough")
    };
    cards.push(card(
        class,
        "Modal basis",
        verdict.to_string(),
        format!(
            "for {:.0} Hz: worst force response off by {}",
            inspection.basis.reference.highest_frequency,
            percent(errors.worst_response())
        ),
    ));
    cards.push(card(
        "",
        "Communication step",
        format!("{:.0e} s", inspection.step.held),
        format!(
            "{:.0e} s with input derivatives",
            inspection.step.with_derivatives
        ),
    ));
    if let Ok(table) = &inspection.campbell {
        cards.push(nearest_critical(inspection, table));
    }
    cards
}

/// The critical speed nearest to the file's speed.
fn nearest_critical(inspection: &Inspection, table: &Campbell) -> [String; 4] {
    let speed = inspection.train.rotors[0].speed.abs();
    let away = |one: &f64| (one - speed).abs();
    let speeds = table.critical_speeds.iter().map(|critical| critical.speed);
    let nearest = speeds.min_by(|one, two| away(one).total_cmp(&away(two)));
    let (value, more) = match nearest {
        Some(critical) if speed > 0.0 => (
            format!("{:.0} rpm", critical * 60.0 / TAU),
            format!(
                "{:+.1} % from the speed of the file",
                100.0 * (critical / speed - 1.0)
            ),
        ),
        Some(critical) => (format!("{:.0} rpm", critical * 60.0 / TAU), String::new()),
        None => (
            "none".to_string(),
            "within the speeds looked at".to_string(),
        ),
    };
    [
        String::new(),
        "Nearest critical speed".to_string(),
        value,
        more,
    ]
}

pub fn vibrations(html: &mut Html, inspection: &Inspection) {
    let limit = inspection.basis.reference.highest_frequency;
    let found = &inspection.vibrations;
    html.text(
        "p",
        &format!(
            "The whole train at its speed, linear, with the mean mesh stiffness, up to {limit:.0} Hz. Kind: where most of the energy is."
        ),
    );
    let numbered = || found.oscillating.iter().enumerate();
    let inside = numbered().filter(|(_, one)| one.natural.frequency <= limit);
    html.table(&tables::VIBRATIONS, &tables::vibrations(inspection, inside));
    let beyond = numbered().filter(|(_, one)| one.natural.frequency > limit);
    let beyond = tables::vibrations(inspection, beyond);
    if !beyond.is_empty() {
        let summary = format!("{} more above {limit:.0} Hz", beyond.len());
        html.folded(&summary, |html| html.table(&tables::VIBRATIONS, &beyond));
    }
    let creeping = found
        .creeping
        .iter()
        .map(|one| one.natural.damping_ratio * one.natural.frequency * TAU);
    let rates: Vec<Cell> = creeping.map(|rate| Cell::scientific(rate, 3)).collect();
    if !rates.is_empty() {
        html.text(
            "p",
            "Motions that creep back without oscillating, decay rate [1/s]:",
        );
        let head: Vec<&str> = rates.iter().map(|_| "1/s").collect();
        html.table(&head, &[rates]);
    }
    match found.rigid {
        0 => {}
        1 => html.text("p", "One further motion is rigid: nothing holds it."),
        more => html.text(
            "p",
            &format!("{more} further motions are rigid: nothing holds them."),
        ),
    }
    html.text("h3", "Over speed");
    let table = match &inspection.campbell {
        Ok(table) => table,
        Err(reason) => {
            html.text("p", &format!("There is no table over speed: {reason}."));
            return;
        }
    };
    // Mesh frequencies are far above rotation: each gets a diagram.
    let rotation = table
        .points
        .last()
        .into_iter()
        .flat_map(|point| &point.rotor_speeds);
    let rotation = rotation.fold(0.0, |most: f64, speed| most.max(speed.abs() / TAU));
    let low = (4.0 * rotation).max(1.25 * lowest(inspection));
    if let Some(picture) = campbell_diagram(&inspection.train, table, limit) {
        html.figure(
            &picture,
            "Damped natural frequencies over speed. Dashed: rotation of the rotors and mesh frequencies with their second harmonics. \
             Where they meet is a critical speed; whether it is excited there depends on the shape.",
        );
    }
    let near = (low < 0.7 * limit).then(|| campbell_diagram(&inspection.train, table, low));
    if let Some(picture) = near.flatten() {
        html.figure(&picture, "The same near the frequencies of rotation.");
    }
    let (head, rows) = tables::over_speed(inspection, table);
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    html.folded("Damped frequencies [Hz] over speed", |html| {
        html.table(&head, &rows);
    });
    let critical = tables::critical_speeds(inspection, table);
    if critical.is_empty() {
        html.text("p", "No critical speed in this range.");
    } else {
        let summary = format!("{} critical speeds", critical.len());
        html.folded(&summary, |html| html.table(&tables::CRITICAL, &critical));
    }
}

/// The lowest natural frequency [Hz].
fn lowest(inspection: &Inspection) -> f64 {
    let first = inspection.vibrations.oscillating.first();
    first.map_or(0.0, |one| one.natural.frequency)
}

pub fn basis(html: &mut Html, inspection: &Inspection) {
    let report = &inspection.basis;
    let errors = &report.errors;
    let [response, compliance] = [errors.worst_response(), errors.worst_compliance()].map(percent);
    let verdict = if errors.sufficient() {
        "large enough"
    } else {
        "not large enough"
    };
    html.text(
        "p",
        &format!(
            "Against all modes of the finite elements, the modes kept are {verdict} for {:.0} Hz: worst force response {response} (RMS over \
             frequency), worst static compliance {compliance}; every force is within 5 % up to {:.0} Hz.",
            report.reference.highest_frequency,
            errors.good_to()
        ),
    );
    match &report.recommendation {
        Some(enough) => {
            let most = |modes: fn(&ModeCounts) -> usize| {
                enough.counts.iter().map(modes).max().unwrap_or(0)
            };
            html.text(
                "p",
                &format!(
                    "Large enough is, with up to {} lateral and {} torsional modes per rotor and a worst response of {}:",
                    most(|counts| counts.lateral_modes),
                    most(|counts| counts.torsional_modes),
                    percent(enough.errors.worst_response())
                ),
            );
            html.code(&format!(
                "[basis]\nmax_frequency = {:.0}\nstatic_shapes = true",
                enough.max_frequency
            ));
        }
        None => html.text(
            "p",
            "No basis that was tried is large enough; make max_element_length smaller.",
        ),
    }
    if let Some(picture) = basis_check(errors) {
        html.figure(
            &picture,
            "Error of the forces at meshes and bearings, by what excites, in thirds of an octave. Below the line: within the limit.",
        );
    }
    html.table(&tables::MODES, &tables::modes(inspection));
    html.table(&["", ""], &numbers(inspection));
    let (head, rows) = tables::errors(&errors.bands);
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    html.folded("Errors of force responses", |html| html.table(&head, &rows));
    html.folded("Errors of static compliances", |html| {
        html.table(&tables::COMPLIANCES, &tables::compliances(inspection));
    });
    if let Some(vibration) = &report.vibration {
        let rows = tables::under_vibration(inspection, vibration);
        let summary = format!(
            "Errors of forces under the gearbox vibration of {} Hz",
            vibration.frequency
        );
        html.folded(&summary, |html| html.table(&["force", "error"], &rows));
    }
}

/// The numbers of the check.
fn numbers(inspection: &Inspection) -> Vec<Vec<Cell>> {
    let report = &inspection.basis;
    let share = |what: &str, value: f64| vec![what.into(), Cell::percent(value)];
    let hertz =
        |what: &str, value: f64| vec![what.into(), Cell::Number(format!("{value:.1} Hz"), value)];
    let count = |what: &str, value: usize| vec![what.into(), Cell::fixed(value as f64, 0)];
    let mut rows = vec![
        hertz(
            "highest frequency of interest",
            report.reference.highest_frequency,
        ),
        hertz("all forces within the limit up to", report.errors.good_to()),
        share("limit", geartrain::analysis::LIMIT),
        share("worst force response", report.errors.worst_response()),
        share("worst static compliance", report.errors.worst_compliance()),
    ];
    if let Some(enough) = &report.recommendation {
        let most =
            |modes: fn(&ModeCounts) -> usize| enough.counts.iter().map(modes).max().unwrap_or(0);
        rows.extend([
            hertz("recommended max_frequency", enough.max_frequency),
            share(
                "worst force response with it",
                enough.errors.worst_response(),
            ),
            share(
                "worst static compliance with it",
                enough.errors.worst_compliance(),
            ),
            count(
                "most lateral modes with it",
                most(|counts| counts.lateral_modes),
            ),
            count(
                "most torsional modes with it",
                most(|counts| counts.torsional_modes),
            ),
        ]);
    }
    if let Some(vibration) = &report.vibration {
        rows.push(hertz("gearbox vibration", vibration.frequency));
    }
    rows
}

pub fn step(html: &mut Html, step: &SuggestedStep) {
    html.text(
        "p",
        &format!(
            "Beside a gearbox of 10 kg per bearing, these steps keep the bearing forces at {:.0} Hz within 1 %:",
            step.frequency
        ),
    );
    let row = |what: &str, value: f64| vec![what.into(), Cell::scientific(value, 0)];
    html.table(
        &["communication step", "[s]"],
        &[
            row("inputs held over a step", step.held),
            row("with input derivatives", step.with_derivatives),
        ],
    );
    match step.stable_to {
        Some(stable) if stable < step.held => html.text(
            "p",
            &format!(
                "Caution: the dampers of the bearings alone keep such a loop stable only up to {stable:.1e} s; the gearbox's own damping has \
                 to do the rest."
            ),
        ),
        Some(_) => {}
        None => html.text(
            "p",
            "Caution: some bearing has no damping; only the gearbox's own damping keeps a loop with held inputs stable.",
        ),
    }
}
