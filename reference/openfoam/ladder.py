"""Runs a problem on several meshes, extrapolates, and makes of it what the judge reads."""

import hashlib
import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from reference.openfoam import read
from reference.openfoam.cell import Cell
from reference.openfoam.errors import InputError
from reference.openfoam.fields import FIELD, write_field
from reference.openfoam.level import LevelRun
from reference.openfoam.richardson import extrapolate
from reference.openfoam.run import FailedRun, missing_of
from reference.openfoam.store import Stored, disagreement
from verification.protocol.quantity import Level, Quantity, Result

CODE = "OpenFOAM"
TABLE = "table.csv"
BALANCES = "Surface force and body force balance to 1e-5, which shows that it converged, not that it is right."
OVER_TIME = "Means over time, at a mean velocity that is held."


@dataclass(frozen=True)
class Options:
    levels: list[int]  # N, run now
    stored: Stored | None = None
    jobs: int = 1
    out: Path = Path()
    command: str = ""


@dataclass(frozen=True)
class Problem:
    """What differs between one body and several."""

    quantity: str
    cell: Cell
    run: Callable[[Path, int], LevelRun]  # in an empty or missing folder, level N
    programs: tuple[str, ...]
    how_to_get: str
    smallest: int  # level
    multiple: int  # of which each level must be
    origin: np.ndarray  # (D,) where in the cell of the scene the origin of the mesh lies, over the side
    similar: bool = True  # the meshes of all levels are, so that an observed order means something


def check_meshes(problem: Problem, levels: list[int]) -> None:
    """Throws InputError where a level cannot be made."""
    for n in levels:
        if n < problem.smallest or n % problem.multiple:
            fix = f"the mesh needs a multiple of {problem.multiple} from {problem.smallest} on"
            raise InputError(f"--levels {n}: {fix}")


def check_levels(problem: Problem, options: Options) -> None:
    """Throws InputError also where the levels give no error estimate."""
    check_meshes(problem, options.levels)
    stored = [level.n for level in options.stored.levels] if options.stored else []
    if len({*options.levels, *(n for n in stored if n > max(options.levels))}) < 2:
        raise InputError(f"--levels {options.levels[0]}: one level gives no error estimate; name two, or add --stored")


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


def quantity_of(levels: list[Level], note: str, similar: bool) -> Quantity:
    found = extrapolate([level.size for level in levels], [level.value for level in levels], similar)
    return Quantity(found.value, found.uncertainty, tuple(levels), found.order, f"{found.note} {note}")


def quantities_of(
    problem: Problem, levels: list[Level], runs: list[LevelRun], stored: Stored | None
) -> dict[str, Quantity]:
    """The drag; the energy of the flow where it is steady and runs on two levels tell it; the period where every level sheds."""
    if runs[0].history is None:
        found = {problem.quantity: quantity_of(levels, BALANCES, problem.similar)}
        energies = [Level(f"N {run.n}", 1 / run.n, run.energy, run.core_seconds) for run in runs if run.energy is not None]
        if len(energies) > 1:
            found["energy"] = quantity_of(energies, "Twice the kinetic energy over the mass of the fluid and the square of its mean velocity.",
                                          problem.similar)
        return found
    known = [(run.uncertainty, run.period) for run in runs]
    known += [(level.uncertainty, level.period) for level in stored.levels if level.n > runs[-1].n] if stored else []
    drag = quantity_of(levels, OVER_TIME, problem.similar)
    found = {problem.quantity: replace(drag, uncertainty=math.hypot(drag.uncertainty, known[-1][0]))}
    if all(period for _, period in known):
        unit = problem.cell.side / problem.cell.speed
        periods = [replace(level, value=period * unit) for level, (_, period) in zip(levels, known, strict=True)]
        found["period"] = quantity_of(periods, "Of the force across the flow.", problem.similar)
    return found


def write_table(history: np.ndarray, cell: Cell, out: Path) -> None:
    out.mkdir(parents=True, exist_ok=True)
    rows = history * [cell.side / cell.speed, 1, 1]
    columns = "time [s or of the scene],F / (mu U) [-],force across / (mu U) [-]"
    np.savetxt(out / TABLE, rows, "%.7g", ",", header=columns, comments="")


def inputs_of(runs: list[LevelRun]) -> str:
    return hashlib.sha256("".join(run.checksum for run in runs).encode()).hexdigest()


def superficial_of(run: LevelRun, cell: Cell) -> float:
    return read.volume(run.folder) / (1 - cell.solid)


def solve(problem: Problem, options: Options, folder: Path) -> Result:
    """Runs the levels in subfolders of `folder`, and writes field.npz of the finest. Throws InputError."""
    check_levels(problem, options)
    if missing := missing_of((*problem.programs, "postProcess"), problem.how_to_get):
        return Result(CODE, command=options.command, missing=missing)
    cell, ladder = problem.cell, sorted(set(options.levels))
    try:
        with ThreadPoolExecutor(options.jobs) as pool:
            runs = list(pool.map(lambda n: problem.run(folder / f"n_{n}", n), ladder))
        finest = runs[-1]
        write_field(finest.folder, cell, superficial_of(finest, cell), problem.origin, options.out)
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
        quantities=quantities_of(problem, levels, runs, options.stored),
        objection="; ".join(objections),
        field=FIELD,
        table=TABLE if finest.history is not None else "",
    )
