"""Charts of the drag over the points of a family of cases: one body in a periodic cell, several solids fractions and
Reynolds numbers."""

from collections.abc import Iterable

import numpy as np

from verification.measures.curve import Chart, Curve
from verification.measures.extrapolation import correlations, isolated
from verification.measures.measures import Point
from verification.protocol.quantity import COVERAGE


def fraction_of(scene: dict) -> float:
    size, radius = scene["box"]["size"], scene["body"][0]["radius"]
    return (np.pi * radius**2 if len(size) == 2 else 4 / 3 * np.pi * radius**3) / np.prod(size)


def reynolds_of(scene: dict) -> float:
    """On the diameter."""
    fluid = scene["fluid"]
    return 2 * scene["body"][0]["radius"] * fluid["reference_velocity"] * fluid["density"] / fluid["viscosity"]


def by_reynolds(points: Iterable[Point]) -> dict[float, list[Point]]:
    """By Reynolds number, in each by solids fraction, all in ascending order."""
    found: dict[float, list[Point]] = {}
    for point in points:
        found.setdefault(float(f"{reynolds_of(point.scene):.3g}"), []).append(point)
    return {number: sorted(found[number], key=lambda point: fraction_of(point.scene)) for number in sorted(found)}


def drag_errors(points: list[Point]) -> Chart:
    """Of the finest level against the first reference of the case, per cent."""
    curves = []
    for number, some in by_reynolds(points).items():
        errors = np.array([100 * point.error for point in some])
        bars = np.array([100 * point.half_width / point.scale for point in some])
        fractions = np.array([fraction_of(point.scene) for point in some])
        curves.append(Curve(f"Re {number:g}", fractions, errors, points=True, error=bars))
    return Chart(f"{points[0].family}: error of the drag at the finest level", "solids fraction", "E, %", tuple(curves))


def drag_of_one_sphere(points: list[Point]) -> list[Chart]:
    """At each Reynolds number measured at three solids fractions or more, the drag extrapolated to a sphere alone, beside the
    correlations. No verdict: with inertia the cells must be wider than the wake for the extrapolation to mean much."""
    charts = []
    for number, some in by_reynolds(points).items():
        some = [point for point in some if np.isfinite(point.value)]
        if len(some) < 3:
            continue
        fraction = np.array([fraction_of(point.scene) for point in some])
        drag = np.array([point.value for point in some])
        bars = np.array([point.half_width for point in some])
        alone = isolated(list(fraction), list(drag), list(np.maximum(bars / COVERAGE, 1e-6 * drag)))
        shares = np.linspace(0.0, fraction.max() ** (1 / 3), 100)
        curves = [Curve(name, np.zeros(1), np.array([value]), reference=True, points=True)
                  for name, value in (correlations(number) if number > 0.5 else {"Stokes": 1.0}).items()]
        curves += [
            Curve("fit", shares, alone.drag(shares**3)),
            Curve("measured", np.cbrt(fraction), drag, points=True, error=bars),
            Curve(f"alone: {alone.value:.3g} +- {COVERAGE * alone.uncertainty:.1g}", np.zeros(1), np.array([alone.value]),
                  points=True, error=np.array([COVERAGE * alone.uncertainty])),
        ]
        charts.append(Chart(f"Drag in ever wider cells, Re {number:g}", "cube root of the solids fraction",
                            "F / (6 pi mu R U)", tuple(curves)))
    return charts
