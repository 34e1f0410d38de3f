//! What every key changes.

/// How to change a key, and what that changes.
pub struct Row {
    pub table: &'static str,
    pub key: &'static str,
    /// Makes the key a part of the model first.
    pub base: &'static [(&'static str, &'static str)],
    /// Changes the key.
    pub edits: &'static [(&'static str, &'static str)],
    /// Among the variables whose names contain this, some change.
    pub changes: &'static [&'static str],
    /// Variables whose names contain this stay to the bit, as long as there are any.
    pub keeps: &'static [&'static str],
}

type Edits = &'static [(&'static str, &'static str)];

const PLAIN: Edits = &[];
const FREE: Edits = &[
    ("\"refuse\"", "\"hold\""),
    (
        "\n[[rotor.basis_support]]\nposition = 0.142\nlateral = 2.2e5\ntorsional = 330.0\n",
        "",
    ),
];
const BYFREQ: Edits = &[(
    "lateral_modes = 4\ntorsional_modes = 3",
    "max_frequency = 6000.0",
)];
const RACK: Edits = &[(
    "base_radius = 0.0338",
    "module = 0.003\npressure_angle = 0.35",
)];
const CLEAR: Edits = &[(
    "law = \"hertz\"\ncoefficient = 1.51e10\nexponent = 1.45",
    "law = \"clearance\"\nstiffness = 1.53e8",
)];
const CUBIC: Edits = &[(
    "law = \"hertz\"\ncoefficient = 1.51e10\nexponent = 1.45",
    "law = \"cubic\"\ncoefficient = 1.51e16",
)];
const DAMPING: Edits = &[("damping_ratio = 0.052", "damping = 800.0")];
const REVERSED: Edits = &[
    ("value = 61.0", "value = -61.0"),
    ("value = 91.5", "value = -91.5"),
];
const BILATERAL: Edits = &[(
    "contact = \"unilateral\"\nbacklash = 3.1e-5",
    "contact = \"bilateral\"",
)];
const CONST: Edits = &[(
    "law = \"tooth_pair\"\npair = 2.01e8\nquadratic = 0.33\nquartic = 0.11\nramp = 0.21\ncontact_ratio = 1.62",
    "law = \"constant\"\nmean = 3.01e8",
)];
const RECT: Edits = &[(
    "law = \"tooth_pair\"\npair = 2.01e8\nquadratic = 0.33\nquartic = 0.11\nramp = 0.21\ncontact_ratio = 1.62",
    "law = \"rectangular\"\npair = 2.02e8\ncontact_ratio = 1.63",
)];
const SINGLE: Edits = &[(
    "law = \"tooth_pair\"\npair = 2.01e8\nquadratic = 0.33\nquartic = 0.11\nramp = 0.21\ncontact_ratio = 1.62",
    "law = \"rectangular\"\nsingle = 2.03e8\ndouble = 3.53e8\ncontact_ratio = 1.63",
)];
const FOURIER: Edits = &[(
    "law = \"tooth_pair\"\npair = 2.01e8\nquadratic = 0.33\nquartic = 0.11\nramp = 0.21\ncontact_ratio = 1.62",
    "law = \"fourier\"\nmean = 3.02e8\ncosine = [0.15, 0.05]\nsine = [0.07]",
)];
const TABLE: Edits = &[(
    "law = \"tooth_pair\"\npair = 2.01e8\nquadratic = 0.33\nquartic = 0.11\nramp = 0.21\ncontact_ratio = 1.62",
    "law = \"table\"\nphase = [0.0, 0.45]\nvalue = [2.5e8, 3.5e8]",
)];
const GEOMETRY: Edits = &[
    (
        "law = \"tooth_pair\"\npair = 2.01e8\nquadratic = 0.33\nquartic = 0.11\nramp = 0.21\ncontact_ratio = 1.62",
        "law = \"tooth_geometry\"\nmodule = 0.003\nface_width = 0.021\nrack_pressure_angle = 0.35\naddendum = [1.0, 1.0]\ndedendum = [1.25, 1.25]\nprofile_shift = [0.0, 0.0]\nbore_radius = [0.015, 0.02]\nmaterial = \"other\"",
    ),
    (
        "base_radius = 0.0338",
        "module = 0.003\npressure_angle = 0.35",
    ),
    (
        "base_radius = 0.0507",
        "module = 0.003\npressure_angle = 0.35",
    ),
];

