"""What a run measured. Every function takes a Run and returns a Measured in the terms of its case's manifest.

The formulas are those of the exact solutions and of the published drag tables; no figure of the solver enters but the
fields it wrote and the scene it was given.
"""

from dataclasses import dataclass

import numpy as np

from verification.measures.fits import decay_rate, extrapolate, relaxed
from verification.measures.flows import amplitudes, initial_flow, viscosity_of
from verification.measures.measures import by_name
from verification.protocol.quantity import Measured
from verification.protocol.run import Run

# A drag counts when the force of the fluid on the solid balances the body force, and the velocity has settled, to this.
SETTLED = 0.005
SLOWEST = 3.0  # relaxation times: both ways of relaxing at once are slower than either


def viscosity(run: Run) -> Measured:
    """nu / nu_declared of a flow that decays as exp(-nu lambda t): see verification/measures/flows.py.

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


@dataclass(frozen=True)
class DragSeries:
    """Solids of one kind in a periodic cell over time, along the body force, in their frame; scene units."""

    time: np.ndarray
    velocity: np.ndarray  # superficial
    across: np.ndarray  # (n, D), superficial velocity less its part along the force
    on_surface: np.ndarray  # force of the fluid on all of them, over the body force that the PPs of the cell receive
    body_force: float  # F: that body force over the share of the fluid in the cell
    relaxation: float  # time in which an unsteady flow decays, about


def drag_series(run: Run) -> DragSeries:
    """Of fixed solids, or of some that move: then the slip says what flows past them.

    A velocity relaxes as momentum passes to the solid, in rho V_f U / F_s, and as vorticity spreads over the cell, in
    (L / 2 pi)^2 / nu.
    """
    (body,) = run.scene["body"]
    fluid, series, box = run.scene["fluid"], run.series, np.array(run.scene["box"]["size"])
    force = np.array(run.scene["force"]["fluid"])
    acceleration = float(np.linalg.norm(force))

    direction = force / acceleration

    def vectors(name: str) -> np.ndarray:
        return np.column_stack([series[f"{name}_{axis}"] for axis in "xyz"[: len(box)]])

    solids = len(body.get("positions", [None]))
    volume = np.pi * body["radius"] ** 2 if len(box) == 2 else 4 / 3 * np.pi * body["radius"] ** 3
    cell = float(np.prod(box))
    open_share = 1 - solids * volume / cell
    past = vectors("fluid_velocity") if body.get("motion", "free") == "fixed" else -vectors("slip")
    velocity = open_share * past @ direction
    received = fluid["density"] * acceleration * cell * _filled(run)
    transfer = fluid["density"] * cell * abs(velocity[-1]) / received
    spreading = (box.max() / (2 * np.pi)) ** 2 * fluid["density"] / fluid["viscosity"]
    return DragSeries(
        time=series["time"],
        velocity=velocity,
        across=open_share * past - np.outer(velocity, direction),
        on_surface=solids * (vectors("drag") @ direction) / received,
        body_force=received / open_share,
        relaxation=float(max(transfer, spreading)),
    )


def _filled(run: Run) -> float:
    """Share of the cell that the PPs fill at rest density: their number is whole, so not quite that of the fluid."""
    found = [
        run.series[f"superficial_velocity_{axis}"][moving] / mean[moving]
        for axis in "xyz"[: len(run.scene["box"]["size"])]
        for mean in [run.series[f"fluid_velocity_{axis}"]]
        for moving in [np.abs(mean) > 0.1 * np.abs(mean).max()]
    ]
    return float(np.median(np.concatenate(found)))


def drag(run: Run) -> Measured:
    """F / (mu U) in the plane, F / (6 pi mu R U) in space, of all solids of one kind in a periodic cell together.

    F is the mean pressure gradient times the volume of the whole cell; the force on the surface, which is the body force
    that the fluid receives, is less by the share of the solid. U is the superficial velocity, over the whole cell.
    (Convention of Sangani and Acrivos 1982, Zick and Homsy 1982.) The frame is that of the solids. Force and velocity are
    taken along the body force, and extrapolated over no longer than a few relaxation times of the flow: a drift that is
    slower is noise of the particles.
    """
    cell = drag_series(run)
    limit = extrapolate(cell.time, cell.velocity, SLOWEST * cell.relaxation)
    scale = run.scene["fluid"]["viscosity"] * limit.value
    if len(run.scene["box"]["size"]) == 3:
        scale *= 6 * np.pi * run.scene["body"][0]["radius"]
    value = cell.body_force / scale
    imbalance = abs(relaxed(cell.time, cell.on_surface, limit.tau).value - 1)
    objections = []
    if imbalance > SETTLED:
        objections.append(f"forces out of balance by {100 * imbalance:.2f} %")
    if limit.gap > SETTLED:
        objections.append(f"velocity {100 * limit.gap:.2f} % from its extrapolation")
    uncertainty = value * float(np.hypot(limit.error / limit.value, np.hypot(limit.gap, imbalance)))
    return Measured(float(value), uncertainty, "; ".join(objections))


def sideways(run: Run) -> Measured:
    """Superficial velocity across the body force over that along it, both means of the second half of the run."""
    cell = drag_series(run)
    half = cell.time >= 0.5 * cell.time[-1]
    across = np.linalg.norm(cell.across[half].mean(axis=0))
    return Measured(float(across / cell.velocity[half].mean()), 0.0)


def largest_velocity(run: Run) -> Measured:
    """Largest speed of a PP in the last snapshot over the sound speed."""
    speed = np.linalg.norm(run.fluid()["velocity"], axis=1)
    return Measured(float(speed.max()) / run.scene["fluid"]["sound_speed"], 0.0)


OBSERVABLES = by_name(viscosity, drag, sideways, largest_velocity)
