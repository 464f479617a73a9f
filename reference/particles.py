"""A scene as codes of particles start it: fluid and plane walls on one lattice, and what they leave in the files of the protocol.

Shared by LAMMPS, LIGGGHTS and PySPH; OpenFOAM reads scenes by it too. Numbers are those of the scene, in SI where it has units.
The lattice is that of the solver: whole cells along each side, a particle in the middle of each; those inside a wall are the
wall. The disorder of a scene is drawn alike but not from the same random numbers.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reference.exact_flows import FIELDS, field_shape, wave_axes
from verification.protocol.adapter import BadInput, Cannot
from verification.protocol.points import write_points
from verification.protocol.scene import in_si

FRAMES = 40  # that a run leaves, evenly, beside its start
COURANT = 0.25  # of h over the sound speed and the fastest motion, h half the range of the pair law
VISCOUS = 0.125  # of h^2 / nu
FORCED = 0.25  # of sqrt(h / g)


@dataclass(frozen=True)
class Wall:
    """A plane layer: low <= x_axis < low + thickness in the periodic box; velocity (D)."""

    axis: int
    low: float
    thickness: float
    velocity: np.ndarray
    extents: tuple[tuple[int, float, float], ...] = ()  # axis, from, to of each

    def holds(self, points: np.ndarray, size: np.ndarray) -> np.ndarray:
        """(n) whether points (n, D) of the box are inside."""
        inside = (points[:, self.axis] - self.low) % size[self.axis] < self.thickness
        for axis, low, high in self.extents:
            inside &= (points[:, axis] > low) & (points[:, axis] < high)
        return inside


@dataclass(frozen=True)
class Particles:
    """points (n, D), velocity (n, D), wall (n): -1 of the fluid, else which wall."""

    points: np.ndarray
    velocity: np.ndarray
    wall: np.ndarray

    @property
    def fluid(self) -> np.ndarray:
        return self.wall < 0


@dataclass(frozen=True)
class ParticleScene:
    """What codes of particles need of a scene."""

    size: np.ndarray  # (D)
    counts: np.ndarray  # (D) nodes of the lattice
    density: float
    viscosity: float  # dynamic
    reach: float  # rcut: range of the pair law
    sound_speed: float
    gravity: np.ndarray  # (D) acceleration of the fluid
    walls: tuple[Wall, ...]
    duration: float
    table: dict  # [fluid] of the scene

    @property
    def dimension(self) -> int:
        return len(self.size)

    @property
    def cell(self) -> np.ndarray:
        """(D) distance of neighbours on the lattice."""
        return self.size / self.counts

    @property
    def spacing(self) -> float:
        return float(np.prod(self.cell)) ** (1 / self.dimension)

    @property
    def mass(self) -> float:
        return self.density * float(np.prod(self.cell))

    @property
    def kinematic_viscosity(self) -> float:
        return self.viscosity / self.density


def _number(table: dict, key: str, at: str) -> float:
    """Throws BadInput."""
    if key not in table:
        raise BadInput(f"{at}.{key} is missing; give it")
    try:
        return in_si(table[key])
    except (KeyError, ValueError, TypeError, AttributeError):
        raise BadInput(f"{at}.{key} = {table[key]!r}: no number with a unit that is known; write it in SI") from None


def _vector(values: list, dimension: int) -> np.ndarray:
    return np.array([in_si(value) for value in values]) if values else np.zeros(dimension)


def _wall(body: dict, dimension: int, number: int) -> Wall:
    at = f"body.{number}"
    axis = "xyz".index(body["axis"]) if "axis" in body else dimension - 1
    given = body.get("extent", [])
    extents = tuple(("xyz".index(limits["axis"]), _number(limits, "from", f"{at}.extent"), _number(limits, "to", f"{at}.extent"))
                    for limits in (given if isinstance(given, list) else [given]))
    velocity = _vector(body.get("velocity", []), dimension)
    return Wall(axis, _number(body, "position", at), _number(body, "thickness", at), velocity, extents)


def read_particle_scene(scene: dict, sound: bool = True) -> ParticleScene:
    """Throws BadInput, and Cannot on what a fluid between plane walls does not have. Without `sound` its speed is infinite."""
    size, table, force = _vector(scene["box"]["size"], 0), scene["fluid"], scene.get("force", {})
    dimension = len(size)
    if not table.get("particles", True):
        raise Cannot("fluid.particles = false: there is no fluid in this scene")
    if "duration" not in scene.get("run", {}):
        raise Cannot("run.steps counts the steps of the solver; this code needs run.duration")
    if driven := [name for name in FIELDS if name in force]:
        raise Cannot(f"force.{driven[0]}: this code drives the fluid by a uniform acceleration alone")
    if others := [body["shape"] for body in scene.get("body", []) if body["shape"] != "wall"]:
        raise Cannot(f"body of shape {others[0]}: this code has plane walls alone")
    spacing = _number(table, "spacing", "fluid")
    return ParticleScene(
        size=size,
        counts=np.maximum(np.round(size / spacing), 1).astype(int),
        density=_number(table, "density", "fluid"),
        viscosity=_number(table, "viscosity", "fluid"),
        reach=_number(table, "rcut", "fluid") if "rcut" in table else 3 * spacing,
        sound_speed=_number(table, "sound_speed", "fluid") if sound else math.inf,
        gravity=_vector(force.get("fluid", []), dimension),
        walls=tuple(_wall(body, dimension, number) for number, body in enumerate(scene.get("body", []))),
        duration=_number(scene["run"], "duration", "run"),
        table=table,
    )


def start_velocity(scene: ParticleScene, points: np.ndarray) -> np.ndarray:
    """(n, D) of the fluid at points (n, D)."""
    velocity = np.zeros_like(points) + _vector(scene.table.get("velocity", []), scene.dimension)
    for kind in FIELDS:
        if kind in scene.table:
            declared = scene.table[kind]
            phase = 2 * np.pi * declared.get("mode", 1) * points / scene.size
            velocity += _number(declared, "amplitude", f"fluid.{kind}") * field_shape(kind, phase, *wave_axes(declared))
    return velocity


def _displaced(scene: ParticleScene, points: np.ndarray, wall: np.ndarray) -> np.ndarray:
    """Points with the disorder of the scene; those in a wall and within a spacing of one stay."""
    disorder = scene.table.get("disorder")
    if not disorder:
        return points
    move = np.random.default_rng(disorder["seed"]).uniform(-1, 1, points.shape) * disorder["amplitude"] * scene.spacing
    stays = wall >= 0
    for layer in scene.walls:
        for side in (-scene.spacing, scene.spacing):
            stays |= layer.holds((points + side * (np.arange(scene.dimension) == layer.axis)) % scene.size, scene.size)
    return (points + np.where(stays[:, None], 0.0, move)) % scene.size


def particles_of(scene: ParticleScene) -> Particles:
    """At the start of the scene."""
    nodes = np.stack(np.meshgrid(*(np.arange(count) for count in scene.counts), indexing="ij"), axis=-1)
    points = (nodes.reshape(-1, scene.dimension) + 0.5) * scene.cell
    wall = np.full(len(points), -1)
    for number, layer in enumerate(scene.walls):
        wall[layer.holds(points, scene.size)] = number
    points = _displaced(scene, points, wall)
    velocity = start_velocity(scene, points)
    for number, layer in enumerate(scene.walls):
        velocity[wall == number] = layer.velocity
    return Particles(points, velocity, wall)


def fastest_of(scene: ParticleScene, particles: Particles) -> float:
    """Largest speed of the start, or that to which the force may drive the fluid in the widest channel of the box."""
    driven = float(np.linalg.norm(scene.gravity)) * float(scene.size.max()) ** 2 / (8 * scene.kinematic_viscosity)
    return max(float(np.linalg.norm(particles.velocity, axis=1).max()), min(driven, scene.sound_speed))


def largest_step(scene: ParticleScene, h: float, fastest: float) -> float:
    """By sound, friction and force, for a smoothing length h."""
    limits = [COURANT * h / (scene.sound_speed + fastest), VISCOUS * h**2 / scene.kinematic_viscosity]
    force = float(np.linalg.norm(scene.gravity))
    return min(limits + ([FORCED * math.sqrt(h / force)] if force else []))


@dataclass(frozen=True)
class Plan:
    """Of a run: `steps` of length `step`, a frame every so many and at the start."""

    step: float
    steps: int
    every: int


def plan_of(scene: ParticleScene, limit: float, steps: int | None) -> Plan:
    """To the end of the scene, which is met exactly, or for so many steps."""
    every = max(1, math.ceil(scene.duration / FRAMES / limit))
    step = scene.duration / FRAMES / every
    if steps is None:
        return Plan(step, FRAMES * every, every)
    return Plan(step, steps, min(every, steps))


Frame = tuple[float, np.ndarray, np.ndarray]  # time, points (n, D), velocity (n, D)


def leave_frames(out: Path, scene: ParticleScene, particles: Particles, frames: Iterable[Frame],
                 mass: float | None = None) -> None:
    """Writes the snapshots and series.csv of frames that are in the order of `particles`; mass, of one of them, by default
    that of the lattice."""
    mass = scene.mass if mass is None else mass
    fluid, axes = particles.fluid, "xyz"[: scene.dimension]
    lines = ["time," + ",".join(f"fluid_velocity_{axis}" for axis in axes) + ",fluid_energy"]
    for number, (time, points, velocity) in enumerate(frames):
        write_points(out, number, time, points % scene.size, velocity, ~fluid)
        moving = velocity[fluid]
        row = [time, *moving.mean(axis=0), 0.5 * mass * float(np.sum(moving**2))]
        lines.append(",".join(repr(float(value)) for value in row))
    (out / "series.csv").write_text("\n".join(lines) + "\n")
