"""Bearings: coefficients over the speed, and radial forces beyond the linear ones."""
import numpy as np
from scipy.interpolate import PchipInterpolator


def coefficients(data):
    """speed -> (K, C), each 2 x 2 on (x, y); a table is taken at |speed|, monotone piecewise cubics between its entries."""
    def matrices(entry):
        return np.array([[[d["xx"], d["xy"]], [d["yx"], d["yy"]]] for d in (entry["stiffness"], entry["damping"])])

    if "at_speed" not in data:
        constant = matrices(data)
        return lambda speed: constant
    speeds, values = [e["speed"] for e in data["at_speed"]], [matrices(e) for e in data["at_speed"]]
    if len(speeds) == 1:
        return lambda speed: values[0]
    curve = PchipInterpolator(speeds, values)

    def at(speed):
        inside = min(max(abs(speed), speeds[0]), speeds[-1])
        if inside != abs(speed) and data["outside_speeds"] == "refuse":
            raise ValueError(f"{data['name']}: no coefficients at {speed} rad/s")
        return curve(inside)
    return at


class RadialForce:
    """F_r = coefficient max(0, r - clearance)^exponent against the displacement from the gearbox, r its length."""

    def __init__(self, law):
        self.clearance = law["clearance"]
        self.coefficient = law["stiffness"] if law["law"] == "clearance" else law["coefficient"]
        self.exponent = {"clearance": 1.0, "cubic": 3.0}.get(law["law"], law["exponent"])

    def beyond(self, u):
        """r - clearance"""
        return np.hypot(*u) - self.clearance

    def __call__(self, u):
        """The force (x, y) that the displacement u meets."""
        r = np.hypot(*u)
        return self.coefficient * max(0.0, r - self.clearance) ** self.exponent / r * u if r > 0 else 0 * u

    def stiffness(self, u):
        """Its derivative by u."""
        r = np.hypot(*u)
        d = r - self.clearance
        if d < 0 or r == 0:
            return self.coefficient * (self.clearance == 0 and self.exponent == 1) * np.eye(2)
        secant = self.coefficient * d ** self.exponent / r
        tangent = self.coefficient * self.exponent * d ** (self.exponent - 1)
        return secant * np.eye(2) + (tangent - secant) * np.outer(u, u) / r ** 2