const fn row(
    place: [&'static str; 2],
    base: Edits,
    edits: Edits,
    changes: &'static [&'static str],
    keeps: &'static [&'static str],
) -> Row {
    Row {
        table: place[0],
        key: place[1],
        base,
        edits,
        changes,
        keeps,
    }
}

/// Every kind of table, a model that has one, and its header there.
#[rustfmt::skip]
pub const TABLES: &[(&str, Edits, &str)] = &[
    ("top", PLAIN, "kind = \"gear_train\""),
    ("simulation", PLAIN, "[simulation]"),
    ("basis", PLAIN, "[basis]"),
    ("material", PLAIN, "[material.default]"),
    ("rotor", PLAIN, "[[rotor]]"),
    ("rotor.segment", PLAIN, "[[rotor.segment]]"),
    ("rotor.disk", PLAIN, "[[rotor.disk]]"),
    ("rotor.gear", PLAIN, "[[rotor.gear]]"),
    ("rotor.bearing", PLAIN, "[[rotor.bearing]]"),
    ("rotor.bearing.at_speed", PLAIN, "[[rotor.bearing.at_speed]]"),
    ("rotor.bearing.nonlinear hertz", PLAIN, "[rotor.bearing.nonlinear]"),
    ("rotor.bearing.nonlinear clearance", CLEAR, "[rotor.bearing.nonlinear]"),
    ("rotor.bearing.nonlinear cubic", CUBIC, "[rotor.bearing.nonlinear]"),
    ("rotor.unbalance", PLAIN, "[[rotor.unbalance]]"),
    ("rotor.bow", PLAIN, "[[rotor.bow]]"),
    ("rotor.torque", PLAIN, "[[rotor.torque]]"),
    ("rotor.basis_support", PLAIN, "[[rotor.basis_support]]"),
    ("rotor.probe", PLAIN, "[[rotor.probe]]"),
    ("mesh", PLAIN, "[[mesh]]"),
    ("mesh.stiffness tooth_pair", PLAIN, "[mesh.stiffness]"),
    ("mesh.stiffness constant", CONST, "[mesh.stiffness]"),
    ("mesh.stiffness rectangular", RECT, "[mesh.stiffness]"),
    ("mesh.stiffness fourier", FOURIER, "[mesh.stiffness]"),
    ("mesh.stiffness table", TABLE, "[mesh.stiffness]"),
    ("mesh.stiffness tooth_geometry", GEOMETRY, "[mesh.stiffness]"),
    ("mesh.transmission_error", PLAIN, "[[mesh.transmission_error]]"),
    ("gearbox_vibration", PLAIN, "[gearbox_vibration]"),
    ("rotor.bearing.stiffness", PLAIN, "stiffness = {"),
    ("rotor.bearing.damping", PLAIN, "damping = {"),
];

