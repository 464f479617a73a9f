"""Elastic normal impact of two equal spheres, against Hertz' law."""

import numpy as np

from verification.measures.curve import Chart, Curve
from verification.measures.measures import Measures, by_name
from verification.protocol.quantity import Measured
from verification.protocol.run import Run
from verification.protocol.scene import in_si
from verification.protocol.series import read_table

NEAR = 4  # samples that place the first and the last touch


def hertz(run: Run) -> tuple[float, float, float]:
    """(mass, stiffness, speed) of the relative motion: m* d'' = -k d^(3/2), k = 4/3 E* sqrt(R*); SI."""
    first, second = run.scene["body"]
    contact, radius = run.scene["contact"], in_si(first["radius"])
    mass = 4 / 3 * np.pi * radius**3 * in_si(first["density"]) / 2
    young = in_si(contact["young"]) / (2 * (1 - contact["poisson"] ** 2))
    speed = in_si(first["velocity"][0]) - in_si(second["velocity"][0])
    return mass, 4 / 3 * young * np.sqrt(radius / 2), speed


def hertz_history(run: Run, steps: int = 4000) -> tuple[np.ndarray, np.ndarray]:
    """(time from the first touch, force): time as the integral of 1 / speed over the overlap, by energy.

    With overlap = largest (1 - s^2) the integrand has no pole.
    """
    mass, stiffness, speed = hertz(run)
    largest = (5 * mass * speed**2 / (4 * stiffness)) ** 0.4
    s = np.linspace(1, 0, steps + 1)
    x = 1 - s**2
    slowness = np.where(s > 0, 2 * s / np.sqrt(np.maximum(1 - x**2.5, 1e-300)), 2 / np.sqrt(2.5))
    time = np.concatenate([[0.0], np.cumsum(0.5 * (slowness[1:] + slowness[:-1]) * -np.diff(s))]) * largest / speed
    force = stiffness * (largest * x) ** 1.5
    return np.concatenate([time, 2 * time[-1] - time[-2::-1]]), np.concatenate([force, force[-2::-1]])


def history(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """(time, force) of the contact of the first sphere: its mass times its change of velocity a sample."""
    table = read_table(run.folder / "solids.csv")
    first = table["id"] == 0
    time, velocity = table["time"][first], table["velocity_x"][first]
    mass = 2 * hertz(run)[0]
    return 0.5 * (time[1:] + time[:-1]), -mass * np.diff(velocity) / np.diff(time)


def touches(time: np.ndarray, force: np.ndarray) -> tuple[float, float]:
    """First and last: force^(2/3) goes as the overlap, which is straight there. The sample of the touch itself is left out."""
    overlap = np.cbrt(np.maximum(force, 0.0)) ** 2
    inside = np.flatnonzero(force > 0)[1:-1]
    found = []
    for near in (inside[:NEAR], inside[-NEAR:]):
        slope, start = np.polyfit(time[near] - time[near[0]], overlap[near], 1)
        found.append(float(time[near[0]] - start / slope))
    return found[0], found[1]


def contact_force(run: Run) -> Measured:
    """Largest, by the parabola through the highest three samples."""
    time, force = history(run)
    top = int(np.argmax(force))
    left, here, right = force[top - 1 : top + 2]
    return Measured(float(here + (left - right) ** 2 / (16 * (here - 0.5 * (left + right)))), 0.0)


def contact_time(run: Run) -> Measured:
    first, last = touches(*history(run))
    return Measured(last - first, 0.0)


def curves(run: Run) -> list[Chart]:
    time, force = history(run)
    exact_time, exact_force = hertz_history(run)
    first, _ = touches(time, force)
    return [
        Chart(
            "Force of the contact",
            "time (us)",
            "force (kN)",
            (
                Curve("Hertz", 1e6 * (first + exact_time), 1e-3 * exact_force, reference=True),
                Curve("measured", 1e6 * time, 1e-3 * force),
            ),
        )
    ]


MEASURES = Measures(observables=by_name(contact_force, contact_time), charts=curves)
