//! Mesh stiffness from tooth geometry: from the model file to the running model, and what users get wrong.
//!
//! Authority: closed form; the stiffness itself is compared in `src/mesh/tooth_geometry/tests.rs`.

mod support;

use geartrain::mesh::StiffnessLaw;
use geartrain::model::equilibrium;
use geartrain::train::load;
use support::{assembled, file_inputs, started, valid};

fn model() -> String {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/models/from_geometry.toml"
    );
    std::fs::read_to_string(path).expect("the model is part of the repository")
}

fn changed(changes: &[(&str, &str)]) -> String {
    let mut text = model();
    for (from, to) in changes {
        assert!(text.contains(from), "the model has no `{from}`");
        text = text.replacen(from, to, 1);
    }
    text
}

fn mean_stiffness(text: &str) -> f64 {
    assembled(text).meshes[0].mean_stiffness()
}

#[test]
fn the_train_runs_on_the_stiffness_of_its_teeth() {
    let text = model();
    let loaded = valid(&text);
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let law = &loaded.train.meshes[0].stiffness;
    let pair = law.spur_pair().unwrap();
    // The mean over a pitch of the sum over all pairs is the integral over one pair's contact.
    let (eps, samples) = (pair.path_of_contact().contact_ratio(), 2000);
    let mean: f64 = (0..samples)
        .map(|i| pair.pair_stiffness(eps * (f64::from(i) + 0.5) / f64::from(samples)))
        .sum::<f64>()
        * eps
        / f64::from(samples);
    let model = assembled(&text);
    // 1e-6: midpoint rule, O(h^2) at h = 1e-3.
    assert!((model.meshes[0].mean_stiffness() / mean - 1.0).abs() < 1e-6);
    // 60 N m at the pinion's base radius (cos 20 degrees) press the teeth together by F / k.
    let force = 60.0 / (0.5 * 17.0 * 0.003 * 0.939_692_620_785_908_4);
    let found = equilibrium(&model, &file_inputs(&text)).unwrap();
    let deflection = model.meshes[0].row.dot(&found.position);
    assert!((found.mesh_forces[0] / force - 1.0).abs() < 1e-9);
    assert!((deflection / (force / mean) - 1.0).abs() < 1e-6);
    // Two pairs at the start of a pitch, one at its end.
    let k = |cycle: f64| law.value(cycle, law.piece(cycle));
    assert_eq!(law.starts().len(), 2);
    assert!((k(0.3) / (pair.pair_stiffness(0.3) + pair.pair_stiffness(1.3)) - 1.0).abs() < 1e-9);
    assert!((k(0.8) / pair.pair_stiffness(0.8) - 1.0).abs() < 1e-9);
    // It jumps by the pair that comes into contact at the start of a pitch and by the one that leaves at frac(eps).
    let (split, first, last) = (
        law.starts()[1],
        pair.pair_stiffness(0.0),
        pair.pair_stiffness(eps),
    );
    assert!(((law.value(0.0, 0) - law.value(1.0, 1)) / first - 1.0).abs() < 1e-8);
    assert!(((law.value(split, 0) - law.value(split, 1)) / last - 1.0).abs() < 1e-8);
    started(&text, 1e-4).advance_to(0.005).unwrap();
}

#[test]
fn the_mean_is_near_that_of_the_standard() {
    let loaded = valid(&model());
    let law = &loaded.train.meshes[0].stiffness;
    let pair = law.spur_pair().unwrap();
    // ISO 6336-1, method B: 18.33 N/(mm um) over 25 mm. 10 %: beams without fillets against measurements.
    let standard = pair.iso6336().mesh * pair.face_width;
    assert!(
        (standard / (18.33e9 * 0.025) - 1.0).abs() < 3e-4,
        "rounding of 18.33"
    );
    assert!(
        (law.mean() / standard - 1.0).abs() < 0.1,
        "{} N/m",
        law.mean()
    );
}

