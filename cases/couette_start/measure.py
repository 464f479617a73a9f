"""A fluid at rest between a wall at rest and one that starts to move, against the series solution."""

from dataclasses import dataclass
from functools import partial

import numpy as np

from verification.measures.curve import Chart, Curve
from verification.measures.measures import Measures
from verification.protocol.quantity import Measured
from verification.protocol.run import Run, read_time

TIMES = (0.05, 0.1, 0.3, 1.0)  # nu t / H^2


def start_up(y: np.ndarray, time: float, terms: int = 100) -> np.ndarray:
    """u / U at the distance y / H from the wall at rest, time in H^2 / nu (Batchelor 1967, section 4.3).

    u / U = y + sum_n (2 / (n pi)) (-1)^n exp(-n^2 pi^2 t) sin(n pi y); from t = 0.01 on the term n = 100 is below 1e-300.
    """
    n = np.arange(1, terms + 1)[:, None]
    series = 2 / (n * np.pi) * (-1.0) ** n * np.exp(-((n * np.pi) ** 2) * time) * np.sin(n * np.pi * y)
    return y + series.sum(axis=0)


@dataclass(frozen=True)
class Profile:
    """Velocities over that of the wall, at y / H, of one snapshot."""

    time: float  # nu t / H^2
    y: np.ndarray
    velocity: np.ndarray

    @property
    def error(self) -> np.ndarray:
        return self.velocity - start_up(self.y, self.time)


def profile(run: Run, time: float) -> Profile:
    """Of the snapshot nearest to a time, which is compared at the time that it has."""
    fluid, moving = run.scene["fluid"], run.scene["body"][0]
    viscosity, width = fluid["viscosity"] / fluid["density"], moving["position"]
    times = np.array([read_time(path) for path in run.snapshots()]) * viscosity / width**2
    nearest = int(np.argmin(np.abs(times - time)))
    particles = run.fluid(nearest)
    return Profile(float(times[nearest]), particles["points"][:, 1] / width,
                   particles["velocity"][:, 0] / moving["velocity"][0])


def _error(time: float, run: Run) -> Measured:
    found = profile(run, time)
    late = abs(found.time / time - 1)
    objection = "" if late < 0.1 else f"no snapshot near {time} H^2 / nu; the nearest is of {found.time:.3g}"
    return Measured(float(np.sqrt(np.mean(found.error**2))), 0.0, objection)


def curves(run: Run) -> list[Chart]:
    y = np.linspace(0, 1, 201)
    profiles = [profile(run, time) for time in TIMES]
    exact = tuple(Curve(f"series, {p.time:.3f}", y, start_up(y, p.time), reference=True) for p in profiles)
    found = tuple(Curve(f"PPs, {p.time:.3f}", p.y, p.velocity, points=True) for p in profiles)
    wrong = tuple(Curve(f"{p.time:.3f}", p.y, p.error, points=True) for p in profiles)
    return [
        Chart("Velocity between the walls, at times nu t / H^2", "y / H", "u / U", exact + found),
        Chart("Difference from the series, at times nu t / H^2", "y / H", "(u - u_exact) / U", wrong),
    ]


MEASURES = Measures(
    observables={f"error_at_{time:g}".replace(".", ""): partial(_error, time) for time in TIMES},
    charts=curves,
)
