"""The energy budget. Oracle: a body force on a fluid and discs whose velocities grow evenly, integrated by hand."""

import numpy as np
import pytest

from verification.measures.budget import body_work
from verification.protocol.series import Table

TIME = np.linspace(0.0, 2.0, 5)


class Fake:
    """What body_work reads of a run: a box of 4, filled by three quarters, and two discs of radius 1/2."""

    def __init__(self, solid: object, relax: int = 0) -> None:
        columns = {
            "step": np.arange(5.0), "time": TIME,
            "fluid_velocity_x": np.zeros(5), "solid_velocity_x": np.zeros(5),
            "fluid_velocity_y": 3.0 * TIME, "solid_velocity_y": -TIME,
            "superficial_velocity_x": np.zeros(5), "superficial_velocity_y": 0.75 * 3.0 * TIME,
        }
        self.series = Table(columns, dict.fromkeys(columns, ""))
        self.scene = {
            "box": {"size": [1.0, 4.0]}, "fluid": {"density": 2.0}, "body": [{"density": 5.0}],
            "force": {"fluid": [0.0, 0.1], "solid": solid}, "run": {"relax": relax},
        }

    def solids(self) -> dict[str, np.ndarray]:
        return {"radius": np.array([0.5, 0.5])}


def test_work_is_force_times_way() -> None:
    # Fluid: mass 2 * 4 * 3/4 = 6, force 0.6 over 1.5 t^2. Discs: mass 5 * pi / 2, -0.2 of acceleration over -t^2 / 2.
    expected = 0.6 * 1.5 * TIME**2 + 0.2 * 5.0 * np.pi / 2 * TIME**2 / 2
    assert body_work(Fake([0.0, -0.2])) == pytest.approx(expected)


def test_balanced_forces_oppose_each_other() -> None:
    assert body_work(Fake("balance")) == pytest.approx(0.6 * (1.5 + 0.5) * TIME**2)


def test_no_work_before_the_forces_act() -> None:
    work = body_work(Fake("balance", relax=2))
    assert work[1] == 0.0 and work[2] > 0.0