#[test]
fn every_key_changes_the_stiffness() {
    let before = mean_stiffness(&model());
    for (from, to, grows) in [
        ("face_width = 0.025", "face_width = 0.026", true),
        ("addendum = [1.0, 1.0]", "addendum = [0.95, 1.0]", false),
        ("addendum = [1.0, 1.0]", "addendum = [1.0, 0.95]", false),
        ("dedendum = [1.25, 1.25]", "dedendum = [1.3, 1.25]", false),
        ("dedendum = [1.25, 1.25]", "dedendum = [1.25, 1.3]", false),
        (
            "profile_shift = [0.0, 0.0]",
            "profile_shift = [0.0, -0.1]",
            false,
        ),
        (
            "bore_radius = [0.01, 0.025]",
            "bore_radius = [0.009, 0.025]",
            false,
        ),
        (
            "bore_radius = [0.01, 0.025]",
            "bore_radius = [0.01, 0.024]",
            false,
        ),
        ("youngs_modulus = 2.06e11", "youngs_modulus = 2.1e11", true),
        ("poisson_ratio = 0.3", "poisson_ratio = 0.28", true),
    ] {
        let after = mean_stiffness(&changed(&[(from, to)]));
        assert_eq!(after > before, grows, "{to}: {before} -> {after} N/m");
        assert!((after / before - 1.0).abs() > 1e-4, "{to}");
    }
    // A larger distance, a softer wheel.
    let apart = changed(&[(
        "center_angle = 0.4\npressure_angle = 0.3490658503988659",
        "center_angle = 0.4\npressure_angle = 0.36",
    )]);
    assert!(mean_stiffness(&apart) < before, "fewer pairs in contact");
    let mixed = changed(&[
        (
            "material = \"default\"",
            "material = [\"default\", \"light\"]",
        ),
        (
            "[[rotor]]",
            "[material.light]\nyoungs_modulus = 7e10\npoisson_ratio = 0.34\ndensity = 2700.0\n[[rotor]]",
        ),
    ]);
    assert!(mean_stiffness(&mixed) < 0.7 * before);
}

#[test]
fn what_is_left_out_has_its_default() {
    let short = changed(&[
        ("addendum = [1.0, 1.0]\n", ""),
        ("dedendum = [1.25, 1.25]\n", ""),
        ("profile_shift = [0.0, 0.0]\n", ""),
        ("material = \"default\"", ""),
    ]);
    assert_eq!(mean_stiffness(&short), mean_stiffness(&model()));
    // The shafts: 15 mm at the pinion, whose body must be at least 1.4 times as large, and 25 mm.
    let body = changed(&[("bore_radius = [0.01, 0.025]\n", "")]);
    let root = 0.003 * (8.5 - 1.25);
    let pair = *valid(&body).train.meshes[0].stiffness.spur_pair().unwrap();
    assert_eq!(pair.gears[1].bore_radius, 0.025);
    assert!((pair.gears[0].bore_radius / (15e-3_f64).min(root / 1.4) - 1.0).abs() < 1e-12);
}

/// The model with these changes is refused with exactly one message, which contains all of `words`.
#[track_caller]
fn refused(changes: &[(&str, &str)], words: &[&str]) {
    let problems = load(&changed(changes)).map(|_| ()).unwrap_err();
    assert_eq!(problems.len(), 1, "{problems:#?}");
    assert!(problems[0].spot.is_some());
    let sentence = problems[0].to_string();
    for word in ["mesh \"mesh\", stiffness: "].iter().chain(words) {
        assert!(sentence.contains(word), "`{word}` is not in: {sentence}");
    }
}

