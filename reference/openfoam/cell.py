"""A scene as OpenFOAM computes it: bodies at rest in a periodic cell of side 1, with a superficial velocity of 1.

Density is 1 too, so the kinematic viscosity is 2 r / Re, with r the radius over the side and Re on the diameter.
"""

import math
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reference.openfoam.errors import InputError
from verification.protocol.scene import in_si, read_scene

SHAPES = {2: "disc", 3: "sphere"}


@dataclass(frozen=True)
class Cell:
    """Lengths over the side of the cell but for `side` and `speed`, which are in the units of the scene."""

    dimension: int
    radius: float
    reynolds: float  # 2 rho R U / mu
    direction: tuple[float, ...]  # of the force on the fluid, of length 1
    side: float = 1.0
    speed: float = 1.0  # the superficial velocity
    positions: tuple[tuple[float, ...], ...] = ()  # of the bodies, from a corner of the cell
    file: str = ""  # of the scene, for messages

    @property
    def solid(self) -> float:
        """The solids fraction."""
        one = math.pi * self.radius**2 if self.dimension == 2 else 4 / 3 * math.pi * self.radius**3
        return one * len(self.positions)

    @property
    def viscosity(self) -> float:
        return 2 * self.radius / self.reynolds


def cell_of(dimension: int, solid: float, reynolds: float) -> Cell:
    """One body in the middle, the force along x."""
    radius = math.sqrt(solid / math.pi) if dimension == 2 else (3 * solid / (4 * math.pi)) ** (1 / 3)
    along_x = (1.0, 0.0, 0.0)[:dimension]
    return Cell(dimension, radius, reynolds, along_x, positions=((0.5,) * dimension,))


class _Reader:
    """Entries of a scene, with errors that name file and key."""

    def __init__(self, file: Path, scene: dict) -> None:
        self.file, self.scene = file, scene

    def fail(self, key: str, value: object, fix: str) -> InputError:
        return InputError(f"{self.file}: {key} = {value!r}: {fix}")

    def entry(self, key: str, default: object = None):
        found = self.scene
        for part in key.split("."):
            try:
                found = found[int(part)] if isinstance(found, list) else found[part]
            except (KeyError, IndexError):
                if default is not None:
                    return default
                raise InputError(f"{self.file}: {key}: missing; add it") from None
        return found

    def number(self, key: str) -> float:
        try:
            value = in_si(self.entry(key))
        except (KeyError, ValueError, AttributeError):
            raise self.fail(key, self.entry(key), "not a quantity; write a number or a number and a unit") from None
        if not value > 0:
            raise self.fail(key, self.entry(key), "must be above 0")
        return value

    def vector(self, key: str, dimension: int) -> np.ndarray:
        try:
            values = np.array([in_si(value) for value in self.entry(key)])
        except (KeyError, ValueError, TypeError, AttributeError):
            raise self.fail(key, self.entry(key), "not a vector; write a list of quantities") from None
        if len(values) != dimension:
            raise self.fail(key, self.entry(key), f"write {dimension} components")
        return values

    def side(self) -> tuple[int, float]:
        dimension = len(self.entry("box.size"))
        size = self.vector("box.size", dimension)
        if dimension not in SHAPES or size.min() <= 0 or np.ptp(size) > 1e-12 * size.max():
            raise self.fail("box.size", self.entry("box.size"), "write two or three equal sides above 0")
        return dimension, float(size[0])

    def positions(self, dimension: int) -> np.ndarray:
        if "positions" in self.entry("body.0"):
            listed = self.entry("body.0.positions")
            return np.array([self.vector(f"body.0.positions.{i}", dimension) for i in range(len(listed))])
        return self.vector("body.0.position", dimension)[None, :]


def _check_gaps(reader: _Reader, positions: np.ndarray, radius: float) -> None:
    for i in range(len(positions)):
        for j in range(i):
            apart = positions[i] - positions[j]
            if np.linalg.norm(apart - np.round(apart)) <= 2 * radius:
                raise reader.fail("body.0.positions", f"{j} and {i}", "these bodies overlap; move one")
    if 2 * radius >= 1:
        raise reader.fail("body.0.radius", reader.entry("body.0.radius"), "the body meets its images; enlarge the box")


def read_cell(file: Path, overrides: list[str]) -> Cell:
    """The cell of a scene with one kind of body, disc or sphere, whose places are written out. Throws InputError."""
    try:
        reader = _Reader(file, read_scene(file, overrides))
    except FileNotFoundError:
        raise InputError(f"{file}: no such file; give a scene") from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{file}: {error}; mend the TOML") from None
    except (KeyError, IndexError, TypeError, ValueError):
        raise InputError(f"{file}: --set {' '.join(overrides)}: no such key; see solver/scene/README.md") from None
    dimension, side = reader.side()
    if len(reader.entry("body")) != 1:
        raise reader.fail("body", f"{len(reader.entry('body'))} kinds", "OpenFOAM computes scenes of one; leave one")
    shape = reader.entry("body.0.shape")
    if shape != SHAPES[dimension]:
        raise reader.fail("body.0.shape", shape, f'OpenFOAM computes "{SHAPES[dimension]}" in this box')
    motion = reader.entry("body.0.motion", "free")
    if motion not in ("fixed", "moving"):
        raise reader.fail("body.0.motion", motion, 'the drag is that of a held body; write "fixed" or "moving"')
    radius = reader.number("body.0.radius")
    speed = reader.number("fluid.reference_velocity")
    reynolds = 2 * radius * speed * reader.number("fluid.density") / reader.number("fluid.viscosity")
    force = reader.vector("force.fluid", dimension)
    if not np.linalg.norm(force) > 0:
        raise reader.fail("force.fluid", reader.entry("force.fluid"), "must not be 0; it gives the direction")
    positions = reader.positions(dimension) / side
    _check_gaps(reader, positions, radius / side)
    return Cell(
        dimension,
        radius / side,
        reynolds,
        tuple((force / np.linalg.norm(force)).tolist()),
        side,
        speed,
        tuple(map(tuple, positions.tolist())),
        str(file),
    )
