//! From the text of a model file to a [`Config`]: which keys exist, their types and defaults.

use super::document::{Document, Lines, Table};
use super::{
    BaseCircle, Basis, BasisSupport, Bearing, Config, Disk, Flank, Gear, GearboxVibration,
    Material, Mesh, MeshDamping, MeshStiffness, Planar, Probe, Problem, Rotor, Segment, Simulation,
    Start, Torque, TorqueCoupling, Unbalance,
};

/// What a model file says, and what is wrong with it.
#[derive(Debug)]
pub struct Reading {
    /// Everything that could be read, with placeholders (NaN, empty) where there are problems; `None`
    /// when the text is not TOML.
    pub config: Option<Config>,
    /// Syntax errors, missing keys, wrong types, unknown keys.
    pub problems: Vec<Problem>,
    /// Where every key stands.
    pub lines: Lines,
}

/// Reads the text of a model file.
pub fn read(text: &str) -> Reading {
    let document = Document::new(text);
    let parsed = document.parse();
    let config = parsed
        .as_ref()
        .map(|entries| top(document.top(entries.get_ref())));
    let (problems, lines) = document.into_findings();
    Reading {
        config,
        problems,
        lines,
    }
}

fn top(table: Table<'_, '_>) -> Config {
    let kinds = [("gear_train", true), ("housing", false)];
    if table.choice("kind", None, &kinds) == Some(false) {
        table.not_yet("kind", "kind = \"housing\"");
    }
    table.not_yet("housing", "an embedded housing");
    let config = Config {
        name: table.string("name"),
        description: table.optional_string("description").unwrap_or_default(),
        simulation: simulation(table.table("simulation")),
        basis: basis(&table),
        materials: table
            .named_tables("material")
            .into_iter()
            .map(material)
            .collect(),
        rotors: table.tables("rotor").into_iter().map(rotor).collect(),
        meshes: table.tables("mesh").into_iter().map(mesh).collect(),
        gearbox_vibration: gearbox_vibration(table.table("gearbox_vibration")),
    };
    table.finish();
    config
}

fn simulation(table: Option<Table<'_, '_>>) -> Simulation {
    let defaults = Simulation {
        start: Start::Equilibrium,
        tolerance: 1e-4,
        stop_time: 1.0,
        step_size: 1e-5,
    };
    let Some(table) = table else { return defaults };
    if table.choice(
        "speed",
        Some(true),
        &[("prescribed", true), ("free", false)],
    ) == Some(false)
    {
        table.not_yet("speed", "free spin");
    }
    if table.choice(
        "solver",
        Some(true),
        &[("newmark", true), ("exponential", false)],
    ) == Some(false)
    {
        table.not_yet("solver", "the exponential solver");
    }
    let starts = [("equilibrium", Start::Equilibrium), ("rest", Start::Rest)];
    let simulation = Simulation {
        start: table
            .choice("start", Some(defaults.start), &starts)
            .unwrap_or(defaults.start),
        tolerance: table.number_or("tolerance", defaults.tolerance),
        stop_time: table.number_or("stop_time", defaults.stop_time),
        step_size: table.number_or("step_size", defaults.step_size),
    };
    table.finish();
    simulation
}

fn basis(top: &Table<'_, '_>) -> Basis {
    let Some(table) = top.table("basis") else {
        top.problem(
            "basis",
            "missing; the default basis with static shapes is not available yet: give lateral_modes \
             and torsional_modes, or max_frequency",
        );
        return Basis::MaxFrequency(f64::NAN);
    };
    if table.boolean_or("static_shapes", false) {
        table.not_yet("static_shapes", "static_shapes = true");
    }
    let basis = if let Some(frequency) = table.optional_number("max_frequency") {
        for key in ["lateral_modes", "torsional_modes"] {
            if table.has(key) {
                table.problem(key, "contradicts max_frequency; give one or the other");
            }
        }
        Basis::MaxFrequency(frequency)
    } else {
        Basis::Counts {
            lateral_modes: table.count("lateral_modes"),
            torsional_modes: table.count("torsional_modes"),
        }
    };
    table.finish();
    basis
}

fn material((name, table): (String, Table<'_, '_>)) -> (String, Material) {
    let material = Material {
        youngs_modulus: table.number("youngs_modulus"),
        poisson_ratio: table.number("poisson_ratio"),
        density: table.number("density"),
    };
    table.finish();
    (name, material)
}

fn rotor(table: Table<'_, '_>) -> Rotor {
    table.not_yet("bow", "residual bow");
    let rotor = Rotor {
        name: table.string("name"),
        speed: table.number("speed"),
        angle: table.number_or("angle", 0.0),
        max_element_length: table.optional_number("max_element_length"),
        lateral_damping_ratio: table.number_or("lateral_damping_ratio", 0.0),
        torsional_damping_ratio: table.number_or("torsional_damping_ratio", 0.0),
        segments: each(&table, "segment", segment),
        disks: each(&table, "disk", disk),
        gears: each(&table, "gear", gear),
        bearings: each(&table, "bearing", bearing),
        unbalances: each(&table, "unbalance", unbalance),
        torques: each(&table, "torque", torque),
        basis_supports: each(&table, "basis_support", basis_support),
        probes: each(&table, "probe", probe),
    };
    table.finish();
    rotor
}

