//! The static solution and what supports do to it.
//!
//! Authority: closed form.

mod support;

use geartrain::config::Start;
use geartrain::model::{BaseMotion, Inputs, ModalModel, equilibrium};
use support::{assembled, compound, file_inputs, gear_pair, set_going, star, three_stage, valid};

#[test]
fn static_mesh_force_is_torque_over_base_radius() {
    // equations.md, section 6: two meshes share 2250 N m at a base radius of 0.1074069 m.
    let (text, exact) = (three_stage(), 2250.0 / 2.0 / 0.107_406_9);
    let found = equilibrium(&assembled(&text), &file_inputs(&text)).unwrap();
    for force in found.mesh_forces {
        assert!(
            (force / exact - 1.0).abs() < 1e-9,
            "{force} N, exact {exact} N; rounding"
        );
    }
}

/// The gear pair with rotor two as a ring of 60 teeth around the gear of rotor one.
fn ring_pair(flank: &str) -> String {
    let (before, two) = (
        gear_pair(5, "law = \"constant\"\nmean = 4e8", "internal = true"),
        "name = \"two\"",
    );
    let (one, rest) = before.split_once(two).unwrap();
    let rest = rest
        .replace(
            "teeth = 24\nbase_radius = 0.07",
            "teeth = 60\nbase_radius = 0.175",
        )
        .replace("speed = -150", "speed = 60")
        .replace("value = 400", "value = -1000")
        .replace("flank = 1", flank);
    format!("{one}{two}{rest}")
}

#[test]
fn the_static_force_in_a_ring_is_torque_over_base_radius() {
    // Both flanks: T_a / R_a = 400 N m / 0.07 m, and the ring takes 1000 N m at 0.175 m.
    for (flank, sign) in [("flank = 1", 1.0), ("flank = -1", -1.0)] {
        let text = ring_pair(flank);
        let found = equilibrium(&assembled(&text), &file_inputs(&text)).unwrap();
        let exact = sign * 400.0 / 0.07;
        assert!(
            (found.mesh_forces[0] / exact - 1.0).abs() < 1e-9,
            "{found:?}; rounding"
        );
        let [on_a, on_b] = valid(&text).train.meshes[0].line.loads(exact);
        assert!((on_a.torque + 400.0).abs() < 1e-9 && (on_b.torque - 1000.0).abs() < 1e-9);
    }
}

#[test]
fn planets_share_the_torque_of_the_sun_and_pass_it_to_the_ring() {
    // Two planets opposite each other: F = T / (2 R_sun) in every mesh, tooth forces pass through an idler unchanged.
    let text = star();
    let loaded = valid(&text);
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let found = equilibrium(&assembled(&text), &file_inputs(&text)).unwrap();
    let exact = 300.0 / (2.0 * 0.04);
    for force in found.mesh_forces {
        assert!(
            (force / exact - 1.0).abs() < 1e-9,
            "{force} N, exact {exact} N; rounding"
        );
    }
}

#[test]
fn a_compound_shaft_passes_its_torque_from_gear_to_gear() {
    // 120 N m at 0.04 m; 120 x 50/20 = 300 N m on the middle shaft, at 0.045 m on its small gear.
    let text = compound();
    let found = equilibrium(&assembled(&text), &file_inputs(&text)).unwrap();
    for (force, exact) in found.mesh_forces.iter().zip([120.0 / 0.04, 300.0 / 0.045]) {
        assert!(
            (force / exact - 1.0).abs() < 1e-9,
            "{force} N, exact {exact} N; rounding"
        );
    }
}

