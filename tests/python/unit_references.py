"""References against a second source: published series evaluated here."""

import math
from pathlib import Path

import numpy as np
import pytest

from verification.manifest import find_case


def reference(case: str, name: str) -> float:
    (found,) = [observable.reference for observable in find_case(case).observables if observable.name == name]
    return found


def test_sphere_array_against_the_series_for_the_simple_cubic_array() -> None:
    # Sangani and Acrivos 1982, leading terms: 1 / K = 1 - 1.7601 p + p^3 - 1.5593 p^6 + 3.9799 p^8 - 3.0734 p^10 with
    # p the cube root of phi; the terms left out are of order p^11 = 2e-4.
    p = 0.1 ** (1 / 3)
    inverse = 1 - 1.7601 * p + p**3 - 1.5593 * p**6 + 3.9799 * p**8 - 3.0734 * p**10
    assert reference("sphere_array", "drag") == pytest.approx(1 / inverse, rel=1e-3)


def test_sphere_array_lies_between_its_neighbours_in_the_table_of_zick_and_homsy() -> None:
    fraction = np.array([0.027, 0.064, 0.125, 0.216])
    drag = np.array([2.008, 2.810, 4.292, 7.442])
    # ln K is nearly straight in phi^(1/3): a cubic through four points is good to 1 %.
    cubic = np.polyfit(fraction ** (1 / 3), np.log(drag), 3)
    assert reference("sphere_array", "drag") == pytest.approx(np.exp(np.polyval(cubic, 0.1 ** (1 / 3))), rel=0.01)


def test_cylinder_array_against_the_series_for_the_square_array() -> None:
    # Drummond and Tahir 1984: F / (mu U) = 8 pi / (ln(1/phi) - 1.476 + 2 phi - 1.774 phi^2 + 4.076 phi^3). A next term
    # of the size of the last, 4 phi^4 = 0.0065 in a denominator of 0.495, would change the result by 1.3 %.
    phi = 0.2
    series = 8 * np.pi / (np.log(1 / phi) - 1.476 + 2 * phi - 1.774 * phi**2 + 4.076 * phi**3)
    assert reference("cylinder_array", "drag") == pytest.approx(series, rel=0.02)


def test_impact_against_hertz() -> None:
    # Two equal spheres, approach speed V = 20 m/s: E* = E / (2 (1 - nu^2)), R* = R / 2, m* = m / 2.
    radius, young, poisson, density, speed = 0.010, 48e9, 0.2, 2800.0, 20.0
    mass = 4 / 3 * np.pi * radius**3 * density / 2
    stiffness = 4 / 3 * young / (2 * (1 - poisson**2)) * np.sqrt(radius / 2)
    overlap = (5 * mass * speed**2 / (4 * stiffness)) ** 0.4
    factor = 2 * math.sqrt(math.pi) * math.gamma(1.4) / math.gamma(0.9)  # 2.94328
    force, time = stiffness * overlap**1.5, factor * overlap / speed
    assert reference("two_spheres_impact", "contact_force") == pytest.approx(force, rel=1e-6)
    assert reference("two_spheres_impact", "contact_time") == pytest.approx(time, rel=1e-5)


def test_the_references_name_their_source() -> None:
    for file in sorted((Path(__file__).parents[2] / "cases").glob("*/case.toml")):
        assert all(len(observable.source) > 10 for observable in find_case(str(file)).observables)
