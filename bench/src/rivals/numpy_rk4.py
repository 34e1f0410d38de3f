"""The classical Runge-Kutta method in a numpy loop.

Reads the system as JSON on standard input, writes the mesh forces and the wall time as JSON.
"""
import json
import sys
import time

import numpy as np

data = json.load(sys.stdin)
K, D = (np.array(data[key]).T.copy() for key in ("stiffness_columns", "damping_columns"))
W = np.array(data["rows"])
held, mesh_damping = np.array(data["held"]), np.array(data["mesh_damping"])
frequency, along_cosine, along_sine = (np.array(data[key]) for key in ("frequency", "cosine", "sine"))
start_phase, phase_rate = np.array(data["start_phase"]), np.array(data["phase_rate"])
tables = np.array(data["stiffness_over_phase"])
points = tables.shape[1] - 1
n = len(held)
meshes = np.arange(len(W))


def mesh_force(t, q, v):
    place = (start_phase + phase_rate * t) % 1.0 * points
    index = place.astype(int)
    left = tables[meshes, index]
    k = left + (place - index) * (tables[meshes, index + 1] - left)
    return k * (W @ q) + mesh_damping * (W @ v)


def derivative(t, x):
    q, v = x[:n], x[n:]
    load = held + np.cos(frequency * t) @ along_cosine + np.sin(frequency * t) @ along_sine
    return np.concatenate((v, load - K @ q - D @ v - mesh_force(t, q, v) @ W))


def step(t, h, x):
    k1 = derivative(t, x)
    k2 = derivative(t + h / 2, x + h / 2 * k1)
    k3 = derivative(t + h / 2, x + h / 2 * k2)
    k4 = derivative(t + h, x + h * k3)
    return x + h / 6 * (k1 + 2 * (k2 + k3) + k4)


x, forces, begin = np.array(data["start"]), [], 0.0
clock = time.perf_counter()
for end in data["times"]:
    h = (end - begin) / data["steps"]
    for number in range(data["steps"]):
        x = step(begin + number * h, h, x)
    forces.extend(mesh_force(end, x[:n], x[n:]).tolist())
    begin = end
json.dump({"seconds": time.perf_counter() - clock, "steps": data["steps"] * len(data["times"]), "forces": forces}, sys.stdout)
