"""The reference implementation against closed forms: what the Rust program is compared with must itself be right."""

import copy
import math

import numpy as np
import pytest
import reference
from scipy.interpolate import CubicSpline
from scipy.linalg import expm

STEEL = {"default": dict(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0)}
# A shaft that weighs next to nothing: closed forms of a single mass hold to 1e-7.
LIGHT = {"default": dict(youngs_modulus=2.1e11, poisson_ratio=0.3, density=1e-3)}


def rotor(name, speed=0.0, length=0.4, diameter=0.05, **tables):
    return dict(name=name, speed=speed, segment=[dict(length=length, outer_diameter=diameter)], **tables)


def gear(radius, teeth, inertia, mass=5.0):
    return dict(name="gear", position=0.2, teeth=teeth, base_radius=radius, mass=mass, polar_inertia=inertia,
                diametral_inertia=inertia / 2)


def bearings(k=1e8, c=0.0, places=(0.05, 0.35), **more):
    return [dict(name=f"b{i}", position=z, stiffness=dict(xx=k), damping=dict(xx=c), **more) for i, z in enumerate(places)]


def pair(speed=0.0, ratio=2, material=STEEL, simulation=None, basis=None, mesh=None, torques=(0.0, 0.0), slopes=(0.0, 0.0)):
    """Pinion (20 teeth, base radius 0.04 m, 2e-3 kg m^2) and wheel."""
    wheel = gear(0.04 * ratio, 20 * ratio, 0.05, 20.0)
    shafts = [rotor(name, omega, gear=[g], bearing=bearings(c=500.0), torque=[dict(name="t", position=0.0, value=t, slope=c)])
              for name, omega, g, t, c in zip("ab", (speed, -speed / ratio), (gear(0.04, 20, 2e-3), wheel), torques, slopes)]
    contact = dict(name="mesh", gears=["a.gear", "b.gear"], center_angle=0.4, pressure_angle=0.35, phase=0.0,
                   stiffness=dict(law="constant", mean=2e8), damping_ratio=0.0)
    return dict(material=material, rotor=shafts, mesh=[{**contact, **(mesh or {})}], simulation=simulation or {},
                basis=basis or dict(lateral_modes=4, torsional_modes=3))


TORSION_ONLY = dict(lateral_modes=0, torsional_modes=1)


def test_run_up_from_rest_is_torque_over_reduced_inertia():
    """Om' = T / (J_1 + J_2 i^2); the static start leaves no vibration but what the gyroscopes make of it."""
    system = reference.System(pair(simulation=dict(speed="free"), torques=(50.0, 0.0)))
    j1, j2 = (r.j.sum() for r in system.rotors.values())
    out = reference.simulate(system, 0.02, [0.0, 0.01, 0.02], rtol=1e-10)
    for t, speed, angle in zip(out["time"], out["a.speed"], out["a.angle"] - out["a.angle"][0]):
        assert speed == pytest.approx(50.0 / (j1 + j2 / 4) * t, rel=1e-6)
        assert angle == pytest.approx(50.0 / (j1 + j2 / 4) * t ** 2 / 2, rel=1e-6)
    assert out["b.speed"][-1] == pytest.approx(-out["a.speed"][-1] / 2, rel=1e-6)


def test_load_line_brings_the_train_to_rest_exponentially():
    """(J_1 + J_2 i^2) Om' = -slope i^2 Om."""
    model = pair(400.0, simulation=dict(speed="free"), slopes=(0.0, 1.0))
    system = reference.System(model)
    j1, j2 = (r.j.sum() for r in system.rotors.values())
    rate = 1.0 / 4 / (j1 + j2 / 4)
    out = reference.simulate(system, 0.02, [0.0, 0.01, 0.02], rtol=1e-10)
    # 2e-3: the start is not loaded by the load line, the train rings a little.
    assert out["a.speed"] == pytest.approx(400.0 * np.exp(-rate * out["time"]), rel=2e-3)


