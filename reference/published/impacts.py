"""Measured impacts: the oblique ones of Kharaz, Gorham and Salman (2001)."""

import math

from reference.published.table import read_table
from reference.published.value import Published

UNCERTAINTY = {"tangential_restitution": 0.005, "spin": 23.0}  # standard
SAME_ANGLE = 0.02  # degrees


def angles_of(figure: str) -> list[float]:
    """Of the figure's points, degrees: the mean of two readings, to a hundredth."""
    return [round(_mean(row, "angle"), 2) for row in _rows(figure)]


def _rows(figure: str) -> list[dict[str, str]]:
    return [row for row in read_table("kharaz_2001").rows if row["figure"] == figure]


def _mean(row: dict[str, str], key: str) -> float:
    return 0.5 * (float(row[key]) + float(row[f"{key}_again"]))


def kharaz(figure: str, angle: float) -> Published:
    """"tangential_restitution", or "spin" in rad/s, at an angle of the figure. Throws ValueError at others."""
    for row, known in zip(_rows(figure), angles_of(figure), strict=True):
        if abs(known - angle) < SAME_ANGLE:
            return Published(_mean(row, "value"), UNCERTAINTY[figure], read_table("kharaz_2001").source)
    raise ValueError(f"angle of {angle:.4g} degrees: not measured; there are {', '.join(map(str, angles_of(figure)))}")


def angle_of(scene: dict) -> float:
    """Degrees between the velocity of the sphere and the normal of the wall, z."""
    (velocity,) = [body["velocity"] for body in scene["body"] if body["shape"] == "sphere"]
    return math.degrees(math.atan2(math.hypot(velocity[0], velocity[1]), -velocity[2]))


def kharaz_restitution(scene: dict) -> Published:
    return kharaz("tangential_restitution", angle_of(scene))


def kharaz_spin(scene: dict) -> Published:
    return kharaz("spin", angle_of(scene))
