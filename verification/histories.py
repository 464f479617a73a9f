"""Curves over the time of a run that several cases draw."""

import numpy as np

from verification.curve import Chart, Curve
from verification.fits import extrapolate
from verification.solver import Run


def settling(title: str, label: str, time: np.ndarray, values: np.ndarray) -> Chart:
    """A series with the limit of its second half: shows whether it is steady."""
    limit = extrapolate(time, values)
    bounds = Curve("extrapolated limit", time[[0, -1]], np.full(2, limit.value), reference=True)
    return Chart(title, "time", label, (bounds, Curve("measured", time, values)))


def drag_history(run: Run) -> list[Chart]:
    """Superficial velocity, and the force on the surface of one fixed solid over the body force of the fluid."""
    force, series = np.array(run.scene["force"]["fluid"]), run.series
    axis = int(np.argmax(np.abs(force)))
    name = "xyz"[axis]
    filled = series["superficial_velocity_" + name][-1] / series["fluid_velocity_" + name][-1]
    body_force = run.scene["fluid"]["density"] * force[axis] * np.prod(run.scene["box"]["size"]) * filled
    time, surface = series["time"][1:], series["drag_" + name][1:] / body_force  # no force before the first sample
    balance = Chart(
        "Force on the surface against time",
        "time",
        "force on the surface / body force",
        (Curve("balance", time[[0, -1]], np.ones(2), reference=True), Curve("measured", time, surface)),
    )
    velocity = series["superficial_velocity_" + name]
    return [settling("Superficial velocity against time", "U", series["time"], velocity), balance]
