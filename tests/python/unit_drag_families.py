"""Charts of drags over the points of a family. Oracles: drags of arrays published and made here."""

import numpy as np
import pytest

from verification.measures.drag_families import by_reynolds, drag_errors, drag_of_one_sphere, fraction_of
from verification.measures.measures import Point
from verification.protocol.quantity import COVERAGE

# Of a simple cubic array in Stokes flow: Zick and Homsy, J. Fluid Mech. 115, 1982, 13-26.
STOKES = {0.216: 7.442, 0.027: 2.008, 0.125: 4.292, 0.064: 2.810}


def point(fraction: float, reynolds: float, drag: float, value: float) -> Point:
    side = (4 * np.pi / 3 / fraction) ** (1 / 3)
    scene = {"box": {"size": [side] * 3}, "body": [{"radius": 1.0}],
             "fluid": {"reference_velocity": 1.0, "density": 1.0, "viscosity": 2 / reynolds}}
    return Point("spheres", f"phi_{fraction}", scene, {}, {}, value, value / drag - 1, COVERAGE * 0.01, drag)


POINTS = [point(phi, 0.1, drag, 1.02 * drag) for phi, drag in STOKES.items()] + [point(0.125, 10.0, 4.4, 4.4)]


def test_points_are_sorted_by_reynolds_number_and_fraction() -> None:
    found = by_reynolds(POINTS)
    assert list(found) == [0.1, 10.0]
    assert [round(fraction_of(one.scene), 9) for one in found[0.1]] == [0.027, 0.064, 0.125, 0.216]


def test_errors_and_their_bars() -> None:
    slow, fast = drag_errors(POINTS).curves
    assert slow.y == pytest.approx(np.full(4, 2.0)) and fast.y == pytest.approx(np.zeros(1), abs=1e-12)
    assert slow.error == pytest.approx([100 * 0.02 / STOKES[phi] for phi in sorted(STOKES)])  # k = 2


def test_one_sphere_alone_needs_three_cells_and_meets_stokes_law() -> None:
    (chart,) = drag_of_one_sphere(POINTS)  # none of Re 10
    alone = chart.curves[-1]
    assert alone.y[0] == pytest.approx(1.02, abs=0.01)
    assert [curve.label for curve in chart.curves if curve.reference] == ["Stokes"]
