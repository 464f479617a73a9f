"""One body in a periodic cell on one mesh: made, run, measured."""

import math
import shutil
from dataclasses import KW_ONLY, dataclass
from pathlib import Path

import numpy as np

from reference.openfoam import read
from reference.openfoam.blocks import block_mesh_dict, mesh_of
from reference.openfoam.case_files import Solver, steady_for, write_case
from reference.openfoam.cell import Cell
from reference.openfoam.run import run, say
from verification.protocol.quantity import checksum_of

DRIFT = 1e-4  # of the drag over the last tenth of a steady run, relative
BALANCE = 1e-5  # between the force on the surface and the body force, relative


@dataclass(frozen=True)
class LevelRun:
    n: int
    drag: float  # F / (mu U), F / (6 pi mu R U) in space; the mean over time of a transient run
    core_seconds: float
    checksum: str
    version: str
    folder: Path
    _: KW_ONLY
    objection: str = ""
    uncertainty: float = 0.0  # of a mean over time
    period: float | None = None  # sides over superficial velocity
    energy: float | None = None  # 2 E / (m w^2), E the kinetic energy of the fluid of mass m and w its mean velocity; of a steady run
    history: np.ndarray | None = None  # (n, 3) time in these units, drag, force across; of a transient run


def drag_scale(cell: Cell, fluid_volume: float) -> float:
    """Drag per mean force on the fluid; U is that of the mesh, whose body is a little smaller than the true one."""
    superficial = fluid_volume / (1 - cell.solid)
    scale = cell.viscosity * superficial
    return 1 / (scale if cell.dimension == 2 else 6 * math.pi * cell.radius * scale)


def steady_objection(folder: Path, cell: Cell, fluid_volume: float) -> str:
    """Why a steady run cannot count. That the forces balance is no evidence of accuracy: with gradients by Gauss they
    do once the iteration has converged, even in a wrong solution."""
    gradient = read.gradients(folder, "simpleFoam")
    tail = gradient[-max(len(gradient) // 10, 2) :]
    drift = np.ptp(tail) / abs(tail[-1])
    force = read.forces(folder)[-1, 1 : 1 + cell.dimension] @ np.array(cell.direction)
    balance = abs(force / (gradient[-1] * fluid_volume) - 1)
    objections = []
    if not drift < DRIFT:
        where = "over the last tenth of the iterations"
        objections.append(f"drag drifts by {drift:.1e} {where}: no steady state, try --transient")
    if not balance < BALANCE:
        objections.append(f"force on the surface and body force differ by {balance:.1e}")
    return "; ".join(objections)


def make(folder: Path, cell: Cell, n: int, solver: Solver) -> list[Path]:
    """Writes the case into an empty folder."""
    shutil.rmtree(folder, ignore_errors=True)
    mesh = mesh_of(cell.dimension, cell.radius, n)
    patches = {name: patch.kind for name, patch in mesh.patches.items()}
    return write_case(folder, cell, solver, patches, block_mesh_dict(mesh))


def energy_of(folder: Path) -> float:
    """2 E / (m w^2) at the last time. Throws FailedRun."""
    run(folder, "postProcess", "-func", "writeCellVolumes", "-latestTime")
    last = read.latest(folder)
    velocity = read.vectors(last / "U")
    share = read.scalars(last / "V", len(velocity))
    share = share / share.sum()
    return float(share @ np.sum(velocity**2, axis=1) / np.sum((share @ velocity) ** 2))


def measure(folder: Path, cell: Cell, n: int, checksum: str, seconds: float) -> LevelRun:
    """Runs simpleFoam on a case whose mesh is made, and reads the drag. Throws FailedRun."""
    seconds += run(folder, "checkMesh") + run(folder, "simpleFoam")
    fluid_volume = read.volume(folder)
    drag = float(read.gradients(folder, "simpleFoam")[-1] * drag_scale(cell, fluid_volume))
    say(f"N {n}: drag {drag:.7g}, {seconds:.1f} core-seconds")
    version = read.version(folder, "simpleFoam")
    return LevelRun(n, drag, seconds, checksum, version, folder, objection=steady_objection(folder, cell, fluid_volume))


def run_level(folder: Path, cell: Cell, n: int) -> LevelRun:
    """Steady drag at level n. Throws FailedRun."""
    checksum = checksum_of(make(folder, cell, n, steady_for(cell, n)), folder)
    return measure(folder, cell, n, checksum, run(folder, "blockMesh"))