def test_angle_speed_and_theta_belong_together():
    model = pair(100.0, simulation=dict(speed="free", start="rest"), torques=(80.0, -20.0),
                 mesh=dict(stiffness=dict(law="tooth_pair", pair=2e8, contact_ratio=1.6, ramp=0.1, quadratic=0.3)))
    times = np.linspace(0.0, 0.005, 2001)
    out = reference.simulate(model, 0.005, times, rtol=1e-10)
    # 1e-5 of the change of speed: the spline's error at 1000 points per tooth and jumps of Om'' at the breakpoints.
    slope = CubicSpline(times, out["a.angle"])(times, 1)
    assert np.abs(slope - out["a.speed"]).max() < 1e-5 * np.ptp(out["a.speed"])
    # A gear in the middle of its shaft vibrates about the mean, does not run away from it.
    assert np.abs(out["a.gear.theta"]).max() < 1e-3 < out["a.angle"][-1]


def test_unbalance_of_a_floating_rotor_turns_about_the_centre_of_mass():
    """Without supports M x + m e e^{i(phi + delta)} moves uniformly, however the speed changes (Om^2 and Om' parts)."""
    shaft = rotor("r", 300.0, unbalance=[dict(name="u", position=0.2, moment=1e-3, phase=0.7)], angle=0.3,
                  torque=[dict(name="t", position=0.0, value=30.0)], probe=[dict(name="middle", position=0.2)])
    model = dict(material=STEEL, rotor=[shaft], simulation=dict(speed="free"), basis=dict(lateral_modes=2, torsional_modes=1))
    times = np.linspace(0.0, 0.03, 40)
    out = reference.simulate(model, 0.03, times)
    mass = 7850.0 * math.pi * 0.05 ** 2 / 4 * 0.4
    turning = 1e-3 / mass * np.exp(1j * (out["r.angle"] + 0.7))
    uniform = turning[0] + times * 300.0j * turning[0]
    found = out["r.middle.x"] + 1j * out["r.middle.y"]
    assert np.abs(found - (uniform - turning)).max() < 1e-9 * np.abs(found).max()
    assert out["r.speed"][-1] > 500.0


def test_a_floating_gyroscope_keeps_its_lateral_angular_momentum_while_it_spins_up():
    """d/dt (I b_x' + Om J b_y) = 0: Om' G and Om G are two parts of one derivative."""
    disk = dict(position=0.2, mass=10.0, polar_inertia=0.3, diametral_inertia=0.16)
    shaft = rotor("r", 200.0, disk=[disk], torque=[dict(name="t", position=0.2, value=3000.0)])
    model = dict(material=LIGHT, rotor=[shaft], simulation=dict(speed="free"), basis=dict(lateral_modes=2, torsional_modes=1))
    s = reference.System(model)
    i = 2 * s.rotors["r"].node(0.2) + 1
    phi = s.phi["r"][0][i]
    velocity = s.rigid @ s.speed0
    velocity[s.at["r"][0]] += 0.5 * phi                                    # a tilting motion
    out = reference.simulate(s, 0.02, np.linspace(0.0, 0.02, 50), initial=(np.zeros(s.n), velocity))
    q, v = out["state"][:, :s.n], out["state"][:, s.n:]
    bx, by = (q[:, s.at["r"][plane]] @ phi for plane in (0, 1))
    dbx, dby = (v[:, s.at["r"][plane]] @ phi for plane in (0, 1))
    hx, hy = 0.16 * dbx + out["r.speed"] * 0.3 * by, 0.16 * dby - out["r.speed"] * 0.3 * bx
    assert out["r.speed"][-1] > 390.0
    # 1e-6: the shaft has inertia too.
    assert max(np.ptp(hx), np.ptp(hy)) < 1e-6 * np.abs(0.16 * dbx).max()


BOW = dict(positions=[0.05, 0.2, 0.35], amplitudes=[1e-5, 6e-5, 3e-5], phase=0.6)
OFFSET = 6e-5 - (1e-5 + 3e-5) / 2        # of the middle from the line through the bearings


def bowed(speed, material, full=False):
    disk = dict(position=0.2, mass=30.0, polar_inertia=0.0, diametral_inertia=0.0)
    shaft = rotor("r", speed, bow=[BOW], disk=[disk], bearing=bearings(), probe=[dict(name="middle", position=0.2)])
    basis = dict(lateral_modes=4, torsional_modes=1, static_shapes=True)
    s = reference.System(dict(material=material, rotor=[shaft], basis=basis), full)
    q = np.linalg.solve(s.stiffness - speed ** 2 * s.mass + 1j * speed * s.damping, s.bow[:, 0])
    return s, q                                                            # the steady state is Re q e^{i speed t}