#[test]
fn numbers_and_lists_are_checked() {
    refused(
        &[("face_width = 0.025", "face_width = 0.0")],
        &["face_width", "greater than 0"],
    );
    refused(&[("face_width = 0.025\n", "")], &["face_width", "missing"]);
    refused(&[("module = 0.003\nface", "face")], &["module", "missing"]);
    refused(
        &[("addendum = [1.0, 1.0]", "addendum = [1.0]")],
        &["addendum", "list of two numbers", "found 1"],
    );
    refused(
        &[("dedendum = [1.25, 1.25]", "dedendum = [1.25, -1.25]")],
        &["dedendum", "greater than 0", "-1.25"],
    );
    refused(
        &[("profile_shift = [0.0, 0.0]", "profile_shift = [nan, 0.0]")],
        &["profile_shift", "NaN"],
    );
    refused(
        &[(
            "material = \"default\"",
            "material = [\"default\", \"steel\"]",
        )],
        &["material", "[material.steel]", "default"],
    );
    refused(
        &[("material = \"default\"", "material = 3")],
        &["material", "list of two"],
    );
    refused(
        &[(
            "face_width = 0.025",
            "face_width = 0.025\nrack_pressure_angle = 20.0",
        )],
        &["rack_pressure_angle", "between 0 and pi/2", "20"],
    );
    refused(
        &[("material = \"default\"", "mean = 4e8")],
        &["mean", "unknown key", "profile_shift"],
    );
}

#[test]
fn teeth_that_do_not_fit_are_refused_with_what_to_change() {
    refused(
        &[
            (
                "damping_ratio = 0.05",
                "damping_ratio = 0.05\ninternal = true",
            ),
            ("speed = -102.0", "speed = 102.0"),
        ],
        &["law", "external gears only", "tooth_pair"],
    );
    // The rack makes another base circle than the gear has.
    refused(
        &[(
            "teeth = 43\nmodule = 0.003\npressure_angle = 0.3490658503988659",
            "teeth = 43\nbase_radius = 0.06",
        )],
        &[
            "module",
            "43 teeth",
            "0.0606",
            "\"wheel_shaft.wheel\" is 0.06 m",
            "to 0.0029",
        ],
    );
    // 10 teeth are undercut: 1 - 10 sin^2(20) / 1.6 = 0.269. (The speeds follow the teeth.)
    refused(
        &[
            ("teeth = 17", "teeth = 10"),
            ("speed = -102.0", "speed = -60.0"),
            (
                "bore_radius = [0.01, 0.025]",
                "bore_radius = [0.008, 0.025]",
            ),
        ],
        &[
            "profile_shift",
            "10 teeth of \"pinion_shaft.pinion\" are undercut",
            "at least 0.2689",
        ],
    );
    refused(
        &[("profile_shift = [0.0, 0.0]", "profile_shift = [0.3, 0.0]")],
        &[
            "profile_shift",
            "too thick",
            "0.349",
            "at most 0.0000",
            "found 0.3",
        ],
    );
    refused(
        &[
            ("profile_shift = [0.0, 0.0]", "profile_shift = [1.3, -1.3]"),
            ("bore_radius = [0.01, 0.025]", "bore_radius = [0.01, 0.03]"),
        ],
        &[
            "addendum",
            "pinion_shaft.pinion",
            "come to a point",
            "modules thick",
        ],
    );
    refused(
        &[
            ("addendum = [1.0, 1.0]", "addendum = [1.0, 1.2]"),
            ("dedendum = [1.25, 1.25]", "dedendum = [1.6, 1.25]"),
        ],
        &[
            "addendum",
            "wheel_shaft.wheel",
            "cut into",
            "base circle",
            "larger profile_shift",
        ],
    );
    refused(
        &[("dedendum = [1.25, 1.25]", "dedendum = [0.95, 1.25]")],
        &[
            "dedendum",
            "tips of \"wheel_shaft.wheel\" run into the root of \"pinion_shaft.pinion\"",
            "0.0500 modules",
        ],
    );
    refused(
        &[("addendum = [1.0, 1.0]", "addendum = [0.5, 0.5]")],
        &["addendum", "contact ratio is 0.8", "at least 1"],
    );
    refused(
        &[("dedendum = [1.25, 1.25]", "dedendum = [6.0, 1.25]")],
        &["dedendum", "root radius of 0.0075", "reduce"],
    );
    refused(
        &[("bore_radius = [0.01, 0.025]", "bore_radius = [0.01, 0.05]")],
        &[
            "bore_radius",
            "from 0.00867",
            "to 0.0433",
            "wheel_shaft.wheel",
            "0.05 m",
        ],
    );
    refused(
        &[
            ("bore_radius = [0.01, 0.025]\n", ""),
            ("outer_diameter = 0.03", "outer_diameter = 0.045"),
        ],
        &[
            "module",
            "root circle of \"pinion_shaft.pinion\"",
            "0.021750 m",
            "inside its shaft",
            "0.0225 m",
        ],
    );
}

