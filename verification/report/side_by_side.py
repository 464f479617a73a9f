"""The same picture from both codes: the speed of the fluid on one colour scale, and how far the two are apart."""

from dataclasses import dataclass
from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.patches import Circle
from matplotlib.tri import CubicTriInterpolator, LinearTriInterpolator, Triangulation

from verification.protocol.run import Run
from verification.protocol.scene import in_si
from verification.report.canvas import DARK, figure_of
from verification.report.fields import Window
from verification.report.shapes import Balls, balls_of_scene, box_of, images

NODES = 200  # along each side of the picture
SLAB = 0.75  # half the thickness of the layer about the middle plane that is shown of a scene in space, in spacings


def _plane(points: np.ndarray, velocity: np.ndarray, box: np.ndarray, half: float) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 2) and speeds (n) in the plane, or near the middle plane of the third axis."""
    near = np.abs(points[:, 2] - 0.5 * box[2]) < half if len(box) == 3 else slice(None)
    return points[near, :2], np.linalg.norm(velocity[near], axis=1)


def _nodes(box: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return Window(np.zeros(2), box[:2]).nodes((NODES, NODES))


def _on_grid(points: np.ndarray, values: np.ndarray, box: np.ndarray, interpolator: type) -> np.ndarray:
    """(NODES, NODES), between the points and their periodic images, which a margin of a fifth of the box takes in."""
    places, copies = [], []
    for shift in images(box):
        moved = points + shift
        inside = np.all((moved > -0.2 * box[:2]) & (moved < 1.2 * box[:2]), axis=1)
        places.append(moved[inside])
        copies.append(values[inside])
    whole, chosen = np.unique(np.concatenate(places).round(9), axis=0, return_index=True)  # cells above each other in space
    return interpolator(Triangulation(*whole.T), np.concatenate(copies)[chosen])(*_nodes(box)).filled(np.nan)


def _surfaces(balls: Balls) -> np.ndarray:
    """Points (n, 2) of the circles in which the plane cuts the solids, all of them at rest: no slip holds there."""
    angle = np.linspace(0, 2 * np.pi, 180, endpoint=False)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    return np.concatenate([np.empty((0, 2)), *(centre + radius * circle for centre, radius in balls.discs())])


def _seen_from_the_body(run: Run, box: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points and velocities of the PPs. Where the body moves, its velocity and its way are taken off: the reference code holds
    it in its place."""
    fluid, body = run.fluid(), run.scene["body"][0]
    points, velocity = fluid["points"].copy(), fluid["velocity"].copy()
    if body.get("motion") == "moving":
        axes = slice(len(box))
        way = run.solids()["points"][0, axes] - balls_of_scene(run.scene).centres[0]
        points[:, axes] = np.mod(points[:, axes] - way, box)
        velocity[:, axes] -= [in_si(value) for value in body.get("velocity", [0.0] * len(box))]
    return points, velocity


def speeds(run: Run, other: Run) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(box, speed of this code, speed of the reference code), the latter two (NODES, NODES), NaN inside of the fixed solids.

    Linear between points, but for a mesh in space: its cells near the middle plane leave gaps at the borders of the box, which a
    smooth field bridges.
    """
    box, balls = box_of(run.scene), balls_of_scene(run.scene)
    field = other.fluid()
    half = SLAB * in_si(run.scene["fluid"]["spacing"])
    ours = _plane(*_seen_from_the_body(run, box), box, half)
    theirs = _plane(field["points"][:, : len(box)], field["velocity"][:, : len(box)], box, np.inf)
    surface, solid = _surfaces(balls), balls.distance(*_nodes(box)) < 0
    bridging = CubicTriInterpolator if len(box) == 3 else LinearTriInterpolator
    grids = []
    for (points, speed), interpolator in ((ours, LinearTriInterpolator), (theirs, bridging)):
        whole, known = np.concatenate([points, surface]), np.concatenate([speed, np.zeros(len(surface))])
        grids.append(np.where(solid, np.nan, _on_grid(whole, known, box, interpolator)))
    return box, *grids


@dataclass(frozen=True)
class Apart:
    """The difference over the mean speed: its mean, and root mean squares of all of the fluid, within one cutoff of a surface,
    and beyond."""

    mean: float
    whole: float
    layer: float
    beyond: float


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.nanmean(values**2))) if np.isfinite(values).any() else np.nan


def apart(scene: dict, difference: np.ndarray) -> Apart:
    """Of a difference (NODES, NODES) over the mean."""
    near = balls_of_scene(scene).distance(*_nodes(box_of(scene))) < in_si(scene["fluid"]["rcut"])
    return Apart(float(np.nanmean(difference)), _rms(difference), _rms(difference[near]), _rms(difference[~near]))


def caption(found: Apart, code: str) -> str:
    """How large the difference is at the surface and elsewhere, and what its single spots are."""
    return (f"Dashed: one cutoff from the surface. Within it the difference from {code} has an rms of {100 * found.layer:.2g} %, beyond it "
            f"{100 * found.beyond:.2g} % of the mean speed; its mean over the fluid is {100 * found.mean:+.2g} %. One snapshot is shown: "
            "single spots of both signs are the disorder of the particles at that time.")


def _draw_layer(axes, balls: Balls, cutoff: float) -> None:
    """The circles at one cutoff from the surfaces, images included."""
    for centre, radius in balls.discs():
        for shift in images(balls.box):
            axes.add_patch(Circle(centre + shift, radius + cutoff, fill=False, edgecolor=DARK, linestyle="--", linewidth=0.8))


def compare_fields(run: Run, other: Run, code: str, title: str, file: Path) -> None:
    box, ours, theirs = speeds(run, other)
    difference = (ours - theirs) / np.nanmean(theirs)
    found, balls = apart(run.scene, difference), balls_of_scene(run.scene)
    edge = 100 * float(np.nanquantile(np.abs(difference), 0.99))
    extent = Window(np.zeros(2), box[:2]).extent
    speed = {"cmap": "viridis", "vmin": 0.0, "vmax": float(np.nanmax(theirs))}
    with figure_of(file, 11.0, 1.35 + 2.9 * box[1] / box[0], columns=3) as axes:
        for panel, values, name in ((axes[0], ours, "MaPPM"), (axes[1], theirs, code)):
            drawn = panel.imshow(values, origin="lower", extent=extent, **speed)
            panel.set_title(f"{name}: speed", fontsize=10)
        panel.figure.colorbar(drawn, ax=list(axes[:2]), shrink=0.85)
        drawn = axes[2].imshow(100 * difference, origin="lower", extent=extent, cmap="RdBu_r", vmin=-edge, vmax=edge)
        axes[2].set_title(f"difference, % of the mean; rms {100 * found.whole:.2g} %", fontsize=10)
        panel.figure.colorbar(drawn, ax=axes[2], shrink=0.85, extend="both")
        _draw_layer(axes[2], balls, in_si(run.scene["fluid"]["rcut"]))
        panel.figure.suptitle(title, fontsize=10)
        panel.figure.supxlabel(fill(caption(found, code), 165), fontsize=9)
        for panel in axes:
            panel.set(facecolor="#3a3f47", xlim=extent[:2], ylim=extent[2:], xlabel="x")
            panel.grid(visible=False)
        axes[0].set_ylabel("y")
