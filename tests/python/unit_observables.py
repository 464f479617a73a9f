"""Observables on series written here, whose answers are worked out by hand."""

from types import SimpleNamespace

import numpy as np
import pytest

from verification.measures.observables import drag, sideways
from verification.protocol.series import Table

TIME = np.linspace(0.0, 10.0, 101)


def cell(size: tuple[float, ...], on_surface: float, velocity: np.ndarray, turn: float = 0.0,
         moves: tuple[float, ...] = ()) -> SimpleNamespace:
    """A solid of a fifth of the cell, driven by 2 along a direction turned by `turn` from x in the plane of x and y; PPs
    fill 0.8 of the cell. `velocity` is the superficial one past the solid, which is fixed or `moves` at the velocity given."""
    dimension = len(size)
    direction = np.array([np.cos(turn), np.sin(turn), 0.0][:dimension])
    fifth = 0.2 * np.prod(size)
    radius = np.sqrt(fifth / np.pi) if dimension == 2 else (3 * fifth / (4 * np.pi)) ** (1 / 3)
    scene = {
        "box": {"size": list(size)},
        "fluid": {"density": 1.0, "viscosity": 0.5},
        "body": [{"radius": radius, "motion": "moving" if moves else "fixed"}],
        "force": {"fluid": list(2.0 * direction)},
    }
    columns = {"time": TIME}
    for axis, share, own in zip("xyz", direction, moves or (0.0,) * dimension, strict=False):
        columns[f"fluid_velocity_{axis}"] = share * velocity / 0.8 + own
        columns[f"superficial_velocity_{axis}"] = 0.8 * columns[f"fluid_velocity_{axis}"]
        columns[f"slip_{axis}"] = -share * velocity / 0.8
        columns[f"drag_{axis}"] = np.full_like(TIME, share * on_surface)
    return SimpleNamespace(scene=scene, series=Table(columns, dict.fromkeys(columns, "")))


STEADY = np.full_like(TIME, 0.1)


def test_drag_of_a_cylinder_and_of_a_sphere() -> None:
    # F = rho g V = 2, of which 0.8 act through the surface; mu U = 0.05.
    plane = drag(cell((1.0, 1.0), 1.6, STEADY))
    assert (plane.value, plane.objection) == (pytest.approx(2.0 / 0.05, rel=1e-12), "")
    # In a cube of side 2, F = 16 and 12.8 act through the surface; 6 pi mu R U = 0.3 pi R with R^3 = 1.2 / pi.
    space = drag(cell((2.0, 2.0, 2.0), 12.8, STEADY))
    assert (space.value, space.objection) == (pytest.approx(16.0 / (0.3 * np.pi * (1.2 / np.pi) ** (1 / 3)), rel=1e-12), "")


@pytest.mark.parametrize("turn", [0.3, np.pi / 2, 2.0])
def test_drag_along_any_direction_on_a_solid_that_moves(turn: float) -> None:
    # As in the plane above: neither the direction of the force nor a common velocity shows.
    turned = cell((1.0, 1.0), 1.6, STEADY, turn, moves=(0.7, -0.4))
    assert (drag(turned).value, drag(turned).objection) == (pytest.approx(40.0, rel=1e-12), "")
    assert sideways(turned).value == pytest.approx(0.0, abs=1e-12)


def test_a_flow_that_leaves_the_direction_of_the_force() -> None:
    drifting = cell((1.0, 1.0), 1.6, STEADY)
    drifting.series.columns["fluid_velocity_y"] = np.full_like(TIME, -0.03)
    assert sideways(drifting).value == pytest.approx(0.03 / 0.125, rel=1e-12)


def test_pps_that_fill_less_than_the_fluid_are_driven_less() -> None:
    # 1 % too few: 1.584 drive the cell, and F is 1.98; the mean velocity of the fluid, and with it U, is what it is.
    thin = cell((1.0, 1.0), 1.584, STEADY)
    thin.series.columns["superficial_velocity_x"] = 0.99 * STEADY
    assert (drag(thin).value, drag(thin).objection) == (pytest.approx(1.98 / 0.05, rel=1e-12), "")


@pytest.mark.parametrize("factor", [0.99, 1.01])
def test_a_drag_is_not_accepted_while_forces_are_out_of_balance(factor: float) -> None:
    assert drag(cell((1.0, 1.0), 1.6 * factor, STEADY)).objection == "forces out of balance by 1.00 %"


def test_a_slow_drift_is_not_extrapolated() -> None:
    # The flow relaxes in 0.06; 3 % of drift over the second half are noise about its mean, of which the end is 1 % off.
    drifting = 0.1 * (1.0 + 0.06 * (TIME - 7.5) / 10.0)
    measured = drag(cell((1.0, 1.0), 1.6, drifting))
    assert measured.value == pytest.approx(40.0, rel=4e-3)
    assert measured.objection.endswith("from its extrapolation")
    assert measured.uncertainty > 0.01 * measured.value


def test_a_drag_is_not_accepted_before_the_flow_has_settled() -> None:
    rising = 0.1 * (1.0 - np.exp(-TIME / 3.0))  # 4 % are missing at the end
    assert drag(cell((1.0, 1.0), 1.6, rising)).objection.endswith("from its extrapolation")
