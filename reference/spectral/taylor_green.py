"""Decay of the Taylor-Green vortices in space, by a Fourier-Galerkin solution of the Navier-Stokes equations.

    python3 reference/spectral/taylor_green.py --reynolds 10 --points 48 --out cases/taylor_green_3d/reference.csv

Units: U = k = 1, so the box is 2 pi wide and nu = 1 / Re. Start: u = sin x cos y cos z, v = -cos x sin y cos z, w = 0 (Taylor
and Green 1937). Products in real space with the 2/3 rule, the pressure by projection, viscosity exactly by an integrating
factor, classic Runge-Kutta of fourth order in time (Canuto, Hussaini, Quarteroni and Zang, Spectral Methods, 2007).
"""

import argparse
import hashlib
from pathlib import Path

import numpy as np


class Spectral:
    """Velocity as Fourier coefficients (3, n, n, n / 2 + 1) in a box of 2 pi."""

    def __init__(self, points: int, viscosity: float):
        whole, half = np.fft.fftfreq(points, 1 / points), np.fft.rfftfreq(points, 1 / points)
        self.k = np.stack(np.meshgrid(whole, whole, half, indexing="ij"))
        self.square = np.sum(self.k**2, axis=0)
        self.inverse = 1 / np.where(self.square == 0, 1, self.square)
        self.kept = np.all(np.abs(self.k) < points / 3, axis=0)
        self.viscosity, self.points = viscosity, points

    def real(self, coefficients: np.ndarray) -> np.ndarray:
        return np.fft.irfftn(coefficients, s=(self.points,) * 3, axes=(-3, -2, -1))

    def convection(self, u: np.ndarray) -> np.ndarray:
        """-div(u u) less the gradient of pressure that keeps div u = 0."""
        velocity = self.real(u)
        rate = np.empty_like(u)
        for i in range(3):
            flux = np.fft.rfftn(velocity[i] * velocity, axes=(-3, -2, -1))
            rate[i] = -1j * np.sum(self.k * flux, axis=0) * self.kept
        return rate - self.k * np.sum(self.k * rate, axis=0) * self.inverse

    def step(self, u: np.ndarray, dt: float) -> np.ndarray:
        half = np.exp(-0.5 * self.viscosity * self.square * dt)
        a = self.convection(u)
        b = self.convection(half * (u + 0.5 * dt * a))
        c = self.convection(half * u + 0.5 * dt * b)
        d = self.convection(half * (half * u + dt * c))
        return half * half * (u + dt / 6 * a) + dt / 3 * half * (b + c) + dt / 6 * d

    def energy(self, u: np.ndarray) -> float:
        return float(0.5 * np.mean(np.sum(self.real(u) ** 2, axis=0)))


def vortices(points: int, plane: bool = False) -> np.ndarray:
    """The start, in real space; `plane` leaves out cos z, which gives the exact two-dimensional flow."""
    x = 2 * np.pi * np.arange(points) / points
    x, y, z = np.meshgrid(x, x, x, indexing="ij")
    depth = 1.0 if plane else np.cos(z)
    return np.stack([np.sin(x) * np.cos(y) * depth, -np.cos(x) * np.sin(y) * depth, np.zeros_like(x)])


def decay(start: np.ndarray, reynolds: float, times: np.ndarray, steps: int) -> np.ndarray:
    """E / E(0) at the times, which are equidistant from 0, with `steps` between two of them."""
    solver = Spectral(start.shape[-1], 1 / reynolds)
    u, dt = np.fft.rfftn(start, axes=(-3, -2, -1)), float(times[1] - times[0]) / steps
    energies = [solver.energy(u)]
    for _ in times[1:]:
        for _ in range(steps):
            u = solver.step(u, dt)
        energies.append(solver.energy(u))
    return np.array(energies) / energies[0]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--reynolds", type=float, default=10.0, help="U / (nu k)")
    parser.add_argument("--points", type=int, default=48, help="grid points a side")
    parser.add_argument("--end", type=float, default=4.0, help="time in 1 / (k U)")
    parser.add_argument("--rows", type=int, default=41)
    parser.add_argument("--steps", type=int, default=4, help="between two rows")
    parser.add_argument("--out", type=Path, required=True)
    given = parser.parse_args()
    times = np.linspace(0.0, given.end, given.rows)
    energies = decay(vortices(given.points), given.reynolds, times, given.steps)
    rows = "".join(f"{time:.4f},{energy:.10f}\n" for time, energy in zip(times, energies, strict=True))
    command = f"--reynolds {given.reynolds:g} --points {given.points} --end {given.end:g} --rows {given.rows} --steps {given.steps}"
    given.out.write_text(
        f"# python3 reference/spectral/taylor_green.py {command}\n"
        f"# sha256 of the rows below the names: {hashlib.sha256(rows.encode()).hexdigest()}\nk U t,E / E(0)\n{rows}"
    )


if __name__ == "__main__":
    main()
