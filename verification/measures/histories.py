"""Curves over the time of a run that several cases draw."""

import numpy as np

from verification.measures.curve import Chart, Curve
from verification.measures.fits import extrapolate
from verification.measures.observables import drag_series
from verification.protocol.run import Run


def settling(title: str, label: str, time: np.ndarray, values: np.ndarray) -> Chart:
    """A series with the limit of its second half: shows whether it is steady."""
    limit = extrapolate(time, values)
    bounds = Curve("extrapolated limit", time[[0, -1]], np.full(2, limit.value), reference=True)
    return Chart(title, "time", label, (bounds, Curve("measured", time, values)))


def drag_history(run: Run) -> list[Chart]:
    """Superficial velocity, and the force on the surface of one solid over the body force of the fluid."""
    cell = drag_series(run)
    balance = Chart(
        "Force on the surface against time",
        "time",
        "force on the surface / body force",
        (
            Curve("balance", cell.time[[0, -1]], np.ones(2), reference=True),
            Curve("measured", cell.time[1:], cell.on_surface[1:]),  # no force before the first sample
        ),
    )
    return [settling("Superficial velocity against time", "U", cell.time, cell.velocity), balance]
