"""How exact and how stable the ways to couple train and housing are: tables and picture of docs/coupling.md.

    cargo xtask coupling

packs the pair and calls this with its folder and the document.
"""

import argparse
from pathlib import Path

import matplotlib
import numpy as np
from candidates import Averaged, Estimate, Estimated, MeanOfParabola, Motion, Predicted, TransmissionLine
from energy import energies
from measure import GRID, Course, coupled, largest_stable_step, reference, step_for
from schemes import (Derivatives, DerivativesOnKnownBearings, Held, HeldAndContinued, HeldAndContinuedOnKnownBearings, HeldOldOutputs,
                     HeldOldOutputsAndContinued, HeldOnKnownBearings, HeldWithoutVelocity, Rollback, RollbackOnKnownBearings, Sequential,
                     SequentialExtrapolated)

matplotlib.use("Agg")  # draws into files, needs no screen
import matplotlib.pyplot as plt  # noqa: E402

# The paper's case 4: large imbalance, and a vibration of the ground that the gearbox stands on.
CASE_4 = {f"stage{stage}.gear_unbalance.moment": 1.5e-4 for stage in (1, 2, 3)}
CASE_4 |= {f"gearbox_vibration.amplitude_{axis}": 25e-6 for axis in "xy"}
STOP = 0.02  # 36 mesh periods [s]
STEPS = [1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 5e-5, 1e-4, 2e-4]
KINDS = ("bearing force", "mesh force", "acceleration")

SCHEMES = {
    "parallel, velocity inputs left at 0": HeldWithoutVelocity,
    "parallel, held, outputs as of the end of the last step": HeldOldOutputs,
    "the same, `simulation.input_extrapolation` = 1": HeldOldOutputsAndContinued,
    "parallel, held, outputs re-evaluated": Held,
    "the same with `simulation.input_extrapolation` = 1": HeldAndContinued,
    "parallel, held, `simulation.input_extrapolation` = 1 and `simulation.known_bearings` = 1": HeldAndContinuedOnKnownBearings,
    "sequential, held forces": Sequential,
    "parallel, input derivatives": Derivatives,
    "parallel, input derivatives, `simulation.known_bearings` = 1": DerivativesOnKnownBearings,
    "sequential, extrapolated forces": SequentialExtrapolated,
    "two iterations with rollback": Rollback,
    "two iterations with rollback, `simulation.known_bearings` = 1": RollbackOnKnownBearings,
    "three iterations with rollback": lambda: Rollback(3),
}
CANDIDATES = {
    "nothing (held, re-evaluated)": Held,
    "force outputs averaged over the last step": lambda: Averaged(predict=False),
    "the same, extrapolated to the coming step": lambda: Averaged(predict=True),
    "outputs predicted half a step ahead": Predicted,
    "train: displacement moves with the velocity input, velocity with its difference": lambda: Estimated(train=Motion(False)),
    "train: backward differences": lambda: Estimated(train=Estimate(1)),
    "housing: backward difference of the forces": lambda: Estimated(housing=Estimate(1)),
    "both: backward differences": lambda: Estimated(Estimate(1), Estimate(1)),
    "both, displacement with the velocity input": lambda: Estimated(Motion(False), Estimate(1)),
    "the same, displacement bent by the estimated acceleration": lambda: Estimated(Motion(True), Estimate(1), bent=True),
    "both: parabola through three points": lambda: Estimated(Estimate(2), Estimate(2), bent=True),
    "both: straight line with the mean of that parabola": lambda: Estimated(MeanOfParabola(), MeanOfParabola()),
    "both: motion bent, parabola for the forces": lambda: Estimated(Motion(True), Estimate(2), bent=True),
    "housing knows the bearings, rest of the force held; train held": HeldOnKnownBearings,
    "housing knows the bearings; both continue what is left": HeldAndContinuedOnKnownBearings,
    "the same, stiffness and damping 30 % too low": lambda: HeldAndContinuedOnKnownBearings(0.7),
    "the same, 50 % too low": lambda: HeldAndContinuedOnKnownBearings(0.5),
    "transmission lines of 1e4 N s/m": lambda: TransmissionLine(1e4),
    "transmission lines of 3e4 N s/m": lambda: TransmissionLine(3e4),
    "transmission lines of 1e5 N s/m": lambda: TransmissionLine(1e5),
}

ENERGY = ["parallel, held, outputs re-evaluated", "parallel, input derivatives", "two iterations with rollback",
          "both, displacement with the velocity input", "both: parabola through three points",
          "parallel, input derivatives, `simulation.known_bearings` = 1",
          "parallel, held, `simulation.input_extrapolation` = 1 and `simulation.known_bearings` = 1"]


def errors(folder: Path, exact: Course, scheme, h: float, stop: float) -> list[float]:
    """Of bearing forces, mesh forces and accelerations; infinite where the pair has run away."""
    peak = np.abs(exact.bearings).max()
    return coupled(folder, CASE_4, scheme(), h, stop, limit=100 * peak).errors(exact.every(round(h / GRID)))


def percent(value: float) -> str:
    return f"{100 * value:.2g}" if value < 0.995 else f"{100 * value:.0f}" if value < 10 else "-"


