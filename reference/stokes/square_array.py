"""Stokes flow through a square array of discs, by eigenfunctions and collocation: the drag at any solids fraction.

In polar coordinates about a disc of radius a the stream function of a flow along x that is symmetric about both axes is

    psi = sum over odd n of sin(n theta) f_n(r),   f_n of r^n, r^-n, r^(n+2), r^(2-n);   for n = 1: r, 1/r, r^3, r ln r,

u = psi_y, v = -psi_x. No slip at r = a leaves two of the four. On the edges of the cell of side 1 symmetry asks for

    psi_x = 0 and w_x = 0 at x = 1/2,   psi = U / 2 and w = 0 at y = 1/2     (w = -Lap psi, the vorticity),

which is met at many points by least squares (the method of Sparrow and Loeffler, AIChE Journal 5, 1959, 325-330). Far
from a body that holds the fluid back with a force F, psi is F r ln r sin(theta) / (4 pi mu): that term gives the drag.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class ArrayDrag:
    """F / (mu U), F the mean pressure gradient times the cell, U the superficial velocity; `change`: relative, from
    three quarters of the terms to all of them."""

    drag: float
    change: float


def _powers(radius: float, n: int) -> list[list[tuple[float, int]]]:
    """The two f_n without slip at r = radius, each a list of (factor, power); power 0 stands for r ln(r / radius)."""
    if n == 1:  # r ln(r / a) - (r - a^2 / r) / 2;  r^3 - 2 a^2 r + a^4 / r
        return [[(1.0, 0), (-0.5, 1), (0.5 * radius**2, -1)], [(1.0, 3), (-2 * radius**2, 1), (radius**4, -1)]]
    # r^n and r^(n+2), completed by r^-n and r^(2-n) so that f and f' vanish at a.
    return [[(1.0, power), (-0.5 * (power + n) * radius ** (power - 2 + n), 2 - n),
             (0.5 * (power + n - 2) * radius ** (power + n), -n)] for power in (n, n + 2)]  # fmt: skip


def _value_and_slopes(power: int, n: int, r: np.ndarray, theta: np.ndarray, radius: float) -> np.ndarray:
    """psi, psi_x, w, w_x of sin(n theta) r^power, or of sin(theta) r ln(r / radius)."""
    sine, cosine = np.sin(n * theta), np.cos(n * theta)

    def along_x(f: np.ndarray, slope: np.ndarray) -> np.ndarray:
        return slope * sine * np.cos(theta) - f / r * n * cosine * np.sin(theta)

    if power == 0:
        logarithm = np.log(r / radius)
        f, slope, vorticity, its_slope = r * logarithm, logarithm + 1, -2 / r, 2 / r**2
    else:
        square = power**2 - n**2
        f, slope = r**power, power * r ** (power - 1.0)
        vorticity, its_slope = -square * r ** (power - 2.0), -square * (power - 2) * r ** (power - 3.0)
    return np.array([f * sine, along_x(f, slope), vorticity * sine, along_x(vorticity, its_slope)])


def _drag(fraction: float, terms: int) -> float:
    """Of as many odd n as `terms`."""
    radius = np.sqrt(fraction / np.pi)
    along = (np.arange(4 * terms) + 0.5) / (8 * terms)
    half = np.full_like(along, 0.5)
    r, theta = np.hypot(half, along), np.arctan2(along, half)  # of the points at x = 1/2; pi/2 - theta: at y = 1/2
    columns = []
    for n in 2 * np.arange(terms) + 1:
        for parts in _powers(radius, int(n)):
            right = sum(factor * _value_and_slopes(power, n, r, theta, radius) for factor, power in parts)
            upper = sum(factor * _value_and_slopes(power, n, r, np.pi / 2 - theta, radius) for factor, power in parts)
            columns.append(np.concatenate([right[1], right[3], upper[0], upper[2]]))
    matrix = np.column_stack(columns)
    scale = np.linalg.norm(matrix, axis=0)
    wanted = np.zeros(len(matrix))
    wanted[2 * len(along) : 3 * len(along)] = 0.5
    strengths, *_ = np.linalg.lstsq(matrix / scale, wanted, rcond=1e-15)
    return 4 * np.pi * strengths[0] / scale[0]


def square_array(fraction: float, terms: int = 32) -> ArrayDrag:
    """At a solids fraction of at most 0.6. Throws ValueError beyond."""
    if not 0 < fraction <= 0.6:
        raise ValueError(f"solids fraction {fraction}: the collocation holds above 0 and up to 0.6")
    fine, coarse = _drag(fraction, terms), _drag(fraction, 3 * terms // 4)
    return ArrayDrag(fine, abs(coarse / fine - 1))
