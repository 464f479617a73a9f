"""Contacts of composites, and contacts too soft to hold.

Oracles: the declared restitution, and the bounds of an overlap in solver/particles/overlap.hpp.
"""

from pathlib import Path

import pytest

from verification.codes.mappm import Options, run, start
from verification.protocol.series import read_table

SCENE = Path(__file__).parent / "scenes" / "bounce.toml"
RANGE = 3
ONE_BALL = "body.1.balls=[{centre=[0,0,0], radius=0.5}]"
SOFT = ("contact.stiffness=0.5", "run.step=0.0005", ONE_BALL)


def rebound(folder: Path, *overrides: str, ranks: int = 1) -> float:
    run(SCENE, folder, Options(ranks=ranks, overrides=overrides))
    return float(read_table(folder / "solids.csv")["velocity_z"][-1])


@pytest.mark.parametrize("ranks", [0, 1])
def test_a_body_that_lands_on_two_balls_rebounds_as_on_one(tmp_path: Path, ranks: int) -> None:
    assert rebound(tmp_path / "one", ONE_BALL, ranks=ranks) == pytest.approx(0.8, abs=1e-3)
    assert rebound(tmp_path / "two", ranks=ranks) == pytest.approx(0.8, abs=1e-3)


def test_hertz_and_three_balls_too(tmp_path: Path) -> None:
    hertz = ("contact={model='hertz', young=20000.0, poisson=0.3, restitution=0.7}",)
    three = "body.1.balls=[{centre=[0,0,0], radius=0.5}, {centre=[0.4,0,0], radius=0.5}, {centre=[0.2,0.4,0], radius=0.5}]"
    assert rebound(tmp_path / "two", *hertz) == pytest.approx(0.7, abs=2e-3)
    # The middle of three balls is not that of their mass: on the third of it the body turns a little.
    assert rebound(tmp_path / "three", *hertz, three, "body.1.rotates=false") == pytest.approx(0.7, abs=2e-3)


def lines_of(folder: Path, ranks: int, *overrides: str) -> tuple[int, list[str]]:
    process = start(SCENE, folder, Options(ranks=ranks, overrides=overrides))
    _, stderr = process.communicate()
    return process.returncode, [line for line in stderr.splitlines() if line.startswith(("warning: ", "error: "))]


def test_a_wall_that_is_too_soft_is_a_warning_and_then_ends_the_run_alike_on_any_ranks(tmp_path: Path) -> None:
    code, lines = lines_of(tmp_path / "0", 0, *SOFT)
    assert code == RANGE
    assert len(lines) == 2, lines
    warning, error = lines
    for part in ("warning: step ", "solid 0 and the wall at z = 0.5", "more than 0.1", "raise contact.stiffness"):
        assert part in warning
    for part in ("error: step ", "solid 0 and the wall at z = 0.5", "more than 0.5", "raise contact.stiffness"):
        assert part in error
    for ranks in (1, 2, 3):
        assert lines_of(tmp_path / str(ranks), ranks, *SOFT) == (code, lines)


def test_two_balls_that_would_pass_through_each_other_are_named(tmp_path: Path) -> None:
    pair = ("body=[{shape='sphere', radius=0.3, density=1.0, positions=[[1.0,2.0,2.0],[2.0,2.0,2.0]],"
            " first_velocity=[1.0,0.0,0.0]}]", "contact.stiffness=0.05", "run.steps=4000", "run.step=0.001")
    code, lines = lines_of(tmp_path / "0", 0, *pair)
    assert code == RANGE
    assert [("solids 0 and 1 overlap" in line) for line in lines] == [True, True]
    assert lines_of(tmp_path / "3", 3, *pair, ) == (code, lines)


def test_a_contact_that_holds_says_nothing(tmp_path: Path) -> None:
    assert lines_of(tmp_path, 1) == (0, [])
