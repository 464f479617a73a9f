"""A run is resumed by the values of its scene, however they are written, and a refusal names the key that differs.

Oracle: the digest of a run that was not interrupted.
"""

from pathlib import Path

import pytest

from verification.codes.mappm import Options, run, start

SCENE = Path(__file__).parent / "scenes" / "bounce.toml"
INPUT = 2
CHECKPOINT = ("output.checkpoint=50", "run.steps=150")


def resumed(folder: Path, *overrides: str, steps: int | None = 200) -> tuple[int, str]:
    process = start(SCENE, folder, Options(steps=steps, resume=folder, overrides=overrides))
    _, stderr = process.communicate()
    return process.returncode, stderr


@pytest.fixture
def stopped(tmp_path: Path) -> Path:
    run(SCENE, tmp_path, Options(overrides=CHECKPOINT))
    return tmp_path


@pytest.mark.parametrize("same", ["body.1.density=1", "fluid.spacing=1e-1", "contact.friction=0.0", "body.1.motion=free",
                                  "run.relax=0", "output.sample=5"])
def test_the_same_values_are_the_same_scene(stopped: Path, same: str) -> None:
    code, stderr = resumed(stopped, same)
    assert code == 0, stderr
    through = run(SCENE, stopped / "through", Options(steps=200))
    again = run(SCENE, stopped / "again", Options(steps=200, resume=stopped, overrides=(same,)))
    assert again.record["digest"] == through.record["digest"]


@pytest.mark.parametrize(
    ("other", "said"),
    [
        ("run.relax=5", "run.relax = 5 here and 0 in the checkpoint"),
        ("run.step=0.001", "run.step = 0.001 here and 0.0001 in the checkpoint"),
        ("run.step_factor=0.5", "run.step_factor = 0.5 here and 1 in the checkpoint"),
        ("fluid.reference_velocity=3", "fluid.reference_velocity = 3 here and 0 in the checkpoint"),
        ("contact.friction=0.3", "contact.friction = 0.3 here and 0 in the checkpoint"),
        ("force.solid=[0.0,0.0,-1.0]", "force.solid = [0, 0, -1] here and not given in the checkpoint"),
        ("body.1.balls.1.radius=0.4", "body.1.balls.1.contact_radius = 0.4 here and 0.5 in the checkpoint"),
    ],
)
def test_the_key_that_differs_is_named_with_both_values(stopped: Path, other: str, said: str) -> None:
    code, stderr = resumed(stopped, other)
    assert code == INPUT
    assert said in stderr


def test_an_end_before_the_checkpoint_is_refused_and_one_at_it_is_said(stopped: Path) -> None:
    code, stderr = resumed(stopped, steps=100)
    assert code == INPUT
    for part in ("command line: --steps", "ends at step 100", "is of step 150", "let it end later"):
        assert part in stderr
    code, stderr = resumed(stopped, "run.steps=100", steps=None)
    assert code == INPUT
    assert "run.steps: the run ends at step 100" in stderr
    code, stderr = resumed(stopped, steps=150)
    assert code == 0
    assert "warning: --steps: " in stderr and "is of step 150, the last: no step is made" in stderr
