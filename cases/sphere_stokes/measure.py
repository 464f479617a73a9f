"""The energy of the flow, and what the report draws; the drag itself is measured by verification/measures/observables.py."""

import numpy as np

from verification.measures.curve import Chart
from verification.measures.drag_families import drag_errors, drag_of_one_sphere
from verification.measures.histories import drag_history
from verification.measures.measures import Measures, Point, by_name
from verification.protocol.quantity import Measured
from verification.protocol.run import Run


def family_curves(results: list[Point]) -> list[Chart]:
    return [drag_errors(results), *drag_of_one_sphere(results)]


def energy(run: Run) -> Measured:
    """2 E / (m w^2), E the kinetic energy of the fluid of mass m and w its mean velocity, over the last tenth of the run: 1 and what
    a body that is released drags along, see virtual_mass in cases/falling_sphere."""
    tail = slice(-max(2, len(run.series) // 10), None)
    radius, size, density = run.scene["body"][0]["radius"], np.array(run.scene["box"]["size"]), run.scene["fluid"]["density"]
    mass = density * (float(np.prod(size)) - 4 / 3 * np.pi * radius**3)
    square = sum(run.series[f"fluid_velocity_{axis}"][tail] ** 2 for axis in "xyz")
    values = 2 * run.series["fluid_energy"][tail] / (mass * square)
    return Measured(float(values.mean()), float(values.std()))


MEASURES = Measures(observables=by_name(energy), charts=drag_history, charts_of_family=family_curves)
