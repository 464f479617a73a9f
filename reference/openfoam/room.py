"""The fluid of a scene as a mesh sees it: a rectangle or a cuboid, along each axis periodic or between two plane walls."""

from dataclasses import dataclass

import numpy as np

from reference.exact_flows import gap_between
from reference.particles import ParticleScene
from verification.protocol.adapter import Cannot

SAME = 1e-3  # of the spacing: faces of walls that are this close meet


@dataclass(frozen=True)
class Room:
    """Numbers of the scene, in SI where it has units. D = 2 or 3."""

    origin: np.ndarray  # (D) its lowest corner in the box of the scene
    size: np.ndarray  # (D)
    cells: np.ndarray  # (D) along each side
    walls: dict[int, tuple[np.ndarray, np.ndarray]]  # by axis the velocities (D) of the lower and of the upper wall

    @property
    def width(self) -> np.ndarray:
        """(D) of a cell."""
        return self.size / self.cells

    @property
    def count(self) -> int:
        return int(np.prod(self.cells))

    def centres(self) -> np.ndarray:
        """(n, D) of the cells from the lowest corner, in the order of OpenFOAM: x runs first."""
        axes = [(np.arange(count) + 0.5) * width for count, width in zip(self.cells, self.width, strict=True)]
        mesh = np.meshgrid(*axes[::-1], indexing="ij")[::-1]
        return np.stack(mesh, axis=-1).reshape(-1, len(axes))


def _covers(start: float, end: float, low: float, width: float, side: float, near: float) -> bool:
    """Whether a wall from `start` to `end` reaches over the gap from `low` on."""
    before = (low - start + near) % side - near  # of the gap's start, from the start of the wall
    return before >= -near and before + width <= end - start + near


def room_of(scene: ParticleScene) -> Room:
    """Throws Cannot where the fluid fills no such room."""
    near = SAME * scene.spacing
    origin, size, walls = np.zeros(scene.dimension), scene.size.copy(), {}
    for axis in {wall.axis for wall in scene.walls}:
        across = [wall for wall in scene.walls if wall.axis == axis]
        layers = [(wall.low, wall.thickness) for wall in across]
        start, size[axis], below, above = gap_between(layers, float(scene.size[axis]), near)
        start %= scene.size[axis]
        origin[axis] = 0.0 if scene.size[axis] - start < near else start
        walls[axis] = (across[below].velocity, across[above].velocity)
    for wall in scene.walls:
        for along, start, end in wall.extents:
            if not _covers(start, end, float(origin[along]), float(size[along]), float(scene.size[along]), near):
                raise Cannot("a wall that ends within the fluid: this code has rooms whose walls reach from side to side")
    cells = np.maximum(np.round(size / scene.spacing), 1).astype(int)
    return Room(origin, size, cells, walls)
