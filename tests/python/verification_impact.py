"""Normal impact of two spheres. Oracle: Hertz' closed form, evaluated in unit_references.py."""

from pathlib import Path

from support import assert_correct, judged


def test_force_and_duration(tmp_path: Path) -> None:
    _, outcomes = judged("two_spheres_impact", tmp_path)
    assert_correct(outcomes["contact_force"], goal=0.002)
    assert_correct(outcomes["contact_time"], goal=0.002)
