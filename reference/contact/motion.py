"""What an impact is measured by, from the table of a motion: the same for the solver's solids.csv and for a reference code.

Body 0 meets body 1, or a wall. The normal n points to body 0 from the other; t is the direction, across n, in which the
point of contact of body 0 moves against the other at the start, or that of body 0 itself where that does not move.
"""

import csv
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from reference.contact.scene import ContactScene


@dataclass(frozen=True)
class Motion:
    """n rows of b bodies. `force` is that on each body where the table has it."""

    scene: ContactScene
    time: np.ndarray  # (n,)
    position: np.ndarray  # (n, b, D)
    velocity: np.ndarray  # (n, b, D)
    spin: np.ndarray  # (n, b, 3), in the plane (n, b, 1)
    force: np.ndarray | None  # (n, b, D)

    @cached_property
    def overlap(self) -> np.ndarray:
        """Of body 0 and what it meets, negative while they are apart."""
        one = self.scene.bodies[0]
        if len(self.scene.bodies) > 1:
            distance = np.linalg.norm(self.position[:, 0] - self.position[:, 1], axis=1)
            return one.radius + self.scene.bodies[1].radius - distance
        return np.max([one.radius - face.sign * (self.position[:, 0, face.axis] - face.place) for face in self.scene.faces], axis=0)

    @cached_property
    def normal(self) -> np.ndarray:
        """Where the two are nearest."""
        at = int(np.argmax(self.overlap))
        if len(self.scene.bodies) > 1:
            apart = self.position[at, 0] - self.position[at, 1]
            return apart / np.linalg.norm(apart)
        nearest = min(self.scene.faces, key=lambda face: face.sign * (self.position[at, 0, face.axis] - face.place))
        return nearest.sign * np.eye(self.scene.dimension)[nearest.axis]

    def contact_velocity(self, row: int) -> np.ndarray:
        """Of the point of contact of body 0 against that of the other, by the surfaces' radii."""
        velocity = self.velocity[row, 0] - _cross(self.spin[row, 0], self.normal) * self.scene.bodies[0].radius
        if len(self.scene.bodies) > 1:
            other = self.scene.bodies[1]
            velocity = velocity - self.velocity[row, 1] - _cross(self.spin[row, 1], self.normal) * other.radius
        return velocity

    @cached_property
    def tangent(self) -> np.ndarray:
        """Zero where nothing moves across the normal."""
        for velocity in (self.contact_velocity(0), self.velocity[0, 0]):
            across = velocity - np.dot(velocity, self.normal) * self.normal
            if np.linalg.norm(across) > 1e-9 * np.linalg.norm(velocity):
                return across / np.linalg.norm(across)
        return np.zeros(self.scene.dimension)


def _cross(spin: np.ndarray, arm: np.ndarray) -> np.ndarray:
    return np.cross(spin, arm) if len(arm) == 3 else spin[0] * np.array([-arm[1], arm[0]])


def read_motion(file: Path, scene: ContactScene) -> Motion:
    """From columns position_*, velocity_*, angular_velocity* and, if there, force_*, with or without units."""
    with file.open(newline="") as lines:
        rows = csv.reader(lines)
        names = [name.partition(" [")[0] for name in next(rows)]
        values = np.array([row for row in rows], dtype=float)
    values = values.reshape(-1, len(scene.bodies), len(names))

    def part(prefix: str) -> np.ndarray | None:
        chosen = [k for k, name in enumerate(names) if name.startswith(prefix)]
        return values[:, :, chosen] if chosen else None

    return Motion(scene, values[:, 0, names.index("time")], part("position_"), part("velocity_"), part("angular_velocity"), part("force_"))


def normal_force(motion: Motion) -> np.ndarray:
    """On body 0, (rows - 1,): of the table, or its mass times the change of its velocity from row to row."""
    if motion.force is not None:
        return motion.force[:-1, 0] @ motion.normal
    return motion.scene.bodies[0].mass * np.diff(motion.velocity[:, 0] @ motion.normal) / np.diff(motion.time)


