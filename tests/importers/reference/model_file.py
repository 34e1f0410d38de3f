"""The model file with every default of design 2 and 8 filled in."""
import copy
import csv
import math
import tomllib
from pathlib import Path

TWO_PI = 2 * math.pi


def load(source):
    """Model file (path) or dict -> dict.  Loading twice changes nothing."""
    if isinstance(source, dict):
        m = copy.deepcopy(source)
    else:
        with open(source, "rb") as f:
            m = tomllib.load(f)
        _housing(m, Path(source))
    sim = m.setdefault("simulation", {})
    sim.setdefault("speed", "prescribed")
    sim.setdefault("start", "equilibrium")
    vib = m.setdefault("gearbox_vibration", {})
    for key in ("amplitude_x", "amplitude_y", "phase_y", "frequency"):
        vib.setdefault(key, 0.0)
    m.setdefault("housing", None)
    for r in m.setdefault("rotor", []):
        _rotor(m, r)
    _meshes(m)
    mesh_hz = [abs(r["speed"]) * g["teeth"] / TWO_PI for r, g in (gear(m, k["gears"][0]) for k in m["mesh"])]
    basis = m.setdefault("basis", dict(static_shapes=True))
    basis.setdefault("static_shapes", False)
    basis.setdefault("max_frequency", max([1000.0] + [3 * f for f in mesh_hz]))        # a count of modes goes before it
    return m


def _housing(m, path):
    """"housing" becomes the points and modes of the structure, and the bearings that stand on it."""
    connect = m.get("housing", {}).get("connect", {})
    if "housing" in m:
        path = path.parent / m["housing"]["file"]
        structure = tomllib.loads(path.read_text())
    elif m["kind"] == "housing":
        structure = m
    else:
        return
    modes = structure.get("mode", [])
    if "modes" in structure:
        modes = list(_modes(structure["modes"], path.parent))
    m["housing"] = dict(point=structure["point"], mode=modes, connect=connect)


def _modes(data, folder):
    """The modes of a table: one line each."""
    lines = [line for line in (folder / data["file"]).read_text().splitlines() if not line.startswith("#")]
    for line in csv.DictReader(lines, skipinitialspace=True):
        shape = {}
        for title, value in line.items():
            point, dot, axis = title.rpartition(".")
            if dot:
                shape.setdefault(point, [0.0, 0.0])["xy".index(axis)] = float(value)
        yield dict(frequency=float(line["frequency"]), damping_ratio=float(line.get("damping_ratio", data.get("damping_ratio"))), shape=shape)


def gear(model, path):
    """The rotor and the gear called "rotor.gear"."""
    rotor, name = path.split(".")
    r = next(r for r in model["rotor"] if r["name"] == rotor)
    return r, next(g for g in r["gear"] if g["name"] == name)


def _rotor(m, r):
    if m["simulation"]["speed"] == "free":
        r.setdefault("speed", 0.0)
        if any(s.get("torsional") for s in r.get("basis_support", [])):
            raise ValueError("a torsional basis support in free spin")
    r.setdefault("angle", 0.0)
    r.setdefault("lateral_damping_ratio", 0.0)
    r.setdefault("torsional_damping_ratio", 0.0)
    for key in ("segment", "disk", "gear", "bearing", "unbalance", "bow", "torque", "basis_support", "probe"):
        r.setdefault(key, [])
    for s in r["segment"]:
        s.setdefault("inner_diameter", 0.0)
        if not isinstance(s.get("material"), dict):                        # already resolved when loaded twice
            s["material"] = m["material"][s.get("material", "default")]
    for g in r["gear"]:
        if "base_radius" not in g:
            g["base_radius"] = 0.5 * g["module"] * g["teeth"] * math.cos(g["pressure_angle"])
    for b in r["bearing"]:
        for entry in b.get("at_speed", [b]):
            for key in ("stiffness", "damping"):
                d = entry.setdefault(key, {})
                d.setdefault("xx", 0.0)
                d.setdefault("yy", d["xx"])
                d.setdefault("xy", 0.0)
                d.setdefault("yx", 0.0)
        b.setdefault("outside_speeds", "refuse")
        if "nonlinear" in b:
            b["nonlinear"].setdefault("clearance", 0.0)
            b["nonlinear"].setdefault("exponent", 1.5)
    for u in r["unbalance"] + r["bow"]:
        u.setdefault("phase", 0.0)
    for t in r["torque"]:
        t.setdefault("value", 0.0)
        t.setdefault("slope", 0.0)
    for s in r["basis_support"]:
        s.setdefault("lateral", 0.0)
        s.setdefault("torsional", 0.0)
    r.setdefault("max_element_length", sum(s["length"] for s in r["segment"]) / 20)


def _meshes(m):
    first = {}                                     # design 8.8: gear -> first mesh in which it is gear a
    for k in m.setdefault("mesh", []):
        for key, value in dict(internal=False, flank=1, contact="bilateral", backlash=0.0, damping_ratio=0.0,
                               torque_coupling="consistent", transmission_error=[], stiffness_factor=1.0).items():
            k.setdefault(key, value)
        for e in k["transmission_error"]:
            e.setdefault("phase", 0.0)
        a = k["gears"][0]
        if "phase" not in k:
            k["phase"] = 0.0
            if a in first:
                turned = k["center_angle"] - first[a]["center_angle"]
                k["phase"] = first[a]["phase"] - k["flank"] * gear(m, a)[1]["teeth"] * turned / TWO_PI
        first.setdefault(a, k)
