"""A sphere released in a periodic cell: its slip against the drag of the array, and Basset's history."""

import numpy as np

from cases.falling_disc.measure import (
    Law,
    Release,
    _over,
    _times,
    release_of,
    slip,
    terminal_velocity,
)
from reference.published.arrays import cubic_stokes
from reference.stokes.history import History
from reference.stokes.laplace import invert
from verification.measures.curve import Chart, Curve
from verification.measures.measures import Measures, by_name
from verification.protocol.quantity import Measured
from verification.protocol.run import Run


def added_mass(release: Release) -> float:
    """In potential flow past the array, for w. By the analogy with conduction past spheres that do not conduct (Maxwell
    1873: (1 - phi) / (1 + phi / 2)) the flow U takes a body force rho dU/dt (1 + phi / 2) / (1 - phi); the sphere feels
    what is left of it in the fluid, phi / 2 rho dU/dt, and U = (1 - phi) w."""
    return 0.5 * release.displaced * (1 - release.fraction)


def virtual_mass(run: Run) -> float:
    """The momentum, beyond m_f w, of the fluid in slow relaxation, for w = 1, from the end of a run, where the flow is steady.

    It is that of its energy: with the velocity field of the steady flow times w(t), seen from the body, F w = f w +
    d/dt (1/2 integral of rho u^2), an integral that goes as w^2. The case sphere_stokes holds that energy against OpenFOAM's.
    """
    release, tail = release_of(run), slice(-max(1, len(run.series) // 10), None)
    w, body, fluid, energy = (float(np.mean(values[tail])) for values in (
        slip(run)[1], *(run.series[name] for name in ("solid_velocity_x", "fluid_velocity_x", "fluid_energy"))))
    mass = release.fluid_mass
    seen = energy - mass * fluid * body + 0.5 * mass * body**2
    return 2 * seen / w**2 - mass


def drag_of(release: Release) -> float:
    """G of f = G w in Stokes flow through the array; U = (1 - phi) w, and the fluid's own pressure gradient has its share of F."""
    return 6 * np.pi * release.viscosity * release.radius * (1 - release.fraction) ** 2 * cubic_stokes(release.fraction).value


def law_of(run: Run) -> Law:
    return Law(drag_of(release_of(run)), virtual_mass(run))


def terminal_over_exact(run: Run) -> Measured:
    release = release_of(run)
    return _over(terminal_velocity(run), release.force / drag_of(release))


def with_history(release: Release, law: Law, time: np.ndarray) -> np.ndarray:
    """Slip with added mass and history. In a fluid that slips past with 3/2 w sin(theta) the boundary layer takes
    6 pi R^2 sqrt(rho mu s)."""
    layer = 6 * np.pi * release.radius**2 * np.sqrt(release.density * release.viscosity)
    history = History(law.drag, added_mass(release), layer, law.virtual_mass)
    return invert(lambda s: release.force / (s * (release.reduced_mass * s + history.impedance(s))), time)


def _largest(run: Run, expected: np.ndarray) -> Measured:
    return Measured(float(np.max(np.abs(np.interp(_times(run), *slip(run)) - expected)) / expected[-1]), 0.0)


def from_drag_law(run: Run) -> Measured:
    return _largest(run, law_of(run).slip(release_of(run), _times(run)))


def from_history(run: Run) -> Measured:
    return _largest(run, with_history(release_of(run), law_of(run), _times(run)))


def curves(run: Run) -> list[Chart]:
    release, law, time = release_of(run), law_of(run), np.linspace(0, slip(run)[0][-1], 200)[1:]
    return [Chart("Slip after release", "time", "w", (
        Curve("drag law alone", time, Law(law.drag, 0.0).slip(release, time)),
        Curve("and added mass", time, Law(law.drag, added_mass(release)).slip(release, time)),
        Curve("and history", time, with_history(release, law, time), reference=True),
        Curve("MaPPM", *slip(run)),
    ))]


MEASURES = Measures(observables=by_name(terminal_over_exact, from_drag_law), charts=curves)
