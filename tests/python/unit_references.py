"""References against a second source: published series evaluated here."""

import math

import numpy as np
import pytest

from verification.suite.manifest import all_cases, find_case


def reference(case: str, name: str) -> float:
    (found,) = [observable.reference for observable in find_case(case).observables
                if observable.name == name and not observable.live]
    return found


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
    written = [observable for case in all_cases() for observable in case.observables
               if not observable.live and not observable.published]
    assert all(len(observable.source) > 10 for observable in written)
