"""Energy: what the body forces put in, from what a run wrote."""

import numpy as np

from verification.protocol.run import Run


def body_work(run: Run) -> np.ndarray:
    """Work of the body forces on fluid and solids since the start, by the trapezoidal rule over the samples.

    The momentum that the forces give in an interval times the mean velocity of what they act on.
    """
    series, scene = run.series, run.scene
    mass, solid_mass = _masses(run)
    work = np.zeros(len(series))
    for axis, name in enumerate("xyz"[: len(scene["box"]["size"])]):
        fluid = scene["force"]["fluid"][axis] * mass
        solid = -fluid if scene["force"].get("solid") == "balance" else solid_mass * scene["force"]["solid"][axis]
        power = fluid * series["fluid_velocity_" + name] + solid * series["solid_velocity_" + name]
        power = np.where(series["step"] < scene["run"].get("relax", 0), 0.0, power)
        work[1:] += np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(series["time"]))
    return work


def _masses(run: Run) -> tuple[float, float]:
    """(of all PPs, of all free discs or spheres), in the scene's units."""
    fluid, series = run.scene["fluid"], run.series
    box = float(np.prod(run.scene["box"]["size"]))
    axis = "xyz"[int(np.argmax(np.abs(run.scene["force"]["fluid"])))]
    moving = series["fluid_velocity_" + axis] != 0.0
    filled = float((series["superficial_velocity_" + axis][moving] / series["fluid_velocity_" + axis][moving]).mean())
    balls = run.solids()
    volume = np.pi * balls["radius"] ** 2 if len(run.scene["box"]["size"]) == 2 else 4 / 3 * np.pi * balls["radius"] ** 3
    density = run.scene["body"][0]["density"]
    return fluid["density"] * box * filled, float(density * volume.sum())
