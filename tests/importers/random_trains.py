"""Random gear trains that an engineer could have drawn: the whole feature space of the model file, from a seed.

A train is drawn from the drive outwards: each further rotor hangs on a rotor that is there, by a gear of its own or by
one that already meshes, outside or as a ring.  Torques balance, flanks follow the power, every shaft is damped, and the
teeth are loaded, so that two accurate solutions of the same equations stay together.

    python random_trains.py SEED          the model file
"""
import math
import random
import sys

STEEL = dict(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0)
TITANIUM = dict(youngs_modulus=1.14e11, poisson_ratio=0.34, density=4430.0)
PRESSURE_ANGLE = 0.35


class Draw(random.Random):
    """Numbers with few digits: a model file should be readable."""

    def number(self, low, high, digits=4):
        return float(f"{self.uniform(low, high):.{digits}g}")

    def magnitude(self, low, high):
        return float(f"{math.exp(self.uniform(math.log(low), math.log(high))):.3g}")

    def chance(self, probability):
        return self.random() < probability

    def angle(self):
        return self.number(-3.0, 3.0)


def train(seed):
    """A model file as a dict, ready for `toml_text` and for the reference."""
    draw = Draw(seed)
    free = draw.chance(0.35)
    model = dict(kind="gear_train", name=f"train{seed}", description="Random train",
                 simulation=dict(speed="free" if free else "prescribed", start="rest" if draw.chance(0.3) else "equilibrium",
                                 tolerance=1e-5, stop_time=0.012, step_size=2e-5),
                 material=dict(default=STEEL, titanium=TITANIUM), rotor=[], mesh=[])
    basis = _basis(draw)
    if basis:
        model["basis"] = basis
    count = draw.choice([1, 2, 2, 3, 3, 4])
    speed = draw.choice([-1, 1]) * draw.number(80.0, 400.0)
    shafts = [Shaft(draw, "shaft1", speed)]
    for index in range(1, count):
        _hang(draw, model, shafts, f"shaft{index + 1}")
    if count > 1 and draw.chance(0.25):
        _second_path(draw, model, shafts)
    _power(draw, shafts)
    for shaft in shafts:
        model["rotor"].append(shaft.table(draw, free, basis is None or basis.get("static_shapes")))
    if draw.chance(0.4) or count == 1:
        model["gearbox_vibration"] = dict(amplitude_x=draw.magnitude(5e-7, 4e-6), amplitude_y=draw.magnitude(5e-7, 4e-6),
                                          phase_y=draw.angle(), frequency=draw.number(200.0, 1500.0))
    return model


def _basis(draw):
    kind = draw.choice(["count", "count", "frequency", "shapes", "default"])
    if kind == "count":
        return dict(lateral_modes=draw.randint(3, 7), torsional_modes=draw.randint(2, 4), static_shapes=draw.chance(0.3))
    if kind == "frequency":
        return dict(max_frequency=draw.number(1500.0, 5000.0, 2))
    if kind == "shapes":
        return dict(max_frequency=draw.number(1000.0, 2500.0, 2), static_shapes=True)
    return None


