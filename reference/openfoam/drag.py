"""The problem `drag`: one fixed body in a square or cubic cell, steady or over time."""

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from reference.openfoam import read
from reference.openfoam.cell import Cell
from reference.openfoam.errors import InputError
from reference.openfoam.fields import FIELD, write_field
from reference.openfoam.ladder import Problem
from reference.openfoam.level import LevelRun, energy_of, run_level
from reference.openfoam.run import HOW_TO_GET
from reference.openfoam.transient import run_transient
from verification.protocol.quantity import Quantity, Result

MULTIPLE = {2: 4, 3: 2}  # the blocks hold 0.75 N and 1.5 N cells outwards


def level_of_spacing(cell: Cell, spacing: float) -> int:
    """The level N whose cells are about as wide as a spacing: along a side in the plane, along half an edge in space."""
    multiple, along = MULTIPLE[cell.dimension], cell.side if cell.dimension == 2 else cell.side / 2
    return max(2 * multiple, multiple * round(along / spacing / multiple))


def drag_at(cell: Cell, spacing: float, out: Path) -> Result:
    """Drag on one body, on one mesh as wide as a spacing, without an estimate of its error; leaves the field in `out`.

    Throws InputError and FailedRun.
    """
    problem, n = drag_problem(cell), level_of_spacing(cell, spacing)
    with tempfile.TemporaryDirectory(prefix="openfoam_") as folder:
        found = problem.run(Path(folder) / "case", n)
        write_field(found.folder, cell, read.volume(found.folder) / (1 - cell.solid), problem.origin, out)
    quantities = {name: Quantity(value, 0.0, note=f"one mesh, N {n}") for name, value in (("drag", found.drag), ("energy", found.energy))}
    return Result("OpenFOAM", found.version, inputs=found.checksum, quantities=quantities, objection=found.objection, field=FIELD)


def drag_problem(cell: Cell, end: float | None = None) -> Problem:
    """`end`: run over time until then, in sides over superficial velocity. Throws InputError."""
    if len(cell.positions) != 1:
        many = f"{len(cell.positions)} bodies"
        raise InputError(f"{cell.file}: body.0.positions: {many}; `drag` is for one, take the problem `bodies`")
    if end is not None and cell.dimension == 3:
        raise InputError("--transient: works in the plane alone; leave it out for a scene in space")
    if end is not None and end <= 0:
        raise InputError(f"--end {end}: must be above 0")

    def run(folder: Path, n: int) -> LevelRun:
        if end is not None:
            return run_transient(folder, cell, n, end)
        return replace(run_level(folder, cell, n), energy=energy_of(folder))

    program = "simpleFoam" if end is None else "pimpleFoam"
    multiple = MULTIPLE[cell.dimension]
    return Problem("drag", cell, run, ("blockMesh", "checkMesh", program), HOW_TO_GET, 2 * multiple, multiple,
                   np.array(cell.positions[0]))
