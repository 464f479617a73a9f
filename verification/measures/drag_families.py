"""Charts of the drag over the points of a family of cases: one body in a periodic cell, several solids fractions and
Reynolds numbers."""

from collections.abc import Iterable

import numpy as np

from verification.measures.curve import Chart, Curve
from verification.measures.extrapolation import correlations, isolated
from verification.suite.judge import COVERAGE, Outcome
from verification.suite.result import CaseResult


def fraction_of(scene: dict) -> float:
    size, radius = scene["box"]["size"], scene["body"][0]["radius"]
    return (np.pi * radius**2 if len(size) == 2 else 4 / 3 * np.pi * radius**3) / np.prod(size)


def reynolds_of(scene: dict) -> float:
    """On the diameter."""
    fluid = scene["fluid"]
    return 2 * scene["body"][0]["radius"] * fluid["reference_velocity"] * fluid["density"] / fluid["viscosity"]


Point = tuple[float, Outcome]


def by_reynolds(results: Iterable[CaseResult]) -> dict[float, list[Point]]:
    """(solids fraction, first outcome) of each result, by Reynolds number, all in ascending order."""
    found: dict[float, list[Point]] = {}
    for result in results:
        number = float(f"{reynolds_of(result.case.scene):.3g}")
        found.setdefault(number, []).append((fraction_of(result.case.scene), result.outcomes[0]))
    return {number: sorted(found[number], key=lambda point: point[0]) for number in sorted(found)}


def _bars(points: list[Point]) -> np.ndarray:
    return np.array([COVERAGE * outcome.u_num * outcome.scale for _, outcome in points])


def drag_errors(results: list[CaseResult]) -> Chart:
    """Of the finest level against the first reference of the case, per cent."""
    curves = []
    for number, points in by_reynolds(results).items():
        errors = np.array([100 * outcome.error for _, outcome in points])
        bars = 100 * _bars(points) / np.array([outcome.scale for _, outcome in points])
        fractions = np.array([fraction for fraction, _ in points])
        curves.append(Curve(f"Re {number:g}", fractions, errors, points=True, error=bars))
    return Chart(f"{results[0].case.family}: error of the drag at the finest level", "solids fraction", "E, %", tuple(curves))


def drag_of_one_sphere(results: list[CaseResult]) -> list[Chart]:
    """At each Reynolds number measured at three solids fractions or more, the drag extrapolated to a sphere alone, beside the
    correlations. No verdict: with inertia the cells must be wider than the wake for the extrapolation to mean much."""
    charts = []
    for number, points in by_reynolds(results).items():
        points = [point for point in points if np.isfinite(point[1].measured.value)]
        if len(points) < 3:
            continue
        fraction = np.array([share for share, _ in points])
        drag = np.array([outcome.measured.value for _, outcome in points])
        bars = _bars(points)
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
