"""Unsteady Stokes flow through a square array of discs: its drag at a complex rate s, and a disc released from rest.

All is Laplace transformed. In the frame of the discs, whose acceleration is a part of the body force b, the stream
function of a flow along x that is symmetric about both axes is

    psi = sum over odd n of sin(n theta) f_n(r),   f_n of r^n, r^-n, I_n(k r), K_n(k r),   k^2 = s / nu.

No slip and the symmetries of the cell are met as in square_array.py. The part without vorticity has the velocity
potential phi, pressure -rho s phi, and b is what makes the pressure periodic. The flow takes up rho s U L^2 of the
momentum b V_fluid; the disc takes the rest, f. With the slip w = U / (1 - fraction), the mean velocity of the fluid
seen from the disc,

    Z(s) = f / (mu w)

is the drag at s = 0, and holds added mass and history at other rates. A disc of mass m_s and the fluid, of mass m_f in
a cell, driven apart by forces F and -F from rest, obey (m s + Z) w = F / s, m = m_s m_f / (m_s + m_f).
"""

import numpy as np

from reference.stokes.bessel import log_first_kind, log_second_kind
from reference.stokes.laplace import invert
from reference.stokes.square_array import square_array

TERMS = 24
HALF_DIAGONAL = np.sqrt(0.5)


class _Order:
    """The functions of one n: f and f' at radii, each scaled to about 1 somewhere in the cell."""

    def __init__(self, n: int, radius: float, k: complex, bessel: dict) -> None:
        self.n, self.radius, self.k, self.bessel = n, radius, k, bessel

    def functions(self, at: str) -> np.ndarray:
        """(4, 2, points): r^n, r^-n, I_n, K_n with their slopes; `at`: "edge" or "disc"."""
        r, log_i, log_k = self.bessel[at]
        n, i_scale = self.n, self.bessel["edge"][1][self.n].real.max()
        k_scale = self.bessel["disc"][2][n].real.max()
        power, inverse = (r / HALF_DIAGONAL) ** n, (self.radius / r) ** n
        i, i_next = np.exp(log_i[n] - i_scale), np.exp(log_i[n + 1] - i_scale)
        second, second_next = np.exp(log_k[n] - k_scale), np.exp(log_k[n + 1] - k_scale)
        return np.array([
            [power, n / r * power],
            [inverse, -n / r * inverse],
            [i, self.k * i_next + n / r * i],
            [second, -self.k * second_next + n / r * second],
        ])

    def without_slip(self) -> np.ndarray:
        """Two rows of four factors each: combinations that vanish at the disc with their slopes."""
        at_disc = self.functions("disc")[:, :, 0]
        inner = at_disc[[1, 3]].T
        rows = np.zeros((2, 4), dtype=complex)
        for row, free in enumerate((0, 2)):
            rows[row, free] = 1.0
            rows[row, [1, 3]] = np.linalg.solve(inner, -at_disc[free])
        return rows


def _edges(order: _Order, theta: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """psi, psi_x, and the same of the part with vorticity, and phi, of both combinations: (5, 2, points)."""
    r, n = order.bessel["edge"][0], order.n
    f, slope = np.moveaxis(order.functions("edge"), 1, 0)
    sine, cosine = np.sin(n * theta), np.cos(n * theta)
    psi = f * sine
    along_x = slope * sine * np.cos(theta) - f / r * n * cosine * np.sin(theta)
    rotational, potential = np.array([0, 0, 1, 1.0]), np.array([1.0, -1, 0, 0])
    return np.array([rows @ psi, rows @ along_x, (rows * rotational) @ psi, (rows * rotational) @ along_x,
                     (rows * potential) @ (f * cosine)])


def impedance(fraction: float, s: complex, terms: int = TERMS) -> complex:
    """Z / mu of a cell of side 1 at the rate s, in nu / L^2; modulus of s from 1e-2 to 1e6."""
    radius, k = np.sqrt(fraction / np.pi), np.sqrt(complex(s))
    along = (np.arange(4 * terms) + 0.5) / (8 * terms)
    r, theta = np.hypot(0.5, along), np.arctan2(along, 0.5)
    bessel = {name: (points, log_first_kind(2 * terms, k * points), log_second_kind(2 * terms, k * points))
              for name, points in (("edge", r), ("disc", np.array([radius])))}
    columns, potentials = [], []
    for n in 2 * np.arange(terms) + 1:
        order = _Order(int(n), radius, k, bessel)
        rows = order.without_slip()
        right, upper = _edges(order, theta, rows), _edges(order, np.pi / 2 - theta, rows)
        columns += list(np.concatenate([right[1], right[3], upper[0], upper[2]], axis=1))
        potentials += list(right[4])
    matrix = np.column_stack(columns)
    scale = np.linalg.norm(matrix, axis=0)
    wanted = np.zeros(len(matrix), dtype=complex)
    wanted[2 * len(along) : 3 * len(along)] = 0.5
    strengths = np.linalg.lstsq(matrix / scale, wanted, rcond=1e-15)[0] / scale
    body_force = 2 * s * np.mean(strengths @ np.array(potentials))  # rho b, for U = 1: phi is constant along x = 1/2
    return (1 - fraction) * ((1 - fraction) * body_force - s)


def slip_after_release(fraction: float, mass: float, time: np.ndarray) -> np.ndarray:
    """w mu / F at times in L^2 / nu, from 1e-3 on; `mass` the reduced one, in rho L^2."""
    return invert(lambda s: 1 / (s * (mass * s + impedance(fraction, s))), time)


def virtual_mass(fraction: float) -> float:
    """dZ/ds at s = 0 in rho L^2: the momentum, beyond m_f w, of the fluid in slow relaxation.

    For it <u^2> / <u>^2 - 1 times m_f holds as well, with the steady velocity u and means over the fluid.
    """
    steady = (1 - fraction) ** 2 * square_array(fraction).drag
    half, whole = ((impedance(fraction, s).real - steady) / s for s in (0.5, 1.0))
    return 2 * half - whole
