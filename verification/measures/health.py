"""Whether the particles of a run are still a fluid: figures of its last state that classes of failure are told from."""

import numpy as np

from verification.protocol.run import Run

LOWEST = 0.001  # share of the PPs below the distance that `nearest` gives
INSIDE = 0.5  # spacings: a PP that is deeper in a solid has leaked
BLOCK = 512  # PPs whose distances are worked out at a time


def _distances(points: np.ndarray, box: np.ndarray, reach: float) -> np.ndarray:
    """(n,) from each point to the nearest other, in a periodic box; `reach` is how far is looked, and stands where there is none."""
    order = np.argsort(points[:, 0])
    points, places = points[order], np.arange(len(points))
    found = np.full(len(points), reach)
    for start in range(0, len(points), BLOCK):
        block = points[start : start + BLOCK]
        off = np.abs(points[None, :, 0] - block[:, None, 0][[0, -1]])
        near = (np.minimum(off, box[0] - off).min(axis=0) <= reach) | (
            (points[:, 0] >= block[0, 0]) & (points[:, 0] <= block[-1, 0]))
        others = points[near]
        gap = np.abs(block[:, None, :] - others[None, :, :])
        gap = np.minimum(gap, box - gap)
        square = np.einsum("ijk,ijk->ij", gap, gap)
        square[places[start : start + BLOCK, None] == places[near]] = np.inf  # itself
        found[start : start + BLOCK] = np.minimum(reach, np.sqrt(square.min(axis=1)))
    back = np.empty_like(found)
    back[order] = found
    return back


def nearest(run: Run) -> float:
    """Distance to the nearest PP, in spacings, that a thousandth of the PPs fall below. 1 on a square lattice, 1.07 on a hexagonal one;
    far below where PPs clump in pairs."""
    box = np.array(run.scene["box"]["size"], float)
    spacing = run.scene["fluid"]["spacing"]
    points = run.fluid()["points"][:, : len(box)] % box
    return float(np.quantile(_distances(points, box, 2 * spacing), LOWEST)) / spacing


def inside(run: Run) -> float:
    """Share of the PPs that lie deeper than half a spacing in a ball of a solid."""
    box = np.array(run.scene["box"]["size"], float)
    if not run.snapshots("solids"):
        return 0.0
    points, balls = run.fluid()["points"][:, : len(box)], run.solids()
    leaked = np.zeros(len(points), bool)
    for centre, radius in zip(balls["points"][:, : len(box)], balls["radius"], strict=True):
        gap = np.abs(points - centre) % box
        gap = np.minimum(gap, box - gap)
        leaked |= np.linalg.norm(gap, axis=1) < radius - INSIDE * run.scene["fluid"]["spacing"]
    return float(leaked.mean())


def flow(run: Run) -> float:
    """Mean velocity of the fluid at the end over fluid.reference_velocity; 1 where that is not given."""
    scale = run.scene["fluid"].get("reference_velocity")
    if not scale:
        return 1.0
    axes = "xyz"[: len(run.scene["box"]["size"])]
    return float(np.linalg.norm([run.series[f"fluid_velocity_{axis}"][-1] for axis in axes])) / scale


HEALTH = {"nearest": nearest, "inside": inside, "flow": flow}