def test_bow_slow_roll():
    """Slowly turned, the shaft shows its bow less the line through the bearings, and loads nothing: a shaft on two
    bearings is statically determinate."""
    s, q = bowed(1e-3, STEEL, full=True)
    x, y, _ = s.rows("r", 0.2)
    # 1e-6: the condition of the finite elements.
    assert x @ q == pytest.approx(OFFSET * np.exp(0.6j), rel=1e-6)
    assert y @ q == pytest.approx(-1j * OFFSET * np.exp(0.6j), rel=1e-6)
    out = reference.simulate(s, 1e-9, [0.0], initial=(q.real, np.zeros(s.n)))
    assert np.abs(out["r.b0.force_x"]).max() < 1e-3


def test_bow_amplification():
    """A massless shaft with a disk shows r / (1 - (Om/w)^2) there; and a run that begins in that state stays in it."""
    speed = 600.0
    s, q = bowed(speed, LIGHT)
    x = s.rows("r", 0.2)[0]
    ratio = speed ** 2 * 30.0 * (x @ np.linalg.solve(s.stiffness, x))
    assert 0.1 < ratio < 0.9
    assert x @ q == pytest.approx(OFFSET / (1 - ratio) * np.exp(0.6j), rel=1e-5)
    s, q = bowed(speed, STEEL)
    times = np.linspace(0.0, 0.005, 20)
    out = reference.simulate(s, 0.005, times, initial=(q.real, (1j * speed * q).real))
    expected = (s.rows("r", 0.2)[0] @ q) * np.exp(1j * speed * times)
    assert out["r.middle.x"] == pytest.approx(expected.real, abs=1e-9 * abs(expected[0]))


def test_energy_is_kept_through_impacts():
    """Without damping: kinetic, elastic and contact energy of a train that rattles between both flanks."""
    mesh = dict(contact="unilateral", backlash=2e-5)
    model = pair(basis=dict(lateral_modes=3, torsional_modes=2), mesh=mesh, simulation=dict(start="rest"))
    for r in model["rotor"]:
        for b in r["bearing"]:
            b["damping"] = dict(xx=0.0)
    s = reference.System(model)
    velocity = s.rigid @ np.array([2.0, -0.5])
    out = reference.simulate(s, 0.02, np.linspace(0.0, 0.02, 400), initial=(np.zeros(s.n), velocity))
    q, v = out["state"][:, :s.n], out["state"][:, s.n:]
    d = np.maximum(q @ s.right.T - s.gap, 0.0)
    energy = (np.sum(v @ s.mass * v, axis=1) + np.sum(q @ s.stiffness * q, axis=1) + 2e8 * np.sum(d ** 2, axis=1)) / 2
    force = out["mesh.force"]
    assert force.max() > 100.0 and force.min() < -100.0 and np.sum(force == 0) > 50
    assert np.ptp(energy) < 1e-8 * energy[0]


def test_torque_reversal_through_backlash():
    """Rigid rotors: spring, free flight across the gap, spring; by hand."""
    model = pair(basis=TORSION_ONLY, torques=(40.0, 80.0), mesh=dict(contact="unilateral", backlash=1e-4))
    s = reference.System(model)
    j1, j2 = (r.j.sum() for r in s.rotors.values())
    m, k, load, gap = 1 / (0.04 ** 2 / j1 + 0.08 ** 2 / j2), 2e8, 1000.0, 1e-4
    turned = {f"{name}.t": lambda t, value=value: value * (1.0 if t < 1e-3 else -1.0) for name, value in (("a", 40.0), ("b", 80.0))}
    times = np.linspace(0.0, 4e-3, 400)
    out = reference.simulate(s, 4e-3, times, torques=turned, knots=[1e-3])

    w, static = math.sqrt(k / m), load / k
    leave = math.acos(0.5) / w                                             # -d + 2 d cos(w t) = 0 from d
    speed = -2 * static * w * math.sin(w * leave)
    flight = (math.sqrt(speed ** 2 + 2 * load / m * gap) + speed) / (load / m)
    impact = speed - load / m * flight

    def by_hand(t):
        t -= 1e-3
        if t < 0:
            return static
        if t < leave:
            return -static + 2 * static * math.cos(w * t)
        t -= leave
        if t < flight:
            return speed * t - load / m * t ** 2 / 2
        t -= flight
        return -gap - static + static * math.cos(w * t) + impact / w * math.sin(w * t)

    first = times < 1e-3 + leave + flight + 0.5 * math.pi / w
    assert out["mesh.deflection"][first] == pytest.approx([by_hand(t) for t in times[first]], abs=1e-9 * gap)
    assert out["mesh.force"].max() == pytest.approx(load) and out["mesh.force"].min() < -2 * load


