"""Shake the bearings of a gear train with a measured vibration of its gearbox.

    cargo xtask fmu examples/three_stage.toml
    python examples/measured_vibration.py target/fmu/three_stage.fmu examples/gearbox_vibration.csv

The CSV has the columns time_s, ax_m_s2, ay_m_s2: acceleration of the gearbox, evenly sampled. (The one beside this script is
generated, see `make_vibration.py`.) The FMU wants displacement and velocity of each bearing: acceleration is integrated twice in
the frequency domain, which also interpolates it to the communication step. Below LOWEST a sensor knows nothing, and
double integration would blow it up, so that is left out. Every bearing moves alike here; give each its own where you have it.
"""

import argparse
from pathlib import Path

import fmpy
import matplotlib
import numpy as np

matplotlib.use("Agg")  # draws into files, needs no screen
import matplotlib.pyplot as plt  # noqa: E402

LOWEST = 20.0  # [Hz]
FINER = 5  # communication steps per sample of the measurement


def integrate(acceleration: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Displacement and velocity, FINER times as often sampled; the record is taken as periodic."""
    count = len(acceleration)
    omega = 2 * np.pi * np.fft.rfftfreq(count, step)
    lines = np.fft.rfft(acceleration) * (omega >= 2 * np.pi * LOWEST)
    omega[0] = 1.0  # its line is zero
    return tuple(FINER * np.fft.irfft(lines / (1j * omega) ** power, FINER * count) for power in (2, 1))


def bearing_forces(fmu: Path, description, motion: dict[str, np.ndarray], step: float) -> dict[str, np.ndarray]:
    """Forces on the gearbox at all bearings while their housings move: x, y [m], vx, vy [m/s] over time."""
    references = {variable.name: variable.valueReference for variable in description.modelVariables}
    bearings = [name.removesuffix(".housing.x") for name in references if name.endswith(".housing.x")]
    inputs = [references[f"{bearing}.housing.{end}"] for end in motion for bearing in bearings]
    outputs = {f"{bearing}.force_{axis}": references[f"{bearing}.force_{axis}"] for bearing in bearings for axis in "xy"}

    instance = fmpy.instantiate_fmu(fmpy.extract(fmu), description)
    instance.setupExperiment()
    instance.enterInitializationMode()
    instance.exitInitializationMode()
    values = np.repeat(np.array(list(motion.values())), len(bearings), axis=0)
    rates = np.diff(values) / step
    forces = []
    for index in range(len(rates[0])):
        instance.setReal(inputs, values[:, index])
        # With input derivatives the FMU sees straight lines between the samples instead of stairs.
        instance.setRealInputDerivatives(inputs, [1] * len(inputs), rates[:, index])
        instance.doStep(currentCommunicationPoint=index * step, communicationStepSize=step)
        forces.append(instance.getReal(list(outputs.values())))
    instance.terminate()
    instance.freeInstance()
    return dict(zip(outputs, np.transpose(forces)))


def spectrum(signal: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    hann = np.hanning(len(signal))
    amplitude = 2 * np.abs(np.fft.rfft((signal - signal.mean()) * hann)) / hann.sum()
    return np.fft.rfftfreq(len(signal), step), amplitude


def main() -> None:
    parser = argparse.ArgumentParser(description="Drive a gear train with a measured gearbox vibration.")
    parser.add_argument("fmu", type=Path)
    parser.add_argument("csv", type=Path)
    parser.add_argument("--output", type=Path, default=Path("target/examples"), help="folder for the picture")
    arguments = parser.parse_args()

    measured = np.genfromtxt(arguments.csv, delimiter=",", names=True, comments="#", skip_header=1)
    sampling = measured["time_s"][1] - measured["time_s"][0]
    step = sampling / FINER
    (x, vx), (y, vy) = (integrate(measured[f"a{axis}_m_s2"], sampling) for axis in "xy")
    time = step * np.arange(len(x))

    motion = {"x": x, "y": y, "vx": vx, "vy": vy}

    description = fmpy.read_model_description(arguments.fmu)
    still = bearing_forces(arguments.fmu, description, {end: np.zeros_like(x) for end in motion}, step)
    shaken = bearing_forces(arguments.fmu, description, motion, step)

    worst = max(shaken, key=lambda name: np.ptp(shaken[name]))
    figure, (top, middle, bottom) = plt.subplots(3, 1, figsize=(11, 10), layout="constrained")
    for axis, colour in (("x", "#0072B2"), ("y", "#D55E00")):
        top.plot(1e3 * measured["time_s"], measured[f"a{axis}_m_s2"], color=colour, linewidth=0.7, label=axis)
        middle.plot(1e3 * time, 1e6 * motion[axis], color=colour, linewidth=0.7, label=axis)
    top.set(title=f"Acceleration of the gearbox, first quarter of {arguments.csv.name}", xlabel="time, ms", ylabel="acceleration, m/s²",
            xlim=(0, 1e3 * time[-1] / 4))
    middle.set(title=f"Its displacement above {LOWEST:.0f} Hz", xlabel="time, ms", ylabel="displacement, µm")
    bottom.semilogy(*spectrum(shaken[worst], step), color="#0072B2", linewidth=0.9, label="gearbox moves as measured")
    bottom.semilogy(*spectrum(still[worst], step), color="0.6", linewidth=0.9, label="gearbox at rest")
    bottom.set(title=f"Spectrum of {worst}", xlabel="frequency, Hz", ylabel="amplitude, N", xlim=(0, 4000), ylim=(1e-1, None))
    for ax in (top, middle, bottom):
        ax.legend(loc="upper right")
        ax.grid(alpha=0.25)

    arguments.output.mkdir(parents=True, exist_ok=True)
    figure.savefig(arguments.output / "measured_vibration.png", dpi=110)
    print(f"{worst}: {np.ptp(still[worst]):.0f} N peak to peak at rest, {np.ptp(shaken[worst]):.0f} N shaken")
    print(f"written: {arguments.output / 'measured_vibration.png'}")


if __name__ == "__main__":
    main()
