"""Simulate an FMU and look at it: mesh forces over time and frequency, orbits of the gears.

    cargo xtask fmu examples/three_stage.toml
    python examples/simulate_and_plot.py target/fmu/three_stage.fmu
    python examples/simulate_and_plot.py target/fmu/three_stage.fmu --set gearbox_vibration.amplitude_x=25e-6

Works with the FMU of any model file: what is drawn follows from the names of its variables.
"""

import argparse
from pathlib import Path

import fmpy
import matplotlib
import numpy as np

matplotlib.use("Agg")  # draws into files, needs no screen
import matplotlib.pyplot as plt  # noqa: E402

LAST = 1000  # samples of the end that orbits show, a quarter of them for forces


def main() -> None:
    parser = argparse.ArgumentParser(description="Simulate an FMU and draw mesh forces and orbits.")
    parser.add_argument("fmu", type=Path)
    parser.add_argument("--set", action="append", default=[], metavar="PARAMETER=VALUE", help="may be repeated")
    parser.add_argument("--stop", type=float, help="end of the simulation [s]; the model file's otherwise")
    parser.add_argument("--output", type=Path, default=Path("target/examples"), help="folder for the picture")
    arguments = parser.parse_args()
    parameters = dict(word.split("=") for word in arguments.set)

    # <mesh>.force is the normal force of a mesh; <rotor>.<gear>.x, .y are the displacement of a gear.
    description = fmpy.read_model_description(arguments.fmu)
    outputs = [variable.name for variable in description.modelVariables if variable.causality == "output"]
    forces = [name for name in outputs if name.endswith(".force")]
    gears = [name.removesuffix(".mesh_torque") for name in outputs if name.endswith(".mesh_torque")]

    step = float(description.defaultExperiment.stepSize)
    result = fmpy.simulate_fmu(arguments.fmu, stop_time=arguments.stop, output_interval=step, start_values=parameters,
                               output=forces + [f"{gear}.{axis}" for gear in gears for axis in "xy"])
    settled = result[len(result) // 2:]  # for the spectrum
    last = result[-LAST:]

    figure, (over_time, over_frequency, orbits) = plt.subplots(1, 3, figsize=(16, 5.5), layout="constrained")
    for index, name in enumerate(forces):
        width = 2.4 / (1 + index)  # later lines do not hide earlier ones
        over_time.plot(1e3 * last["time"][-LAST // 4:], 1e-3 * last[name][-LAST // 4:], linewidth=width, label=name)
        force = settled[name]
        hann = np.hanning(len(force))
        amplitude = 2 * np.abs(np.fft.rfft((force - force.mean()) * hann)) / hann.sum()
        over_frequency.plot(np.fft.rfftfreq(len(force), step), 1e-3 * amplitude, linewidth=width, label=name)
    over_time.set(xlabel="time, ms", ylabel="mesh force, kN", title="Mesh forces at the end")
    over_frequency.set(xlabel="frequency, Hz", ylabel="amplitude, kN", title="Their spectra, second half", xlim=(0, 6000))
    for gear in gears:
        x, y = (1e6 * last[f"{gear}.{axis}"] for axis in "xy")
        orbits.plot(x - x.mean(), y - y.mean(), linewidth=0.8, label=gear)
    orbits.set(xlabel="x, µm", ylabel="y, µm", title="Orbits of the gears about their mean", aspect="equal")
    for ax in (over_time, over_frequency, orbits):
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=3, frameon=False)
        ax.grid(alpha=0.25)
    figure.suptitle(description.description)

    arguments.output.mkdir(parents=True, exist_ok=True)
    picture = arguments.output / f"{description.modelName}.png"
    figure.savefig(picture, dpi=110)
    for name in forces:
        print(f"{name}: mean {result[name].mean():.0f} N, largest {result[name].max():.0f} N")
    print(f"written: {picture}")


if __name__ == "__main__":
    main()
