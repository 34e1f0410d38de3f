//! Numbers with units: the same model as in SI, to the bit where factors are exact, and messages about wrong ones.

mod support;

use core::f64::consts::PI;

use geartrain::config::{Config, Problem, read};
use geartrain::train::{load, no_files};
use support::{started, three_stage};

/// The example that is written with units.
fn two_shaft() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/two_shaft.toml");
    std::fs::read_to_string(path).expect("the example is part of the repository")
}

fn config(text: &str) -> Config {
    let reading = read(text, &no_files);
    assert!(reading.problems.is_empty(), "{:#?}", reading.problems);
    reading.config.unwrap()
}

/// A number of a model file that is nothing but a rotor's angle, length, ... in its place.
fn value_of(key: &str, text: &str) -> Result<f64, String> {
    let (table, read_back): (&str, fn(&Config) -> f64) = match key {
        "angle" => ("", |config| config.rotors[0].angle),
        "speed" => ("", |config| config.rotors[0].speed),
        "length" => ("[[rotor.segment]]\n", |config| {
            config.rotors[0].segments[0].length
        }),
        "mass" => ("[[rotor.disk]]\n", |config| config.rotors[0].disks[0].mass),
        "inertia" => ("[[rotor.disk]]\npolar_", |config| {
            config.rotors[0].disks[0].polar_inertia
        }),
        "value" => ("[[rotor.torque]]\n", |config| {
            config.rotors[0].torques[0].value
        }),
        "torsional" => ("[[rotor.basis_support]]\n", |config| {
            config.rotors[0].basis_supports[0].torsional
        }),
        "lateral" => ("[[rotor.basis_support]]\n", |config| {
            config.rotors[0].basis_supports[0].lateral
        }),
        "frequency" => ("[gearbox_vibration]\n", |config| {
            config.gearbox_vibration.frequency
        }),
        "lateral_damping_ratio" => ("", |config| config.rotors[0].lateral_damping_ratio),
        other => panic!("no place for {other}"),
    };
    let reading = read(
        &format!("[[rotor]]\n{table}{key} = \"{text}\"\n"),
        &no_files,
    );
    let value = read_back(reading.config.as_ref().unwrap());
    let about = |problem: &&Problem| problem.message.contains('"') || value.is_nan();
    let own = reading
        .problems
        .iter()
        .filter(|problem| problem.message.starts_with(&format!("{key}: ")));
    match own.filter(about).map(ToString::to_string).next() {
        Some(message) => Err(message),
        None => Ok(value),
    }
}

#[test]
fn exact_factors_give_the_number_nearest_to_the_exact_one() {
    for (key, text, si) in [
        ("length", "40 inch", 1.016),
        ("length", "2.4 in", 0.06096),
        ("length", "5 ft 6 inch", 1.6764),
        ("length", "0.1 mm", 1e-4),
        ("length", "3 um", 3e-6),
        ("length", "3 µm", 3e-6),
        ("length", "1/3 m", 1.0 / 3.0),
        ("length", "-5 mm", -0.005),
        ("mass", "250 g", 0.25),
        ("mass", "1 lb", 0.45359237),
        ("value", "2.25 kN m", 2250.0),
        ("value", "2.25 kN·m", 2250.0),
        ("value", "2250 N*m", 2250.0),
        ("lateral", "1e5 N/mm", 1e8),
        ("lateral", "100 MN/m", 1e8),
        ("torsional", "3 kN m/rad", 3000.0),
        ("frequency", "1.2 kHz", 1200.0),
        ("frequency", "72000/min", 1200.0),
        ("lateral_damping_ratio", "5 %", 0.05),
        ("lateral_damping_ratio", "0.05", 0.05),
        ("inertia", "700 kg mm^2", 7e-4),
        ("inertia", "700 kg mm2", 7e-4),
        ("inertia", "700 kg·mm²", 7e-4),
    ] {
        assert_eq!(value_of(key, text), Ok(si), "{text}");
    }
    // Where a naive product of rounded factors is one bit off.
    assert_ne!(3.3 * 0.0254, 0.08382);
    assert_eq!(value_of("length", "3.3 inch"), Ok(0.08382));
}

#[test]
fn revolutions_are_two_pi_radians_and_angles_the_nearest_number() {
    for (key, text, si) in [
        ("speed", "3000 rpm", 100.0 * PI),
        ("speed", "-50 rev/s", -100.0 * PI),
        ("speed", "314 rad/s", 314.0),
        ("speed", "-1500 rpm * 23/71", -50.0 * PI * 23.0 / 71.0),
        ("angle", "180 deg", PI),
        ("angle", "90°", PI / 2.0),
        ("angle", "0.25 turn", PI / 2.0),
        ("angle", "pi/4 rad", PI / 4.0),
        ("torsional", "1 N m/deg", 180.0 / PI),
    ] {
        let value = value_of(key, text).unwrap();
        // Two roundings of the comparison itself.
        assert!((value / si - 1.0).abs() < 4e-16, "{text}: {value} {si}");
    }
    assert_eq!(value_of("angle", "180 deg"), Ok(PI));
}

