//! Whether the modes kept are enough, and the communication step.

use geartrain::analysis::{CHANNELS, LIMIT, SuggestedStep};

use geartrain::rotor::ModeCounts;

use super::{Inspection, json};

/// Compliances listed at most.
const COMPLIANCES: usize = 4;

/// The verdict first, then where the errors are.
pub fn print_basis(inspection: &Inspection) {
    let report = &inspection.basis;
    let errors = &report.errors;
    println!("\nModal basis, against the full finite-element model");
    let counts = inspection.train.rotors.iter().zip(&inspection.model.rotors);
    let counts: Vec<String> = counts
        .map(|(rotor, modal)| {
            let counts = modal.counts;
            let shapes = [
                counts.lateral - counts.lateral_modes,
                counts.torsional - counts.torsional_modes,
            ];
            let added = match shapes {
                [0, 0] => String::new(),
                [lateral, torsional] => format!(" + {lateral}/{torsional} static shapes"),
            };
            let (lateral, torsional) = (counts.lateral_modes, counts.torsional_modes);
            format!("{} {lateral}/{torsional}{added}", rotor.name)
        })
        .collect();
    println!("  modes (lateral/torsional): {}", counts.join(", "));
    let (highest, limit) = (report.reference.highest_frequency, 100.0 * LIMIT);
    let verdict = if errors.sufficient() {
        "LARGE ENOUGH"
    } else {
        "NOT LARGE ENOUGH"
    };
    println!(
        "  {verdict} for {highest:.0} Hz: worst force response {} (RMS over frequency), worst static compliance {}; limit {limit} %",
        percent(errors.worst_response()),
        percent(errors.worst_compliance())
    );
    match &report.recommendation {
        Some(enough) => {
            let counts = |modes: fn(&ModeCounts) -> usize| {
                enough.counts.iter().map(modes).max().unwrap_or(0)
            };
            println!(
                "  large enough is: max_frequency = {:.0}, static_shapes = true   (up to {}/{} modes; worst response {})",
                enough.max_frequency,
                counts(|counts| counts.lateral_modes),
                counts(|counts| counts.torsional_modes),
                percent(enough.errors.worst_response())
            );
        }
        None => {
            println!("  no basis that was tried is large enough; make max_element_length smaller");
        }
    }
    if let Some(vibration) = &report.vibration {
        let worst = |name: &str, errors: &[f64]| {
            let largest = errors.iter().copied().reduce(f64::max)?;
            Some(format!("worst {name} force {}", percent(largest)))
        };
        let parts = [
            worst("mesh", &vibration.meshes),
            worst("bearing", &vibration.bearings),
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        println!(
            "  gearbox vibration of {} Hz: {}",
            vibration.frequency,
            parts.join(", ")
        );
    }
    print_octaves(inspection);
    print_compliances(inspection);
}

fn print_octaves(inspection: &Inspection) {
    let errors = &inspection.basis.errors;
    println!("\n  largest error [%] of mesh and bearing forces, by what excites");
    let heads = ["all supports", "one support", "transm. error", "torque"];
    let heads = heads.map(|head| format!("  {head:^17}")).concat();
    println!("  {:>15}{}", "", heads.trim_end());
    println!(
        "  {:>15}{}",
        "f [Hz]",
        format!("  {:>8} {:>8}", "mesh", "bearing").repeat(4)
    );
    let row = |name: &str, cells: Vec<Option<f64>>, decimals: usize| {
        let cell = |cell: &Option<f64>| match cell {
            Some(value) => format!("{value:>8.decimals$}"),
            None => format!("{:>8}", "-"),
        };
        let pair = |pair: &[Option<f64>]| format!("  {} {}", cell(&pair[0]), cell(&pair[1]));
        println!(
            "  {name:>15}{}",
            cells.chunks(2).map(pair).collect::<String>()
        );
    };
    for octave in errors.octaves() {
        let percents = octave
            .channels
            .iter()
            .map(|error| error.map(|error| 100.0 * error));
        let name = format!("{:.0} - {:.0}", octave.from, octave.to);
        row(&name, percents.collect(), 2);
    }
    let rms = (0..CHANNELS.len()).map(|channel| errors.channel_rms(channel));
    row(
        "RMS",
        rms.map(|error| error.map(|error| 100.0 * error)).collect(),
        2,
    );
    let good = (0..CHANNELS.len()).map(|channel| errors.channel_good_to(channel));
    row("good to [Hz]", good.collect(), 0);
}

fn print_compliances(inspection: &Inspection) {
    let mut worst = inspection.basis.errors.compliances.clone();
    worst.sort_by(|one, two| two.1.total_cmp(&one.1));
    let named: Vec<String> = worst
        .iter()
        .take(COMPLIANCES)
        .map(|(spot, error)| {
            let direction = if spot.torsional {
                "torsional"
            } else {
                "lateral"
            };
            let rotor = inspection.rotor_name(spot.rotor);
            let place = json::place(inspection, spot);
            format!("{rotor}.{place} {direction} {}", percent(*error))
        })
        .collect();
    println!(
        "  largest errors of static compliances: {}",
        named.join(", ")
    );
}

/// The communication step and its reason.
pub fn print_step(step: &SuggestedStep) {
    println!("\nCommunication step with a gearbox model");
    println!(
        "  {:.0e} s with held inputs, {:.0e} s with input derivatives: 1 % in the bearing forces at {:.0} Hz",
        step.held, step.with_derivatives, step.frequency
    );
    println!("  (measured beside a gearbox of 10 kg per bearing; docs/inspect.md)");
    match step.stable_to {
        Some(stable) if stable < step.held => println!(
            "  CAUTION: the dampers of the bearings alone keep such a loop stable only up to {stable:.1e} s; \
             the gearbox's own damping has to do the rest"
        ),
        Some(_) => {}
        None => println!(
            "  CAUTION: some bearing has no damping; only the gearbox's own damping keeps a loop with held inputs stable"
        ),
    }
}

/// A share for people.
pub fn percent(ratio: f64) -> String {
    match 100.0 * ratio {
        large if large >= 10.0 => format!("{large:.0} %"),
        small => format!("{small:.2} %"),
    }
}