/// The model with other teeth on the pinion, racks and a thinner shaft; angles in degrees.
fn pinion(teeth: u32, lists: [&str; 3], [rack, operating]: [f64; 2]) -> String {
    let ([addendum, dedendum, shift], degree) = (lists, 0.349_065_850_398_865_9 / 20.0);
    let speed = -258.0 * f64::from(teeth) / 43.0;
    let angle = "pressure_angle = 0.3490658503988659";
    changed(&[
        ("teeth = 17", &format!("teeth = {teeth}")),
        ("speed = -102.0", &format!("speed = {speed}")),
        ("[1.0, 1.0]", &format!("[{addendum}]")),
        ("[1.25, 1.25]", &format!("[{dedendum}]")),
        ("[0.0, 0.0]", &format!("[{shift}]")),
        (
            "bore_radius = [0.01, 0.025]",
            &format!("rack_pressure_angle = {}", rack * degree),
        ),
        ("outer_diameter = 0.03", "outer_diameter = 0.01"),
        (angle, &format!("pressure_angle = {}", rack * degree)),
        (angle, &format!("pressure_angle = {}", rack * degree)),
        (angle, &format!("pressure_angle = {}", operating * degree)),
    ])
}

#[test]
fn whatever_passes_the_rules_has_a_positive_and_exact_stiffness() {
    let mut accepted = 0;
    for teeth in [5, 9, 14, 17, 60, 2000] {
        for addendum in ["0.8, 1.0", "1.0, 1.0", "1.3, 1.3", "1e9, 1.0"] {
            for dedendum in ["1.25, 1.25", "1.7, 1.7", "0.01, 1e-9"] {
                for shift in ["0.0, 0.0", "0.5, 0.5", "0.9, -0.9", "-1e6, 1e6"] {
                    for angles in [[15.0, 18.0], [20.0, 20.0], [20.0, 24.0], [28.0, 30.0]] {
                        let text = pinion(teeth, [addendum, dedendum, shift], angles);
                        let Ok(loaded) = load(&text) else { continue };
                        accepted += 1;
                        check_law(&loaded.train.meshes[0].stiffness);
                    }
                }
            }
        }
    }
    assert!(accepted > 30, "{accepted} of 1152");
}

/// The law is positive and the sum of the integrals over the engaged pairs.
fn check_law(law: &StiffnessLaw) {
    let pair = law.spur_pair().unwrap();
    assert!(law.mean() > 0.0 && law.mean().is_finite(), "{pair:?}");
    let eps = pair.path_of_contact().contact_ratio();
    for cycle in [0.0, 0.13, 0.26, 0.39, 0.52, 0.65, 0.78, 0.91] {
        let engaged = (0..10).map(|j| cycle + f64::from(j)).filter(|&x| x <= eps);
        let exact: f64 = engaged.map(|x| pair.pair_stiffness(x)).sum();
        let found = law.value(cycle, law.piece(cycle));
        assert!((found / exact - 1.0).abs() < 1e-9, "{pair:?} at {cycle}");
    }
}
