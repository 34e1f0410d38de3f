"""Independent reference for geartrain: the equations of equations.md, written for reading and for accuracy, not for speed.

Nothing here is shared with the Rust program.  "eq" = equations.md, "design" = design.md.  SI units, plain numbers only.
Element matrices come from Gauss integration of the Timoshenko shape functions, dynamics from DOP853 between the places
where the equations are not smooth: breakpoints of the mesh stiffness, contact made and lost, clearances closed.

    python -m reference MODEL.toml --frequencies          JSON: uncoupled and coupled frequencies
    python -m reference MODEL.toml --simulate 0.02 1e-4   CSV of every output, t = 0, 1e-4, ... 0.02

Modules, each built on those before it:

    model_file   the TOML file with every default filled in                 design 2, 8
    rotor        finite elements of one rotor                               eq 2
    basis        modes kept and static shapes                               eq 4, design 8.2, 8.3
    bearing      speed-dependent coefficients, nonlinear radial forces
    stiffness    k over the mesh phase, piece by piece                      eq 3
    mesh         line of action, contact terms, phase, transmission error   eq 3
    system       M q'' + D q' + K q = forces, gyroscopics, free spin        eq 2, 4
    equilibrium  the static start                                           design 8.5
    simulation   integration from event to event
    outputs      the variables of design 3
    frequencies  of the uncoupled rotors and of the whole train
"""
from .frequencies import coupled, frequencies
from .model_file import load
from .simulation import simulate
from .system import System

__all__ = ["System", "coupled", "frequencies", "load", "simulate"]
