"""Damping of a standing sound wave. Oracle: its amplitude falls as exp(-nu k^2 t / 2).

The viscous force of the pair law is mu times the Laplacian of the velocity, for sound too: there is no further 4/3 and
no bulk viscosity. The period alone sees neither a density nor a position that is one step late; such a fault feeds the
wave by omega^2 dt, more than viscosity takes.
"""

from pathlib import Path

import pytest
from support import judged


def damping(folder: Path, viscosity: float, *overrides: str) -> float:
    """Damping of the wave of the case over nu k^2 / 2."""
    _, outcomes = judged("sound_wave", folder, f"fluid.viscosity={viscosity}", *overrides)
    return outcomes["sound_damping"].measured.value


@pytest.mark.parametrize("method", ["classic", "transport"])
@pytest.mark.parametrize("factor", [1.0, 0.5])  # of the step: none of the damping is the step's
def test_sound_is_damped_by_viscosity(tmp_path: Path, method: str, factor: float) -> None:
    found = damping(tmp_path, 5e-4, f"fluid.method={method}", f"run.step_factor={factor}", "output.snapshot=3")
    assert abs(found - 1) < 0.005


def test_the_transport_velocity_leaves_weak_sound_alone(tmp_path: Path) -> None:
    """The share of the shift goes by the square of the strain, which in weak sound is small."""
    weak, strong = (damping(tmp_path / rate, 5e-4, f"fluid.shift_rate={rate}", "run.step_factor=0.5")
                    for rate in ("0.1", "0.5"))
    assert weak == pytest.approx(strong, abs=1e-4)