def touch_times(motion: Motion) -> tuple[float, float]:
    """Of the first touch and of the parting: zeros of the overlap, which is straight there. NaN where there is none."""
    inside = np.flatnonzero(motion.overlap > 0)
    if len(inside) == 0 or inside[0] == 0 or inside[-1] == len(motion.time) - 1:
        return math.nan, math.nan

    def zero(before: int) -> float:
        left, right = motion.overlap[before : before + 2]
        return float(motion.time[before] + (motion.time[before + 1] - motion.time[before]) * left / (left - right))

    return zero(inside[0] - 1), zero(inside[-1])


def contact_force(motion: Motion) -> float:
    """Largest, along the normal, by the parabola through the highest three rows."""
    force = normal_force(motion)
    top = int(np.clip(np.argmax(force), 1, len(force) - 2))
    left, here, right = force[top - 1 : top + 2]
    bend = here - 0.5 * (left + right)
    return float(here + (left - right) ** 2 / (16 * bend)) if bend > 0 else float(here)


def contact_time(motion: Motion) -> float:
    first, last = touch_times(motion)
    return last - first


def restitution(motion: Motion) -> float:
    relative = motion.velocity[[0, -1], 0] - (motion.velocity[[0, -1], 1] if len(motion.scene.bodies) > 1 else 0)
    before, after = relative @ motion.normal
    return float(-after / before)


def normal_velocity(motion: Motion) -> float:
    """Of body 0 after the impact, away from the other."""
    return float(motion.velocity[-1, 0] @ motion.normal)


def tangential_velocity(motion: Motion) -> float:
    """Of body 0 after the impact, along t."""
    return float(motion.velocity[-1, 0] @ motion.tangent)


def spin(motion: Motion) -> float:
    """Of body 0 after the impact, about n x t: positive for a ball that rolls along t. Without t, about its first axis."""
    n, t = motion.normal, motion.tangent
    if not t.any():
        first = motion.spin[0, 0]
        return float(motion.spin[-1, 0] @ first) / (float(np.linalg.norm(first)) or 1.0)
    axis = np.cross(n, t) if motion.scene.dimension == 3 else np.array([n[0] * t[1] - n[1] * t[0]])
    return float(motion.spin[-1, 0] @ axis)


def tangential_restitution(motion: Motion) -> float:
    """Of the velocity of the centre, along t: NaN where it has none before."""
    before = float(motion.velocity[0, 0] @ motion.tangent)
    return tangential_velocity(motion) / before if before else math.nan


def rebound_angle(motion: Motion) -> float:
    """Of the point of contact, from the normal, in degrees; negative where it returns."""
    velocity = motion.contact_velocity(-1)
    return math.degrees(math.atan2(float(velocity @ motion.tangent), abs(float(velocity @ motion.normal))))


IMPACT: dict[str, Callable[[Motion], float]] = {
    quantity.__name__: quantity
    for quantity in (contact_force, contact_time, restitution, normal_velocity, tangential_velocity, spin,
                     tangential_restitution, rebound_angle)
}


def _upward(motion: Motion) -> np.ndarray:
    return -motion.scene.gravity / np.linalg.norm(motion.scene.gravity)


def centre(motion: Motion) -> np.ndarray:
    """Height of the common centre of mass, (n,)."""
    mass = np.array([body.mass for body in motion.scene.bodies])
    return (motion.position @ _upward(motion)) @ mass / mass.sum()


def height(motion: Motion) -> float:
    """Of the topmost centre at the end."""
    return float(np.max(motion.position[-1] @ _upward(motion)))


def middle(motion: Motion) -> float:
    """Height of the common centre of mass at the end."""
    return float(centre(motion)[-1])


def fall_time(motion: Motion) -> float:
    """When the common centre of mass has first fallen half its way."""
    fallen = centre(motion)[0] - centre(motion)
    half = 0.5 * fallen[-1]
    after = int(np.argmax(fallen >= half))
    return float(np.interp(half, fallen[after - 1 : after + 1], motion.time[after - 1 : after + 1]))


def lowest_overlap(motion: Motion) -> float:
    """Deepest with a wall at the end."""
    depths = [body.radius - face.sign * (motion.position[-1, n, face.axis] - face.place)
              for n, body in enumerate(motion.scene.bodies) for face in motion.scene.faces]
    return float(max(depths))


REST: dict[str, Callable[[Motion], float]] = {
    quantity.__name__: quantity for quantity in (height, middle, fall_time, lowest_overlap)
}
