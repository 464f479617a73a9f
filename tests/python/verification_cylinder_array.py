"""Drag of a disc in a periodic cell. Oracles: the table of Sangani and Acrivos; for a free disc, the fixed one."""

from pathlib import Path

from support import assert_correct, judged
from verification.observables import drag


def test_stokes_drag(tmp_path: Path) -> None:
    _, outcomes = judged("cylinder_array", tmp_path)
    assert_correct(outcomes["drag"], goal=0.03)


FREE = ("body.0.motion=free", "body.0.density=10.0", "force.solid=balance")


def test_a_free_disc_meets_the_drag_of_a_fixed_one(tmp_path: Path) -> None:
    fixed, _ = judged("cylinder_array", tmp_path / "fixed")
    free, _ = judged("cylinder_array", tmp_path / "free", *FREE)
    assert not drag(fixed).objection
    assert not drag(free).objection
    assert abs(drag(free).value / drag(fixed).value - 1) < 0.03
