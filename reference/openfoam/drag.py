"""The problem `drag`: one fixed body in a square or cubic cell, on several meshes."""

import hashlib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
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

CODE = "OpenFOAM"
STEP_OF_N = {2: 4, 3: 2}  # the blocks hold 0.75 N and 1.5 N cells outwards
BALANCES = "Surface force and body force balance to 1e-5, which shows that it converged, not that it is right."


@dataclass(frozen=True)
class Options:
    levels: list[int]  # N, run now
    stored: Stored | None = None
    jobs: int = 1
    out: Path = Path()
    command: str = ""


def check_levels(cell: Cell, options: Options) -> None:
    """Throws InputError."""
    step = STEP_OF_N[cell.dimension]
    for n in options.levels:
        if n < 2 * step or n % step:
            raise InputError(f"--levels {n}: the mesh needs a multiple of {step} from {2 * step} on")
    if len(merged_sizes(options)) < 2:
        raise InputError(f"--levels {options.levels[0]}: one level gives no error estimate; name two, or add --stored")


def merged_sizes(options: Options) -> list[int]:
    """N of the levels run now and of the finer stored ones, from coarse to fine."""
    finer = [level.n for level in options.stored.levels if level.n > max(options.levels)] if options.stored else []
    return sorted(set(options.levels)) + finer


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


def inputs_of(runs: list[LevelRun]) -> str:
    return hashlib.sha256("".join(run.checksum for run in runs).encode()).hexdigest()


def superficial_of(run: LevelRun, cell: Cell) -> float:
    return read.volume(run.folder) / (1 - cell.solid)


def drag(cell: Cell, options: Options, folder: Path) -> Result:
    """Runs the levels in subfolders of `folder`, and writes field.npz of the finest. Throws InputError."""
    check_levels(cell, options)
    if missing := missing_of(("blockMesh", "checkMesh", "simpleFoam", "postProcess")):
        return Result(CODE, command=options.command, missing=missing)
    ladder = sorted(set(options.levels))
    try:
        with ThreadPoolExecutor(options.jobs) as pool:
            runs = list(pool.map(lambda n: run_level(folder / f"n_{n}", cell, n), ladder))
        finest = runs[-1]
        middle = np.array(cell.positions[0])
        write_field(finest.folder, cell, superficial_of(finest, cell), middle, 0.26 / finest.n, options.out)
    except FailedRun as error:
        return Result(CODE, command=options.command, objection=str(error))
    levels, objections = merge(runs, options.stored)
    return Result(
        code=CODE,
        version=finest.version,
        command=options.command,
        inputs=inputs_of(runs),
        quantities={"drag": quantity_of(levels, BALANCES)},
        objection="; ".join(objections),
        field=FIELD,
    )