def test_a_mass_in_a_clearance_flies_and_rebounds():
    """Free flight across 2 c, then half a sine of length pi sqrt(m/k)."""
    k, c, v = 1e7, 2e-5, 0.05
    nonlinear = dict(law="clearance", clearance=c, stiffness=k)
    disk = dict(position=0.2, mass=10.0, polar_inertia=0.1, diametral_inertia=0.05)
    shaft = rotor("r", disk=[disk], bearing=bearings(0.0, places=(0.2,), nonlinear=nonlinear))
    s = reference.System(dict(material=LIGHT, rotor=[shaft], basis=dict(lateral_modes=2, torsional_modes=1)))
    x = s.rows("r", 0.2)[0]
    direction = s.minv @ x / (x @ s.minv @ x)
    mass = 1 / (x @ s.minv @ x)
    contact, flight = math.pi * math.sqrt(mass / k), 2 * c / v
    times = np.linspace(0.0, 2 * flight + 2 * contact, 300)
    out = reference.simulate(s, times[-1], times, initial=(np.zeros(s.n), v * direction))

    def by_hand(t):
        t, side = t - flight / 2, 1
        if t < 0:
            return v * (t + flight / 2)
        while t >= contact + flight:
            t, side = t - contact - flight, -side
        depth = v * math.sqrt(mass / k) * math.sin(t * math.sqrt(k / mass)) if t < contact else -v * (t - contact)
        return side * (c + depth)

    expected = np.array([by_hand(t) for t in times])
    assert out["r.b0.x"] == pytest.approx(expected, abs=1e-9 * c)
    assert out["r.b0.force_x"].max() == pytest.approx(v * math.sqrt(k * mass), rel=1e-3)


@pytest.mark.parametrize("law, penetration", [
    (dict(law="clearance", clearance=1e-5, stiffness=1e8), lambda f: f / 1e8 + 1e-5),
    (dict(law="cubic", coefficient=1e18, clearance=1e-5), lambda f: (f / 1e18) ** (1 / 3) + 1e-5),
    (dict(law="hertz", coefficient=1e10), lambda f: (f / 1e10) ** (2 / 3)),
    (dict(law="hertz", coefficient=5e8, exponent=10 / 9), lambda f: (f / 5e8) ** 0.9),
])
def test_equilibrium_in_nonlinear_bearings(law, penetration):
    """Half the mesh force is on each of two equal bearings; the shaft is as far off as the law wants for that."""
    model = pair(torques=(40.0, 80.0))
    for b in model["rotor"][0]["bearing"]:
        b.update(stiffness=dict(xx=0.0), nonlinear=law)
    out = reference.simulate(model, 1e-6, [0.0])
    force = 40.0 / 0.04
    assert out["mesh.force"][0] == pytest.approx(force, rel=1e-10)
    assert math.hypot(out["a.b0.x"][0], out["a.b0.y"][0]) == pytest.approx(penetration(force / 2), rel=1e-9)


def test_equilibrium_lies_on_the_flank_that_the_torque_asks_for():
    model = pair(torques=(-40.0, -80.0), mesh=dict(contact="unilateral", backlash=1e-4), basis=TORSION_ONLY)
    out = reference.simulate(model, 1e-6, [0.0])
    assert out["mesh.force"][0] == pytest.approx(-1000.0, rel=1e-9)
    assert out["mesh.deflection"][0] == pytest.approx(-1e-4 - 1000.0 / 2e8, rel=1e-9)


