"""A body released in a periodic cell: its slip against a drag law, LIGGGHTS, and unsteady Stokes flow.

The slip w is the mean velocity of the fluid seen from the body, along the force. With the forces F and -F on fluid and
body, (m_s m_f / (m_s + m_f)) dw/dt = F - f.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from reference.stokes.square_array import square_array
from reference.stokes.unsteady_array import slip_after_release, virtual_mass
from verification.measures.curve import Chart, Curve
from verification.measures.measures import Measures, Values, by_name
from verification.protocol.quantity import Measured
from verification.protocol.run import Run
from verification.protocol.series import read_table

TIMES = 24  # at which a run is compared with theory


@dataclass(frozen=True)
class Release:
    """The scene in its own units. In the plane masses and forces are those of a metre of depth."""

    dimension: int
    side: float
    fraction: float
    radius: float
    density: float  # of the fluid
    viscosity: float
    ratio: float  # of the densities of body and fluid
    acceleration: float  # of the fluid, along x

    @property
    def fluid_mass(self) -> float:
        return self.density * self.side**self.dimension * (1 - self.fraction)

    @property
    def displaced(self) -> float:
        return self.density * self.side**self.dimension * self.fraction

    @property
    def reduced_mass(self) -> float:
        return 1 / (1 / self.fluid_mass + 1 / (self.ratio * self.displaced))

    @property
    def force(self) -> float:
        return self.fluid_mass * self.acceleration

    @property
    def diffusion_time(self) -> float:
        """L^2 / nu."""
        return self.side**2 * self.density / self.viscosity


def release_of(run: Run) -> Release:
    (body,), fluid, sides = run.scene["body"], run.scene["fluid"], run.scene["box"]["size"]
    solid = np.pi * body["radius"] ** 2 if len(sides) == 2 else 4 / 3 * np.pi * body["radius"] ** 3
    return Release(len(sides), sides[0], solid / np.prod(sides), body["radius"], fluid["density"], fluid["viscosity"],
                   body["density"] / fluid["density"], run.scene["force"]["fluid"][0])


@dataclass(frozen=True)
class Law:
    """f = drag w + virtual_mass dw/dt."""

    drag: float
    virtual_mass: float

    def slip(self, release: Release, time: np.ndarray) -> np.ndarray:
        """After release at time 0."""
        return release.force / self.drag * -np.expm1(-time * self.drag / (release.reduced_mass + self.virtual_mass))


@cache
def stokes_law(release: Release) -> Law:
    """Of Stokes flow through the array, in slow relaxation."""
    drag = release.viscosity * (1 - release.fraction) ** 2 * square_array(release.fraction).drag
    return Law(drag, virtual_mass(release.fraction) * release.density * release.side**2)


@cache
def stokes_flow(release: Release, times: tuple[float, ...]) -> np.ndarray:
    """Slip of the unsteady Stokes flow, added mass and history included."""
    mass = release.reduced_mass / (release.density * release.side**2)
    found = slip_after_release(release.fraction, mass, np.array(times) / release.diffusion_time)
    return found * release.force / release.viscosity


def slip(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """(time since the release, w)."""
    series, relax = run.series, run.scene["run"].get("relax", 0)
    since = series["step"] >= relax
    time = series["time"][since]
    return time - relax * series["time"][-1] / series["step"][-1], -series["slip_x"][since]


def terminal_velocity(run: Run) -> Measured:
    """Mean of the last tenth of the run; uncertainty, how far it still moves there."""
    tail = slip(run)[1][-max(2, len(run.series) // 10) :]
    return Measured(float(np.mean(tail)), float(np.std(tail)))


def relaxation_time(run: Run) -> Measured:
    time, w = slip(run)
    reached = -np.expm1(-1.0) * terminal_velocity(run).value
    return Measured(float(np.interp(reached, w, time)), float(time[1] - time[0]) / 2)


@cache
def stokes_relaxation(release: Release) -> float:
    """When the slip of unsteady Stokes flow is 1 - 1/e of its limit, by three steps of the secant."""
    limit = release.force / stokes_law(release).drag

    def missing(time: float) -> float:
        return float(stokes_flow(release, (time,))[0] / limit + np.expm1(-1.0))

    law = stokes_law(release)
    before, now = (share * (release.reduced_mass + law.virtual_mass) / law.drag for share in (0.9, 1.0))
    left, right = missing(before), missing(now)
    for _ in range(3):
        before, now = now, now - right * (now - before) / (right - left)
        left, right = right, missing(now)
    return now


def _times(run: Run) -> np.ndarray:
    """Up to the end, of which two digits count: runs that end within a step of each other are compared at the same times, and
    the theory is worked out once for all of them."""
    end = slip(run)[0][-1]
    unit = 10.0 ** (np.floor(np.log10(end)) - 1)
    end = np.floor(end / unit + 1e-9) * unit
    return np.geomspace(0.01 * end, end, TIMES)


def _largest(run: Run, expected: np.ndarray) -> Measured:
    time, w = slip(run)
    return Measured(float(np.max(np.abs(np.interp(_times(run), time, w) - expected)) / expected[-1]), 0.0)


def _over(measured: Measured, exact: float) -> Measured:
    return Measured(measured.value / exact, measured.uncertainty / exact)


def terminal_over_exact(run: Run) -> Measured:
    release = release_of(run)
    return _over(terminal_velocity(run), release.force / stokes_law(release).drag)


def relaxation_over_exact(run: Run) -> Measured:
    return _over(relaxation_time(run), stokes_relaxation(release_of(run)))


def from_drag_law(run: Run) -> Measured:
    release = release_of(run)
    return _largest(run, stokes_law(release).slip(release, _times(run)))


def from_stokes_flow(run: Run) -> Measured:
    return _largest(run, stokes_flow(release_of(run), tuple(_times(run))))


def lag(run: Run) -> Measured:
    """Largest lag behind the drag law without the fluid that the body drags along, of the velocity at the end."""
    release, (time, w) = release_of(run), slip(run)
    alone = Law(stokes_law(release).drag, 0.0).slip(release, time)
    return Measured(float(np.max(alone - w) / alone[-1]), 0.0)


def reference_options(runs: Sequence[Values]) -> dict[str, str]:
    """The drag law that is handed to LIGGGHTS: nothing of it is measured here."""
    values = runs[0].values
    return {"gamma": f"{values['law_drag']:.12g}", "force": f"{values['force']:.12g}", "mass": f"{values['law_mass']:.12g}"}


# The same of every run: what the drag law for LIGGGHTS is made of, by Stokes flow through the array.
FIGURES = {
    "force": lambda run: release_of(run).force,
    "law_drag": lambda run: stokes_law(release_of(run)).drag,
    "law_mass": lambda run: release_of(run).reduced_mass + stokes_law(release_of(run)).virtual_mass,
}


def laws(run: Run) -> tuple[Curve, ...]:
    """Without and with the mass that a body in a wide fluid adds: that of the fluid displaced, in space half of it."""
    release, time = release_of(run), np.linspace(0, slip(run)[0][-1], 200)
    drag = stokes_law(release).drag
    added = release.displaced * (1.0 if release.dimension == 2 else 0.5)
    return (Curve("drag law alone", time, Law(drag, 0.0).slip(release, time)),
            Curve("and added mass", time, Law(drag, added).slip(release, time)))


def curves(run: Run) -> list[Chart]:
    times = _times(run)
    found = stokes_flow(release_of(run), tuple(times))
    exact = Curve("unsteady Stokes flow: added mass and history", times, found, reference=True)
    return [Chart("Slip after release", "time", "w", (*laws(run), exact, Curve("MaPPM", *slip(run))))]


def charts_of_both(run: Run, other: Run) -> list[Chart]:
    table, (time, w) = read_table(other.folder / "table.csv"), slip(run)
    theirs = Curve("LIGGGHTS, drag and dragged fluid of steady Stokes flow", table["time"], table["velocity"], reference=True)
    difference = (w - np.interp(time, table["time"], table["velocity"])) / table["velocity"][-1]
    return [Chart("Slip after release", "time", "w", (theirs, Curve("MaPPM", time, w))),
            Chart("Difference from LIGGGHTS", "time", "over w at the end", (Curve("MaPPM", time, difference),))]


MEASURES = Measures(
    observables=by_name(terminal_over_exact, relaxation_over_exact, from_drag_law, from_stokes_flow),
    figures=FIGURES,
    charts=curves,
    charts_of_both=charts_of_both,
    reference_options=reference_options,
)