/// One row a line: a table is read across.
#[rustfmt::skip]
pub const ROWS: &[Row] = &[
    row(["top", "name"], PLAIN, &[("name = \"everything\"", "name = \"other\"")], &[], &[""]),
    row(["top", "description"], PLAIN, &[("\"One of everything\"", "\"Other words\"")], &[], &[""]),
    row(["simulation", "speed"], FREE, &[("speed = \"prescribed\"", "speed = \"free\"")], &["one.speed", "mesh.force"], &["frequency["]),
    row(["simulation", "solver"], PLAIN, &[("\"exponential\"", "\"newmark\"")], &[], &["one.angle", "one.speed", "frequency["]),
    row(["simulation", "start"], PLAIN, &[("\"equilibrium\"", "\"rest\"")], &["mesh.force", "one.left.force_x"], &["frequency["]),
    row(["simulation", "tolerance"], PLAIN, &[("1.1e-5", "1e-3")], &["simulation.tolerance"], &["frequency["]),
    row(["simulation", "input_extrapolation"], PLAIN, &[("stop_time = 0.5", "stop_time = 0.5\ninput_extrapolation = true")], &["input_extrapolation"], &["force", "frequency["]),
    row(["simulation", "stop_time"], PLAIN, &[("stop_time = 0.5", "stop_time = 0.6")], &[], &[""]),
    row(["simulation", "step_size"], PLAIN, &[("1.2e-5", "1.3e-5")], &[], &[""]),
    row(["basis", "lateral_modes"], PLAIN, &[("lateral_modes = 4", "lateral_modes = 5")], &["one.lateral_frequency[5]", "mesh.force"], &["torsional_frequency"]),
    row(["basis", "torsional_modes"], PLAIN, &[("torsional_modes = 3", "torsional_modes = 4")], &["one.torsional_frequency[4]", "mesh.force"], &["lateral_frequency"]),
    row(["basis", "static_shapes"], PLAIN, &[("static_shapes = true", "static_shapes = false")], &["mesh.force", "one.end.x"], &["frequency["]),
    row(["basis", "max_frequency"], BYFREQ, &[("max_frequency = 6000.0", "max_frequency = 9000.0")], &["mesh.force"], &["one.lateral_frequency[1]"]),
    row(["material", "youngs_modulus"], PLAIN, &[("2.1e11", "2.2e11")], &["one.lateral_frequency[1]", "two.lateral_frequency[1]", "two.torsional_frequency[1]", "mesh.force"], &[]),
    row(["material", "poisson_ratio"], PLAIN, &[("= 0.3\n", "= 0.29\n")], &["two.lateral_frequency[4]", "two.torsional_frequency[1]"], &[]),
    row(["material", "density"], PLAIN, &[("7850.0", "7950.0")], &["one.lateral_frequency[1]", "two.torsional_frequency[1]"], &[]),
    row(["rotor", "name"], PLAIN, &[("name = \"one\"", "name = \"first\""), ("[\"one.pinion\"", "[\"first.pinion\"")], &["first.speed"], &["mesh.", "two."]),
    row(["rotor", "speed"], PLAIN, &[("speed = -120.0", "speed = -120.00006")], &["two.angle"], &["one.angle", "frequency["]),
    row(["rotor", "angle"], PLAIN, &[("angle = 0.25", "angle = 0.3")], &["one.angle", "mesh.stiffness", "mesh.force"], &["two.angle", "frequency["]),
    row(["rotor", "max_element_length"], PLAIN, &[("0.031", "0.017")], &["one.lateral_frequency[4]", "mesh.force"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor", "lateral_damping_ratio"], PLAIN, &[("0.011", "0.03")], &["mesh.force", "one.end.x"], &["frequency["]),
    row(["rotor", "torsional_damping_ratio"], PLAIN, &[("0.012", "0.04")], &["mesh.force", "one.end.theta"], &["frequency["]),
    row(["rotor.segment", "length"], PLAIN, &[("0.21\n", "0.22\n")], &["one.lateral_frequency[1]", "one.torsional_frequency[1]", "mesh.force"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.segment", "outer_diameter"], PLAIN, &[("0.041", "0.042")], &["one.lateral_frequency[1]", "one.torsional_frequency[1]", "mesh.force"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.segment", "inner_diameter"], PLAIN, &[("0.013", "0.014")], &["one.lateral_frequency[1]", "one.torsional_frequency[1]", "mesh.force"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.segment", "material"], PLAIN, &[("material = \"other\"", "material = \"default\"")], &["one.lateral_frequency[1]", "one.torsional_frequency[1]", "mesh.force"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.disk", "position"], PLAIN, &[("0.32", "0.325")], &["one.lateral_frequency[1]", "one.torsional_frequency[1]"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.disk", "mass"], PLAIN, &[("1.7\n", "1.8\n")], &["one.lateral_frequency[1]", "mesh.force"], &["two.lateral_frequency", "two.torsional_frequency", "one.torsional_frequency"]),
    row(["rotor.disk", "polar_inertia"], PLAIN, &[("0.0031", "0.0032")], &["one.torsional_frequency[1]", "mesh.force"], &["two.lateral_frequency", "two.torsional_frequency", "one.lateral_frequency"]),
    row(["rotor.disk", "diametral_inertia"], PLAIN, &[("0.0017", "0.0018")], &["one.lateral_frequency[2]"], &["two.lateral_frequency", "two.torsional_frequency", "one.torsional_frequency"]),
    row(["rotor.gear", "name"], PLAIN, &[("name = \"pinion\"", "name = \"g\""), ("[\"one.pinion\"", "[\"one.g\"")], &["one.g.x"], &["mesh.", "two."]),
    row(["rotor.gear", "position"], PLAIN, &[("0.14\n", "0.145\n")], &["one.lateral_frequency[2]", "mesh.force"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.gear", "teeth"], PLAIN, &[("teeth = 24", "teeth = 48"), ("teeth = 36", "teeth = 72")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["rotor.gear", "base_radius"], PLAIN, &[("0.0338", "0.0339")], &["mesh.force", "one.pinion.mesh_torque"], &["frequency["]),
    row(["rotor.gear", "mass"], PLAIN, &[("1.3\n", "1.4\n")], &["one.lateral_frequency[1]"], &["two.lateral_frequency", "two.torsional_frequency", "one.torsional_frequency"]),
    row(["rotor.gear", "polar_inertia"], PLAIN, &[("0.0009", "0.00095")], &["one.torsional_frequency[1]", "mesh.force"], &["two.lateral_frequency", "two.torsional_frequency", "one.lateral_frequency"]),
    row(["rotor.gear", "diametral_inertia"], PLAIN, &[("0.0005\n", "0.0006\n")], &["one.lateral_frequency[2]"], &["two.lateral_frequency", "two.torsional_frequency", "one.torsional_frequency"]),
    row(["rotor.gear", "module"], RACK, &[("module = 0.003", "module = 0.0031")], &["mesh.force"], &["frequency["]),
    row(["rotor.gear", "pressure_angle"], RACK, &[("pressure_angle = 0.35\n", "pressure_angle = 0.36\n")], &["mesh.force"], &["frequency["]),
    row(["rotor.bearing", "name"], PLAIN, &[("name = \"left\"", "name = \"l\"")], &["one.l.force_x"], &["mesh.", "two."]),
    row(["rotor.bearing", "position"], PLAIN, &[("0.02\n", "0.025\n")], &["one.lateral_frequency[1]", "one.left.x", "mesh.force"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing", "stiffness"], PLAIN, &[("6.1e7", "6.2e7")], &["one.lateral_frequency[1]", "one.left.x"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing", "damping"], PLAIN, &[("710.0", "720.0")], &["one.left.force_x", "mesh.force"], &["frequency["]),
    row(["rotor.bearing", "outside_speeds"], PLAIN, &[("\"refuse\"", "\"hold\"")], &[], &[""]),
    row(["rotor.bearing", "at_speed"], PLAIN, &[("302.0", "202.0")], &["one.lateral_frequency[1]", "mesh.force"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing", "nonlinear"], PLAIN, &[("\n[rotor.bearing.nonlinear]\nlaw = \"hertz\"\ncoefficient = 1.51e10\nexponent = 1.45\nclearance = 1.5e-7\n", "")], &["one.left.x", "mesh.force"], &["frequency["]),
    row(["rotor.bearing.stiffness", "xx"], PLAIN, &[("xx = 6.1e7", "xx = 6.3e7")], &["one.left.force_x", "one.left.stiffness.xx"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing.stiffness", "yy"], PLAIN, &[("yy = 5.2e7", "yy = 5.1e7")], &["one.left.force_y", "one.left.stiffness.yy"], &["frequency[", "two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing.stiffness", "xy"], PLAIN, &[("xy = 1.3e6", "xy = 1.5e6")], &["one.left.force_x", "one.left.stiffness.xy"], &["frequency[", "two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing.stiffness", "yx"], PLAIN, &[("yx = -1.4e6", "yx = -1.2e6")], &["one.left.force_y", "one.left.stiffness.yx"], &["frequency[", "two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing.damping", "xx"], PLAIN, &[("xx = 710.0", "xx = 715.0")], &["one.left.force_x", "one.left.damping.xx"], &["frequency[", "two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing.damping", "yy"], PLAIN, &[("yy = 620.0", "yy = 630.0")], &["one.left.force_y", "one.left.damping.yy"], &["frequency[", "two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing.damping", "xy"], PLAIN, &[("xy = 53.0", "xy = 57.0")], &["one.left.force_x", "one.left.damping.xy"], &["frequency[", "two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing.damping", "yx"], PLAIN, &[("yx = -44.0", "yx = -49.0")], &["one.left.force_y", "one.left.damping.yx"], &["frequency[", "two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing.at_speed", "speed"], PLAIN, &[("101.0", "131.0")], &["one.lateral_frequency[1]", "mesh.force"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing.at_speed", "stiffness"], PLAIN, &[("5.5e7", "5.6e7")], &["one.lateral_frequency[1]", "one.right.x"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing.at_speed", "damping"], PLAIN, &[("730.0", "760.0")], &["one.right.force_x"], &["frequency["]),
    row(["rotor.bearing.nonlinear clearance", "law"], CLEAR, &[("law = \"clearance\"\nstiffness = 1.53e8", "law = \"cubic\"\ncoefficient = 1.53e8")], &["one.left.x", "mesh.force"], &["frequency["]),
    row(["rotor.bearing.nonlinear clearance", "clearance"], CLEAR, &[("1.5e-7", "1.6e-7")], &["one.left.x", "mesh.force"], &["frequency["]),
    row(["rotor.bearing.nonlinear clearance", "stiffness"], CLEAR, &[("1.53e8", "1.6e8")], &["one.left.x"], &["frequency["]),
    row(["rotor.bearing.nonlinear cubic", "law"], CUBIC, &[("law = \"cubic\"\ncoefficient = 1.51e16", "law = \"hertz\"\ncoefficient = 1.51e10")], &["one.left.x", "mesh.force"], &["frequency["]),
    row(["rotor.bearing.nonlinear cubic", "clearance"], CUBIC, &[("1.5e-7", "1.6e-7")], &["one.left.x"], &["frequency["]),
    row(["rotor.bearing.nonlinear cubic", "coefficient"], CUBIC, &[("1.51e16", "1.6e16")], &["one.left.x"], &["frequency["]),
    row(["rotor.bearing.nonlinear hertz", "law"], PLAIN, &[("law = \"hertz\"\ncoefficient = 1.51e10\nexponent = 1.45", "law = \"cubic\"\ncoefficient = 1.51e16")], &["one.left.x", "one.left.force_x"], &["frequency[", "two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing.nonlinear hertz", "coefficient"], PLAIN, &[("1.51e10", "1.6e10")], &["one.left.x", "one.left.force_x"], &["frequency[", "two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing.nonlinear hertz", "exponent"], PLAIN, &[("1.45", "1.5")], &["one.left.x", "one.left.force_x"], &["frequency[", "two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bearing.nonlinear hertz", "clearance"], PLAIN, &[("1.5e-7", "1.6e-7")], &["one.left.x", "one.left.force_x"], &["frequency[", "two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.unbalance", "name"], PLAIN, &[("\"residual\"", "\"u\"")], &["one.u.moment"], &["mesh.", "two.", "one.left"]),
    row(["rotor.unbalance", "position"], PLAIN, &[("0.31\n", "0.315\n")], &["one.end.x"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.unbalance", "moment"], PLAIN, &[("2.3e-4", "2.6e-4")], &["one.end.x", "mesh.force"], &["frequency["]),
    row(["rotor.unbalance", "phase"], PLAIN, &[("0.42", "0.52")], &["one.end.x", "mesh.force"], &["frequency["]),
    row(["rotor.bow", "positions"], PLAIN, &[("0.22", "0.23")], &["one.end.x"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.bow", "amplitudes"], PLAIN, &[("3.3e-6", "3.6e-6")], &["one.end.x", "one.left.force_x"], &["frequency["]),
    row(["rotor.bow", "phase"], PLAIN, &[("0.71", "0.81")], &["one.end.x", "one.left.force_x"], &["frequency["]),
    row(["rotor.torque", "name"], PLAIN, &[("\"drive\"", "\"d\"")], &["one.d.torque"], &["mesh.", "two.", "one.left"]),
    row(["rotor.torque", "position"], PLAIN, &[("0.01\n", "0.015\n")], &["one.end.theta"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.torque", "value"], PLAIN, &[("61.0", "62.0")], &["one.drive.torque", "mesh.force"], &["frequency["]),
    row(["rotor.torque", "slope"], PLAIN, &[("0.021", "0.03")], &["mesh.force", "one.pinion.theta"], &["frequency["]),
    row(["rotor.basis_support", "position"], PLAIN, &[("0.142", "0.152")], &["one.lateral_frequency[1]", "one.torsional_frequency[1]"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["rotor.basis_support", "lateral"], PLAIN, &[("2.2e5", "3.2e5")], &["one.lateral_frequency[1]"], &["two.lateral_frequency", "two.torsional_frequency", "one.torsional_frequency"]),
    row(["rotor.basis_support", "torsional"], PLAIN, &[("330.0", "430.0")], &["one.torsional_frequency[1]"], &["two.lateral_frequency", "two.torsional_frequency", "one.lateral_frequency"]),
    row(["rotor.probe", "name"], PLAIN, &[("\"end\"", "\"e\"")], &["one.e.x"], &["mesh.", "two.", "one.left"]),
    row(["rotor.probe", "position"], PLAIN, &[("0.39\n", "0.4\n")], &["one.end.x"], &["two.lateral_frequency", "two.torsional_frequency"]),
    row(["mesh", "name"], PLAIN, &[("name = \"mesh\"", "name = \"m\"")], &["m.force"], &["one.", "two."]),
    row(["mesh", "gears"], PLAIN, &[("[\"one.pinion\", \"two.wheel\"]", "[\"two.wheel\", \"one.pinion\"]")], &["mesh.force_x"], &["frequency["]),
    row(["mesh", "center_angle"], PLAIN, &[("0.61", "0.71")], &["mesh.force_x", "one.left.force_x"], &["frequency["]),
    row(["mesh", "pressure_angle"], PLAIN, &[("0.351", "0.361")], &["mesh.force_x", "one.left.force_x"], &["frequency["]),
    row(["mesh", "internal"], PLAIN, &[("internal = false", "internal = true"), ("speed = -120.0", "speed = 120.0"), ("value = 91.5", "value = -91.5")], &["mesh.force_x"], &["frequency[", "one.angle"]),
    row(["mesh", "flank"], PLAIN, &[("flank = 1", "flank = -1")], &["mesh.force", "mesh.force_x"], &["frequency["]),
    row(["mesh", "phase"], PLAIN, &[("0.17", "0.27")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh", "damping_ratio"], PLAIN, &[("0.052", "0.062")], &["mesh.force"], &["frequency[", "mesh.stiffness"]),
    row(["mesh", "damping"], DAMPING, &[("damping = 800.0", "damping = 900.0")], &["mesh.force"], &["frequency[", "mesh.stiffness"]),
    row(["mesh", "contact"], REVERSED, &[("contact = \"unilateral\"\nbacklash = 3.1e-5", "contact = \"bilateral\"")], &["mesh.force"], &["frequency[", "mesh.stiffness"]),
    row(["mesh", "backlash"], REVERSED, &[("3.1e-5", "3.6e-5")], &["mesh.deflection", "mesh.backlash"], &["frequency[", "mesh.stiffness"]),
    row(["mesh", "torque_coupling"], BILATERAL, &[("\"consistent\"", "\"as_printed\"")], &["mesh.force", "one.pinion.mesh_torque"], &["frequency[", "mesh.stiffness"]),
    row(["mesh", "transmission_error"], PLAIN, &[("\n[[mesh.transmission_error]]\norder = 1\namplitude = 1.9e-6\nphase = 0.93\n", "")], &["mesh.force"], &["frequency[", "mesh.stiffness"]),
    row(["mesh.stiffness tooth_pair", "law"], PLAIN, &[("law = \"tooth_pair\"\npair = 2.01e8\nquadratic = 0.33\nquartic = 0.11\nramp = 0.21\ncontact_ratio = 1.62", "law = \"constant\"\nmean = 3e8")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness tooth_pair", "pair"], PLAIN, &[("2.01e8", "2.11e8")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness tooth_pair", "quadratic"], PLAIN, &[("0.33", "0.3")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness tooth_pair", "quartic"], PLAIN, &[("0.11\n", "0.12\n")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness tooth_pair", "ramp"], PLAIN, &[("0.21\ncon", "0.22\ncon")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness tooth_pair", "contact_ratio"], PLAIN, &[("1.62", "1.66")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness constant", "law"], CONST, &[("law = \"constant\"\nmean = 3.01e8", "law = \"rectangular\"\npair = 2e8\ncontact_ratio = 1.5")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness constant", "mean"], CONST, &[("3.01e8", "3.11e8")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness rectangular", "law"], RECT, &[("law = \"rectangular\"\npair = 2.02e8\ncontact_ratio = 1.63", "law = \"constant\"\nmean = 3e8")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness rectangular", "pair"], RECT, &[("pair = 2.02e8", "pair = 2.12e8")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness rectangular", "contact_ratio"], RECT, &[("1.63", "1.73")], &["mesh.force"], &["frequency["]),
    row(["mesh.stiffness rectangular", "single"], SINGLE, &[("2.03e8", "2.13e8")], &["mesh.force"], &["frequency["]),
    row(["mesh.stiffness rectangular", "double"], SINGLE, &[("3.53e8", "3.63e8")], &["mesh.force"], &["frequency["]),
    row(["mesh.stiffness fourier", "law"], FOURIER, &[("law = \"fourier\"\nmean = 3.02e8\ncosine = [0.15, 0.05]\nsine = [0.07]", "law = \"constant\"\nmean = 3e8")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness fourier", "mean"], FOURIER, &[("3.02e8", "3.12e8")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness fourier", "cosine"], FOURIER, &[("0.15", "0.16")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness fourier", "sine"], FOURIER, &[("0.07", "0.08")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness table", "law"], TABLE, &[("law = \"table\"\nphase = [0.0, 0.45]\nvalue = [2.5e8, 3.5e8]", "law = \"constant\"\nmean = 3e8")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness table", "phase"], TABLE, &[("[0.0, 0.45]", "[0.0, 0.55]")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness table", "value"], TABLE, &[("3.5e8", "3.6e8")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness tooth_geometry", "law"], GEOMETRY, &[("law = \"tooth_geometry\"\nmodule = 0.003\nface_width = 0.021\nrack_pressure_angle = 0.35\naddendum = [1.0, 1.0]\ndedendum = [1.25, 1.25]\nprofile_shift = [0.0, 0.0]\nbore_radius = [0.015, 0.02]\nmaterial = \"other\"", "law = \"constant\"\nmean = 3e8")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness tooth_geometry", "face_width"], GEOMETRY, &[("0.021\nrack", "0.022\nrack")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness tooth_geometry", "addendum"], GEOMETRY, &[("addendum = [1.0", "addendum = [0.95")], &["mesh.force"], &["frequency["]),
    row(["mesh.stiffness tooth_geometry", "dedendum"], GEOMETRY, &[("[1.25, 1.25]", "[1.3, 1.25]")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness tooth_geometry", "profile_shift"], GEOMETRY, &[("profile_shift = [0.0", "profile_shift = [-0.05")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness tooth_geometry", "bore_radius"], GEOMETRY, &[("[0.015", "[0.016")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness tooth_geometry", "material"], GEOMETRY, &[("0.02]\nmaterial = \"other\"", "0.02]\nmaterial = \"default\"")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.transmission_error", "order"], PLAIN, &[("order = 1", "order = 2")], &["mesh.force"], &["frequency[", "mesh.stiffness"]),
    row(["mesh.transmission_error", "amplitude"], PLAIN, &[("1.9e-6", "2.0e-6")], &["mesh.force", "mesh.deflection"], &["frequency[", "mesh.stiffness"]),
    row(["mesh.transmission_error", "phase"], PLAIN, &[("0.93", "0.95")], &["mesh.force"], &["frequency[", "mesh.stiffness"]),
    row(["gearbox_vibration", "amplitude_x"], PLAIN, &[("2.1e-6", "2.2e-6")], &["one.left.force_x", "gearbox_vibration.amplitude_x"], &["frequency["]),
    row(["gearbox_vibration", "amplitude_y"], PLAIN, &[("1.1e-6", "1.2e-6")], &["one.left.force_y", "gearbox_vibration.amplitude_y"], &["frequency["]),
    row(["gearbox_vibration", "phase_y"], PLAIN, &[("0.72", "0.82")], &["one.left.force_y", "gearbox_vibration.phase_y"], &["frequency["]),
    row(["gearbox_vibration", "frequency"], PLAIN, &[("433.0", "434.0")], &["one.left.force_x", "gearbox_vibration.frequency"], &["frequency["]),
    row(["mesh.stiffness tooth_geometry", "module"], GEOMETRY, &[("module = 0.003\npress", "module = 0.0031\npress"), ("module = 0.003\npress", "module = 0.0031\npress"), ("module = 0.003\nface", "module = 0.0031\nface")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
    row(["mesh.stiffness tooth_geometry", "rack_pressure_angle"], GEOMETRY, &[("module = 0.003\npressure_angle = 0.35\n", "module = 0.003\npressure_angle = 0.349\n"), ("module = 0.003\npressure_angle = 0.35\n", "module = 0.003\npressure_angle = 0.349\n"), ("rack_pressure_angle = 0.35\n", "rack_pressure_angle = 0.349\n")], &["mesh.stiffness", "mesh.force"], &["frequency["]),
];

/// Keys without a row: tables, which have rows of their own, and what this version refuses.
pub const ELSEWHERE: &[(&str, &str)] = &[
    ("top", "kind"),
    ("top", "housing"),
    ("top", "simulation"),
    ("top", "basis"),
    ("top", "material"),
    ("top", "rotor"),
    ("top", "mesh"),
    ("top", "gearbox_vibration"),
    ("rotor", "segment"),
    ("rotor", "disk"),
    ("rotor", "gear"),
    ("rotor", "bearing"),
    ("rotor", "unbalance"),
    ("rotor", "bow"),
    ("rotor", "torque"),
    ("rotor", "basis_support"),
    ("rotor", "probe"),
    ("mesh", "stiffness"),
];
