"""Stokes flow about a disc between two plane walls, periodic along them, by the method of fundamental solutions.

The flow is a sum of point forces (Stokeslets) inside the disc and beyond the walls; their strengths are such that the
velocity is the wanted one at points of the disc and of the walls, by least squares. A Stokeslet that repeats along x with
the period L has a closed form (Pozrikidis, Boundary Integral and Singularity Methods for Linearized Viscous Flow, 1992,
section 2.6): with k = 2 pi / L and A = 1/2 ln(2 cosh k y - 2 cos k x)

    u = F.G / (4 pi mu),   G_xx = 1 - A - y A_y,   G_xy = y A_x,   G_yy = -A + y A_y.

The walls are at y = 0 and y = 1: lengths are in units of the width of the channel. The pressure is periodic.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Disc:
    radius: float
    height: float = 0.5  # of its centre above the lower wall


@dataclass(frozen=True)
class Resistance:
    """What the fluid exerts on the disc, over the viscosity; and the largest error of the velocity on disc and walls,
    found between the points where it is prescribed."""

    force: np.ndarray
    torque: float
    residual: float


def stokeslets(at: np.ndarray, sources: np.ndarray, period: float) -> np.ndarray:
    """Matrix (2 n, 2 m): velocities at n points, x then y, of forces at m sources, over the viscosity."""
    k = 2 * np.pi / period
    x, y = np.moveaxis(at[:, None, :] - sources[None, :, :], -1, 0)
    below = 2 * np.cosh(k * y) - 2 * np.cos(k * x)
    a, a_x, a_y = 0.5 * np.log(below), k * np.sin(k * x) / below, k * np.sinh(k * y) / below
    return np.block([[1 - a - y * a_y, y * a_x], [y * a_x, -a + y * a_y]]) / (4 * np.pi)


def _circle(disc: Disc, radius: float, count: int, shift: float = 0.0) -> np.ndarray:
    angle = 2 * np.pi * (np.arange(count) + shift) / count
    return np.column_stack([radius * np.cos(angle), disc.height + radius * np.sin(angle)])


def _lines(heights: tuple[float, float], period: float, count: int, shift: float = 0.0) -> np.ndarray:
    x = period * (np.arange(count) + shift) / count
    return np.concatenate([np.column_stack([x, np.full(count, height)]) for height in heights])


class Channel:
    """The linear problem of one disc, prepared once. `points` are the sources in the disc and, per length of the channel's
    width, beyond each wall; there are twice as many points where the velocity is prescribed."""

    def __init__(self, disc: Disc, period: float, points: int = 48) -> None:
        self.disc = disc
        along = max(16, round(points * period))
        gap = min(disc.height, 1 - disc.height) - disc.radius
        inner, beyond = disc.radius - min(0.5 * disc.radius, 2 * gap), min(0.5, 2 * gap)  # of the sources
        self._sources = np.concatenate([_circle(disc, inner, points), _lines((-beyond, 1 + beyond), period, along)])
        self._inside = points
        self._surface = _circle(disc, disc.radius, 2 * points)
        walls = _lines((0.0, 1.0), period, 2 * along)
        self._matrix = self._velocities(np.concatenate([self._surface, walls]), period)
        self._check_surface = _circle(disc, disc.radius, 2 * points, shift=0.5)
        check = np.concatenate([self._check_surface, _lines((0.0, 1.0), period, 2 * along, shift=0.5)])
        self._check = self._velocities(check, period)

    def _velocities(self, at: np.ndarray, period: float) -> np.ndarray:
        """Of the sources and, in the last column, of a uniform flow along the channel, which completes them."""
        uniform = np.concatenate([np.ones(len(at)), np.zeros(len(at))])[:, None]
        return np.hstack([stokeslets(at, self._sources, period), uniform])

    def resistance(self, velocity) -> Resistance:
        """`velocity` gives (n, 2) velocities at (n, 2) points of the surface; on the walls the fluid is at rest."""

        def wanted(surface: np.ndarray, rows: int) -> np.ndarray:
            both = np.zeros((2, rows // 2))
            both[:, : len(surface)] = velocity(surface).T
            return both.ravel()

        right = wanted(self._surface, len(self._matrix))
        strengths, *_ = np.linalg.lstsq(self._matrix, right, rcond=1e-14)
        residual = np.abs(self._check @ strengths - wanted(self._check_surface, len(self._check))).max()
        forces = strengths[:-1].reshape(2, -1)[:, : self._inside]  # of the disc on the fluid
        arm = self._sources[: self._inside] - np.array([0.0, self.disc.height])
        torque = np.sum(arm[:, 0] * forces[1] - arm[:, 1] * forces[0])
        return Resistance(-forces.sum(axis=1), -float(torque), float(residual))

    def turning(self, points: np.ndarray) -> np.ndarray:
        """Rotation with angular velocity 1 about the centre."""
        return np.column_stack([-(points[:, 1] - self.disc.height), points[:, 0]])

    def shear(self, points: np.ndarray) -> np.ndarray:
        """u = y - 1/2: walls that move in opposite directions, with the shear rate 1."""
        return np.column_stack([points[:, 1] - 0.5, np.zeros(len(points))])


def angular_velocity(disc: Disc, period: float, points: int = 48) -> float:
    """-omega / G of a disc free of torque in u = G (y - 1/2); 1/2 in a wide channel.

    The shear itself exerts no torque. What disturbs it is at rest on the walls, and on the disc omega x r - u.
    """
    channel = Channel(disc, period, points)
    held, turned = channel.resistance(lambda at: -channel.shear(at)), channel.resistance(channel.turning)
    return held.torque / turned.torque


def angular_velocity_without_transpose(disc: Disc, period: float, points: int = 48) -> float:
    """The same for a fluid whose momentum flux is mu grad u - p in place of mu (grad u + grad u^T) - p.

    The velocities are the same, and so is the force on a rigid body, but not the torque: on its surface grad u^T n =
    -omega x n, whose moment is -2 mu V omega (Gauss; in the plane V is the area). Without it the disc turns too fast, with
    the whole shear rate in a wide channel.
    """
    channel = Channel(disc, period, points)
    held, turned = channel.resistance(lambda at: -channel.shear(at)), channel.resistance(channel.turning)
    return held.torque / (turned.torque + 2 * np.pi * disc.radius**2)