class Shaft:
    """A rotor in the making: its gears first, the rest around them."""

    def __init__(self, draw, name, speed):
        self.name, self.speed, self.power, self.drives = name, speed, 0.0, False
        self.length, self.gears, self.torque = draw.number(0.28, 0.5, 2), [], 0.0

    def gear(self, draw, teeth, module, near=None):
        place = near or draw.number(0.25, 0.7, 2) * self.length
        taken = [g["position"] for g in self.gears]
        while any(abs(place - other) < 0.02 for other in taken):
            place = 0.2 * self.length + (place + 0.03 - 0.2 * self.length) % (0.6 * self.length)
        radius, width = module * teeth / 2, draw.number(0.02, 0.04, 2)
        mass = 0.7 * STEEL["density"] * math.pi * radius ** 2 * width
        polar = mass * radius ** 2 / 2
        g = dict(name=f"gear{len(self.gears) + 1}", position=round(place, 4), teeth=teeth, base_radius=radius * math.cos(PRESSURE_ANGLE),
                 mass=mass, polar_inertia=polar, diametral_inertia=polar / 2 + mass * width ** 2 / 12)
        self.gears.append(g)
        return g

    def place(self, fraction):
        return round(fraction * self.length, 4)

    def table(self, draw, free, whole):
        r = dict(name=self.name, speed=self.speed, lateral_damping_ratio=draw.number(0.003, 0.02, 2),
                 torsional_damping_ratio=draw.number(0.005, 0.02, 2))
        if draw.chance(0.3):
            r["angle"] = draw.angle()
        if draw.chance(0.5):
            r["max_element_length"] = draw.number(0.02, 0.05, 2)
        r["segment"] = self._segments(draw)
        r["gear"] = self.gears
        r["bearing"] = self._bearings(draw, free)
        r["torque"] = self._torques(draw, free)
        if draw.chance(0.3):
            polar = draw.magnitude(1e-3, 2e-2)
            r["disk"] = [dict(position=self.place(draw.choice([0.0, 1.0])), mass=draw.number(0.5, 3.0, 2), polar_inertia=polar,
                              diametral_inertia=0.6 * polar)]
        if draw.chance(0.5):
            r["unbalance"] = [dict(name=f"u{i}", position=self.place(draw.number(0.1, 0.9, 2)), moment=draw.magnitude(1e-5, 4e-4),
                                   phase=draw.angle()) for i in range(draw.randint(1, 2))]
        if draw.chance(0.3):
            places = sorted(draw.sample([0.0, 0.2, 0.4, 0.55, 0.75, 1.0], draw.randint(3, 4)))
            r["bow"] = [dict(positions=[self.place(z) for z in places], amplitudes=[draw.number(-2e-5, 2e-5, 2) for _ in places],
                             phase=draw.angle())]
        if draw.chance(0.2):
            support = dict(position=self.place(draw.number(0.3, 0.6, 2)), lateral=draw.magnitude(1e4, 1e6))
            if not free and whole:                                         # a few modes of a held shaft cannot turn with the others
                support["torsional"] = draw.magnitude(1e2, 1e4)
            r["basis_support"] = [support]
        if draw.chance(0.4):
            r["probe"] = [dict(name="probe", position=self.place(draw.number(0.0, 1.0, 2)))]
        return r

    def _segments(self, draw):
        cuts = sorted({0.0, 1.0, *(draw.number(0.1, 0.9, 2) for _ in range(draw.randint(0, 2)))})
        segments = []
        for a, b in zip(cuts, cuts[1:]):
            outer = draw.number(0.035, 0.07, 2)
            segment = dict(length=self.place(b) - self.place(a), outer_diameter=outer)
            if draw.chance(0.3):
                segment["inner_diameter"] = float(f"{draw.uniform(0.2, 0.6) * outer:.2g}")
            if draw.chance(0.2):
                segment["material"] = "titanium"
            segments.append(segment)
        return segments

    def _bearings(self, draw, free):
        places = [draw.number(0.03, 0.15, 2), draw.number(0.8, 0.97, 2)] + ([0.5] if draw.chance(0.15) else [])
        bearings = []
        for index, z in enumerate(places):
            b = dict(name=f"b{index + 1}", position=self.place(z))
            if draw.chance(0.2):
                b["at_speed"] = self._over_speed(draw)
                if free or draw.chance(0.3):
                    b["outside_speeds"] = "hold"
            else:
                b.update(zip(("stiffness", "damping"), _coefficients(draw)))
            if draw.chance(0.15):
                b["nonlinear"] = draw.choice([
                    dict(law="clearance", clearance=draw.number(2e-6, 1e-5, 2), stiffness=draw.magnitude(3e7, 2e8)),
                    dict(law="cubic", coefficient=draw.magnitude(1e16, 1e18), clearance=draw.choice([0.0, 3e-6])),
                    dict(law="hertz", coefficient=draw.magnitude(2e9, 2e10)),
                    dict(law="hertz", coefficient=draw.magnitude(5e7, 5e8), exponent=10 / 9, clearance=draw.choice([0.0, 2e-6])),
                ])
            bearings.append(b)
        return bearings

    def _over_speed(self, draw):
        fractions = [0.0, draw.number(0.3, 0.7, 2), draw.number(0.9, 1.1, 2), draw.number(1.3, 1.6, 2)]
        entries = []
        for fraction in fractions:
            stiffness, damping = _coefficients(draw)
            entries.append(dict(speed=float(f"{fraction * abs(self.speed):.4g}"), stiffness=stiffness, damping=damping))
        return entries

    def _torques(self, draw, free):
        if not self.torque:
            return []
        # In free spin the slope acts on the whole speed: the load line goes through the balanced point.
        slope = float(f"{draw.uniform(0.02, 0.2) * abs(self.torque / self.speed):.3g}")
        value = self.torque + (slope * self.speed if free else 0.0)
        place = self.place(draw.choice([0.0, 1.0])) if draw.chance(0.8) or not self.gears else self.gears[0]["position"]
        return [dict(name="drive" if self.drives else "load", position=place, value=value, slope=slope)]


