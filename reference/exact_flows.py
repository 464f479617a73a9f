"""Exact solutions of the Navier-Stokes equations for the scenes that have one, from the scene alone.

Periodic fields that decay as exp(-nu lambda t) while a mean stream carries them, and plane channels whose walls start to
move or whose body force starts to act, as sums of decaying modes (Batchelor 1967, section 4.3).
"""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, field

import numpy as np

from verification.protocol.adapter import Cannot
from verification.protocol.scene import in_si

FIELDS = ("wave", "vortices", "abc")
AXES = "xyz"
DECAYED = 40.0  # a mode that has lost exp(-40) is beyond the digits of a double


def field_shape(kind: str, phase: np.ndarray, along: int, across: int) -> np.ndarray:
    """(n, D) a field of FIELDS of amplitude 1 at phases k x (n, D); a wave has the direction `along` and its gradient `across`."""
    shape, sine, cosine = np.zeros_like(phase), np.sin(phase), np.cos(phase)
    if kind == "wave":
        shape[:, along] = sine[:, across]
    elif kind == "vortices":
        deep = np.prod(cosine[:, 2:], axis=1)
        shape[:, 0], shape[:, 1] = sine[:, 0] * cosine[:, 1] * deep, -cosine[:, 0] * sine[:, 1] * deep
    else:
        for axis in range(3):
            shape[:, axis] = sine[:, (axis + 2) % 3] + cosine[:, (axis + 1) % 3]
    return shape


def wave_axes(declared: dict) -> tuple[int, int]:
    """(direction, gradient) of the table of a field; (0, 1) of one that is no wave."""
    return AXES.index(declared.get("direction", "x")), AXES.index(declared.get("gradient", "y"))


def _vector(values: list | None) -> np.ndarray:
    """Three numbers; those that are not given are 0."""
    whole = np.zeros(3)
    for axis, value in enumerate(values or []):
        whole[axis] = in_si(value)
    return whole


class Exact(ABC):
    """The velocity at any place and time, in the units of the scene."""

    @abstractmethod
    def velocity(self, points: np.ndarray, time: float) -> np.ndarray:
        """At points (n, 3): (n, 3)."""

    def holds_fluid(self, points: np.ndarray) -> np.ndarray:
        """Which of the points (n, 3) lie in the fluid: (n)."""
        return np.ones(len(points), dtype=bool)


@dataclass(frozen=True)
class Decaying(Exact):
    """u = U + A f(x - U t) exp(-nu lambda t), lap f = -lambda f; k = 2 pi mode / side of each axis."""

    kind: str
    amplitude: float
    k: np.ndarray  # (3)
    rate: float  # nu lambda
    along: int = 0  # of a wave
    across: int = 1
    stream: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def velocity(self, points: np.ndarray, time: float) -> np.ndarray:
        shape = field_shape(self.kind, (points - self.stream * time) * self.k, self.along, self.across)
        return self.stream + self.amplitude * math.exp(-self.rate * time) * shape


@dataclass(frozen=True)
class Channel(Exact):
    """Fluid at rest between plane walls of which one or both start to move, or which a body force starts to drive.

    With eta = (y - y_0) / H and tau = nu t / H^2 the flow is its steady state u_s less a sum of modes,
    u = u_s - sum_n b_n sin(n pi eta) exp(-n^2 pi^2 tau), u_s = U_0 + (U_1 - U_0) eta + g H^2 eta (1 - eta) / (2 nu),
    b_n = 2 (U_0 - (-1)^n U_1) / (n pi) + 2 (1 - (-1)^n) g H^2 / (nu n^3 pi^3).
    """

    normal: int
    start: float  # y_0
    width: float  # H
    side: float  # of the periodic box along the normal
    viscosity: float  # nu
    lower: np.ndarray  # (3), U_0
    upper: np.ndarray  # (3), U_1
    force: np.ndarray  # (3), g

    def _eta(self, points: np.ndarray) -> np.ndarray:
        return (points[:, self.normal] - self.start) % self.side / self.width

    def holds_fluid(self, points: np.ndarray) -> np.ndarray:
        eta = self._eta(points)
        return (eta > 1e-9) & (eta < 1 - 1e-9)

    def velocity(self, points: np.ndarray, time: float) -> np.ndarray:
        if time <= 0:
            return np.zeros_like(points)
        eta, tau = self._eta(points)[:, None], self.viscosity * time / self.width**2
        driven = self.force * self.width**2 / self.viscosity
        found = self.lower + (self.upper - self.lower) * eta + driven * eta * (1 - eta) / 2
        for n in range(1, math.ceil(math.sqrt(DECAYED / tau) / math.pi) + 1):
            odd = 1 - (-1) ** n
            mode = 2 * (self.lower - (-1) ** n * self.upper) / (n * math.pi) + 2 * odd * driven / (n * math.pi) ** 3
            found = found - mode * np.sin(n * math.pi * eta) * math.exp(-((n * math.pi) ** 2) * tau)
        return found