#[test]
fn a_wrong_dimension_is_named_with_the_one_that_is_wanted() {
    for (key, text, message) in [
        (
            "length",
            "3000 rpm",
            "\"3000 rpm\" is an angular speed, a length in m is wanted",
        ),
        (
            "speed",
            "50 Hz",
            "\"50 Hz\" is a frequency, an angular speed in rad/s is wanted",
        ),
        (
            "frequency",
            "3000 rpm",
            "is an angular speed, a frequency in Hz is wanted",
        ),
        (
            "torsional",
            "5 N m",
            "is a torque, a torsional stiffness in N m/rad is wanted",
        ),
        (
            "length",
            "40",
            "\"40\" has no unit, a length in m is wanted",
        ),
        (
            "lateral_damping_ratio",
            "3 deg",
            "is an angle, a plain number is wanted",
        ),
        ("mass", "3 N", "is a force, a mass in kg is wanted"),
        (
            "mass",
            "3 kg^2",
            "is something else, a mass in kg is wanted",
        ),
    ] {
        let found = value_of(key, text).unwrap_err();
        assert!(found.contains(message), "{found}");
    }
}

#[test]
fn what_is_no_quantity_gets_a_message_that_says_what_to_write() {
    for (text, message) in [
        (
            "40 zoll",
            "unknown unit \"zoll\"; known are m, g, s, N, Pa, Hz, rad with prefixes",
        ),
        ("2 kNm", "unknown unit \"kNm\"; write \"kN m\""),
        ("3000 RPM", "unknown unit \"RPM\"; it is written \"rpm\""),
        ("20 °C", "unknown unit \"°C\""),
        ("5 USD", "unknown unit"),
        ("sqrt(4) m", "unknown unit \"sqrt\""),
        ("1,5 m", "not understood at \",\""),
        ("3 m + 2 kg", "cannot be calculated"),
        ("1/0 m", "cannot be calculated"),
        ("3 m) + (2 m", "parentheses do not match"),
        ("9^9^9^9 m", "cannot be calculated"),
        ("", "must be a number"),
        ("today", "must be a number"),
    ] {
        let found = value_of("length", text).unwrap_err();
        assert!(found.contains(message), "{text}: {found}");
    }
    let endless = "(".repeat(100_000);
    assert!(value_of("length", &endless).unwrap_err().len() < 400);
}

#[test]
fn lists_and_inline_tables_take_units_and_the_wrong_entry_is_marked() {
    let text = "[[rotor]]\n[[rotor.bow]]\npositions = [\"0 mm\", 0.5, \"1 m\"]\namplitudes = [\"1 um\", \"2 um\", \"3 s\"]\n\
                [[rotor.bearing]]\nstiffness = { xx = \"1e5 N/mm\", xy = \"1 N s/m\" }\n";
    let reading = read(text, &no_files);
    let config = reading.config.unwrap();
    assert_eq!(config.rotors[0].bows[0].positions, [0.0, 0.5, 1.0]);
    assert_eq!(config.rotors[0].bows[0].amplitudes[..2], [1e-6, 2e-6]);
    assert_eq!(config.rotors[0].bearings[0].stiffness.xx, 1e8);
    let marked = |part: &str| {
        let find = |problem: &&Problem| problem.message.contains(part);
        let problem = reading.problems.iter().find(find).unwrap();
        let excerpt = problem.spot.unwrap().excerpt(text);
        let lines: Vec<String> = excerpt.lines().map(str::to_string).collect();
        let from = lines[2].find('^').unwrap();
        lines[1][from..lines[2].len()].to_string()
    };
    assert_eq!(marked("is a time"), "\"3 s\"");
    assert_eq!(marked("is a damping"), "\"1 N s/m\"");
}

#[test]
fn a_hertzian_coefficient_follows_its_exponent() {
    let text = |exponent: &str, coefficient: &str| {
        format!(
            "[[rotor]]\n[[rotor.bearing]]\n[rotor.bearing.nonlinear]\nlaw = \"hertz\"\nexponent = {exponent}\n\
             coefficient = {coefficient}\n"
        )
    };
    let law = |exponent: &str, coefficient: &str| {
        let config = read(&text(exponent, coefficient), &no_files)
            .config
            .unwrap();
        let law = config.rotors[0].bearings[0].nonlinear.unwrap();
        (law.exponent, law.coefficient)
    };
    assert_eq!(law("1.5", "\"1e9 N/m^1.5\""), (1.5, 1e9));
    let (exponent, coefficient) = law("\"10/9\"", "\"5 N/mm^(10/9)\"");
    assert_eq!(exponent, 10.0 / 9.0);
    // 1000^(10/9) = 10^(10/3); 1e-15: the root is taken by fend in floating point.
    assert!((coefficient / (5.0 * libm::pow(10.0, 10.0 / 3.0)) - 1.0).abs() < 1e-15);
    assert!(law("1.5", "\"1e9 N/m^1.4\"").1.is_nan());
}

