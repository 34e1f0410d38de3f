"""Run the four cases of the paper through FMPy and draw its figures 5 to 16 again.

The model is the three-stage geared rotor of Choy, Tu, Zakrajsek and Townsend (1991), see `three_stage.toml`:

    case 1   no gearbox vibration   small imbalance
    case 2   gearbox vibration      small imbalance
    case 3   no gearbox vibration   large imbalance
    case 4   gearbox vibration      large imbalance

The paper gives the frequency of the gearbox vibration, 1200 Hz, but no amplitudes. The 25e-6 m (x and y a quarter
period apart), 5e-6 kg m and 1.5e-4 kg m below are our assumptions: compare which lines stand out, not how high they are.
Every case is evaluated after SETTLING_TIME; with SETTLING_TIME = 0 the free lateral vibration of the start is seen.

    python paper_cases.py three_stage.fmu OUTPUT_FOLDER

writes the evaluated window of each case as case_1.csv ... case_4.csv (SI units, the FMU's names), and the pictures.
It needs fmpy, numpy and matplotlib (`requirements.txt`).
"""
import argparse
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np
from fmpy import simulate_fmu

matplotlib.use("Agg")  # draws into files, needs no screen
import matplotlib.pyplot as plt  # noqa: E402

STEP = 2e-5  # communication step [s]: sampling at 50 kHz
SETTLING_TIME = 3.5  # [s]; the lateral vibration of stage 3 at 110 Hz decays slowest
WINDOW = 0.5  # evaluated after that [s]: a spectral line every 2 Hz
SAMPLES = round(WINDOW / STEP)

STAGES = ("stage1", "stage2", "stage3")
MESHES = {"mesh12": "stage2", "mesh13": "stage3"}  # and the stage each one drives
ORDINALS = ("first", "second")
LATERAL_FREQUENCIES = {"stage1": (115, 145), "stage2": (160, 189), "stage3": (110, 200)}  # Table I [Hz]
TORSIONAL_FREQUENCIES = {"stage1": (355, 1090), "stage2": (550, 1610), "stage3": (280, 820)}  # Table I [Hz]
ROTATION, VIBRATION, MESHING = 50, 1200, 1800  # [Hz]

MICRO, KILO = 1e6, 1e-3  # from SI to the units of the pictures
LATERAL_UNIT, TORSIONAL_UNIT = "µm √kg", "µrad √(kg m²)"  # modal coordinates are mass-normalised

COLOUR = {"stage1": "#0072B2", "stage2": "#D55E00", "stage3": "#009E73"}  # Okabe and Ito: safe for the colour-blind
NATURAL = "#CC79A7"  # marks natural frequencies


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


def recorded_variables() -> list[str]:
    names = [f"{mesh}.force" for mesh in MESHES]
    for stage in STAGES:
        names += [f"{stage}.gear.{axis}" for axis in "xy"]
        names += [f"{stage}.modal.{axis}[{mode}]" for axis in ("x", "y", "theta") for mode in (1, 2)]
    return names


def progress_line(stop_time: float) -> Callable[..., bool]:
    """A callback for simulate_fmu that adds to the current line at every 20 %."""
    percent = 0

    def step_finished(time: float, _recorder) -> bool:
        nonlocal percent
        if time > stop_time * (percent + 20) / 100 - STEP / 2:
            percent += 20
            print(f" {percent} %", end="", flush=True)
        return True  # go on

    return step_finished


def simulate(fmu: Path, case: Case) -> np.ndarray:
    """Run one case; returns the evaluated window, a structured array with one field per variable."""
    start_values = {f"{stage}.gear_unbalance.moment": case.imbalance for stage in STAGES}
    start_values |= {f"gearbox_vibration.amplitude_{axis}": case.vibration for axis in "xy"}
    stop_time = SETTLING_TIME + WINDOW
    print(f"{case.title}:", end="", flush=True)
    result = simulate_fmu(fmu, stop_time=stop_time, output_interval=STEP, start_values=start_values,
                          output=recorded_variables(), step_finished=progress_line(stop_time))
    print()
    return np.asarray(result)[-SAMPLES:]


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


