"""Bodies that meet and walls, as numbers of one system of units, read from a scene of the solver."""

import math
from dataclasses import dataclass

import numpy as np

from verification.protocol.scene import in_si


@dataclass(frozen=True)
class Body:
    radius: float
    mass: float
    position: np.ndarray  # (D,)
    velocity: np.ndarray  # (D,)
    spin: np.ndarray  # (3,) in space, (1,) in the plane


@dataclass(frozen=True)
class Face:
    """Of a wall at rest: bodies are on its side `sign` along `axis`."""

    axis: int
    place: float
    sign: int


@dataclass(frozen=True)
class Law:
    model: str  # "linear" or "hertz"
    stiffness: float
    young: float
    poisson: float
    restitution: float
    friction: float


@dataclass(frozen=True)
class ContactScene:
    size: np.ndarray  # of the periodic box, (D,)
    bodies: tuple[Body, ...]
    faces: tuple[Face, ...]
    law: Law
    gravity: np.ndarray  # (D,), of the bodies
    step: float
    steps: int
    sample: int  # steps between rows of a table

    @property
    def dimension(self) -> int:
        return len(self.size)


SHAPES = {2: "disc", 3: "sphere"}


def _vector(values: list, dimension: int) -> np.ndarray:
    if len(values) != dimension:
        raise ValueError(f"{values}: write {dimension} components")
    return np.array([in_si(value) for value in values])


def _refuse(table: dict, where: str, **allowed) -> None:
    """Keys that would change the motion in a way that is not known here, unless they have the value allowed."""
    for key, value in allowed.items():
        if key in table and table[key] != value:
            raise ValueError(f"{where}.{key} = {table[key]!r}: not supported; remove it")


def _positions(body: dict, where: str, dimension: int) -> list[np.ndarray]:
    if "position" in body:
        return [_vector(body["position"], dimension)]
    if "positions" in body:
        return [_vector(position, dimension) for position in body["positions"]]
    raise ValueError(f"{where}: matrices and random places are not supported; write position or positions")


def _bodies(body: dict, where: str, dimension: int) -> list[Body]:
    if body["shape"] != SHAPES[dimension]:
        raise ValueError(f"{where}.shape = {body['shape']!r}: not supported; write \"{SHAPES[dimension]}\"")
    _refuse(body, where, motion="free", rotates=True, contact_radius=body["radius"])
    radius = in_si(body["radius"])
    volume = math.pi * radius**2 if dimension == 2 else 4 / 3 * math.pi * radius**3
    zero = [0.0] * dimension
    spin = body.get("angular_velocity", 0.0 if dimension == 2 else zero)
    spin = _vector([spin] if dimension == 2 else spin, 1 if dimension == 2 else 3)
    found = []
    for n, position in enumerate(_positions(body, where, dimension)):
        velocity = body.get("velocity", zero)
        if n == 0:
            velocity = body.get("first_velocity", velocity)
        found.append(Body(radius, volume * in_si(body["density"]), position, _vector(velocity, dimension), spin))
    return found


def _faces(wall: dict, where: str, size: np.ndarray) -> list[Face]:
    """Both of a wall from `position` on; the lower one belongs to bodies below it, through the border if it lies there."""
    _refuse(wall, where, motion="fixed", extent=None)
    axis = "xyz".index(wall.get("axis", "xyz"[len(size) - 1]))
    lower, upper = in_si(wall["position"]), in_si(wall["position"]) + in_si(wall["thickness"])
    side = size[axis]
    return [Face(axis, upper % side, 1), Face(axis, lower if lower > 0 else side, -1)]


def _law(table: dict) -> Law:
    if table.get("model") not in ("linear", "hertz"):
        raise ValueError(f"contact.model = {table.get('model')!r}: write \"linear\" or \"hertz\"")
    linear = table["model"] == "linear"
    return Law(table["model"], in_si(table["stiffness"]) if linear else math.nan, math.nan if linear else in_si(table["young"]),
               math.nan if linear else float(table["poisson"]), float(table.get("restitution", 1.0)), float(table.get("friction", 0.0)))


def _steps(run: dict, step: float) -> int:
    if "steps" in run:
        return int(run["steps"])
    return math.ceil(in_si(run["duration"]) / step - 1e-9)


def contact_scene(scene: dict) -> ContactScene:
    """Throws ValueError naming key, value and fix."""
    try:
        return _contact_scene(scene)
    except (KeyError, IndexError, TypeError, AttributeError) as error:
        raise ValueError(f"{error} is missing or no value of a scene; mend the scene") from None


def _contact_scene(scene: dict) -> ContactScene:
    size = np.array([in_si(side) for side in scene["box"]["size"]])
    if scene["fluid"].get("particles", True):
        raise ValueError("fluid.particles = true: solids alone can be computed here; write particles = false")
    if "step" not in scene["run"]:
        raise ValueError("run.step: missing; the step must be given, not a factor of a limit")
    _refuse(scene["run"], "run", relax=0)
    bodies, faces = [], []
    for n, body in enumerate(scene["body"]):
        if body["shape"] == "wall":
            faces += _faces(body, f"body.{n}", size)
        else:
            bodies += _bodies(body, f"body.{n}", len(size))
    if not bodies:
        raise ValueError("body: no sphere or disc; add one")
    gravity = scene.get("force", {}).get("solid", [0.0] * len(size))
    if gravity == "balance":
        raise ValueError('force.solid = "balance": there is no fluid to balance; write a vector')
    step = in_si(scene["run"]["step"])
    return ContactScene(size, tuple(bodies), tuple(faces), _law(scene.get("contact", {})), _vector(gravity, len(size)), step,
                        _steps(scene["run"], step), int(scene.get("output", {}).get("sample", 100)))
