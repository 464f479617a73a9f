"""The problem `bodies`: the total drag on several fixed discs or spheres in a periodic cell, on unstructured meshes."""

import shutil
from pathlib import Path

import numpy as np

from reference.openfoam import plane_mesh, space_mesh
from reference.openfoam.case_files import Steady, write_case
from reference.openfoam.cell import Cell
from reference.openfoam.errors import InputError
from reference.openfoam.ladder import Problem
from reference.openfoam.level import LevelRun, measure
from reference.openfoam.shift import clear_cuts
from verification.protocol.quantity import checksum_of

CLEAR = 0.05  # of a radius, from a surface to a side of the cell
SMALLEST = {2: 12, 3: 6}  # coarser meshes do not converge
ITERATIONS = 5000  # a run that converges takes some hundreds
HOW_TO_GET = "apt-get install openfoam gmsh"


def bodies_problem(cell: Cell) -> Problem:
    """Throws InputError."""
    shift, clearance = clear_cuts(np.array(cell.positions), cell.radius)
    if clearance < CLEAR * cell.radius:
        raise InputError(f"{cell.file}: body.0.positions: every cut through the box meets a body, and the mesh needs "
                         "one along each axis that meets none; move one")
    positions = (np.array(cell.positions) + shift) % 1.0
    mesh = plane_mesh if cell.dimension == 2 else space_mesh

    def run(folder: Path, n: int) -> LevelRun:
        shutil.rmtree(folder, ignore_errors=True)
        files = write_case(folder, cell, Steady(0.9, 1e-7, ITERATIONS), mesh.kinds(len(positions)))
        files += mesh.write_input(folder, positions, cell.radius, n)
        return measure(folder, cell, n, checksum_of(files, folder), mesh.make_mesh(folder))

    return Problem("total_drag", cell, run, (*mesh.PROGRAMS, "checkMesh", "simpleFoam"), HOW_TO_GET,
                   SMALLEST[cell.dimension], 1, -shift, similar=False)