#[test]
fn a_long_chain_of_idlers_carries_one_force() {
    // Twelve equal gears in a row: the torque of the first and that of the last balance, T / R in every mesh.
    let text = gear_pair(3, "law = \"constant\"\nmean = 4e8", "");
    let starts: Vec<usize> = text.match_indices("[[rotor]]").map(|(at, _)| at).collect();
    let (one, two) = (&text[starts[0]..starts[1]], &text[starts[1]..]);
    let (two, mesh) = two.split_at(two.find("[[mesh]]").unwrap());
    let idler = one.replace("value = 400", "value = 0");
    let mut chain = text[..starts[0]].to_string() + one;
    for index in 1..11 {
        let speed = if index % 2 == 1 {
            "speed = -150"
        } else {
            "speed = 150"
        };
        let name = format!("name = \"idler{index}\"");
        chain += &idler
            .replace("name = \"one\"", &name)
            .replace("speed = 150", speed);
    }
    chain += two; // the twelfth turns backwards like the second
    let name = |index: usize| match index {
        0 => "one".to_string(),
        11 => "two".to_string(),
        _ => format!("idler{index}"),
    };
    for index in 0..11 {
        let (gears, flank) = (
            format!("\"{}.gear\", \"{}.gear\"", name(index), name(index + 1)),
            if index % 2 == 0 {
                "flank = 1\n"
            } else {
                "flank = -1\n"
            },
        );
        chain += &mesh
            .replace("\"mesh\"", &format!("\"mesh{index}\""))
            .replace("\"one.gear\", \"two.gear\"", &gears)
            .replace("flank = 1\n", flank);
    }
    let found = equilibrium(&assembled(&chain), &file_inputs(&chain)).unwrap();
    assert_eq!(found.mesh_forces.len(), 11);
    for force in found.mesh_forces {
        assert!(
            (force / (400.0 / 0.07) - 1.0).abs() < 1e-9,
            "{force} N; rounding"
        );
    }
}

#[test]
fn equilibrium_stays_where_it_is_when_nothing_excites() {
    let text = gear_pair(5, "law = \"constant\"\nmean = 4e8", "damping_ratio = 0.05")
        .replace("moment = 2e-4", "moment = 0.0");
    let mut simulation = support::started(&text, 1e-6);
    let before = simulation.motion().mesh_force(0);
    simulation.advance_to(0.05).unwrap();
    let after = simulation.motion().mesh_force(0);
    assert!(
        (after / before - 1.0).abs() < 1e-9,
        "{before} N -> {after} N; rounding over 1e4 steps"
    );
}

/// The gear pair with every mode its finite elements have: two per station and plane, one in torsion.
fn all_modes() -> String {
    gear_pair(1, "law = \"constant\"\nmean = 4e8", "")
        .replace("lateral_modes = 1", "lateral_modes = 18")
        .replace("torsional_modes = 1", "torsional_modes = 9")
}

#[test]
fn a_uniform_shift_of_all_supports_gives_no_force() {
    let text = all_modes();
    let model = assembled(&text);
    let shift = BaseMotion {
        displacement: [3e-4, -2e-4],
        velocity: [0.0; 2],
    };
    let inputs = Inputs::new(&[0.0; 2], &vec![shift; model.bearings().count()], &[]);
    let simulation = set_going(model, inputs, Start::Equilibrium, 1e-4);
    let motion = simulation.motion();
    // 1e-9 of the force of one bearing held against the shift.
    let scale = 9e7 * 3e-4;
    assert!(
        motion.mesh_force(0).abs() < 1e-9 * scale,
        "{} N",
        motion.mesh_force(0)
    );
    let rotors = motion.model.rotors.iter().enumerate();
    let bearings =
        rotors.flat_map(|(index, rotor)| rotor.bearings.iter().map(move |one| (index, one)));
    for (input, (rotor, bearing)) in bearings.enumerate() {
        let force = motion.bearing_force(rotor, bearing, input);
        assert!(
            force.iter().all(|component| component.abs() < 1e-9 * scale),
            "{force:?} N"
        );
    }
}

