"""A sphere released in a periodic cell: its slip against its own drag law, LIGGGHTS, and Basset's history."""

import numpy as np

from cases.falling_disc.measure import (
    Law,
    Release,
    _times,
    live_curves,
    live_options,
    measured_law,
    relaxation_time,
    release_of,
    slip,
    terminal_velocity,
)
from reference.stokes.laplace import invert
from verification.curve import Chart, Curve
from verification.observables import Measured
from verification.solver import Run

__all__ = ["curves", "from_drag_law", "from_history", "live_curves", "live_options", "relaxation_time", "terminal_velocity"]


def added_mass(release: Release) -> float:
    """In potential flow: half the fluid displaced, more in an array (Zuber, Chem. Eng. Sci. 19, 1964, 897-917)."""
    return 0.5 * release.displaced * (1 + 2 * release.fraction) / (1 - release.fraction)


def with_history(release: Release, law: Law, time: np.ndarray) -> np.ndarray:
    """Slip under the drag f(s) / w(s) = G + m_a s + 6 pi mu R (sqrt(T (s + a)) - sqrt(T a)), T = R^2 / nu.

    At large s that is added mass and Basset's history (Landau and Lifshitz, Fluid Mechanics, section 24); in a cell momentum
    has only so far to diffuse, so it is forgotten at a rate a, which the momentum at small s determines: f' = m_v.
    """
    stokes, memory = 6 * np.pi * release.viscosity * release.radius, release.radius**2 * release.density / release.viscosity
    mass = added_mass(release)
    rate = memory * (stokes / (2 * (law.virtual_mass - mass))) ** 2

    def transformed(s: complex) -> complex:
        history = stokes * (np.sqrt(memory * (s + rate)) - np.sqrt(memory * rate))
        return release.force / (s * (release.reduced_mass * s + law.drag + mass * s + history))

    return invert(transformed, time)


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
