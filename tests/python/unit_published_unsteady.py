"""Unsteady Stokes flow through a square array. Oracles: tables, steady flow, potential flow, known transforms."""

import numpy as np
import pytest

from reference.stokes.bessel import log_first_kind, log_second_kind
from reference.stokes.laplace import invert
from reference.stokes.square_array import square_array
from reference.stokes.unsteady_array import impedance, slip_after_release, virtual_mass


def test_bessel_functions_against_tables() -> None:
    # Abramowitz and Stegun 1964, tables 9.8 and 9.11, and I_10(1) = 2.752948040e-10, K_10(1) = 1.807132899e8.
    z = np.array([1.0, 10.0], dtype=complex)
    first, second = np.exp(log_first_kind(10, z)), np.exp(log_second_kind(10, z))
    assert first[0].real == pytest.approx([1.2660658778, 2815.7166284], rel=1e-9)
    assert first[10, 0].real == pytest.approx(2.752948040e-10, rel=1e-9)
    assert second[1].real == pytest.approx([0.6019072302, 1.8648773454e-5], rel=1e-9)
    assert second[10, 0].real == pytest.approx(1.807132899e8, rel=1e-9)


@pytest.mark.parametrize("z", [0.02 + 0.01j, 2 + 3j, 30 + 25j])
def test_bessel_functions_have_their_wronskian(z: complex) -> None:
    first, second = (kind(60, np.array([z]))[:, 0] for kind in (log_first_kind, log_second_kind))
    products = np.exp(first[:-1] + second[1:]) + np.exp(first[1:] + second[:-1])
    assert np.abs(products * z - 1).max() < 1e-9


def test_inverse_transforms_that_are_known() -> None:
    time = np.array([0.1, 1.0, 4.0])
    assert invert(lambda s: 1 / (s + 2), time) == pytest.approx(np.exp(-2 * time), abs=1e-5)
    assert invert(lambda s: 1 / np.sqrt(s), time) == pytest.approx(1 / np.sqrt(np.pi * time), rel=1e-5)


@pytest.mark.parametrize("fraction", [0.02, 0.1, 0.3])
def test_slowly_the_drag_is_that_of_steady_flow(fraction: float) -> None:
    steady = (1 - fraction) ** 2 * square_array(fraction).drag
    slow = impedance(fraction, 0.02).real
    assert slow - 0.02 * virtual_mass(fraction) == pytest.approx(steady, rel=1e-5)


def test_suddenly_a_disc_carries_the_added_mass_of_potential_flow() -> None:
    # (Z / s - m_a) falls as s^(-1/2), the boundary layer; m_a of a dilute square array, Rayleigh 1892 by the analogy
    # with conduction: mean flow past discs without conduction, (1 - phi) / (1 + phi), so m_a = phi (1 - phi) to order
    # phi^3 for the mean velocity of the fluid.
    for fraction in (0.02, 0.1):
        coarse, fine = (impedance(fraction, s).real / s for s in (4e4, 1.6e5))
        assert 2 * fine - coarse == pytest.approx(fraction * (1 - fraction), rel=0.005)


def test_more_terms_do_not_change_the_drag() -> None:
    for s in (1.0, 300.0, 10 + 40j):
        assert impedance(0.2, s, 16) == pytest.approx(impedance(0.2, s, 24), rel=1e-6)


def test_a_released_disc_comes_to_its_terminal_slip_and_starts_against_all_inertia() -> None:
    fraction, mass = 0.1, 0.5
    drag = (1 - fraction) ** 2 * square_array(fraction).drag
    early, late = slip_after_release(fraction, mass, np.array([1e-3, 1.0]))
    assert late == pytest.approx(1 / drag, rel=1e-4)
    added = fraction * (1 - fraction)
    assert 1e-3 / (mass + virtual_mass(fraction)) < early < 1e-3 / (mass + added)