def print_table(result: np.ndarray) -> None:
    quantities = [(f"{mesh}.force", KILO, "kN") for mesh in MESHES]
    quantities += [(f"{stage}.gear.{axis}", MICRO, "um") for stage in STAGES for axis in "xy"]
    quantities += [(f"{stage}.modal.x[{mode}]", MICRO, "um sqrt(kg)") for mode in (1, 2) for stage in STAGES]
    quantities += [(f"{stage}.modal.theta[{mode}]", MICRO, "urad sqrt(kg m2)") for mode in (1, 2) for stage in STAGES]
    print(f"\n{'case 4':22}{'mean':>9}   strongest lines: amplitude @ frequency [Hz]")
    for name, factor, unit in quantities:
        signal = factor * result[name]
        lines = "".join(f"{height:9.3f} @{frequency:5.0f}" for frequency, height in strongest_lines(signal, 4))
        print(f"{name:22}{one_decimal(signal.mean()):>9}{lines}  {unit}")


def one_decimal(value: float) -> str:
    return f"{round(value, 1) + 0.0:.1f}"  # + 0.0 turns -0.0 into 0.0


def draw_time(ax, signal: np.ndarray, duration: float, colour: str, title: str) -> None:
    """The last part of a signal about its mean, the mean above it."""
    count = round(duration / STEP)
    ax.plot(1e3 * STEP * np.arange(count), (signal - signal.mean())[-count:], color=colour, linewidth=0.8)
    ax.set(xlim=(0, 1e3 * duration), xlabel="time, ms")
    ax.set_title(title, loc="left", fontsize=8)
    ax.set_title(f"mean {one_decimal(signal.mean())}", loc="right", fontsize=8)


def draw_spectrum(ax, signal: np.ndarray, upper_limit: float, colour: str, excitation, natural) -> None:
    """The amplitudes, with excitation frequencies (dotted, numbered) and natural frequencies (dashed)."""
    for line in excitation:
        ax.axvline(line, color="0.5", linewidth=0.8, linestyle=":", zorder=0)
        ax.annotate(f"{line}", (line, 1.0), (0, 2), xycoords=("data", "axes fraction"), textcoords="offset points",
                    ha="center", fontsize=7.5, color="0.3")
    for line in natural:
        ax.axvline(line, color=NATURAL, linewidth=1.0, linestyle="--", zorder=0)
    ax.semilogy(*spectrum(signal), color=colour, linewidth=1.0)
    ax.set(xlim=(-upper_limit / 100, upper_limit), xlabel="frequency, Hz")


def save(figure, path: Path) -> None:
    figure.savefig(path, dpi=150)
    plt.close(figure)
    print(f"written: {path}")


def plot_orbits(results: list[np.ndarray], path: Path) -> None:
    """Figures 5 to 7: rows are stages, columns cases; an orbit too small for the scale of its row is magnified."""
    figure, axes = plt.subplots(3, 4, figsize=(13, 12), sharex="row", sharey="row", layout="constrained")
    revolution = round(1 / ROTATION / STEP)
    for row, stage in enumerate(STAGES):
        signals = [[MICRO * result[f"{stage}.gear.{axis}"] for axis in "xy"] for result in results]
        reach = 1.1 * max(np.abs(s - s.mean()).max() for orbit in signals for s in orbit)
        for ax, case, (x, y) in zip(axes[row], CASES, signals):
            orbit = [(s - s.mean())[-revolution:] for s in (x, y)]
            ax.plot(*orbit, color=COLOUR[stage], linewidth=0.7)
            ax.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xlabel="x, µm")
            if np.abs(orbit).max() < reach / 10:
                inset = ax.inset_axes((0.58, 0.1, 0.4, 0.4), title="magnified", aspect="equal", xticks=())
                inset.plot(*orbit, color=COLOUR[stage], linewidth=0.7)
            mean = f"mean ({one_decimal(x.mean())}, {one_decimal(y.mean())})"
            ax.set_title(f"{case.title}\n{mean}, peak-peak {np.ptp(x):.2f} × {np.ptp(y):.2f}", fontsize=8)
        axes[row, 0].set_ylabel(f"Figure {5 + row}: stage {row + 1}\ny, µm")
    figure.suptitle("Figures 5 to 7: orbits of the gears about their mean, one revolution (in µm, one scale per row)")
    save(figure, path)


