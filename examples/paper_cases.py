"""Reproduce Table I and figures 3 to 16 of the paper: four cases of excitation, simulated by the FMU.

The model is the three-stage geared rotor of Choy, Tu, Zakrajsek and Townsend (1991), see `three_stage.toml`:

    case 1   no gearbox vibration   small imbalance
    case 2   gearbox vibration      small imbalance
    case 3   no gearbox vibration   large imbalance
    case 4   gearbox vibration      large imbalance

The paper gives the frequency of the gearbox vibration, 1200 Hz, but no amplitudes. The 25e-6 m (x and y a quarter
period apart), 5e-6 kg m and 1.5e-4 kg m below are our assumptions: compare which lines stand out, not their heights.
Each case is evaluated twice: in the first half second, in which the start from the static equilibrium still rings, and
after 3.5 s, when that has gone.

    cargo xtask inspect examples/three_stage.toml --format json > inspection.json
    python examples/paper_cases.py target/fmu/three_stage.fmu inspection.json OUTPUT_FOLDER

writes one picture per figure, table_1.csv, and the settled half second of each case as case_1.csv ... case_4.csv (SI
units, the FMU's names).
"""

import argparse
import csv
import json
from dataclasses import dataclass
from pathlib import Path

import fmpy
import matplotlib
import numpy as np

matplotlib.use("Agg")  # draws into files, needs no screen
import matplotlib.pyplot as plt  # noqa: E402

STEP = 2e-5  # communication step [s]: sampling at 50 kHz
WINDOW = 0.5  # length of what is evaluated [s]: a spectral line every 2 Hz
SETTLED = 3.5  # start of the second window [s]; the lateral vibration of stage 3 at 110 Hz decays slowest
SAMPLES = round(WINDOW / STEP)

STAGES = ("stage1", "stage2", "stage3")
ROMAN = dict(zip(STAGES, ("I", "II", "III")))
MESHES = {"mesh12": "stage2", "mesh13": "stage3"}  # and the stage each one drives
LATERAL = {"stage1": (115, 145), "stage2": (160, 189), "stage3": (110, 200)}  # Table I [Hz]
TORSIONAL = {"stage1": (355, 1090), "stage2": (550, 1610), "stage3": (280, 820)}  # Table I [Hz]
ROTATION, VIBRATION, MESHING = 50, 1200, 1800  # [Hz]

MICRO, KILO = 1e6, 1e-3  # from SI to the units of the pictures
LATERAL_UNIT, TORSIONAL_UNIT = "µm √kg", "µrad √(kg m²)"  # modal coordinates are mass-normalised

COLOUR = {"stage1": "#0072B2", "stage2": "#D55E00", "stage3": "#009E73"}  # Okabe and Ito: safe for the colour-blind
NATURAL, START = "#AA3377", "0.75"  # natural frequencies; spectra of the first half second


@dataclass(frozen=True)
class Case:
    title: str
    vibration: float  # amplitude of the gearbox at every bearing [m]
    imbalance: float  # of each gear [kg m]


CASES = (
    Case("Case 1: no vibration, small imbalance", 0.0, 5e-6),
    Case("Case 2: vibration, small imbalance", 25e-6, 5e-6),
    Case("Case 3: no vibration, large imbalance", 0.0, 1.5e-4),
    Case("Case 4: vibration, large imbalance", 25e-6, 1.5e-4),
)


@dataclass(frozen=True)
class Result:
    """One structured array per window, with a field per variable."""
    start: np.ndarray
    settled: np.ndarray


def recorded_variables() -> list[str]:
    names = [f"{mesh}.force" for mesh in MESHES]
    for stage in STAGES:
        names += [f"{stage}.gear.{axis}" for axis in "xy"]
        names += [f"{stage}.modal.{axis}[{mode}]" for axis in ("x", "y", "theta") for mode in (1, 2)]
    return names