/// Reads every table `[[key]]` with `item` and closes it.
fn each<T>(table: &Table<'_, '_>, key: &'static str, item: fn(&Table<'_, '_>) -> T) -> Vec<T> {
    let read_one = |inner: Table<'_, '_>| {
        let value = item(&inner);
        inner.finish();
        value
    };
    table.tables(key).into_iter().map(read_one).collect()
}

fn segment(table: &Table<'_, '_>) -> Segment {
    Segment {
        length: table.number("length"),
        outer_diameter: table.number("outer_diameter"),
        inner_diameter: table.number_or("inner_diameter", 0.0),
        material: table
            .optional_string("material")
            .unwrap_or_else(|| "default".to_string()),
    }
}

fn disk(table: &Table<'_, '_>) -> Disk {
    Disk {
        position: table.number("position"),
        mass: table.number("mass"),
        polar_inertia: table.number("polar_inertia"),
        diametral_inertia: table.number("diametral_inertia"),
    }
}

fn gear(table: &Table<'_, '_>) -> Gear {
    let teeth = table.count("teeth");
    Gear {
        name: table.string("name"),
        body: disk(table),
        teeth: u32::try_from(teeth).unwrap_or(u32::MAX),
        base: base_circle(table),
    }
}

fn base_circle(table: &Table<'_, '_>) -> BaseCircle {
    let radius = table.optional_number("base_radius");
    let module = table.optional_number("module");
    let pressure_angle = table.optional_number("pressure_angle");
    match (radius, module, pressure_angle) {
        (Some(radius), None, None) => BaseCircle::Radius(radius),
        (None, Some(module), Some(pressure_angle)) => BaseCircle::Rack {
            module,
            pressure_angle,
        },
        (None, None, None) => {
            let message = "missing; give base_radius, or module and pressure_angle";
            table.problem("base_radius", message);
            BaseCircle::Radius(f64::NAN)
        }
        _ => {
            let message = "give either base_radius alone, or module and pressure_angle together";
            table.problem("base_radius", message);
            BaseCircle::Radius(f64::NAN)
        }
    }
}

fn bearing(table: &Table<'_, '_>) -> Bearing {
    Bearing {
        name: table.string("name"),
        position: table.number("position"),
        stiffness: planar(table, "stiffness"),
        damping: planar(table, "damping"),
    }
}

/// yy defaults to xx, cross terms to zero; damping may be absent altogether.
fn planar(bearing: &Table<'_, '_>, key: &'static str) -> Planar {
    let Some(table) = bearing.table(key) else {
        if key == "stiffness" && !bearing.has(key) {
            bearing.problem(key, "missing");
        }
        return Planar {
            xx: 0.0,
            xy: 0.0,
            yx: 0.0,
            yy: 0.0,
        };
    };
    let xx = table.number("xx");
    let planar = Planar {
        xx,
        xy: table.number_or("xy", 0.0),
        yx: table.number_or("yx", 0.0),
        yy: table.number_or("yy", xx),
    };
    table.finish();
    planar
}

fn unbalance(table: &Table<'_, '_>) -> Unbalance {
    Unbalance {
        name: table.string("name"),
        position: table.number("position"),
        moment: table.number("moment"),
        phase: table.number_or("phase", 0.0),
    }
}

fn torque(table: &Table<'_, '_>) -> Torque {
    Torque {
        name: table.string("name"),
        position: table.number("position"),
        value: table.number_or("value", 0.0),
        slope: table.number_or("slope", 0.0),
    }
}

fn basis_support(table: &Table<'_, '_>) -> BasisSupport {
    BasisSupport {
        position: table.number("position"),
        lateral: table.number_or("lateral", 0.0),
        torsional: table.number_or("torsional", 0.0),
    }
}

fn probe(table: &Table<'_, '_>) -> Probe {
    Probe {
        name: table.string("name"),
        position: table.number("position"),
    }
}

fn mesh(table: Table<'_, '_>) -> Mesh {
    if table.boolean_or("internal", false) {
        table.not_yet("internal", "an internal gear (internal = true)");
    }
    if table.choice(
        "contact",
        Some(true),
        &[("bilateral", true), ("unilateral", false)],
    ) == Some(false)
    {
        table.not_yet("contact", "contact = \"unilateral\"");
    }
    if table.number_or("backlash", 0.0) != 0.0 {
        let message = "must be 0 with bilateral contact (unilateral contact is not available yet)";
        table.problem("backlash", message);
    }
    table.not_yet("transmission_error", "transmission error");
    let consistent = TorqueCoupling::Consistent;
    let couplings = [
        ("consistent", consistent),
        ("as_printed", TorqueCoupling::AsPrinted),
    ];
    let mesh = Mesh {
        name: table.string("name"),
        gears: table.pair_of_strings("gears"),
        center_angle: table.number("center_angle"),
        pressure_angle: table.number("pressure_angle"),
        flank: flank(&table),
        phase: table.optional_number("phase"),
        damping: mesh_damping(&table),
        torque_coupling: table
            .choice("torque_coupling", Some(consistent), &couplings)
            .unwrap_or(consistent),
        stiffness: mesh_stiffness(&table),
        stiffness_factor: 1.0,
    };
    table.finish();
    mesh
}

