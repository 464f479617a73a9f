"""One body in a periodic cell over time, for flows that the steady solver does not find or that shed vortices."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reference.openfoam import read
from reference.openfoam.case_files import Transient
from reference.openfoam.cell import Cell
from reference.openfoam.level import LevelRun, drag_scale, make
from reference.openfoam.run import run, say
from verification.protocol.quantity import checksum_of

COURANT = 0.4  # of the superficial velocity in the cells at the wall; they widen outwards, where the flow is faster
DIFFUSION = 1.0  # nu step / width^2 of the cells at the wall; above it the flow diverges
SHEDS = 1e-3  # force across the flow, rms over mean drag, from which on a flow counts as shedding
CROSSINGS = 5  # of the mean of that force, upwards, to tell a period
STEADY = 1e-3  # change of the drag between the halves of the window, relative, that a mean may have


@dataclass(frozen=True)
class History:
    """What the force did after it had settled, with standard uncertainties, in the units of the input."""

    drag: float
    drag_uncertainty: float
    period: float | None
    period_uncertainty: float
    swing: float  # largest less smallest drag over the mean


def _crossings(time: np.ndarray, signal: np.ndarray) -> np.ndarray:
    """Times at which a signal crosses 0 upwards, between its samples by a straight line."""
    at = np.flatnonzero((signal[:-1] < 0) & (signal[1:] >= 0))
    return time[at] - signal[at] * (time[at + 1] - time[at]) / (signal[at + 1] - signal[at])


def analyse(time: np.ndarray, drag: np.ndarray, lift: np.ndarray) -> History:
    """Of the second half of a history. The mean is over whole periods where there is one."""
    second = time >= (time[0] + time[-1]) / 2
    time, drag, lift = time[second], drag[second], lift[second]
    centred = lift - lift.mean()
    crossings = _crossings(time, centred)
    period, scatter = None, 0.0
    halves = np.array_split(centred, 2)
    lasting = np.std(halves[1]) > 0.5 * np.std(halves[0])
    if np.std(centred) > SHEDS * abs(drag.mean()) and lasting and len(crossings) >= CROSSINGS:
        spacings = np.diff(crossings)
        period, scatter = float(spacings.mean()), float(spacings.std(ddof=1) / math.sqrt(len(spacings)))
        whole = (time >= crossings[0]) & (time < crossings[-1])
        time, drag = time[whole], drag[whole]
    first, last = (half.mean() for half in np.array_split(drag, 2))
    return History(float(drag.mean()), float(abs(last - first) / 2), period, scatter, float(np.ptp(drag) / drag.mean()))


def transient_for(cell: Cell, n: int, end: float) -> Transient:
    """Plane cells only. Width at the wall: a quarter of the circle over n."""
    width = math.pi * cell.radius / (2 * n)
    return Transient(min(COURANT * width, DIFFUSION * width**2 / cell.viscosity), end)


def run_transient(folder: Path, cell: Cell, n: int, end: float) -> LevelRun:
    """Mean drag, and period if it sheds, at level n. Throws FailedRun."""
    solver = transient_for(cell, n, end)
    checksum = checksum_of(make(folder, cell, n, solver), folder)
    seconds = sum(run(folder, program) for program in ("blockMesh", "checkMesh", solver.program))
    fluid_volume = read.volume(folder)
    scale = drag_scale(cell, fluid_volume) / fluid_volume
    rows = read.forces(folder)
    along = np.array(cell.direction)
    across = np.array([-along[1], along[0]])
    table = np.column_stack([rows[:, 0], rows[:, 1:3] @ along * scale, rows[:, 1:3] @ across * scale])
    history = analyse(*table.T)
    objection = ""
    if history.period is None and history.drag_uncertainty > STEADY * history.drag:
        objection = "neither steady nor periodic in the time given; give more with --end"
    period = f"period {history.period:.4g}" if history.period else "no period"
    say(f"N {n}: mean drag {history.drag:.7g} +- {history.drag_uncertainty:.2g}, {period}, "
        f"swing {history.swing:.2g}, {seconds:.1f} core-seconds")
    version = read.version(folder, solver.program)
    return LevelRun(n, history.drag, seconds, checksum, version, folder, objection=objection,
                    uncertainty=history.drag_uncertainty, period=history.period, history=table)
