"""The steady field of forced vortices."""

import numpy as np

from verification.measures.curve import Chart, Curve
from verification.measures.flows import Field, fields, initial_flow
from verification.measures.measures import Measures, by_name
from verification.protocol.quantity import Measured
from verification.protocol.run import Run


def _errors(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """(time, relative root-mean-square error of the velocity) of every snapshot."""
    flow = initial_flow(run)

    def error(field: Field) -> float:
        exact = flow.amplitude * flow.shape(field.points)
        return float(np.linalg.norm(field.velocity - exact) / np.linalg.norm(exact))

    found = [(field.time, error(field)) for field in fields(run)]
    return np.array([time for time, _ in found]), np.array([error for _, error in found])


def field_error(run: Run) -> Measured:
    """Its root mean square over the second half of the run."""
    time, error = _errors(run)
    second = error[time > 0.5 * time[-1]]
    return Measured(float(np.sqrt(np.mean(second**2))), float(np.std(second)))


def curves(run: Run) -> list[Chart]:
    time, error = _errors(run)
    measured = Curve("measured", time, error)
    return [Chart("Error of the velocity field", "time", "rms(u - u_exact) / rms(u_exact)", (measured,))]


MEASURES = Measures(observables=by_name(field_error), charts=curves)
