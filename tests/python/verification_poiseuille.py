"""Flow between plane walls. Oracle: the parabola g y (H - y) / (2 nu)."""

from pathlib import Path

from support import assert_correct, judged


def test_profile(tmp_path: Path) -> None:
    _, outcomes = judged("poiseuille", tmp_path)
    assert_correct(outcomes["poiseuille"], goal=0.01)
