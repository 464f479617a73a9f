"""Velocities on the centre lines of a lid-driven cavity, against Ghia, Ghia and Shin (1982)."""

from functools import cache

import numpy as np

from reference.published.cavity import centre_line
from verification.measures.curve import Chart, Curve
from verification.measures.fits import extrapolate, values_at
from verification.measures.histories import settling
from verification.measures.measures import Measures, by_name
from verification.measures.observables import SETTLED
from verification.protocol.quantity import Measured
from verification.protocol.run import Run, read_time

RADIUS = 3.0  # of the fit, in spacings
LATE = 0.8  # of the run: later snapshots count
LINE = np.linspace(0.0, 1.0, 201)


def reynolds(run: Run) -> int:
    fluid = run.scene["fluid"]
    return round(fluid["density"] * run.scene["body"][0]["velocity"][0] / fluid["viscosity"])


def _late_snapshots(run: Run) -> list[int]:
    times = [read_time(path) for path in run.snapshots()]
    return [i for i, time in enumerate(times) if time > LATE * times[-1]]


@cache
def _fitted(run: Run, component: str, at: tuple[float, ...]) -> np.ndarray:
    """(snapshots, points): velocity over that of the lid, late in the run, at places of the centre line."""
    lid, radius = run.scene["body"][0]["velocity"][0], RADIUS * run.scene["fluid"]["spacing"]
    middle = np.full(len(at), 0.5)
    places = np.column_stack([middle, at] if component == "u" else [at, middle])
    rows = []
    for which in _late_snapshots(run):
        particles = run.fluid(which)
        velocity = particles["velocity"][:, "uv".index(component)] / lid
        rows.append(values_at(particles["points"][:, :2], velocity, places, radius))
    return np.array(rows)


def profiles(run: Run, component: str, at: np.ndarray) -> np.ndarray:
    return _fitted(run, component, tuple(at))


def _objection(run: Run) -> str:
    energy = extrapolate(run.series["time"], run.series["fluid_energy"])
    count = len(_late_snapshots(run))
    objections = [] if energy.gap < SETTLED else [f"kinetic energy {100 * energy.gap:.2f} % from its extrapolation"]
    return "; ".join(objections + ([] if count >= 4 else [f"{count} late snapshots; write more"]))


def _differences(run: Run) -> np.ndarray:
    """From the tables, of the mean of the late snapshots, at all points between the walls."""
    both = []
    for component in "uv":
        table = centre_line(component, reynolds(run))
        inner = slice(1, -1)
        both.append(profiles(run, component, table.position[inner]).mean(axis=0) - table.velocity[inner])
    return np.concatenate(both)


def rms_from_ghia(run: Run) -> Measured:
    return Measured(float(np.sqrt(np.mean(_differences(run) ** 2))), 0.0, _objection(run))


def largest_from_ghia(run: Run) -> Measured:
    return Measured(float(np.abs(_differences(run)).max()), 0.0, _objection(run))


def _extreme(run: Run, component: str, sign: float) -> Measured:
    """Of the mean profile; the uncertainty is that of the mean over snapshots."""
    rows = sign * profiles(run, component, LINE[3:-3])
    values = rows.max(axis=1)
    scatter = float(np.std(values, ddof=1) / np.sqrt(len(values))) if len(values) > 1 else 0.0
    return Measured(sign * float(rows.mean(axis=0).max()), scatter, _objection(run))


def lowest_u(run: Run) -> Measured:
    return _extreme(run, "u", -1.0)


def highest_v(run: Run) -> Measured:
    return _extreme(run, "v", 1.0)


def lowest_v(run: Run) -> Measured:
    return _extreme(run, "v", -1.0)


def curves(run: Run) -> list[Chart]:
    charts = []
    for component, across, line in (("u", "y", "vertical"), ("v", "x", "horizontal")):
        table, inner = centre_line(component, reynolds(run)), LINE[3:-3]
        charts.append(
            Chart(
                f"Velocity on the {line} centre line",
                across,
                f"{component} / U",
                (
                    Curve("Ghia et al.", table.position, table.velocity, reference=True, points=True),
                    Curve("PPs", inner, profiles(run, component, inner).mean(axis=0)),
                ),
            )
        )
    charts.append(
        settling("Kinetic energy against time", "kinetic energy", run.series["time"], run.series["fluid_energy"])
    )
    return charts


MEASURES = Measures(observables=by_name(rms_from_ghia, largest_from_ghia, lowest_u, highest_v, lowest_v), charts=curves)
