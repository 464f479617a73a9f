"""What is made for LIGGGHTS and read from it; LIGGGHTS itself is not run here."""

from pathlib import Path

import pytest

from reference.liggghts import fall
from reference.liggghts.__main__ import main, parser, scene_of
from reference.liggghts.program import MISSING
from verification.protocol.quantity import read_result

SCENE = """
[box]
size = [1.0, 1.0]
[[body]]
shape = "disc"
radius = 0.5
density = 4.0
[run]
duration = 3.0
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    file = tmp_path / "case.toml"
    file.write_text(SCENE)
    return file


def test_a_program_not_on_path_is_missing_and_no_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    assert main(["fall", "--mass", "1", "--gamma", "1", "--force", "1", "--duration", "1", "--out", str(tmp_path)]) == 0
    result = read_result(tmp_path)
    assert result.missing == MISSING
    assert not result.quantities


def test_a_failure_of_the_program_is_told_in_its_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture
) -> None:
    program = tmp_path / "liggghts"
    program.write_text("#!/bin/sh\necho 'ERROR: Lost atoms (thermo.cpp:1)'\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin")
    assert main(["fall", "--mass", "1", "--gamma", "1", "--force", "1", "--duration", "1", "--out", str(tmp_path)]) == 1
    assert "Lost atoms" in capsys.readouterr().err


def test_a_fall_takes_mass_and_duration_of_the_scene(scene: Path) -> None:
    """A disc of radius 1/2 and density 4 has the mass pi."""
    options = parser().parse_args(["fall", "--scene", str(scene), "--gamma", "1", "--force", "2", "--out", "x"])
    made = fall.fall_of(options, scene_of(options))
    assert made == fall.Fall(pytest.approx(3.141592653589793), 2.0, 1.0, 0.0, 3.0)


def test_the_terminal_velocity_balances_force_and_drag() -> None:
    made = fall.Fall(mass=1, force=2, gamma=0.5, quadratic=0.25, duration=1)
    assert (0.5 + 0.25 * made.terminal) * made.terminal == pytest.approx(2)


def test_a_linear_drag_is_viscous_and_a_quadratic_one_a_variable() -> None:
    assert "fix drag all viscous 0.5\n" in fall.script_of(fall.Fall(1, 2, 0.5, 0.0, 1), 100_000)
    script = fall.script_of(fall.Fall(1, 2, 0.5, 0.25, 1), 100_000)
    assert '"-(0.5+0.25*sqrt(vx*vx+vy*vy+vz*vz))*vx"' in script and "viscous" not in script


@pytest.mark.parametrize(
    "arguments, named",
    [
        (["--gamma", "-1", "--force", "1", "--mass", "1", "--duration", "1"], "--gamma -1.0: must be positive"),
        (["--gamma", "1", "--force", "1", "--mass", "1", "--duration", "nan"], "--duration nan"),
        (["--gamma", "1", "--force", "1", "--quadratic", "-1", "--mass", "1", "--duration", "1"], "--quadratic -1.0"),
        (["--gamma", "1", "--force", "1"], "give --mass and --duration"),
        (["--gamma", "1", "--force", "1", "--scene", "no/case.toml"], "no/case.toml: No such file"),
    ],
)
def test_bad_input_is_one_line_that_names_it(
    tmp_path: Path, capsys: pytest.CaptureFixture, arguments: list[str], named: str
) -> None:
    assert main(["fall", *arguments, "--out", str(tmp_path)]) == 2
    message = capsys.readouterr().err
    assert named in message and message.count("\n") == 1
