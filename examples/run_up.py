"""Run a gear train up from standstill and watch its spectrum over the speed: a waterfall plot.

    cargo xtask fmu examples/electric_drive.toml
    python examples/run_up.py target/fmu/electric_drive.fmu

Orders follow the speed and draw straight lines: once per revolution the imbalance, 23 times per revolution the teeth. Natural
frequencies do not move; where a line of the teeth crosses one, the spectrum shows a ridge.
"""

import argparse
from pathlib import Path

import matplotlib
import numpy as np
from fmpy import simulate_fmu

matplotlib.use("Agg")  # draws into files, needs no screen
import matplotlib.pyplot as plt  # noqa: E402

STEP = 5e-5  # communication step [s]: spectra up to 10 kHz
SPECTRA, LENGTH = 60, 2048  # number of spectra, and samples in each: 0.1 s
HIGHEST = 3000  # shown [Hz]
TEETH = 23  # of the pinion
FORCE = "motor.right.force_y"  # bearing force on the gearbox


def main() -> None:
    parser = argparse.ArgumentParser(description="Waterfall plot of a run-up.")
    parser.add_argument("fmu", type=Path)
    parser.add_argument("--stop", type=float, default=2.5, help="end of the run-up [s]")
    parser.add_argument("--output", type=Path, default=Path("target/examples"), help="folder for the picture")
    arguments = parser.parse_args()

    result = simulate_fmu(arguments.fmu, stop_time=arguments.stop, output_interval=STEP, output=[FORCE, "motor.speed"])
    force, speed = result[FORCE], result["motor.speed"] / (2 * np.pi)  # [N], [1/s]

    hann = np.hanning(LENGTH)
    frequencies = np.fft.rfftfreq(LENGTH, STEP)
    shown = frequencies < HIGHEST

    rpm = 60 * speed
    middle = rpm[LENGTH // 2:-LENGTH // 2]  # speed in the middle of the piece that starts at each sample
    bases = np.linspace(middle[0], middle[-1], SPECTRA)
    spectra = []
    for start in np.searchsorted(middle, bases):
        piece = force[start:start + LENGTH]
        spectra.append(2 * np.abs(np.fft.rfft((piece - piece.mean()) * hann))[shown] / hann.sum())
    highest = np.max(spectra)
    scale = 8 * (bases[1] - bases[0]) / highest  # the highest line is as high as eight distances between spectra

    figure, ax = plt.subplots(figsize=(11, 8), layout="constrained")
    for place, (base, amplitude) in enumerate(zip(bases, spectra)):
        ax.fill_between(frequencies[shown], base, base + scale * amplitude, facecolor="white", edgecolor="#0072B2",
                        linewidth=0.8, zorder=1 - place / SPECTRA)
    for order, name in ((1, "rotation"), (TEETH, "teeth"), (2 * TEETH, "teeth, twice")):
        end = min(rpm[-1], 60 * HIGHEST / order)
        ax.plot([0, order * end / 60], [0, end], color="#D55E00", linewidth=0.8, linestyle=":", zorder=2)
        ax.annotate(f"{order}x: {name}", (order * end / 60, end), (0, 3), textcoords="offset points", color="#D55E00",
                    ha="left" if order == 1 else "right")
    ax.set(xlim=(0, HIGHEST), ylim=(0, None), xlabel="frequency, Hz", ylabel="speed of the motor, rpm")
    ax.set_title(f"Run-up from standstill: {FORCE}, spectra of {LENGTH * STEP:.1f} s, highest line {highest:.0f} N")

    arguments.output.mkdir(parents=True, exist_ok=True)
    figure.savefig(arguments.output / "run_up.png", dpi=110)
    print(f"{rpm[-1]:.0f} rpm after {arguments.stop} s")
    print(f"written: {arguments.output / 'run_up.png'}")


if __name__ == "__main__":
    main()