def _coefficients(draw):
    """K and C; what circulates (xy against yx) is small against C times the lowest frequency."""
    k, c = draw.magnitude(3e7, 2e8), draw.magnitude(600.0, 4000.0)
    stiffness, damping = dict(xx=k), dict(xx=c)
    if draw.chance(0.4):
        stiffness["yy"], damping["yy"] = float(f"{k * draw.uniform(0.6, 1.5):.3g}"), float(f"{c * draw.uniform(0.6, 1.5):.3g}")
    if draw.chance(0.3):
        both, circulating = draw.uniform(-0.1, 0.1) * k, draw.uniform(-1, 1) * 300.0 * c
        stiffness["xy"], stiffness["yx"] = float(f"{both + circulating:.3g}"), float(f"{both - circulating:.3g}")
        damping["xy"] = damping["yx"] = float(f"{draw.uniform(-0.1, 0.1) * c:.3g}")
    return stiffness, damping


def _hang(draw, model, shafts, name):
    """A further rotor on one of those there."""
    source = draw.choice(shafts)
    if source.gears and draw.chance(0.3):
        first = draw.choice(source.gears)
        module = 2 * first["base_radius"] / math.cos(PRESSURE_ANGLE) / first["teeth"]
    else:
        module = draw.choice([0.002, 0.0025, 0.003, 0.004])
        first = source.gear(draw, draw.randint(17, 40), module)
    internal = draw.chance(0.2)
    ratio = draw.uniform(1.8, 2.8) if internal else draw.uniform(0.6, 2.2)
    teeth = max(17, round(ratio * first["teeth"]))
    shaft = Shaft(draw, name, source.speed * first["teeth"] / teeth * (1 if internal else -1))
    shafts.append(shaft)
    second = shaft.gear(draw, teeth, module)
    _mesh(draw, model, (source, first), (shaft, second), draw.angle(), internal)


def _second_path(draw, model, shafts):
    """A second pair of gears between two shafts that already mesh: the same centre distance and ratio, finer teeth."""
    mesh = model["mesh"][0]
    if mesh["internal"]:
        return
    pairs = []
    for path in mesh["gears"]:
        name, g = path.split(".")
        shaft = next(s for s in shafts if s.name == name)
        first = next(x for x in shaft.gears if x["name"] == g)
        module = 2 * first["base_radius"] / math.cos(PRESSURE_ANGLE) / first["teeth"]
        pairs.append((shaft, shaft.gear(draw, 2 * first["teeth"], module / 2)))
    driver, driven = pairs if mesh["flank"] == (1 if pairs[0][0].speed > 0 else -1) else pairs[::-1]
    _mesh(draw, model, driver, driven, mesh["center_angle"] + (0.0 if driver is pairs[0] else math.pi), False)


def _mesh(draw, model, driver, driven, center_angle, internal):
    a, b = (driver, driven) if internal or draw.chance(0.6) else (driven, driver)
    flank = (1 if a[0].speed > 0 else -1) * (1 if a is driver else -1)
    mesh = dict(name=f"mesh{len(model['mesh']) + 1}", gears=[f"{s.name}.{g['name']}" for s, g in (a, b)],
                center_angle=center_angle + (0.0 if a is driver else math.pi), pressure_angle=PRESSURE_ANGLE, internal=internal, flank=flank)
    if draw.chance(0.6):
        mesh["phase"] = draw.number(0.0, 1.0, 2)
    mesh.update(dict(damping_ratio=draw.number(0.03, 0.1, 2)) if draw.chance(0.7) else dict(damping=draw.magnitude(800.0, 4000.0)))
    mesh["stiffness"] = _law(draw)
    if mesh["stiffness"]["law"] == "constant" or draw.chance(0.4):         # something must move
        mesh["transmission_error"] = [dict(order=order, amplitude=draw.magnitude(3e-7, 3e-6) / order, phase=draw.angle())
                                      for order in range(1, draw.randint(1, 3) + 1)]
    # Trains that start without load hit their teeth again and again: those are files of their own in tests/models.
    if draw.chance(0.45) and model["simulation"]["start"] == "equilibrium":
        mesh["contact"] = "unilateral"
        if draw.chance(0.8):
            mesh["backlash"] = draw.number(3e-5, 1e-4, 2)
    elif draw.chance(0.15):
        mesh["torque_coupling"] = "as_printed"
        mesh.pop("damping", None)
        mesh["damping_ratio"] = 0.0                                        # it would excite: eq 5, (6) and (18)
    model["mesh"].append(mesh)