def plot_lateral_mode(results: list[np.ndarray], mode: int, first_figure: int, path: Path) -> None:
    """Figures 8 to 10 (mode 1) or 11 to 13 (mode 2): one block per stage, columns are cases."""
    figure = plt.figure(figsize=(14, 14), layout="constrained")
    figure.suptitle(f"Figures {first_figure} to {first_figure + 2}: {ORDINALS[mode - 1]} lateral modal coordinate in x")
    for row, (stage, block) in enumerate(zip(STAGES, figure.subfigures(3, 1, hspace=0.03))):
        natural = LATERAL_FREQUENCIES[stage][mode - 1]
        heading = f"Figure {first_figure + row}: stage {row + 1} (dashed: natural frequency {natural} Hz)"
        block.suptitle(heading, fontsize=11)
        upper, lower = block.subplots(2, 4, sharex="row", sharey="row")
        for column, (case, result) in enumerate(zip(CASES, results)):
            signal = MICRO * result[f"{stage}.modal.x[{mode}]"]
            draw_time(upper[column], signal, 2 / ROTATION, COLOUR[stage], case.title)
            draw_spectrum(lower[column], signal, 2000, COLOUR[stage], (ROTATION, VIBRATION, MESHING), (natural,))
        upper[0].set_ylabel(f"about mean, {LATERAL_UNIT}")
        lower[0].set(ylim=(1e-4, 2e3), ylabel=f"amplitude, {LATERAL_UNIT}")
    save(figure, path)


def plot_mesh_forces(result: np.ndarray, path: Path) -> None:
    """Figure 14. Sampling folds the weak harmonics above 25 kHz back, for example 25 * 1800 Hz to 5000 Hz."""
    figure, axes = plt.subplots(2, 2, figsize=(13, 7), sharey="col", width_ratios=(1, 1.6), layout="constrained")
    natural = [TORSIONAL_FREQUENCIES[stage][0] for stage in STAGES]
    for (left, right), (mesh, driven) in zip(axes, MESHES.items()):
        force = KILO * result[f"{mesh}.force"]
        draw_time(left, force, 5 / MESHING, COLOUR[driven], f"Mesh of stages 1 and {driven[-1]}")
        draw_spectrum(right, force, 6000, COLOUR[driven], (VIBRATION, MESHING, 2 * MESHING, 3 * MESHING), natural)
        left.set_ylabel("force about mean, kN")
        right.set(ylim=(1e-4, 30), ylabel="amplitude, kN")
    figure.suptitle("Figure 14: mesh forces in case 4 (dashed: first torsional frequencies 280, 355, 550 Hz)")
    save(figure, path)


def plot_torsional_modes(result: np.ndarray, path: Path) -> None:
    """Figures 15 and 16: one block per mode, columns are stages."""
    figure = plt.figure(figsize=(13, 10), layout="constrained")
    figure.suptitle("Figures 15 and 16: torsional modal coordinates in case 4 (dashed: natural frequency)")
    for row, block in enumerate(figure.subfigures(2, 1, hspace=0.03)):
        block.suptitle(f"Figure {15 + row}: {ORDINALS[row]} torsional mode", fontsize=11)
        upper, lower = block.subplots(2, 3, sharex="row", sharey="row")
        for column, stage in enumerate(STAGES):
            signal = MICRO * result[f"{stage}.modal.theta[{row + 1}]"]
            natural = TORSIONAL_FREQUENCIES[stage][row]
            draw_time(upper[column], signal, 5 / MESHING, COLOUR[stage], f"Stage {column + 1}, {natural} Hz")
            draw_spectrum(lower[column], signal, 2000, COLOUR[stage], (VIBRATION, MESHING), (natural,))
        upper[0].set_ylabel(f"about mean, {TORSIONAL_UNIT}")
        lower[0].set(ylim=(1e-4, 2e4), ylabel=f"amplitude, {TORSIONAL_UNIT}")
    save(figure, path)


def main() -> None:
    parser = argparse.ArgumentParser(description="Run the four cases of the paper and draw its figures 5 to 16.")
    parser.add_argument("fmu", type=Path, help="the FMU packed from three_stage.toml")
    parser.add_argument("output", type=Path, help="folder for CSV files and pictures, made if missing")
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    results = [simulate(arguments.fmu, case) for case in CASES]
    for number, result in enumerate(results, start=1):
        path = arguments.output / f"case_{number}.csv"
        np.savetxt(path, result, fmt="%.9g", delimiter=",", header=",".join(result.dtype.names), comments="")
        print(f"written: {path}")
    plt.rcParams.update({"font.size": 9, "figure.titlesize": 14, "axes.grid": True, "grid.alpha": 0.25})
    plot_orbits(results, arguments.output / "figures_05_07_orbits.png")
    plot_lateral_mode(results, 1, 8, arguments.output / "figures_08_10_first_lateral_mode.png")
    plot_lateral_mode(results, 2, 11, arguments.output / "figures_11_13_second_lateral_mode.png")
    plot_mesh_forces(results[-1], arguments.output / "figure_14_mesh_forces.png")
    plot_torsional_modes(results[-1], arguments.output / "figures_15_16_torsional_modes.png")
    print_table(results[-1])
    print(f"\nCSV files and pictures are in {arguments.output.resolve()}")


if __name__ == "__main__":
    main()