def test_free_spin_passes_the_breakpoints_as_prescribed_speed_does():
    """With a flywheel on each shaft the speed does not change, and both ways of switching the stiffness agree."""
    law = dict(law="rectangular", pair=1.5e8, contact_ratio=1.6)
    results, turned = [], 0.0
    for speed in ("free", "prescribed"):
        # In free spin the phase begins with the static rotation of the gear.
        mesh = dict(stiffness=law, phase=0.3 + 20 * turned / (2 * math.pi))
        model = pair(-500.0, torques=(40.0, 80.0), mesh=mesh, simulation=dict(speed=speed))
        for r in model["rotor"]:
            r["gear"][0]["polar_inertia"] *= 1e6
            r["gear"][0]["diametral_inertia"] *= 1e6
        results.append(reference.simulate(model, 0.005, np.linspace(0.0, 0.005, 300)))
        turned = (results[0]["a.angle"] + results[0]["a.gear.theta"])[0]
    free, prescribed = results
    for key in ("mesh.force", "a.b0.force_x", "a.gear.x", "mesh.deflection"):
        assert np.std(free[key] - prescribed[key]) < 1e-5 * np.std(prescribed[key]), key


def test_breakpoints_are_passed_backwards_too():
    """A wheel that is braked, stops and turns back: k(p) stays what the angle says."""
    law = dict(law="rectangular", single=2e8, double=3e8, contact_ratio=1.5)
    model = pair(60.0, torques=(-60.0, 60.0), mesh=dict(stiffness=law), simulation=dict(speed="free"), basis=TORSION_ONLY)
    times = np.linspace(0.0, 0.03, 3000)
    out = reference.simulate(model, 0.03, times, rtol=1e-9)
    assert out["a.speed"][-1] < -20.0
    phase = 20 * (out["a.angle"] + out["a.gear.theta"]) / (2 * math.pi) % 1.0
    clear = np.abs((phase + 0.25) % 0.5 - 0.25) > 1e-9
    assert np.array_equal(out["mesh.stiffness"][clear], np.where(phase < 0.5, 3e8, 2e8)[clear])
    assert np.count_nonzero(np.diff(out["mesh.stiffness"])) > 8


def test_rectangular_stiffness_is_a_sequence_of_matrix_exponentials():
    law = dict(law="rectangular", single=2e8, double=3e8, contact_ratio=1.5)
    model = pair(300.0, torques=(40.0, 80.0), mesh=dict(stiffness=law, damping_ratio=0.05))
    s = reference.System(model)
    m = s.meshes[0]
    q0, _ = start = reference.simulation.start(s, {}, {})
    state, period = np.concatenate([q0, np.zeros(s.n), [1.0]]), 2 * math.pi / (300.0 * 20)
    for k in (3e8, 2e8) * 3:
        stiffness, damping = s.stiffness + k * np.outer(m.right, m.right), s.damping + m.c * np.outer(m.right, m.right)
        a = np.block([[np.zeros((s.n, s.n)), np.eye(s.n), np.zeros((s.n, 1))],
                      [-s.minv @ stiffness, -s.minv @ damping, (s.minv @ s.torque)[:, None]], [np.zeros((1, 2 * s.n + 1))]])
        state = expm(a * period / 2) @ state
    found = reference.simulate(s, 3 * period, [3 * period], initial=start)["state"][0]
    assert found == pytest.approx(state[:-1], rel=1e-8, abs=1e-8 * np.abs(state[:-1]).max())


def test_bearing_coefficients_over_the_speed():
    """Two entries are a straight line; beyond the ends the end values hold; free spin sees the same."""
    table = [dict(speed=0.0, stiffness=dict(xx=4e7), damping=dict(xx=100.0)),
             dict(speed=400.0, stiffness=dict(xx=8e7, xy=1e7, yx=-1e7), damping=dict(xx=500.0))]
    results = []
    for speed, changed in (("prescribed", False), ("prescribed", True), ("free", True)):
        model = pair(-300.0, torques=(40.0, 80.0), simulation=dict(speed=speed, start="rest"))
        for r in model["rotor"]:
            r["gear"][0]["polar_inertia"] *= 1e6
            r["gear"][0]["diametral_inertia"] *= 1e6
        b = model["rotor"][0]["bearing"][0]
        b.update(stiffness=dict(xx=7e7, xy=7.5e6, yx=-7.5e6), damping=dict(xx=400.0))
        if changed:
            del b["stiffness"], b["damping"]
            b.update(at_speed=copy.deepcopy(table), outside_speeds="hold")
        results.append(reference.simulate(model, 0.004, np.linspace(0.0, 0.004, 100)))
    for other in results[1:]:
        for key in ("a.b0.force_x", "a.b0.force_y", "a.gear.x"):
            assert np.std(other[key] - results[0][key]) < 1e-6 * np.std(results[0][key]), key
