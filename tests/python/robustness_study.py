"""A study that is killed at random moments and resumed ends with the store of one that was left alone.

Oracle: the other store, row by row but for times.
"""

from pathlib import Path

from tests.robustness.study import STUDY, killed_and_resumed, left_alone, what_counts
from verification.store.laboratory import Laboratory


def test_killed_at_random_moments_and_resumed(tmp_path: Path) -> None:
    alone, resumed = tmp_path / "alone", tmp_path / "resumed"
    seconds = left_alone(alone, STUDY)
    kills = killed_and_resumed(resumed, STUDY, 1, seconds, print)
    assert kills >= 2
    expected = what_counts(Laboratory(alone).store)
    assert len([row for row in expected if row.startswith("runs")]) == 9
    assert what_counts(Laboratory(resumed).store) == expected
    assert not list((resumed / "runs").glob("*.part"))
