"""The same picture from both codes: the speed of the fluid on one colour scale, and how far the two are apart."""

from itertools import product
from pathlib import Path

import numpy as np
from matplotlib.tri import LinearTriInterpolator, Triangulation

from verification.protocol.run import Run
from verification.protocol.scene import in_si
from verification.report.charts import figure_of

NODES = 200  # along each side of the picture
SLAB = 0.75  # half the thickness of the layer about the middle plane that is shown of a scene in space, in spacings


def _plane(points: np.ndarray, velocity: np.ndarray, box: np.ndarray, half: float) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 2) and speeds (n) in the plane, or near the middle plane of the third axis."""
    near = np.abs(points[:, 2] - 0.5 * box[2]) < half if len(box) == 3 else slice(None)
    return points[near, :2], np.linalg.norm(velocity[near], axis=1)


def _on_grid(points: np.ndarray, values: np.ndarray, box: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Linear between the points and their periodic images, which a margin of a fifth of the box takes in."""
    images, copies = [], []
    for shift in product((-1, 0, 1), repeat=2):
        moved = points + np.array(shift) * box[:2]
        inside = np.all((moved > -0.2 * box[:2]) & (moved < 1.2 * box[:2]), axis=1)
        images.append(moved[inside])
        copies.append(values[inside])
    whole = np.concatenate(images)
    return LinearTriInterpolator(Triangulation(*whole.T), np.concatenate(copies))(x, y).filled(np.nan)


def _centres(body: dict) -> list[list[float]]:
    return [[in_si(value) for value in place] for place in body.get("positions", [body["position"]] if "position" in body else [])]


def _in_bodies(scene: dict, box: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Where the plane lies in a disc or sphere, periodic images included."""
    solid = np.zeros(x.shape, dtype=bool)
    for body in scene.get("body", []):
        for centre in _centres(body):
            offset = np.stack([x - centre[0], y - centre[1]])
            offset -= np.round(offset / box[:2, None, None]) * box[:2, None, None]
            depth = centre[2] - 0.5 * box[2] if len(box) == 3 else 0.0
            solid |= np.sum(offset**2, axis=0) < in_si(body["radius"]) ** 2 - depth**2
    return solid


def _surfaces(scene: dict, box: np.ndarray) -> np.ndarray:
    """Points (n, 2) of the circles in which the plane cuts the solids, all of them at rest: no slip holds there."""
    rings = [np.empty((0, 2))]
    for body in scene.get("body", []):
        for centre in _centres(body):
            depth = centre[2] - 0.5 * box[2] if len(box) == 3 else 0.0
            radius = np.sqrt(max(0.0, in_si(body["radius"]) ** 2 - depth**2))
            angle = np.linspace(0, 2 * np.pi, 180, endpoint=False)
            rings.append(centre[:2] + radius * np.column_stack([np.cos(angle), np.sin(angle)]))
    return np.concatenate(rings)


def _seen_from_the_body(run: Run, box: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points and velocities of the PPs. Where the body moves, its velocity and its way are taken off: the reference code holds
    it in its place."""
    fluid, body = run.fluid(), run.scene["body"][0]
    points, velocity = fluid["points"].copy(), fluid["velocity"].copy()
    if body.get("motion") == "moving":
        axes = slice(len(box))
        way = run.solids()["points"][0, axes] - np.array(_centres(body)[0])
        points[:, axes] = np.mod(points[:, axes] - way, box)
        velocity[:, axes] -= [in_si(value) for value in body.get("velocity", [0.0] * len(box))]
    return points, velocity


def speeds(run: Run, other: Run) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(box, speed of this code, speed of the reference code), the latter two (NODES, NODES), NaN inside of the fixed solids."""
    box = np.array([in_si(side) for side in run.scene["box"]["size"]])
    x, y = np.meshgrid(*((np.arange(NODES) + 0.5) / NODES * side for side in box[:2]))
    field = other.fluid()
    half = SLAB * in_si(run.scene["fluid"]["spacing"])
    ours = _plane(*_seen_from_the_body(run, box), box, half)
    theirs = _plane(field["points"][:, : len(box)], field["velocity"][:, : len(box)], box, np.inf)
    solid, surface = _in_bodies(run.scene, box, x, y), _surfaces(run.scene, box)
    grids = []
    for points, speed in (ours, theirs):
        whole, known = np.concatenate([points, surface]), np.concatenate([speed, np.zeros(len(surface))])
        grids.append(np.where(solid, np.nan, _on_grid(whole, known, box, x, y)))
    return box, *grids


def compare_fields(run: Run, other: Run, code: str, title: str, file: Path) -> None:
    box, ours, theirs = speeds(run, other)
    apart = (ours - theirs) / np.nanmean(theirs)
    top = float(np.nanmax(theirs))
    edge = float(np.nanquantile(np.abs(apart), 0.99))
    extent = (0.0, box[0], 0.0, box[1])
    with figure_of(file, 10.5, 1.0 + 3.0 * box[1] / box[0], columns=3) as axes:
        for panel, values, name in ((axes[0], ours, "MaPPM"), (axes[1], theirs, code)):
            drawn = panel.imshow(values, origin="lower", extent=extent, cmap="viridis", vmin=0.0, vmax=top)
            panel.set_title(f"{name}: speed", fontsize=10)
        panel.figure.colorbar(drawn, ax=list(axes[:2]), shrink=0.85)
        drawn = axes[2].imshow(100 * apart, origin="lower", extent=extent, cmap="RdBu_r", vmin=-100 * edge, vmax=100 * edge)
        axes[2].set_title(f"difference, % of the mean; rms {100 * np.sqrt(np.nanmean(apart**2)):.1f} %", fontsize=10)
        panel.figure.colorbar(drawn, ax=axes[2], shrink=0.85)
        panel.figure.suptitle(title, fontsize=10)
        for panel in axes:
            panel.set_facecolor("#3a3f47")
            panel.grid(visible=False)
            panel.set_xticks([])
            panel.set_yticks([])
