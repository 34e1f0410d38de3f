"""Sweep two parameters on all cores, or on a cluster: imbalance and bearing stiffness of stage 1 of the paper's example.

    cargo xtask fmu examples/three_stage.toml
    python examples/sweep.py target/fmu/three_stage.fmu
    python examples/sweep.py target/fmu/three_stage.fmu --scheduler tcp://SCHEDULER:8786

Dask spreads the simulations over workers: processes on this machine, or those of a cluster whose scheduler has the given
address (their Python needs fmpy, numpy and distributed). The FMU travels as bytes, no shared folder is needed.
"""

import argparse
import tempfile
from pathlib import Path

import fmpy
import matplotlib
import numpy as np
from distributed import Client, as_completed

matplotlib.use("Agg")  # draws into files, needs no screen
import matplotlib.pyplot as plt  # noqa: E402

STEP = 1e-4  # communication step [s]
BEARINGS = ("b1", "b2", "b3")


def orbit(fmu: bytes, imbalance: float, stiffness: float, stop: float) -> float:
    """Peak-to-peak displacement of the gear in the second half of a simulation [m]; runs on a worker."""
    parameters = {"stage1.gear_unbalance.moment": imbalance}
    parameters |= {f"stage1.{bearing}.stiffness.{plane}": stiffness for bearing in BEARINGS for plane in ("xx", "yy")}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "train.fmu"
        path.write_bytes(fmu)
        result = fmpy.simulate_fmu(path, stop_time=stop, output_interval=STEP, start_values=parameters,
                                   output=["stage1.gear.x", "stage1.gear.y"])
    settled = result[len(result) // 2:]
    return max(np.ptp(settled["stage1.gear.x"]), np.ptp(settled["stage1.gear.y"]))


def main() -> None:
    parser = argparse.ArgumentParser(description="Sweep imbalance and bearing stiffness with Dask.")
    parser.add_argument("fmu", type=Path)
    parser.add_argument("--scheduler", help="address of a cluster; this machine's cores otherwise")
    parser.add_argument("--points", type=int, default=8, help="values of each parameter")
    parser.add_argument("--stop", type=float, default=1.0, help="length of each simulation [s]")
    parser.add_argument("--output", type=Path, default=Path("target/examples"), help="folder for table and picture")
    arguments = parser.parse_args()
    imbalances = np.linspace(2e-5, 2e-4, arguments.points)  # [kg m]
    stiffnesses = np.geomspace(5e6, 1e9, arguments.points)  # [N/m]

    local = {} if arguments.scheduler else {"threads_per_worker": 1, "dashboard_address": None}
    with Client(arguments.scheduler, **local) as client:
        fmu = client.scatter(arguments.fmu.read_bytes(), broadcast=True)
        places = {}
        for row, stiffness in enumerate(stiffnesses):
            for column, imbalance in enumerate(imbalances):
                places[client.submit(orbit, fmu, imbalance, stiffness, arguments.stop)] = row, column
        sizes = np.empty((arguments.points, arguments.points))
        for done, future in enumerate(as_completed(places), start=1):
            sizes[places[future]] = future.result()
            print(f"\r{done} of {len(places)} simulations", end="", flush=True)
    print()

    arguments.output.mkdir(parents=True, exist_ok=True)
    table = np.column_stack([np.tile(imbalances, arguments.points), np.repeat(stiffnesses, arguments.points), sizes.ravel()])
    np.savetxt(arguments.output / "sweep.csv", table, fmt="%.6g", delimiter=",", comments="",
               header="imbalance_kg_m,bearing_stiffness_n_m,peak_to_peak_m")

    figure, ax = plt.subplots(figsize=(8, 6), layout="constrained")
    mesh = ax.pcolormesh(1e6 * imbalances, stiffnesses, 1e6 * sizes, shading="nearest", norm="log")
    ax.set(yscale="log", xlabel="imbalance of the gear of stage 1, g mm", ylabel="stiffness of its bearings, N/m")
    ax.set_title("Peak-to-peak displacement of the gear of stage 1")
    figure.colorbar(mesh, label="µm")
    figure.savefig(arguments.output / "sweep.png", dpi=110)
    print(f"largest orbit: {1e6 * sizes.max():.2f} um")
    print(f"written: {arguments.output / 'sweep.csv'}, {arguments.output / 'sweep.png'}")


if __name__ == "__main__":
    main()
