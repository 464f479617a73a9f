"""The plain method on flows without walls, where it must do as well. Oracle: exact solutions, those of the cases."""

from pathlib import Path

import pytest
from support import assert_holds, judged


@pytest.mark.parametrize("case", ["shear_wave", "shear_wave_3d"])
def test_viscosity(tmp_path: Path, case: str) -> None:
    _, outcomes = judged(case, tmp_path, "fluid.method=classic")
    assert_holds(outcomes["viscosity"], goal=0.005)


def test_sound(tmp_path: Path) -> None:
    _, outcomes = judged("sound_wave", tmp_path, "fluid.method=classic")
    assert_holds(outcomes["sound_speed"], goal=0.005)
    assert_holds(outcomes["sound_damping"], goal=0.02)