def exact_flow(scene: dict) -> Exact:
    """The exact solution of a scene. Throws Cannot where none is known here."""
    fluid, force = scene["fluid"], scene.get("force", {})
    if not fluid.get("particles", True):
        raise Cannot("no fluid")
    if scene.get("run", {}).get("relax", 0):
        raise Cannot("run.relax: what the relaxation does has no exact solution")
    if any(name in force for name in FIELDS):
        raise Cannot("a force that is a field has no exact solution here")
    bodies = scene.get("body", [])
    if any(body.get("shape") != "wall" for body in bodies):
        raise Cannot("flow about bodies has no exact solution here")
    return _channel(scene) if bodies else _decaying(scene)


def _viscosity(fluid: dict) -> float:
    return in_si(fluid["viscosity"]) / in_si(fluid["density"])


def _decaying(scene: dict) -> Decaying:
    fluid, size = scene["fluid"], [in_si(side) for side in scene["box"]["size"]]
    found = [kind for kind in FIELDS if kind in fluid]
    if len(found) != 1:
        raise Cannot("a periodic scene needs one of fluid.wave, fluid.vortices, fluid.abc")
    if np.any(_vector(scene.get("force", {}).get("fluid"))):
        raise Cannot("a periodic fluid under a force has no exact solution here")
    (kind,) = found
    table = fluid[kind]
    if kind == "vortices" and len(size) == 3:
        raise Cannot("of vortices in space only the start is exact")
    k = np.zeros(3)
    k[: len(size)] = 2 * math.pi * table.get("mode", 1) / np.array(size)
    axes = wave_axes(table)
    if axes[0] == axes[1]:
        raise Cannot("a wave along its own gradient is sound, which has no exact solution here")
    eigenvalue = {"wave": k[axes[1]] ** 2, "vortices": k @ k, "abc": k[0] ** 2}[kind]
    rate = float(_viscosity(fluid) * eigenvalue)
    return Decaying(kind, in_si(table["amplitude"]), k, rate, *axes, _vector(fluid.get("velocity")))


def gap_between(layers: list[tuple[float, float]], side: float, least: float) -> tuple[float, float, int, int]:
    """Start and width of the only gap wider than `least` that layers (lower face, thickness) leave in a periodic box, and
    which of them are below and above it. Throws Cannot where there is not one.
    """
    order, gaps = sorted(range(len(layers)), key=lambda which: layers[which][0]), []
    for below, above in zip(order, order[1:] + order[:1], strict=True):
        start = sum(layers[below])
        width = layers[above][0] - start + (side if above == order[0] else 0.0)
        if width > least:
            gaps.append((start, width, below, above))
    if len(gaps) != 1:
        raise Cannot(f"{len(gaps)} channels between the walls, one is needed")
    return gaps[0]


def _channel(scene: dict) -> Channel:
    fluid, walls, size = scene["fluid"], scene["body"], scene["box"]["size"]
    last = AXES[len(size) - 1]
    axes = {wall.get("axis", last) for wall in walls}
    if len(axes) > 1 or any("extent" in wall for wall in walls):
        raise Cannot("walls that are not parallel, or limited, have no exact solution here")
    if any(kind in fluid for kind in FIELDS) or np.any(_vector(fluid.get("velocity"))):
        raise Cannot("between walls the fluid must start at rest")
    normal = AXES.index(axes.pop())
    force = _vector(scene.get("force", {}).get("fluid"))
    if force[normal]:
        raise Cannot("a force across the walls has no exact solution here")
    side = in_si(size[normal])
    layers = [(in_si(wall["position"]), in_si(wall["thickness"])) for wall in walls]
    start, width, below, above = gap_between(layers, side, 1e-3 * in_si(fluid["spacing"]))
    velocities = (_vector(walls[which].get("velocity")) for which in (below, above))
    return Channel(normal, start, width, side, _viscosity(fluid), *velocities, force)
