"""Stokes flow about a disc in a channel. Oracles: the equations, Lorentz' reciprocity, a wide channel, more points."""

import numpy as np
import pytest

from reference.stokes.channel import (
    Channel,
    Disc,
    angular_velocity,
    angular_velocity_without_transpose,
    stokeslets,
)
from verification.suite.manifest import find_case

PERIOD = 1.0


def test_a_stokeslet_repeats_and_solves_the_equations() -> None:
    # Curl of Laplacian u = 0 and div u = 0, by central differences: (1e-2)^2 of fourth derivatives over a unit distance.
    source, step = np.array([[0.1, -0.2]]), 1e-2

    def at(x: float, y: float) -> np.ndarray:
        return stokeslets(np.array([[x, y]]), source, 2.0)

    assert at(0.7, 0.5) == pytest.approx(at(2.7, 0.5), abs=1e-13)
    steps = step * np.arange(-2, 3)
    u = np.array([[at(0.8 + a, 0.5 + b) for b in steps] for a in steps])
    d_x = (u[2:, 1:-1] - u[:-2, 1:-1]) / (2 * step)
    d_y = (u[1:-1, 2:] - u[1:-1, :-2]) / (2 * step)
    assert d_x[1, 1, 0] + d_y[1, 1, 1] == pytest.approx([0.0, 0.0], abs=1e-4)
    vorticity = d_x[:, :, 1] - d_y[:, :, 0]
    five = vorticity[0, 1] + vorticity[2, 1] + vorticity[1, 0] + vorticity[1, 2] - 4 * vorticity[1, 1]
    assert five / step**2 == pytest.approx([0.0, 0.0], abs=1e-2)


def test_the_spin_of_the_case_does_not_change_with_the_points() -> None:
    (observable,) = find_case("disc_in_couette").observables
    disc = Disc(0.2)
    values = [angular_velocity(disc, PERIOD, points) for points in (24, 32, 64)]
    assert values == pytest.approx([values[-1]] * 3, rel=1e-7)
    assert observable.reference == pytest.approx(values[-1], abs=observable.uncertainty)


def test_the_velocity_is_met_between_the_points() -> None:
    channel = Channel(Disc(0.2), PERIOD)
    assert channel.resistance(lambda at: -channel.shear(at)).residual < 1e-8


def test_a_small_disc_in_a_wide_channel_turns_with_half_the_shear_rate() -> None:
    slower = [0.5 - angular_velocity(Disc(radius), 2.0) for radius in (0.02, 0.04)]
    assert slower[0] < 5e-4
    assert slower[1] / slower[0] == pytest.approx(4.0, rel=0.02)  # the walls act as (R / H)^2


def test_without_the_transposed_gradient_a_small_disc_turns_with_the_whole_shear_rate() -> None:
    # Around a disc u = Om r + (om - Om) R^2 / r, Om = G / 2: du/dr = 2 Om - om vanishes at om = G.
    assert angular_velocity_without_transpose(Disc(0.01), 2.0) == pytest.approx(1.0, abs=1e-3)


def test_turning_and_moving_are_reciprocal() -> None:
    # Lorentz: the force along x on a disc that turns is the torque on one that moves along x. Off the middle both exist.
    channel = Channel(Disc(0.2, height=0.35), 1.0, 64)
    turned = channel.resistance(channel.turning)
    moved = channel.resistance(lambda at: np.column_stack([np.ones(len(at)), np.zeros(len(at))]))
    assert abs(turned.force[0]) > 0.1
    assert turned.force[0] == pytest.approx(moved.torque, rel=1e-6)
    assert turned.torque < 0.0
