"""Drag of a free disc in a periodic cell. Oracle: the fixed disc, whose drag the case cylinder_array judges."""

from pathlib import Path

import pytest

from support import judged
from verification.observables import drag


STOKES = ("fluid.spacing=0.03125", "fluid.rcut=0.109375")  # R / dx = 8
FREE = ("body.0.motion=free", "body.0.density=10.0", "force.solid=balance")
# Reynolds number 20 on the diameter, solids fraction 0.131, R / dx = 8: U is 1 to a per cent, c 20 U.
INERTIA = (
    "body.0.radius=0.204203", "fluid.viscosity=0.02042", "fluid.spacing=0.025641026", "fluid.rcut=0.08974359",
    "fluid.sound_speed=20.0", "force.fluid=[0.7474,0.0]", "run.duration=16.0",
)


@pytest.mark.parametrize("flow", [STOKES, INERTIA], ids=["Stokes", "Re 20"])
def test_a_free_disc_meets_the_drag_of_a_fixed_one(tmp_path: Path, flow: tuple[str, ...]) -> None:
    fixed, _ = judged("cylinder_array", tmp_path / "fixed", *flow)
    free, _ = judged("cylinder_array", tmp_path / "free", *flow, *FREE)
    assert not drag(fixed).objection
    assert not drag(free).objection
    assert abs(drag(free).value / drag(fixed).value - 1) < 0.03