#[test]
fn all_forces_on_a_rotor_at_rest_balance() {
    let text = three_stage();
    let simulation = set_going(
        assembled(&text),
        file_inputs(&text),
        Start::Equilibrium,
        1e-4,
    );
    let motion = simulation.motion();
    // With the full set of modes the sum over the bearings is the mesh force; with three modes only the
    // torque balance is exact: load torque + mesh torque = 0 on stages 2 and 3 at the mean stiffness.
    for mesh in 0..2 {
        let ratio = motion.model.meshes[mesh].mean_stiffness() / motion.mesh_stiffness(mesh);
        let [_, on_b] = motion.mesh_loads(mesh);
        assert!(
            (on_b.torque * ratio + 1125.0).abs() < 1125.0 * 1e-9,
            "{} N m",
            on_b.torque * ratio
        );
    }
}

#[test]
fn torsional_basis_supports_change_the_basis_and_not_the_static_forces() {
    // 10 474 N again, and rotations of the size of the twist, 1e-3 rad, not of a mechanism.
    let exact = 2250.0 / 2.0 / 0.107_406_9;
    for (torsional, modes) in [("1e3", 3), ("1e3", 12), ("1e6", 12)] {
        let text = three_stage()
            .replace("torsional = 0.0", &format!("torsional = {torsional}"))
            .replace("torsional_modes = 3", &format!("torsional_modes = {modes}"));
        let model = assembled(&text);
        let found = equilibrium(&model, &file_inputs(&text)).unwrap();
        for force in found.mesh_forces {
            // 1e-3: three modes of a supported shaft represent the rigid rotation no better.
            assert!(
                (force / exact - 1.0).abs() < 1e-3,
                "{torsional}, {modes}: {force} N"
            );
        }
        let theta = model.rotors[0].gears[0].theta.dot(&found.position);
        assert!(theta.abs() < 1e-2, "{torsional}, {modes}: {theta} rad");
    }
}

#[test]
fn unbalanced_torque_is_carried_by_rigid_acceleration() {
    let text = gear_pair(4, "law = \"constant\"\nmean = 4e8", "");
    let model = assembled(&text);
    // Only rotor one is driven: both gears and shafts accelerate, the mesh passes on the share of rotor
    // two: T R_b J_b' / (R_a (J_a + J_b i^2)) = T / 2 R for equal rotors.
    let inputs = Inputs::new(&[400.0, 0.0], &[BaseMotion::default(); 4], &[]);
    let found = equilibrium(&model, &inputs).unwrap();
    assert!(
        (found.mesh_forces[0] / (400.0 / 2.0 / 0.07) - 1.0).abs() < 1e-9,
        "{:?}",
        found.mesh_forces
    );
    // No mean rotation: equal shafts turn against each other, theta_one = theta_two at the gears.
    let theta = |rotor: usize| {
        let rotor = &model.rotors[rotor];
        let rigid = rotor.torsional.range().start;
        found.position[rigid] * rotor.gears[0].theta.entry(rigid)
    };
    assert!(
        (theta(0) / theta(1) - 1.0).abs() < 1e-9,
        "{} and {}",
        theta(0),
        theta(1)
    );
}

#[test]
fn a_full_set_of_modes_equals_the_finite_element_model() {
    // Static deflection under a support shift of one bearing: with all modes the basis support must not
    // matter at all, which is only so when nothing is lost in the projection.
    let plain = all_modes();
    let supported = plain.replacen(
        "[[rotor.torque]]",
        "[[rotor.basis_support]]\nposition = 0.25\nlateral = 5e7\ntorsional = 0.0\n[[rotor.torque]]",
        1,
    );
    let one_more = plain.replace("lateral_modes = 18", "lateral_modes = 19");
    assert!(
        ModalModel::assemble(&valid(&one_more).train, None).is_err(),
        "18 are all there are"
    );
    let force = |text: &str| {
        let mut inputs = file_inputs(text);
        inputs.bases_mut()[0] = [1e-4, 0.0, 0.0, 0.0];
        equilibrium(&assembled(text), &inputs).unwrap().mesh_forces[0]
    };
    let (one, two) = (force(&plain), force(&supported));
    assert!((one / two - 1.0).abs() < 1e-9, "{one} N against {two} N");
}
