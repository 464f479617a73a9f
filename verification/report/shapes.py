"""Solids as the plane of a picture cuts them: balls as discs, walls as strips, with their periodic images."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np

from verification.protocol.run import Run
from verification.protocol.scene import in_si


def box_of(scene: dict) -> np.ndarray:
    """(D,), in the units of the scene."""
    return np.array([in_si(side) for side in scene["box"]["size"]])


@dataclass(frozen=True)
class Balls:
    """In a periodic box (D,). In space the picture shows the middle plane of the third axis."""

    box: np.ndarray
    centres: np.ndarray  # (n, D)
    radius: np.ndarray  # (n,)

    @property
    def depth(self) -> np.ndarray:
        """(n,): of the centres, from the plane of the picture."""
        return self.centres[:, 2] - 0.5 * self.box[2] if len(self.box) == 3 else np.zeros(len(self.centres))

    def distance(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """From places in the plane to the nearest surface, negative inside; infinite where there is no ball."""
        nearest = np.full(x.shape, np.inf)
        for centre, radius, depth in zip(self.centres, self.radius, self.depth, strict=True):
            dx, dy = (d - side * np.round(d / side) for d, side in zip((x - centre[0], y - centre[1]), self.box[:2], strict=True))
            nearest = np.minimum(nearest, np.sqrt(dx**2 + dy**2 + depth**2) - radius)
        return nearest

    def discs(self) -> Iterator[tuple[np.ndarray, float]]:
        """(centre (2,), radius) of the cuts with the plane, each once."""
        cut = self.radius**2 - self.depth**2
        for centre, squared in zip(self.centres, cut, strict=True):
            if squared > 0:
                yield centre[:2], float(np.sqrt(squared))


def balls_of_scene(scene: dict) -> Balls:
    """Where the scene sets them."""
    box, centres, radius = box_of(scene), [], []
    for body in scene.get("body", []):
        if body["shape"] != "wall":
            places = body.get("positions", [body["position"]] if "position" in body else [])
            centres += [[in_si(value) for value in place] for place in places]
            radius += [in_si(body["radius"])] * len(places)
    return Balls(box, np.array(centres).reshape(-1, len(box)), np.array(radius))


def balls_of_run(run: Run, which: int = -1) -> Balls:
    """Where a snapshot of the run has them."""
    box = box_of(run.scene)
    if not run.snapshots("solids"):
        return balls_of_scene(run.scene)
    solids = run.solids(which)
    return Balls(box, solids["points"][:, : len(box)], solids["radius"])


@dataclass(frozen=True)
class Strip:
    """A wall, from `low` to `high` (2,) in the plane; what lies beyond the box is its periodic image."""

    low: np.ndarray
    high: np.ndarray
    velocity: np.ndarray  # (2,)


def _strip(body: dict, box: np.ndarray) -> Strip | None:
    """None where the wall does not cut the plane of the picture in a strip."""
    axis = "xyz".index(body.get("axis", "xyz"[len(box) - 1]))
    low, high = np.zeros(len(box)), box.copy()
    low[axis] = in_si(body["position"])
    high[axis] = low[axis] + in_si(body["thickness"])
    given = body.get("extent", [])
    for limits in given if isinstance(given, list) else [given]:
        along = "xyz".index(limits["axis"])
        low[along], high[along] = (in_si(limits[end]) for end in ("from", "to"))
    if len(box) == 3 and (axis == 2 or not low[2] <= 0.5 * box[2] <= high[2]):
        return None
    velocity = np.array([in_si(value) for value in body.get("velocity", [0.0] * len(box))])
    return Strip(low[:2], high[:2], velocity[:2] if body.get("motion") == "moving" else np.zeros(2))


def strips_of(scene: dict) -> list[Strip]:
    strips = (_strip(body, box_of(scene)) for body in scene.get("body", []) if body["shape"] == "wall")
    return [strip for strip in strips if strip is not None]


def window_of(scene: dict) -> np.ndarray:
    """(2,): the lower left corner of a picture of one period. Walls at the end of the box, which bound the fluid on both sides of
    it, are halved."""
    box, strips = box_of(scene)[:2], strips_of(scene)
    corner = np.zeros(2)
    for axis in range(2):
        edge = box[axis]
        for strip in sorted(strips, key=lambda strip: -strip.high[axis]):
            spans = strip.low[axis] > 0  # it does not fill the box along this axis
            if spans and abs(strip.high[axis] - edge) < 1e-9 * box[axis]:
                edge = strip.low[axis]
        corner[axis] = -0.5 * (box[axis] - edge)
    return corner


def images(box: np.ndarray) -> list[np.ndarray]:
    """(2,) each: shifts to the periodic images in the plane."""
    return [np.array(shift) * box[:2] for shift in product((0, -1, 1), repeat=2)]