fn flank(table: &Table<'_, '_>) -> Flank {
    match table.number_or("flank", 1.0) {
        1.0 => Flank::Positive,
        -1.0 => Flank::Negative,
        other => {
            if other.is_finite() {
                table.problem("flank", format!("must be +1 or -1, found {other}"));
            }
            Flank::Positive
        }
    }
}

fn mesh_damping(table: &Table<'_, '_>) -> MeshDamping {
    match (
        table.optional_number("damping_ratio"),
        table.optional_number("damping"),
    ) {
        (Some(_), Some(_)) => {
            let message = "contradicts damping_ratio; give one or the other";
            table.problem("damping", message);
            MeshDamping::Ratio(0.0)
        }
        (Some(ratio), None) => MeshDamping::Ratio(ratio),
        (None, Some(coefficient)) => MeshDamping::Coefficient(coefficient),
        (None, None) => MeshDamping::Ratio(0.0),
    }
}

fn mesh_stiffness(mesh: &Table<'_, '_>) -> MeshStiffness {
    let placeholder = MeshStiffness::Constant { mean: 1.0 };
    let Some(table) = mesh.table("stiffness") else {
        if !mesh.has("stiffness") {
            mesh.problem("stiffness", "missing; write a table [mesh.stiffness]");
        }
        return placeholder;
    };
    type ReadLaw = fn(&Table<'_, '_>) -> MeshStiffness;
    let laws: [(&str, ReadLaw); 5] = [
        ("constant", |table| MeshStiffness::Constant {
            mean: table.number("mean"),
        }),
        ("rectangular", rectangular),
        ("tooth_pair", tooth_pair),
        ("fourier", not_yet_a_law),
        ("table", not_yet_a_law),
    ];
    // Without a law nobody can say which keys are known: the table is not finished.
    let Some(read_law) = table.choice("law", None, &laws) else {
        return placeholder;
    };
    let stiffness = read_law(&table);
    table.finish();
    stiffness
}

fn rectangular(table: &Table<'_, '_>) -> MeshStiffness {
    let contact_ratio = table.number("contact_ratio");
    let pair = table.optional_number("pair");
    let single = table.optional_number("single");
    let double = table.optional_number("double");
    match (pair, single, double) {
        (Some(pair), None, None) => MeshStiffness::Rectangular {
            fewer_pairs: contact_ratio.floor() * pair,
            more_pairs: (contact_ratio.floor() + 1.0) * pair,
            contact_ratio,
        },
        (None, Some(single), Some(double)) => {
            if contact_ratio >= 2.0 {
                let rule = "with single and double must be in [1, 2)";
                table.problem("contact_ratio", format!("{rule}, found {contact_ratio}"));
            }
            MeshStiffness::Rectangular {
                fewer_pairs: single,
                more_pairs: double,
                contact_ratio,
            }
        }
        _ => {
            let message = "missing or ambiguous; give either pair alone, or single and double";
            table.problem("pair", message);
            MeshStiffness::Constant { mean: 1.0 }
        }
    }
}

fn tooth_pair(table: &Table<'_, '_>) -> MeshStiffness {
    MeshStiffness::ToothPair {
        pair: table.number("pair"),
        quadratic: table.number_or("quadratic", 0.0),
        quartic: table.number_or("quartic", 0.0),
        ramp: table.number_or("ramp", 0.0),
        contact_ratio: table.number("contact_ratio"),
    }
}

fn not_yet_a_law(table: &Table<'_, '_>) -> MeshStiffness {
    for key in ["mean", "cosine", "sine", "phase", "value"] {
        table.has(key);
    }
    table.not_yet("law", "this law");
    MeshStiffness::Constant { mean: 1.0 }
}

fn gearbox_vibration(table: Option<Table<'_, '_>>) -> GearboxVibration {
    let Some(table) = table else {
        return GearboxVibration {
            amplitude_x: 0.0,
            amplitude_y: 0.0,
            phase_y: 0.0,
            frequency: 0.0,
        };
    };
    let vibration = GearboxVibration {
        amplitude_x: table.number_or("amplitude_x", 0.0),
        amplitude_y: table.number_or("amplitude_y", 0.0),
        phase_y: table.number_or("phase_y", 0.0),
        frequency: table.number("frequency"),
    };
    table.finish();
    vibration
}
