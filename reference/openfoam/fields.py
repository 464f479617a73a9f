"""The velocity that a run left, in the frame and units of the scene, for pictures."""

from pathlib import Path

import numpy as np

from reference.openfoam import read
from reference.openfoam.cell import Cell
from reference.openfoam.run import run

FIELD = "field.npz"
LARGEST = 20000  # cells of a field in space


def write_field(folder: Path, cell: Cell, superficial: float, origin: np.ndarray, out: Path) -> None:
    """Writes OUT/field.npz from the last time of a run whose superficial velocity is `superficial`.

    `origin`, (D,): where in the cell of the scene the origin of the mesh lies, over the side. In space only the cells
    nearest to the middle plane of the box are written, LARGEST at most, or files would be large.
    """
    run(folder, "postProcess", "-func", "writeCellCentres", "-latestTime")
    last = read.latest(folder)
    points = read.vectors(last / "C")[:, : cell.dimension] + origin
    velocity = read.vectors(last / "U")[:, : cell.dimension]
    if cell.dimension == 3:
        away = np.abs(points[:, 2] % 1.0 - 0.5)
        chosen = np.argsort(away, kind="stable")[: min(LARGEST, round(2 * len(away) ** (2 / 3)))]
        points, velocity = points[chosen], velocity[chosen]
    points = points % 1.0 * cell.side
    velocity = velocity * (cell.speed / superficial)
    out.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(out / FIELD, points=points, velocity=velocity)
