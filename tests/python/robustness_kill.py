"""A few kills of the campaign of tests/robustness/kill.py, which checks digest, tables and lost steps itself."""

from tests.robustness import kill


def test_killed_runs_resume_to_the_same_end() -> None:
    tally = kill.main(["--times", "6", "--ranks", "1,2,3", "--seed", "11"])
    assert tally.kills.total() >= 6
    assert tally.chains >= 1
    assert tally.most_lost <= kill.INTERVAL
