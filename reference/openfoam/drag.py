"""The problem `drag`: one fixed body in a square or cubic cell, on several meshes."""

import hashlib
import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from reference.live import Level, Quantity, Result
from reference.openfoam import read
from reference.openfoam.cell import Cell
from reference.openfoam.errors import InputError
from reference.openfoam.fields import FIELD, write_field
from reference.openfoam.level import LevelRun, run_level
from reference.openfoam.richardson import extrapolate
from reference.openfoam.run import FailedRun, missing_of
from reference.openfoam.store import Stored, disagreement
from reference.openfoam.transient import run_transient

CODE = "OpenFOAM"
TABLE = "table.csv"
STEP_OF_N = {2: 4, 3: 2}  # the blocks hold 0.75 N and 1.5 N cells outwards
BALANCES = "Surface force and body force balance to 1e-5, which shows that it converged, not that it is right."


@dataclass(frozen=True)
class Options:
    levels: list[int]  # N, run now
    stored: Stored | None = None
    jobs: int = 1
    transient: bool = False
    end: float = 30.0  # of a transient run, sides over superficial velocity
    out: Path = Path()
    command: str = ""


def check_meshes(cell: Cell, options: Options) -> None:
    """Throws InputError where a level cannot be made."""
    step = STEP_OF_N[cell.dimension]
    if options.transient and cell.dimension == 3:
        raise InputError("--transient: works in the plane alone; leave it out for a scene in space")
    if options.end <= 0:
        raise InputError(f"--end {options.end}: must be above 0")
    for n in options.levels:
        if n < 2 * step or n % step:
            raise InputError(f"--levels {n}: the mesh needs a multiple of {step} from {2 * step} on")


def check_levels(cell: Cell, options: Options) -> None:
    """Throws InputError also where the levels give no error estimate."""
    check_meshes(cell, options)
    if len(merged_sizes(options)) < 2:
        raise InputError(f"--levels {options.levels[0]}: one level gives no error estimate; name two, or add --stored")


def merged_sizes(options: Options) -> list[int]:
    """N of the levels run now and of the finer stored ones, from coarse to fine."""
    finer = [level.n for level in options.stored.levels if level.n > max(options.levels)] if options.stored else []
    return sorted(set(options.levels)) + finer


def run_any(folder: Path, cell: Cell, n: int, options: Options) -> LevelRun:
    return run_transient(folder, cell, n, options.end) if options.transient else run_level(folder, cell, n)


def merge(runs: list[LevelRun], stored: Stored | None) -> tuple[list[Level], list[str]]:
    """Levels from coarse to fine, and what is to object."""
    levels = [Level(f"N {run.n}", 1 / run.n, float(run.drag), run.core_seconds) for run in runs]
    objections = [f"N {run.n}: {run.objection}" for run in runs if run.objection]
    if stored:
        objections += [text for run in runs if (text := disagreement(stored, run.n, run.drag))]
        levels += [
            Level(f"N {level.n}", 1 / level.n, level.value, level.core_seconds, live=False)
            for level in stored.levels
            if level.n > runs[-1].n
        ]
    return levels, objections


def quantity_of(levels: list[Level], note: str) -> Quantity:
    found = extrapolate([level.size for level in levels], [level.value for level in levels])
    return Quantity(found.value, found.uncertainty, tuple(levels), found.order, f"{found.note} {note}")


def quantities_of(cell: Cell, levels: list[Level], runs: list[LevelRun], stored: Stored | None) -> dict[str, Quantity]:
    """The drag, and the period where every level sheds."""
    if runs[0].history is None:
        return {"drag": quantity_of(levels, BALANCES)}
    known = [(run.uncertainty, run.period) for run in runs]
    known += [(level.uncertainty, level.period) for level in stored.levels if level.n > runs[-1].n] if stored else []
    drag = quantity_of(levels, "Means over time, at a mean velocity that is held.")
    found = {"drag": replace(drag, uncertainty=math.hypot(drag.uncertainty, known[-1][0]))}
    if all(period for _, period in known):
        unit = cell.side / cell.speed
        periods = [replace(level, value=period * unit) for level, (_, period) in zip(levels, known, strict=True)]
        found["period"] = quantity_of(periods, "Of the force across the flow.")
    return found


def write_table(history: np.ndarray, cell: Cell, out: Path) -> None:
    out.mkdir(parents=True, exist_ok=True)
    rows = history * [cell.side / cell.speed, 1, 1]
    np.savetxt(out / TABLE, rows, "%.7g", ",", header="time [s or of the scene],F / (mu U) [-],force across / (mu U) [-]", comments="")


def inputs_of(runs: list[LevelRun]) -> str:
    return hashlib.sha256("".join(run.checksum for run in runs).encode()).hexdigest()


def superficial_of(run: LevelRun, cell: Cell) -> float:
    return read.volume(run.folder) / (1 - cell.solid)


def drag(cell: Cell, options: Options, folder: Path) -> Result:
    """Runs the levels in subfolders of `folder`, and writes field.npz of the finest. Throws InputError."""
    check_levels(cell, options)
    program = "pimpleFoam" if options.transient else "simpleFoam"
    if missing := missing_of(("blockMesh", "checkMesh", program, "postProcess")):
        return Result(CODE, command=options.command, missing=missing)
    ladder = sorted(set(options.levels))
    try:
        with ThreadPoolExecutor(options.jobs) as pool:
            runs = list(pool.map(lambda n: run_any(folder / f"n_{n}", cell, n, options), ladder))
        finest = runs[-1]
        middle = np.array(cell.positions[0])
        write_field(finest.folder, cell, superficial_of(finest, cell), middle, 0.26 / finest.n, options.out)
    except FailedRun as error:
        return Result(CODE, command=options.command, objection=str(error))
    levels, objections = merge(runs, options.stored)
    if finest.history is not None:
        write_table(finest.history, cell, options.out)
    return Result(
        code=CODE,
        version=finest.version,
        command=options.command,
        inputs=inputs_of(runs),
        quantities=quantities_of(cell, levels, runs, options.stored),
        objection="; ".join(objections),
        field=FIELD,
        table=TABLE if finest.history is not None else "",
    )
