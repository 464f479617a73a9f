"""A sphere released in a periodic cell: its slip against its own drag law, LIGGGHTS, and Basset's history."""

from dataclasses import replace

import numpy as np

from cases.falling_disc.measure import MEASURES as DISC
from cases.falling_disc.measure import (
    Law,
    Release,
    _times,
    measured_law,
    relaxation_time,
    release_of,
    slip,
    terminal_velocity,
)
from reference.stokes.history import History
from reference.stokes.laplace import invert
from verification.measures.curve import Chart, Curve
from verification.measures.measures import by_name
from verification.protocol.quantity import Measured
from verification.protocol.run import Run


def added_mass(release: Release) -> float:
    """In potential flow past the array, for w. By the analogy with conduction past spheres that do not conduct (Maxwell
    1873: (1 - phi) / (1 + phi / 2)) the flow U takes a body force rho dU/dt (1 + phi / 2) / (1 - phi); the sphere feels
    what is left of it in the fluid, phi / 2 rho dU/dt, and U = (1 - phi) w."""
    return 0.5 * release.displaced * (1 - release.fraction)


def with_history(release: Release, law: Law, time: np.ndarray) -> np.ndarray:
    """Slip with added mass and history. In a fluid that slips past with 3/2 w sin(theta) the boundary layer takes
    6 pi R^2 sqrt(rho mu s)."""
    layer = 6 * np.pi * release.radius**2 * np.sqrt(release.density * release.viscosity)
    history = History(law.drag, added_mass(release), layer, law.virtual_mass)
    return invert(lambda s: release.force / (s * (release.reduced_mass * s + history.impedance(s))), time)


def _largest(run: Run, expected: np.ndarray) -> Measured:
    return Measured(float(np.max(np.abs(np.interp(_times(run), *slip(run)) - expected)) / expected[-1]), 0.0)


def from_drag_law(run: Run) -> Measured:
    return _largest(run, measured_law(run).slip(release_of(run), _times(run)))


def from_history(run: Run) -> Measured:
    return _largest(run, with_history(release_of(run), measured_law(run), _times(run)))


def curves(run: Run) -> list[Chart]:
    release, law, time = release_of(run), measured_law(run), np.linspace(0, slip(run)[0][-1], 200)[1:]
    return [Chart("Slip after release", "time", "w", (
        Curve("drag law alone", time, Law(law.drag, 0.0).slip(release, time)),
        Curve("and added mass", time, Law(law.drag, added_mass(release)).slip(release, time)),
        Curve("and history", time, with_history(release, law, time), reference=True),
        Curve("MaPPM", *slip(run)),
    ))]


MEASURES = replace(DISC, observables=by_name(terminal_velocity, relaxation_time, from_drag_law), charts=curves)
