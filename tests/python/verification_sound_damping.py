"""Damping of a standing sound wave. Oracle: its kinetic energy falls as exp(-nu k^2 t).

The viscous force of the pair law is mu times the Laplacian of the velocity, for sound too: there is no further 4/3 and
no bulk viscosity. The period alone sees neither a density nor a position that is one step late; such a fault feeds the
wave by omega^2 dt = 0.036, nearly twice what viscosity takes.
"""

from pathlib import Path

import numpy as np
import pytest

from verification.fits import minima
from verification.solver import ROOT, Options, run

WAVE_NUMBER = 2 * np.pi


def damping(folder: Path, viscosity: float, *overrides: str) -> float:
    """Rate at which the maxima of the kinetic energy fall, over nu k^2. The density of the scene is 1."""
    options = Options(overrides=(f"fluid.viscosity={viscosity}", "output.snapshot=0", *overrides))
    series = run(ROOT / "cases" / "sound_wave" / "case.toml", folder, options).series
    time, energy = series["time"], series["fluid_energy"]
    top = minima(time, -energy)
    assert len(top) >= 4
    slope, _ = np.polyfit(top, np.log(np.interp(top, time, energy)), 1)
    return float(-slope / (viscosity * WAVE_NUMBER**2))


@pytest.mark.parametrize(("method", "viscosity", "goal"), [("classic", 5e-4, 0.005), ("transport", 2e-3, 0.015)])
def test_sound_is_damped_by_viscosity(tmp_path: Path, method: str, viscosity: float, goal: float) -> None:
    # The transport velocity adds a damping of its own, see below: 1 % of this viscosity.
    assert abs(damping(tmp_path, viscosity, f"fluid.method={method}") - 1) < goal


def test_the_damping_by_the_transport_velocity_is_first_order_in_the_step(tmp_path: Path) -> None:
    whole, half = (damping(tmp_path / factor, 5e-4, f"run.step_factor={factor}") - 1 for factor in ("1.0", "0.5"))
    assert 0.0 < whole < 0.05
    assert whole / half == pytest.approx(2.0, rel=0.1)  # a tenth for terms of higher order