def simulate(fmu: Path, case: Case) -> Result:
    """Run one case in three pieces: two windows sampled every STEP, and one long step between them."""
    description = fmpy.read_model_description(fmu)
    instance = fmpy.instantiate_fmu(fmpy.extract(fmu), description)
    start_values = {f"{stage}.gear_unbalance.moment": case.imbalance for stage in STAGES}
    start_values |= {f"gearbox_vibration.amplitude_{axis}": case.vibration for axis in "xy"}

    def piece(begin: float, end: float, step: float, **options) -> np.ndarray:
        result = fmpy.simulate_fmu(fmu, start_time=begin, stop_time=end, output_interval=step,
                                   output=recorded_variables(), model_description=description, fmu_instance=instance,
                                   initialize=begin == 0.0, terminate=end > SETTLED, set_stop_time=False, **options)
        return np.asarray(result)[:-1]

    start = piece(0.0, WINDOW, STEP, start_values=start_values)
    piece(WINDOW, SETTLED, SETTLED - WINDOW)
    settled = piece(SETTLED, SETTLED + WINDOW, STEP)
    instance.freeInstance()
    return Result(start, settled)


def spectrum(signal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies [Hz] and single-sided amplitudes: a sinusoid shows its amplitude, 0 Hz the magnitude of the mean."""
    hann = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(SAMPLES) / SAMPLES)
    amplitude = 2 * np.abs(np.fft.rfft((signal - signal.mean()) * hann)) / hann.sum()
    amplitude[0] = abs(signal.mean())
    return np.fft.rfftfreq(SAMPLES, STEP), amplitude


def strongest_lines(signal: np.ndarray, count: int) -> list[tuple[float, float]]:
    """The highest peaks of the spectrum above 0 Hz as (frequency [Hz], amplitude), highest first."""
    frequency, amplitude = spectrum(signal)
    peaks = 1 + np.flatnonzero((amplitude[1:-1] > amplitude[:-2]) & (amplitude[1:-1] > amplitude[2:]))
    highest = peaks[np.argsort(-amplitude[peaks])][:count]
    return [(frequency[i], amplitude[i]) for i in highest]


def short(value: float) -> str:
    return f"{round(value, 1) + 0.0:.1f}"  # + 0.0 turns -0.0 into 0.0


def table_1(rotors: list[dict], path: Path) -> None:
    """Table I beside the frequencies of the model."""
    rows = []
    for kind, published in (("torsional", TORSIONAL), ("lateral", LATERAL)):
        for rotor in rotors:
            for mode, (ours, paper) in enumerate(zip(rotor[f"{kind}_frequencies"], published[rotor["name"]]), start=1):
                rows.append((kind, mode, rotor["name"], f"{ours:.2f}", paper, f"{100 * (ours / paper - 1):+.2f}"))
    header = ("kind", "mode", "rotor", "computed_hz", "table_1_hz", "deviation_percent")
    with open(path, "w", newline="") as file:
        csv.writer(file).writerows([header, *rows])
    print("\nTable I           " + "".join(f"{f'stage {ROMAN[stage]} [Hz]':>20}" for stage in STAGES))
    for kind, mode in sorted({row[:2] for row in rows}, reverse=True):
        of_mode = [row for row in rows if row[:2] == (kind, mode)]
        cells = [f"{ours:>9} (paper {paper})" for *_, ours, paper, _ in of_mode]
        print(f"{kind:>11} {mode:<6}" + "".join(f"{cell:>20}" for cell in cells))


def print_lines(result: np.ndarray) -> None:
    """The strongest lines of the settled case 4."""
    quantities = [(f"{mesh}.force", KILO, "kN") for mesh in MESHES]
    quantities += [(f"{stage}.gear.{axis}", MICRO, "um") for stage in STAGES for axis in "xy"]
    quantities += [(f"{stage}.modal.x[{mode}]", MICRO, "um sqrt(kg)") for mode in (1, 2) for stage in STAGES]
    quantities += [(f"{stage}.modal.theta[{mode}]", MICRO, "urad sqrt(kg m2)") for mode in (1, 2) for stage in STAGES]
    print(f"\n{'case 4, settled':22}{'mean':>9}   strongest lines: amplitude @ frequency [Hz]")
    for name, factor, unit in quantities:
        signal = factor * result[name]
        lines = "".join(f"{height:9.3f} @{frequency:5.0f}" for frequency, height in strongest_lines(signal, 4))
        print(f"{name:22}{short(signal.mean()):>9}{lines}  {unit}")


def draw_time(ax, signal: np.ndarray, duration: float, colour: str, unit: str, title: str) -> None:
    """The last part of a signal about its mean, the mean above it."""
    count = round(duration / STEP)
    ax.plot(1e3 * STEP * np.arange(count), (signal - signal.mean())[-count:], color=colour, linewidth=0.9)
    ax.set(xlim=(0, 1e3 * duration), xlabel="time, ms")
    ax.set_title(title, loc="left")
    ax.set_title(f"mean {short(signal.mean())} {unit}", loc="right")


def draw_spectrum(ax, start: np.ndarray, settled: np.ndarray, highest: float, colour: str, excitation, natural) -> None:
    """Settled amplitudes before those of the start; excitation (dotted) and natural frequencies (dashed) are marked."""
    label = dict(xycoords=("data", "axes fraction"), textcoords="offset points", fontsize=8)
    for line in excitation:
        ax.axvline(line, color="0.35", linewidth=1.0, linestyle=":", zorder=0)
        ax.annotate(f"{line}", (line, 1.0), (0, 2), ha="center", color="0.35", **label)
    for index, line in enumerate(sorted(natural)):
        ax.axvline(line, color=NATURAL, linewidth=1.0, linestyle="--", zorder=0)
        below = -3 - 22 * (index % 2)  # neighbours may be close
        ax.annotate(f"{line}", (line, 1.0), (2, below), va="top", rotation=90, color=NATURAL, **label)
    ax.semilogy(*spectrum(start), color=START, linewidth=1.6, label=f"first {WINDOW} s")
    ax.semilogy(*spectrum(settled), color=colour, linewidth=1.1, label="settled")
    ax.set(xlim=(-highest / 100, highest), xlabel="frequency, Hz")


def save(figure, title: str, path: Path) -> None:
    figure.suptitle(title)
    figure.savefig(path, dpi=110)
    plt.close(figure)
    print(f"written: {path}")


def plot_mode_shapes(rotors: list[dict], mode: int, path: Path) -> None:
    """Figures 3 and 4: columns are stages."""
    figure, axes = plt.subplots(2, 3, figsize=(13, 6.5), sharey="row", layout="constrained")
    for column, rotor in zip(axes.T, rotors):
        for ax, kind in zip(column, ("lateral", "torsional")):
            shapes = rotor["mode_shapes"]
            shape = np.array(shapes[kind][mode - 1])
            shape *= np.sign(shape[np.argmax(np.abs(shape))])  # a mode has no sign of its own
            ax.axhline(0, color="0.6", linewidth=0.8)
            ax.plot(shapes["positions"], shape, color=COLOUR[rotor["name"]], linewidth=1.8)
            for mark, label, places in (("^", "bearing", rotor["bearings"]), ("o", "gear", rotor["gears"])):
                z = [place["position"] for place in places]
                height = np.interp(z, shapes["positions"], shape) if mark == "o" else np.zeros(len(z))
                if mark == "o" or kind == "lateral":
                    ax.plot(z, height, mark, color="0.2", markerfacecolor="white", label=label)
            ax.set(xlabel="z, m")
            ax.set_title(f"stage {ROMAN[rotor['name']]}, {kind}: {rotor[f'{kind}_frequencies'][mode - 1]:.0f} Hz")
    axes[0, 0].legend(loc="best", frameon=False)
    axes[0, 0].set_ylabel("displacement, 1/√kg")
    axes[1, 0].set_ylabel("rotation, 1/√(kg m²)")
    order = ("First", "Second")[mode - 1]
    save(figure, f"Figure {mode + 2}: {order} vibration modes of the three rotors (mass normalised)", path)


def plot_orbits(results: list[Result], stage: str, number: int, path: Path) -> None:
    """Figures 5 to 7: one panel per case; an orbit too small for the common scale is magnified."""
    figure, axes = plt.subplots(2, 2, figsize=(10, 10.4), sharex=True, sharey=True, layout="constrained")
    revolution = round(1 / ROTATION / STEP)
    signals = [[MICRO * result.settled[f"{stage}.gear.{axis}"] for axis in "xy"] for result in results]
    reach = 1.1 * max(np.abs(s - s.mean()).max() for orbit in signals for s in orbit)
    for letter, ax, case, (x, y) in zip("abcd", axes.flat, CASES, signals):
        orbit = [(s - s.mean())[-revolution:] for s in (x, y)]
        ax.plot(*orbit, color=COLOUR[stage], linewidth=0.9)
        ax.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xlabel="x, µm", ylabel="y, µm")
        if np.abs(orbit).max() < reach / 8:
            inset = ax.inset_axes((0.56, 0.08, 0.4, 0.4), aspect="equal")
            inset.set_title("magnified", fontsize=8)
            inset.tick_params(labelsize=7)
            inset.plot(*orbit, color=COLOUR[stage], linewidth=0.9)
        mean = f"mean ({short(x.mean())}, {short(y.mean())}) µm"
        ax.set_title(f"({letter}) {case.title}\n{mean}, peak-peak {np.ptp(x):.2f} × {np.ptp(y):.2f} µm", fontsize=9)
    title = f"Figure {number}: Orbit of the gear of stage {ROMAN[stage]} about its mean, one settled revolution"
    save(figure, title, path)


def plot_lateral_mode(results: list[Result], stage: str, mode: int, number: int, path: Path) -> None:
    """Figures 8 to 10 (mode 1) and 11 to 13 (mode 2): rows are cases, time and spectrum."""
    figure, axes = plt.subplots(4, 2, figsize=(13, 12.5), sharex="col", sharey="col", width_ratios=(1, 1.5),
                                layout="constrained")
    natural = LATERAL[stage][mode - 1]
    name = f"{stage}.modal.x[{mode}]"
    for letters, (left, right), case, result in zip(("ab", "cd", "ef", "gh"), axes, CASES, results):
        start, settled = MICRO * result.start[name], MICRO * result.settled[name]
        draw_time(left, settled, 2 / ROTATION, COLOUR[stage], LATERAL_UNIT, f"({letters[0]}) {case.title}")
        draw_spectrum(right, start, settled, 2000, COLOUR[stage], (ROTATION, VIBRATION, MESHING), (natural,))
        right.set_title(f"({letters[1]})", loc="right")
        left.set_ylabel(f"A{mode} about mean, {LATERAL_UNIT}")
        right.set(ylim=(1e-4, 3e3), ylabel=f"amplitude, {LATERAL_UNIT}")
    axes[0, 1].legend(loc="upper center", framealpha=1.0)
    order = ("First", "Second")[mode - 1]
    save(figure, f"Figure {number}: {order} lateral modal coordinate of stage {ROMAN[stage]}, in x "
                 f"(dashed: its natural frequency, {natural} Hz)", path)


def plot_mesh_forces(result: Result, path: Path) -> None:
    """Figure 14. Sampling folds the weak harmonics above 25 kHz back, for example 25 * 1800 Hz to 5000 Hz."""
    figure, axes = plt.subplots(2, 2, figsize=(13, 7), sharex="col", width_ratios=(1, 1.6), layout="constrained")
    natural = [TORSIONAL[stage][0] for stage in STAGES]
    for (left, right), (mesh, driven) in zip(axes, MESHES.items()):
        start, settled = KILO * result.start[f"{mesh}.force"], KILO * result.settled[f"{mesh}.force"]
        draw_time(left, settled, 5 / MESHING, COLOUR[driven], "kN", f"Stages I and {ROMAN[driven]}")
        excitation = (VIBRATION, MESHING, 2 * MESHING, 3 * MESHING)
        draw_spectrum(right, start, settled, 6000, COLOUR[driven], excitation, natural)
        left.set_ylabel("force about mean, kN")
        right.set(ylim=(1e-4, 30), ylabel="amplitude, kN")
    axes[0, 1].legend(loc="upper center", framealpha=1.0)
    save(figure, "Figure 14: Mesh forces in case 4 (dashed: first torsional frequencies of the rotors)", path)


def plot_torsional_mode(result: Result, mode: int, path: Path) -> None:
    """Figures 15 and 16: rows are stages, time and spectrum."""
    figure, axes = plt.subplots(3, 2, figsize=(13, 10), sharex="col", sharey="col", width_ratios=(1, 1.5),
                                layout="constrained")
    for (left, right), stage in zip(axes, STAGES):
        name, natural = f"{stage}.modal.theta[{mode}]", TORSIONAL[stage][mode - 1]
        start, settled = MICRO * result.start[name], MICRO * result.settled[name]
        draw_time(left, settled, 5 / MESHING, COLOUR[stage], TORSIONAL_UNIT, f"Stage {ROMAN[stage]}")
        draw_spectrum(right, start, settled, 2000, COLOUR[stage], (ROTATION, VIBRATION, MESHING), (natural,))
        left.set_ylabel(f"At{mode} about mean, {TORSIONAL_UNIT}")
        right.set(ylim=(1e-4, 2e4), ylabel=f"amplitude, {TORSIONAL_UNIT}")
    axes[0, 1].legend(loc="upper center", framealpha=1.0)
    order = ("First", "Second")[mode - 1]
    title = f"Figure {mode + 14}: {order} torsional modal coordinates in case 4 (dashed: their natural frequencies)"
    save(figure, title, path)


def main() -> None:
    parser = argparse.ArgumentParser(description="Reproduce Table I and figures 3 to 16 of the paper.")
    parser.add_argument("fmu", type=Path, help="the FMU packed from three_stage.toml")
    parser.add_argument("inspection", type=Path, help="what `cargo xtask inspect --format json` says of it")
    parser.add_argument("output", type=Path, help="folder for tables and pictures, made if missing")
    arguments = parser.parse_args()
    output = arguments.output
    output.mkdir(parents=True, exist_ok=True)
    plt.rcParams.update({"font.size": 9, "axes.titlesize": 9, "figure.titlesize": 13})
    plt.rcParams.update({"axes.grid": True, "grid.alpha": 0.25})

    rotors = json.loads(arguments.inspection.read_text(encoding="utf-8"))["rotors"]
    for mode in (1, 2):
        plot_mode_shapes(rotors, mode, output / f"figure_0{mode + 2}_mode_shapes.png")

    results = []
    for number, case in enumerate(CASES, start=1):
        print(f"simulating {case.title} ...", flush=True)
        results.append(simulate(arguments.fmu, case))
        settled = results[-1].settled
        np.savetxt(output / f"case_{number}.csv", settled, fmt="%.9g", delimiter=",",
                   header=",".join(settled.dtype.names), comments="")

    for index, stage in enumerate(STAGES):
        plot_orbits(results, stage, 5 + index, output / f"figure_{5 + index:02}_orbits.png")
        for mode in (1, 2):
            number = 5 + 3 * mode + index
            plot_lateral_mode(results, stage, mode, number, output / f"figure_{number:02}_lateral_mode_{mode}.png")
    plot_mesh_forces(results[-1], output / "figure_14_mesh_forces.png")
    for mode in (1, 2):
        plot_torsional_mode(results[-1], mode, output / f"figure_{14 + mode}_torsional_mode_{mode}.png")
    table_1(rotors, output / "table_1.csv")
    print_lines(results[-1].settled)
    print(f"\nTables and pictures are in {output.resolve()}")


if __name__ == "__main__":
    main()
