"""Flow between plane walls against u = g y (H - y) / (2 nu)."""

from dataclasses import dataclass

import numpy as np

from verification.measures.curve import Chart, Curve
from verification.measures.fits import extrapolate
from verification.measures.histories import settling
from verification.measures.measures import Measures, by_name
from verification.measures.observables import SETTLED
from verification.protocol.quantity import Measured
from verification.protocol.run import Run


@dataclass(frozen=True)
class Profile:
    """Velocities of the PPs at their distance y from the wall, both in units of the channel: y / H, u / max(u_exact)."""

    y: np.ndarray
    velocity: np.ndarray

    @property
    def error(self) -> np.ndarray:
        return self.velocity - parabola(self.y)


def parabola(y: np.ndarray) -> np.ndarray:
    return 4 * y * (1 - y)


def _along(run: Run) -> int:
    return int(np.argmax(np.abs(run.scene["force"]["fluid"])))


def profile(run: Run) -> Profile:
    """Of the last snapshot."""
    fluid, (wall,) = run.scene["fluid"], run.scene["body"]
    normal, along = "xyz".index(wall["axis"]), _along(run)
    force = run.scene["force"]["fluid"][along]
    side = run.scene["box"]["size"][normal]
    width = side - wall["thickness"]
    particles = run.fluid()
    y = (particles["points"][:, normal] - wall["position"] - wall["thickness"]) % side
    largest = force * width**2 * fluid["density"] / (8 * fluid["viscosity"])
    return Profile(y / width, particles["velocity"][:, along] / largest)


def poiseuille(run: Run) -> Measured:
    """Root-mean-square difference from the parabola, in units of its largest value."""
    moving = extrapolate(run.series["time"], run.series["fluid_velocity_" + "xyz"[_along(run)]])
    objection = "" if moving.gap < SETTLED else f"the flow has not settled: {100 * moving.gap:.2f} % to go"
    return Measured(float(np.sqrt(np.mean(profile(run).error ** 2))), moving.gap, objection)


def curves(run: Run) -> list[Chart]:
    found, exact = profile(run), np.linspace(0, 1, 101)
    mean = "fluid_velocity_" + "xyz"[_along(run)]
    return [
        Chart(
            "Velocity across the channel",
            "y / H",
            "u / max(u_exact)",
            (
                Curve("parabola", exact, parabola(exact), reference=True),
                Curve("PPs", found.y, found.velocity, points=True),
            ),
        ),
        Chart("Difference from the parabola", "y / H", "(u - u_exact) / max(u_exact)",
              (Curve("PPs", found.y, found.error, points=True),)),
        settling("Mean velocity against time", "mean velocity", run.series["time"], run.series[mean]),
    ]


MEASURES = Measures(observables=by_name(poiseuille), charts=curves)
