"""Decay and field of the vortices of Taylor and Green."""

import numpy as np

from verification.measures.curve import Chart, Curve
from verification.measures.flows import amplitudes, decay_chart, fields, initial_flow, viscosity_of
from verification.measures.measures import Measures, by_name
from verification.protocol.quantity import Measured
from verification.protocol.run import Run


def _rate(run: Run) -> float:
    return viscosity_of(run) * initial_flow(run).eigenvalue


def _sound(points: np.ndarray, k: np.ndarray) -> np.ndarray:
    """The two standing waves that a start at uniform density sets off: along x and along y, of twice the wave number.

    The pressure of the vortices, -U^2 (cos 2kx + cos 2ky) / 4, is missing at the start; so sound of velocity U^2 / (4 c)
    rings until friction ends it (linear acoustics).
    """
    waves = np.zeros((2, *points.shape))
    for axis in range(2):
        waves[axis, :, axis] = np.sin(2 * k[axis] * points[:, axis])
    return waves


def field_error(run: Run) -> Measured:
    """Root-mean-square error of the velocity over that of the exact field, when the exact energy has fallen to a
    quarter; without the standing sound waves of the start."""
    flow, quarter = initial_flow(run), np.log(2.0) / _rate(run)
    field = min(fields(run), key=lambda one: abs(one.time - quarter))
    if abs(field.time / quarter - 1) > 0.02:
        return Measured(float("nan"), float("inf"), "no snapshot where the energy is a quarter; write more")
    exact = np.exp(-_rate(run) * field.time) * flow.amplitude * flow.shape(field.points)
    error = (field.velocity - exact).ravel()
    waves = _sound(field.points, flow.k).reshape(2, -1).T
    error -= waves @ np.linalg.lstsq(waves, error, rcond=None)[0]
    return Measured(float(np.linalg.norm(error) / np.linalg.norm(exact)), 0.0)


def curves(run: Run) -> list[Chart]:
    time, series = run.series["time"], run.series["fluid_energy"]
    exact = Curve("exact", time, np.exp(-2 * _rate(run) * time), reference=True)
    found = Curve("all motion", time, series / series[0])
    at, amplitude = amplitudes(run, initial_flow(run))
    projected = Curve("on the exact field", at, amplitude**2, points=True)
    energy = Chart("Kinetic energy", "time", "E / E(0)", (exact, found, projected), log=True)
    return [energy, decay_chart(run)]


MEASURES = Measures(observables=by_name(field_error), charts=curves)
