"""Speed and damping of a standing sound wave."""

import numpy as np

from verification.measures.curve import Chart, Curve
from verification.measures.fits import Oscillation, damped_oscillation
from verification.measures.flows import amplitudes, initial_flow, viscosity_of
from verification.measures.measures import Measures, by_name
from verification.protocol.quantity import Measured
from verification.protocol.run import Run


def _declared(run: Run) -> tuple[float, float]:
    """(c k, damping nu k^2 / 2)."""
    square = initial_flow(run).eigenvalue
    return run.scene["fluid"]["sound_speed"] * np.sqrt(square), 0.5 * viscosity_of(run) * square


def _fitted(run: Run) -> Oscillation | None:
    time, amplitude = amplitudes(run, initial_flow(run))
    return damped_oscillation(time, amplitude)


def sound_speed(run: Run) -> Measured:
    """c / c_declared, from (c k)^2 = frequency^2 + damping^2."""
    found = _fitted(run)
    if found is None:
        return Measured(float("nan"), float("inf"), "no oscillation to fit; run longer or write more snapshots")
    undamped = np.hypot(found.frequency, found.damping)
    return Measured(float(undamped / _declared(run)[0]), found.frequency_error / undamped)


def sound_damping(run: Run) -> Measured:
    """Damping over nu k^2 / 2."""
    found = _fitted(run)
    if found is None:
        return Measured(float("nan"), float("inf"), "no oscillation to fit; run longer or write more snapshots")
    declared = _declared(run)[1]
    return Measured(found.damping / declared, found.damping_error / declared)


def curves(run: Run) -> list[Chart]:
    undamped, damping = _declared(run)
    time, amplitude = amplitudes(run, initial_flow(run))
    frequency, fine = np.sqrt(undamped**2 - damping**2), np.linspace(0.0, time[-1], 400)
    # The wave starts without a gradient of density, so du/dt = -nu k^2 u there.
    exact = np.exp(-damping * fine) * (np.cos(frequency * fine) - damping / frequency * np.sin(frequency * fine))
    measured = Curve("measured", time, amplitude, points=True)
    return [Chart("Amplitude of the wave", "time", "u / U", (Curve("exact", fine, exact, reference=True), measured))]


MEASURES = Measures(observables=by_name(sound_speed, sound_damping), charts=curves)
