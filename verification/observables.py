"""What a run measured. Every function takes a Run and returns a Measured in the terms of its case's manifest.

The formulas are those of the exact solutions and of the published drag tables; no figure of the solver enters but the
fields it wrote and the scene it was given.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from verification.fits import decay_rate, extrapolate
from verification.flows import amplitudes, initial_flow, viscosity_of
from verification.solver import Run

# A drag counts when the force of the fluid on the solid balances the body force, and the velocity has settled, to this.
SETTLED = 0.005


@dataclass(frozen=True)
class Measured:
    """value +- uncertainty, and why it cannot be accepted, if so."""

    value: float
    uncertainty: float
    objection: str = ""


def viscosity(run: Run) -> Measured:
    """nu / nu_declared of a flow that decays as exp(-nu lambda t): see verification/flows.py.

    Measured while the kinetic energy of the flow falls from 0.8 to 0.1 of its start: past the first adjustment of the
    lattice. Projected on the flow, so that the energy of the particles' disorder does not count.
    """
    flow = initial_flow(run)
    time, amplitude = amplitudes(run, flow)
    window = (amplitude**2 < 0.8) & (amplitude**2 > 0.1)
    if np.count_nonzero(window) < 5:
        return Measured(float("nan"), float("inf"), "fewer than five snapshots while the flow decays; write more")
    rate, error = decay_rate(time[window], amplitude[window])
    declared = viscosity_of(run) * flow.eigenvalue
    return Measured(rate / declared, error / declared)


def _cell(run: Run) -> tuple[int, float, float, float]:
    """(axis of the flow, acceleration, volume of the cell, volume of the one solid)."""
    (body,) = run.scene["body"]
    force = np.array(run.scene["force"]["fluid"])
    axis = int(np.argmax(np.abs(force)))
    box = run.scene["box"]["size"]
    solid = np.pi * body["radius"] ** 2 if len(box) == 2 else 4 / 3 * np.pi * body["radius"] ** 3
    return axis, float(force[axis]), float(np.prod(box)), float(solid)


def drag(run: Run) -> Measured:
    """F / (mu U) in the plane, F / (6 pi mu R U) in space, of all solids of one kind in a periodic cell together.

    F is the mean pressure gradient times the volume of the whole cell, rho g V; the force on the surface is less by the
    solids' volume, rho g (V - V_s). U is the superficial velocity, over the whole cell. (Convention of Sangani and
    Acrivos 1982, Zick and Homsy 1982.) A free solid is held by no one: there the frame is that of the solid.
    """
    axis, acceleration, cell, solid = _cell(run)
    fluid, series = run.scene["fluid"], run.series
    name = "xyz"[axis]
    velocity = series["superficial_velocity_" + name]
    if "slip_" + name in series and run.scene["body"][0].get("motion", "free") != "fixed":
        velocity = -series["slip_" + name] * (1 - solid / cell)
    limit = extrapolate(series["time"], velocity)
    scale = fluid["viscosity"] * limit.value
    if len(run.scene["box"]["size"]) == 3:
        scale *= 6 * np.pi * run.scene["body"][0]["radius"]
    value = fluid["density"] * acceleration * cell / scale
    filled = series["superficial_velocity_" + name][-1] / series["fluid_velocity_" + name][-1]  # with PPs, of the cell
    solids = len(run.scene["body"][0].get("positions", [None]))
    on_surface = solids * extrapolate(series["time"], series["drag_" + name]).value
    imbalance = abs(on_surface / (fluid["density"] * acceleration * cell * filled) - 1)
    objections = []
    if imbalance > SETTLED:
        objections.append(f"forces out of balance by {100 * imbalance:.2f} %")
    if limit.gap > SETTLED:
        objections.append(f"velocity {100 * limit.gap:.2f} % from its extrapolation")
    uncertainty = value * float(np.hypot(limit.noise / limit.value, np.hypot(limit.gap, imbalance)))
    return Measured(float(value), uncertainty, "; ".join(objections))


def largest_velocity(run: Run) -> Measured:
    """Largest speed of a PP in the last snapshot over the sound speed."""
    speed = np.linalg.norm(run.fluid()["velocity"], axis=1)
    return Measured(float(speed.max()) / run.scene["fluid"]["sound_speed"], 0.0)


OBSERVABLES: dict[str, Callable[[Run], Measured]] = {
    function.__name__: function
    for function in (viscosity, drag, largest_velocity)
}
