"""Kinetic energy of the vortices in space against a spectral solution."""

from pathlib import Path

import numpy as np

from verification.measures.curve import Chart, Curve
from verification.measures.flows import initial_flow
from verification.measures.measures import Measures, by_name
from verification.protocol.quantity import Measured
from verification.protocol.run import Run


def reference() -> tuple[np.ndarray, np.ndarray]:
    """(k U t, E / E(0)) of reference.csv."""
    rows = np.loadtxt(Path(__file__).parent / "reference.csv", delimiter=",", skiprows=3)
    return rows[:, 0], rows[:, 1]


def _energy(run: Run) -> tuple[np.ndarray, np.ndarray]:
    flow, series = initial_flow(run), run.series
    return flow.k[0] * flow.amplitude * series["time"], series["fluid_energy"] / series["fluid_energy"][0]


def energy(run: Run) -> Measured:
    """Root mean square of the difference of E / E(0) from the reference, until that has fallen to a quarter."""
    time, found = _energy(run)
    exact = np.interp(time, *reference())
    until = exact > 0.25
    if until.all():
        return Measured(float("nan"), float("inf"), "the run ends before the energy is a quarter")
    return Measured(float(np.sqrt(np.mean((found - exact)[until] ** 2))), 0.0)


def curves(run: Run) -> list[Chart]:
    time, found = _energy(run)
    at, exact = reference()
    return [
        Chart("Kinetic energy", "k U t", "E / E(0)", (
            Curve("spectral", at, exact, reference=True), Curve("measured", time, found)), log=True)
    ]


MEASURES = Measures(observables=by_name(energy), charts=curves)