def micro(value: float) -> str:
    return f"{1e6 * value:.3g}" if np.isfinite(value) else "-"


def row(*cells: str) -> str:
    return "| " + " | ".join(cells) + " |"


def measure_schemes(folder: Path, exact: Course) -> tuple[list[str], dict[str, np.ndarray]]:
    """One table per kind of error, with the stability limit in the first; and the errors by scheme."""
    peak = np.abs(exact.bearings).max()
    found, limits = {}, {}
    for name, scheme in SCHEMES.items():
        found[name] = np.array([errors(folder, exact, scheme, h, STOP) for h in STEPS])
        limits[name] = largest_stable_step(folder, CASE_4, scheme, peak)
        print(f"{name}: stable to {micro(limits[name])} us", flush=True)
    lines = []
    for index, kind in enumerate(KINDS):
        lines += ["", f"Error of {kind}s in % at communication steps in us:", ""]
        tail = ("step for 1 %", "stable to") if index == 0 else ("step for 1 %",)
        lines += [row("scheme", *(micro(h) for h in STEPS), *tail), "|---" * (1 + len(STEPS) + len(tail)) + "|"]
        for name, table in found.items():
            last = [micro(step_for(0.01, STEPS, table[:, index]))] + ([micro(limits[name])] if index == 0 else [])
            lines.append(row(name, *map(percent, table[:, index]), *last))
    return lines[1:], found


def measure_candidates(folder: Path, exact: Course) -> list[str]:
    peak = np.abs(exact.bearings).max()
    steps = (1e-5, 2e-5, 5e-5)
    lines = [row("what the slaves do", *(f"bearing, {micro(h)} us" for h in steps), *(f"mesh, {micro(h)} us" for h in steps[:2]),
                 "stable to"), "|---" * 7 + "|"]
    for name, scheme in CANDIDATES.items():
        table = [errors(folder, exact, scheme, h, STOP) for h in steps]
        limit = largest_stable_step(folder, CASE_4, scheme, peak)
        print(f"{name}: stable to {micro(limit)} us", flush=True)
        lines.append(row(name, *(percent(one[0]) for one in table), *(percent(one[1]) for one in table[:2]), micro(limit)))
    return lines


def measure_energy(folder: Path) -> list[str]:
    """Growth of the energy per second, from the first quarter of the run to the last."""
    steps = (1e-5, 2e-5, 5e-5)
    lines = [row("energy of the undamped pair, growth in 1/s", *(f"{micro(h)} us" for h in steps)), "|---" * 4 + "|"]
    for name in ENERGY:
        rates = []
        for h in steps:
            energy = energies(folder, (SCHEMES | CANDIDATES)[name](), h, STOP)
            quarter = len(energy) // 4
            rates.append(np.log(energy[-quarter:].mean() / energy[:quarter].mean()) / (0.75 * STOP))
        lines.append(row(name, *(f"{rate:+.2g}" for rate in rates)))
        print(lines[-1], flush=True)
    return lines


def in_short(name: str) -> str:
    name = name.replace("`simulation.input_extrapolation` = 1", "inputs continued")
    return name.replace("`simulation.known_bearings` = 1", "bearings known")


def draw(found: dict[str, np.ndarray], picture: Path) -> None:
    figure, axes = plt.subplots(1, 3, figsize=(13, 5), sharey=True, layout="constrained")
    for index, (ax, kind) in enumerate(zip(axes, KINDS)):
        for mark, (name, table) in zip("vo^psD*xP<>dh", found.items()):
            ax.loglog(1e6 * np.array(STEPS), 100 * np.where(table[:, index] < 2, table[:, index], np.nan), marker=mark,
                      markersize=5, linewidth=1.2, label=in_short(name))
        ax.axhline(1.0, color="black", linewidth=0.8, linestyle=":")
        ax.set(xlabel="communication step, us", title=kind)
        ax.grid(alpha=0.25, which="both")
    axes[0].set_ylabel("RMS error, % of the RMS of what alternates")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False, fontsize=9)
    figure.savefig(picture, dpi=80)


def insert(document: Path, mark: str, lines: list[str]) -> None:
    """Replaces what is between the document's marks."""
    text = document.read_text()
    begin, end = f"<!-- {mark} -->", f"<!-- end of {mark} -->"
    head, rest = text.split(begin)
    _, tail = rest.split(end)
    document.write_text(f"{head}{begin}\n" + "\n".join(lines) + f"\n{end}{tail}")


def main() -> None:
    parser = argparse.ArgumentParser(description="Measure ways to couple train and housing.")
    parser.add_argument("folder", type=Path, help="what cargo xtask couple wrote for the example")
    parser.add_argument("document", type=Path, help="gets tables between its marks and a picture beside it")
    arguments = parser.parse_args()
    exact = reference(arguments.folder, CASE_4, STOP)
    lines, found = measure_schemes(arguments.folder, exact)
    draw(found, arguments.document.with_suffix(".png"))
    insert(arguments.document, "schemes", lines)
    insert(arguments.document, "energy", measure_energy(arguments.folder))
    insert(arguments.document, "candidates", measure_candidates(arguments.folder, exact))


if __name__ == "__main__":
    main()
