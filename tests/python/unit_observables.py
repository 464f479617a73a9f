"""Observables on series written here, whose answers are worked out by hand."""

from types import SimpleNamespace

import numpy as np
import pytest

from verification.observables import drag
from verification.series import Table

TIME = np.linspace(0.0, 10.0, 101)


def cell(size: tuple[float, ...], on_surface: float, velocity: np.ndarray) -> SimpleNamespace:
    """A fixed solid of radius 0.25 in a cell driven by 2 along x; PPs fill 0.8 of the cell."""
    rest = [0.0] * (len(size) - 1)
    scene = {
        "box": {"size": list(size)},
        "fluid": {"density": 1.0, "viscosity": 0.5},
        "body": [{"radius": 0.25, "motion": "fixed"}],
        "force": {"fluid": [2.0, *rest]},
    }
    columns = {
        "time": TIME,
        "superficial_velocity_x": velocity,
        "fluid_velocity_x": velocity / 0.8,
        "drag_x": np.full_like(TIME, on_surface),
    }
    return SimpleNamespace(scene=scene, series=Table(columns, dict.fromkeys(columns, "")))


STEADY = np.full_like(TIME, 0.1)


def test_drag_of_a_cylinder_and_of_a_sphere() -> None:
    # F = rho g V = 2, of which 0.8 act through the surface; mu U = 0.05.
    plane = drag(cell((1.0, 1.0), 1.6, STEADY))
    assert (plane.value, plane.objection) == (pytest.approx(2.0 / 0.05, rel=1e-12), "")
    # In a cube of side 2, F = 16 and 12.8 act through the surface; 6 pi mu R U = 0.075 pi.
    space = drag(cell((2.0, 2.0, 2.0), 12.8, STEADY))
    assert (space.value, space.objection) == (pytest.approx(16.0 / (0.075 * np.pi), rel=1e-12), "")


@pytest.mark.parametrize("factor", [0.99, 1.01])
def test_a_drag_is_not_accepted_while_forces_are_out_of_balance(factor: float) -> None:
    assert drag(cell((1.0, 1.0), 1.6 * factor, STEADY)).objection == "forces out of balance by 1.00 %"


def test_a_drag_is_not_accepted_before_the_flow_has_settled() -> None:
    rising = 0.1 * (1.0 - np.exp(-TIME / 3.0))  # 4 % are missing at the end
    assert drag(cell((1.0, 1.0), 1.6, rising)).objection.endswith("from its extrapolation")
