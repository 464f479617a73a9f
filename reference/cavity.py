"""Steady flow in the cavity 0 < x, y < 1 whose lid at y = 1 moves with u = 1: Chebyshev collocation, Newton's method.

Unknowns are the stream function and the vorticity at Chebyshev points, u = psi_y, v = -psi_x, w = v_x - u_y:

    Lap psi = -w,   u w_x + v w_y = Lap w / Re,   on the walls psi = 0, and psi_n given in place of a condition on w.

No time, no pressure, no grid of a published solution. The lid meets the sides in two corners where the velocity jumps;
what they cost in accuracy shows as a difference between two numbers of points. Beside each corner the conditions of the
two walls act on the same inner point: there that of the side is dropped, and w = -psi_xx taken.
"""

from dataclasses import dataclass

import numpy as np


def chebyshev(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Points on [0, 1], ascending, and the matrix of the derivative there (Trefethen, Spectral Methods in MATLAB, 2000)."""
    j = np.arange(count + 1)
    x = -np.cos(np.pi * j / count)
    weight = np.where((j == 0) | (j == count), 2.0, 1.0) * (-1.0) ** j
    distance = x[:, None] - x[None, :] + np.eye(count + 1)
    matrix = weight[:, None] / weight[None, :] / distance
    matrix -= np.diag(matrix.sum(axis=1))
    return 0.5 * (x + 1), 2 * matrix


def interpolate(nodes: np.ndarray, values: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Barycentric formula of Chebyshev points (Berrut and Trefethen, SIAM Review 46, 2004)."""
    weight = (-1.0) ** np.arange(len(nodes))
    weight[[0, -1]] *= 0.5
    distance = at[:, None] - nodes[None, :]
    hit = distance == 0.0
    terms = weight / np.where(hit, 1.0, distance)
    found = (terms @ values) / terms.sum(axis=1)
    return np.where(hit.any(axis=1), hit @ values, found)


@dataclass(frozen=True)
class Cavity:
    """Velocities at the nodes (x_i, y_j)."""

    nodes: np.ndarray
    u: np.ndarray
    v: np.ndarray
    correction: float  # of the stream function in the last iteration

    def u_on_vertical(self, y: np.ndarray) -> np.ndarray:
        middle = np.array([0.5])
        column = [interpolate(self.nodes, row, middle)[0] for row in self.u.T]
        return interpolate(self.nodes, np.array(column), y)

    def v_on_horizontal(self, x: np.ndarray) -> np.ndarray:
        middle = np.array([0.5])
        row = [interpolate(self.nodes, column, middle)[0] for column in self.v]
        return interpolate(self.nodes, np.array(row), x)


def solve(reynolds: tuple[float, ...], count: int, iterations: int = 12) -> Cavity:
    """At the last of some Reynolds numbers, each started from the one before; `count` + 1 points a side."""
    nodes, derivative = chebyshev(count)
    side, one = count + 1, np.eye(count + 1)
    d_x, d_y = np.kron(derivative, one), np.kron(one, derivative)
    laplacian = np.kron(derivative @ derivative, one) + np.kron(one, derivative @ derivative)
    i, j = (index.ravel() for index in np.meshgrid(np.arange(side), np.arange(side), indexing="ij"))
    inner = (i > 0) & (i < count) & (j > 0) & (j < count)
    beside, above = ((i == 0) | (i == count)) & (j > 0) & (j < count), ((j == 0) | (j == count)) & (i > 0) & (i < count)
    doubled = beside & ((j == 1) | (j == count - 1))
    lid = np.where(above & (j == count), 1.0, 0.0)
    n = side**2
    matrix, right = np.zeros((2 * n, 2 * n)), np.zeros(2 * n)
    matrix[:n, :n] = np.where(inner[:, None], laplacian, np.eye(n))
    matrix[:n, n:] = np.diag(inner.astype(float))
    walls = np.where((beside & ~doubled)[:, None], d_x, 0) + np.where(above[:, None], d_y, 0)
    walls += np.where(doubled[:, None], d_x @ d_x, 0)
    psi, w, correction = np.zeros(n), np.zeros(n), np.inf
    for number in reynolds:
        for _ in range(iterations):
            u, v, w_x, w_y = d_y @ psi, -d_x @ psi, d_x @ w, d_y @ w
            transport = w_x[:, None] * d_y - w_y[:, None] * d_x
            matrix[n:, :n] = np.where(inner[:, None], transport, walls)
            carried = u[:, None] * d_x + v[:, None] * d_y - laplacian / number
            corners = np.diag((doubled | ~(inner | beside | above)).astype(float))
            matrix[n:, n:] = np.where(inner[:, None], carried, corners)
            right[n:] = np.where(inner, u * w_x + v * w_y, lid)
            found = np.linalg.solve(matrix, right)
            correction = float(np.abs(found[:n] - psi).max())
            psi, w = found[:n], found[n:]
            if correction < 1e-10:
                break
    u, v = (d_y @ psi).reshape(side, side), (-d_x @ psi).reshape(side, side)
    return Cavity(nodes, u, v, correction)
