"""Drag of a sphere in a periodic cubic cell. Oracle: the series of Sangani and Acrivos."""

from pathlib import Path

from support import assert_correct, judged


def test_stokes_drag(tmp_path: Path) -> None:
    _, outcomes = judged("sphere_array", tmp_path)
    assert_correct(outcomes["drag"], goal=0.04)