#[test]
fn every_wrong_number_of_a_file_gives_one_message_at_its_line() {
    let text = two_shaft();
    let lines: Vec<&str> = text.lines().collect();
    let mut tried = 0;
    for (index, line) in lines.iter().enumerate() {
        // A number with its unit, or a whole number.
        let Some((key, value)) = line.split_once(" = ") else {
            continue;
        };
        let value = value.split(" #").next().unwrap().trim_end();
        let digit = |text: &str| text.starts_with(|letter: char| "-.0123456789".contains(letter));
        if line.starts_with('#') || !digit(value.trim_start_matches('"')) {
            continue;
        }
        let mut changed = lines.clone();
        let wrong = format!("{key} = \"1 K\"");
        changed[index] = &wrong;
        let problems = load(&changed.join("\n")).map(|_| ()).unwrap_err();
        assert_eq!(problems.len(), 1, "{line}: {problems:#?}");
        assert_eq!(problems[0].spot.unwrap().line, index + 1, "{line}");
        tried += 1;
    }
    assert!(tried > 50, "{tried}");
}

#[test]
fn the_example_in_inches_is_the_example_in_metres() {
    let mut text = three_stage();
    for (si, written) in [
        ("length = 1.016", "length = \"40 inch\""),
        ("length = 0.762", "length = \"30 inch\""),
        ("length = 0.508", "length = \"20 inch\""),
        ("outer_diameter = 0.06096", "outer_diameter = \"2.4 inch\""),
        ("outer_diameter = 0.03556", "outer_diameter = \"1.4 inch\""),
        ("value = 2250.0", "value = \"2.25 kN m\""),
        (
            "xx = 1.0e+08, yy = 1.0e+08",
            "xx = \"1e5 N/mm\", yy = \"1e5 N/mm\"",
        ),
        ("xx = 800.0", "xx = \"0.8 N s/mm\""),
        ("moment = 5.0e-6", "moment = \"5 g mm\""),
        ("density = 7830.0", "density = \"7.83 g/cm^3\""),
        ("youngs_modulus = 2.07e11", "youngs_modulus = \"207 GPa\""),
        ("pair = 5.0e+08", "pair = \"500 kN/mm\""),
        ("frequency = 1200.0", "frequency = \"1.2 kHz\""),
        ("step_size = 2e-5", "step_size = \"20 us\""),
        // Multiples of pi: the nearest numbers to the exact ones too.
        ("speed = 314.1592653589793", "speed = \"3000 rpm\""),
        ("speed = -314.1592653589793", "speed = \"-3000 rpm\""),
        (
            "center_angle = 3.141592653589793",
            "center_angle = \"180 deg\"",
        ),
        (
            "pressure_angle = 0.3490658503988659",
            "pressure_angle = \"20 deg\"",
        ),
        ("phase_y = 1.5707963267948966", "phase_y = \"90 deg\""),
    ] {
        assert!(text.contains(si), "{si}");
        text = text.replace(si, written);
    }
    assert_eq!(config(&text), config(&three_stage()));
}

#[test]
fn the_second_example_says_what_its_si_numbers_say_and_runs() {
    let text = two_shaft();
    let own = config(&text);
    let (input, output) = (&own.rotors[0], &own.rotors[1]);
    assert_eq!(
        (input.speed, output.segments[0].inner_diameter),
        (50.0 * PI, 0.02)
    );
    assert_eq!(input.segments[1].length, 0.24);
    assert_eq!(input.bearings[0].stiffness.xx, 2e8);
    assert_eq!(output.bearings[0].stiffness.yy, 2.5e8);
    assert_eq!(output.bearings[1].damping.yy, 1500.0);
    assert_eq!(input.unbalances[0].moment, 25e-6);
    assert_eq!(output.torques[0].value, 95.5 * 71.0 / 23.0);
    assert_eq!(own.meshes[0].transmission_error[0].amplitude, 2e-6);
    assert_eq!(own.simulation.step_size, 2e-5);
    assert_eq!(own.materials["default"].youngs_modulus, 2.1e11);
    let loaded = load(&text).unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    started(&text, 1e-4).advance_to(0.01).unwrap();
}