def _law(draw):
    pair, ratio = draw.magnitude(1e8, 3e8), draw.number(1.15, 1.95, 3)
    kind = draw.choice(["constant", "rectangular", "rectangular", "tooth_pair", "tooth_pair", "fourier", "table"])
    if kind == "constant":
        return dict(law=kind, mean=pair)
    if kind == "rectangular" and draw.chance(0.5):
        return dict(law=kind, single=pair, double=float(f"{pair * draw.uniform(1.3, 1.8):.3g}"), contact_ratio=ratio)
    if kind == "rectangular":
        return dict(law=kind, pair=pair, contact_ratio=ratio + draw.choice([0, 0, 1]))
    if kind == "tooth_pair":
        return dict(law=kind, pair=pair, quadratic=draw.number(0.0, 0.4, 2), quartic=draw.number(0.0, 0.2, 2),
                    ramp=draw.choice([0.0, draw.number(0.05, 0.3, 2)]), contact_ratio=ratio + draw.choice([0, 0, 1]))
    if kind == "fourier":
        return dict(law=kind, mean=1.5 * pair, cosine=[draw.number(-0.15, 0.15, 2) for _ in range(3)], sine=[draw.number(-0.1, 0.1, 2)])
    phases = sorted({draw.number(0.0, 0.98, 2) for _ in range(draw.randint(3, 6))})
    values = [float(f"{1.5 * pair * draw.uniform(0.8, 1.2):.3g}") for _ in phases]
    if draw.chance(0.5):                                                   # a jump
        phases.insert(1, phases[1])
        values.insert(1, 1.5 * pair)
    return dict(law=kind, phase=phases, value=values)


def _power(draw, shafts):
    """Every other shaft takes its part of what the first one brings in; tooth forces of some kN."""
    if len(shafts) == 1:
        return
    first = shafts[0]
    radius = min(g["base_radius"] for s in shafts for g in s.gears)
    total = draw.number(2000.0, 5000.0) * radius * abs(first.speed)        # W
    parts = [draw.uniform(0.5, 1.5) for _ in shafts[1:]]
    for shaft, part in zip(shafts[1:], parts):
        shaft.torque = -math.copysign(total * part / sum(parts) / abs(shaft.speed), shaft.speed)
    first.torque, first.drives = math.copysign(total / abs(first.speed), first.speed), True


def toml_text(model):
    """A dict of the model file as TOML: plain values and inline tables first, then tables, then arrays of tables."""
    return "\n".join(_table(model, "")) + "\n"


def _table(table, path):
    inline = path.endswith(".bearing") or path.endswith(".at_speed")
    tables = {k: v for k, v in table.items() if isinstance(v, dict) and not (inline and k in ("stiffness", "damping"))}
    arrays = {k: v for k, v in table.items() if isinstance(v, list) and v and isinstance(v[0], dict)}
    lines = [f"{k} = {_value(v)}" for k, v in table.items() if k not in tables and k not in arrays and v != [] and v is not None]
    prefix = path + "." if path else ""
    for key, value in tables.items():
        if all(isinstance(x, dict) for x in value.values()):
            lines += _table(value, prefix + key)                           # [material.NAME]
        else:
            lines += ["", f"[{prefix}{key}]", *_table(value, prefix + key)]
    for key, values in arrays.items():
        for value in values:
            lines += ["", f"[[{prefix}{key}]]", *_table(value, prefix + key)]
    return lines


def _value(v):
    if isinstance(v, bool):
        return "true" if v else "false"
    if isinstance(v, str):
        return f'"{v}"'
    if isinstance(v, list):
        return "[" + ", ".join(map(_value, v)) + "]"
    if isinstance(v, dict):
        return "{ " + ", ".join(f"{k} = {_value(x)}" for k, x in v.items()) + " }"
    return repr(v)


if __name__ == "__main__":
    print(toml_text(train(int(sys.argv[1]))), end="")
