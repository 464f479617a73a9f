"""Fields of particles on a regular grid, by kernel sums in a periodic box."""

from dataclasses import dataclass

import numpy as np

REACH = 2.0  # of the kernel, in spacings of the particles
PER_SPACING = 5.0  # nodes
FEWEST, MOST = 160, 720  # nodes along the longer side
KNOWN = 0.02  # of the mean sum of weights: where it is less, no particle is near


@dataclass(frozen=True)
class Window:
    """One period in the plane: the lower left corner and the sides, (2,) each."""

    corner: np.ndarray
    sides: np.ndarray

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, bottom, top, as imshow takes them."""
        (left, bottom), (right, top) = self.corner, self.corner + self.sides
        return left, right, bottom, top

    def nodes(self, shape: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
        """x and y, of a shape (rows upward, columns to the right)."""
        rows, columns = shape
        x = self.corner[0] + (np.arange(columns) + 0.5) / columns * self.sides[0]
        y = self.corner[1] + (np.arange(rows) + 0.5) / rows * self.sides[1]
        return np.meshgrid(x, y)


def shape_of(window: Window, spacing: float) -> tuple[int, int]:
    """(rows, columns) of a grid that shows what particles of this spacing resolve, and no more than a picture holds."""
    longer = float(window.sides.max())
    count = np.clip(PER_SPACING * longer / spacing, FEWEST, MOST)
    columns, rows = (max(8, round(count * side / longer)) for side in window.sides)
    return rows, columns


def _deposited(places: np.ndarray, weights: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Sums (rows, columns) of weights, each shared among the four nodes around its place (n, 2), which is in cells."""
    rows, columns = shape
    first = np.floor(places - 0.5).astype(np.int64)
    share = places - 0.5 - first
    total = np.zeros(rows * columns)
    for right in (0, 1):
        for up in (0, 1):
            part = (share[:, 0] if right else 1 - share[:, 0]) * (share[:, 1] if up else 1 - share[:, 1])
            node = (first[:, 1] + up) % rows * columns + (first[:, 0] + right) % columns
            total += np.bincount(node, part * weights, minlength=rows * columns)
    return total.reshape(shape)


def _kernel(window: Window, shape: tuple[int, int], reach: float) -> np.ndarray:
    """Fourier transform of the Wendland kernel about the first node, periodic."""
    along = [np.minimum(np.arange(count), count - np.arange(count)) * side / count
             for count, side in zip(shape, window.sides[::-1], strict=True)]
    q = np.minimum(np.hypot(along[0][:, None], along[1][None, :]) / reach, 1.0)
    return np.fft.rfft2((1 - q) ** 4 * (1 + 4 * q))


def on_grid(points: np.ndarray, values: np.ndarray, window: Window, spacing: float,
            weights: np.ndarray | None = None) -> np.ndarray:
    """(k, rows, columns): the mean of values (n, k) at points (n, 2), weighted by the kernel; NaN where no particle is near.

    The kernel reaches REACH spacings, or as many nodes where these are wider. Particles are first gathered on the nodes, so the
    time grows with their number alone.
    """
    shape = shape_of(window, spacing)
    cells = window.sides / np.array(shape[::-1])
    places = (points - window.corner) / cells
    weights = np.ones(len(points)) if weights is None else weights
    kernel = _kernel(window, shape, REACH * max(spacing, float(cells.max())))

    def summed(quantity: np.ndarray) -> np.ndarray:
        return np.fft.irfft2(np.fft.rfft2(_deposited(places, quantity, shape)) * kernel, s=shape)

    near = summed(weights)
    near[near < KNOWN * near.mean()] = np.nan
    return np.stack([summed(weights * column) / near for column in values.T])


def near_middle(depth: np.ndarray, spacing: float) -> np.ndarray:
    """Weights of particles by their distance from the plane of the picture; 0 beyond 1.5 spacings."""
    return np.maximum(0.0, 1 - (depth / (1.5 * spacing)) ** 2)
