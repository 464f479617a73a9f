"""Moves the cell over a periodic array so that no body lies on a side."""

import numpy as np


def clear_cuts(positions: np.ndarray, radius: float) -> tuple[np.ndarray, float]:
    """positions: (n, D) over the side. Returns a shift (D,) for which the sides of the cell cut no body, and the
    least distance of a surface to a side, negative where every cut hits one.

    Along each axis the bodies cover intervals; the cut is put in the middle of the widest gap between them.
    """
    shift = np.zeros(positions.shape[1])
    clearance = np.inf
    for axis in range(positions.shape[1]):
        middles = np.sort(positions[:, axis] % 1.0)
        gaps = np.diff(np.append(middles, middles[0] + 1))
        widest = int(np.argmax(gaps))
        shift[axis] = -(middles[widest] + gaps[widest] / 2)
        clearance = min(clearance, gaps[widest] / 2 - radius)
    return shift, float(clearance)
