"""Measures of impacts for measure.py of a case, by the formulas that reference codes are measured by (reference/contact)."""

import math
from collections.abc import Callable, Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np

from reference.contact.collision import Collision, collision_of
from reference.contact.motion import IMPACT, REST, Motion, centre, normal_force, read_motion, touch_times
from reference.contact.scene import ContactScene, contact_scene
from verification.measures.curve import Chart, Curve
from verification.measures.measures import Measure, Point
from verification.protocol.quantity import Measured
from verification.protocol.run import Run

LIVE_TABLE = "table.csv"


@lru_cache(maxsize=4)
def motion_of(folder: Path) -> Motion:
    run = Run(folder)
    return read_motion(folder / "solids.csv", contact_scene(run.scene))


def exact_of(run: Run) -> Collision:
    return collision_of(contact_scene(run.scene))


def accepted(value: float) -> Measured:
    return Measured(value, 0.0, "there was no impact" if math.isnan(value) else "")


def measure(name: str) -> Measure:
    return lambda run: accepted((IMPACT | REST)[name](motion_of(run.folder)))


def measured(*names: str) -> dict[str, Measure]:
    return {name: measure(name) for name in names}


def _figure(name: str) -> Callable[[Run], float]:
    return lambda run: IMPACT[name](motion_of(run.folder))


FIGURES = {name: _figure(name) for name in IMPACT}  # for charts of families, judged or not


def over_exact(name: str, of: Callable[[Collision], float]) -> Measure:
    """The measure `name` over what the equation of the overlap gives."""
    return lambda run: accepted(IMPACT[name](motion_of(run.folder)) / of(exact_of(run)))


def force_charts(run: Run, other: Run) -> list[Chart]:
    """Of one impact: the force along the normal, both codes from the first touch on."""
    theirs = read_motion(other.folder / LIVE_TABLE, contact_scene(run.scene))
    curves = []
    for label, motion in (("LIGGGHTS", theirs), ("measured", motion_of(run.folder))):
        first, last = touch_times(motion)
        time = motion.time[:-1] - first
        near = (time > -0.1 * (last - first)) & (time < 1.1 * (last - first))
        curves.append(Curve(label, time[near], normal_force(motion)[near], reference=label == "LIGGGHTS"))
    return [Chart("Force of the contact", "time (s)", "force (N)", tuple(curves))]


def centre_charts(run: Run, other: Run) -> list[Chart]:
    """Height of the common centre of mass over time, both codes."""
    theirs = read_motion(other.folder / LIVE_TABLE, contact_scene(run.scene))
    curves = [Curve(label, motion.time, centre(motion), reference=label == "LIGGGHTS")
              for label, motion in (("LIGGGHTS", theirs), ("measured", motion_of(run.folder)))]
    return [Chart("Centre of mass", "time", "height", tuple(curves))]


Numbers = Mapping[str, float]  # measures of one point by their names


def family_chart(points: list[Point], labels: tuple[str, str, str], x: Callable[[ContactScene], float],
                 y: Callable[[Numbers, ContactScene], float], group: Callable[[str], str], published: tuple[Curve, ...] = ()) -> Chart:
    """y over x of all points, a colour for each `group` of their names, "" for none: the solver's as crosses, LIGGGHTS' as circles.

    `labels` are the title and those of the axes.
    """
    groups: dict[str, list[tuple[float, float, float]]] = {}
    for point in points:
        label, scene = group(point.name), contact_scene(point.scene)
        if label:
            theirs = y(point.reference, scene) if point.reference else math.nan
            groups.setdefault(label, []).append((x(scene), y(point.values, scene), theirs))
    curves = []
    for label, found in groups.items():
        at, values, live = np.array(sorted(found)).T
        curves.append(Curve(label, at, values, points=True, marker="x"))
        if np.isfinite(live).any():
            curves.append(Curve(f"{label}, LIGGGHTS", at, live, reference=True, points=True))
    return Chart(*labels, (*curves, *published))


def read_published(file: Path, test: str, label: str) -> Curve:
    """Of a table with the columns test, x, y: a curve as read off a figure."""
    rows = [line.split(",") for line in file.read_text().splitlines() if line.startswith(f"{test},")]
    x, y = np.array([[float(x), float(y)] for _, x, y in rows]).T
    return Curve(label, x, y, reference=True)
