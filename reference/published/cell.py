"""What a table is entered with, worked out from a scene: solids fraction and Reynolds number of one body in a cell."""

import math
from dataclasses import dataclass

from verification.protocol.scene import in_si


@dataclass(frozen=True)
class Cell:
    """A disc or sphere in a periodic box, units of the scene (SI where it has units)."""

    sides: tuple[float, ...]
    radius: float
    density: float
    viscosity: float
    velocity: float  # fluid.reference_velocity

    @property
    def fraction(self) -> float:
        volume = math.pi * self.radius**2 if len(self.sides) == 2 else 4 / 3 * math.pi * self.radius**3
        return volume / math.prod(self.sides)

    @property
    def reynolds(self) -> float:
        """On the diameter."""
        return 2 * self.radius * self.velocity * self.density / self.viscosity


def _number(scene: dict, table: str, key: str) -> float:
    if key not in scene[table]:
        raise ValueError(f"{table}.{key}: missing, and the table needs it; add it")
    return in_si(scene[table][key])


def cell_of(scene: dict, dimension: int) -> Cell:
    """Throws ValueError where the scene is not one disc (dimension 2) or sphere (3)."""
    sides = tuple(in_si(side) for side in scene["box"]["size"])
    bodies = [body for body in scene.get("body", []) if body.get("shape") != "wall"]
    shape = {2: "disc", 3: "sphere"}[dimension]
    if len(sides) != dimension or len(bodies) != 1 or bodies[0].get("shape") != shape or "position" not in bodies[0]:
        raise ValueError(f"body: the table holds for one {shape} given by its position, in {dimension} dimensions")
    velocity = in_si(scene["fluid"].get("reference_velocity", 0.0))
    density, viscosity = _number(scene, "fluid", "density"), _number(scene, "fluid", "viscosity")
    return Cell(sides, in_si(bodies[0]["radius"]), density, viscosity, velocity)


def equal_sides(scene: dict, dimension: int) -> Cell:
    """cell_of in a box of equal sides. Throws ValueError."""
    cell = cell_of(scene, dimension)
    if max(cell.sides) > min(cell.sides) * (1 + 1e-9):
        raise ValueError(f"box.size = {list(cell.sides)}: the table holds for equal sides")
    return cell


def refuse_outside(name: str, value: float, lowest: float, highest: float, source: str) -> None:
    """Throws ValueError."""
    if not lowest <= value <= highest:
        raise ValueError(f"{name} = {value:.6g}: outside {lowest:g} to {highest:g}, the range of {source}")
