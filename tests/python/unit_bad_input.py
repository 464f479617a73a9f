"""Bad input ends with one message, once however many ranks there are, and with its exit code: 2 for what the user can
mend, 3 for a run that left the range of its numbers.

Oracle: the rule that a message names file, key, value and fix.
"""

import json
import os
import subprocess
from pathlib import Path

import pytest

from verification.codes.mappm import MPI_ENVIRONMENT, Options, best_instruction_set, program, run

SCENES = Path(__file__).parent / "scenes"
SCENE = SCENES / "random_discs.toml"
INPUT, RANGE = 2, 3


def call(options: Options, out: Path, scene: Path = SCENE, **keywords) -> subprocess.CompletedProcess:
    return subprocess.run(
        options.command(scene, out), env=os.environ | MPI_ENVIRONMENT, capture_output=True, text=True, **keywords
    )


def only_error(finished: subprocess.CompletedProcess, code: int) -> str:
    """The one line that starts with "error:"."""
    assert finished.returncode == code, finished.stderr
    lines = [line for line in finished.stderr.splitlines() if line.startswith("error: ")]
    assert len(lines) == 1, finished.stderr
    return lines[0]


def override(*settings: str) -> Options:
    return Options(overrides=settings)


@pytest.mark.parametrize(
    ("settings", "parts"),
    [
        (["fluid.colour=1"], ["fluid.colour", "unknown"]),
        (["fluid.viscosity=thick"], ["fluid.viscosity", "thick"]),
        (["fluid.density=-1.0"], ["fluid.density", "-1"]),
        (["fluid.spacing=0.0"], ["fluid.spacing", "0"]),
        (["body.0.radius=0.6", "body.0.random.count=1"], ["body.0", "box side 1"]),
        (["body.0.random.count=200"], ["body.0.random", "of 200 solids fit"]),
        (["run.step_factor=1.6"], ["run.step_factor", "1.6", "sound", "lower it"]),
        (["fluid.sound_speed=0.01"], ["fluid.sound_speed", "0.01"]),
        (["units=SI", "fluid.density=5 um"], ["fluid.density", "5 um"]),
        (["body.0.shape=sphere"], ["body.0.shape", "disc"]),
        ([" =3"], ["empty key"]),
        (["name=../elsewhere"], ["name", "without '/'"]),
        (["body.0.random.count=1000000000000000000"], ["body.0.random.count", "at most"]),
        (["body.0.angular_velocity=20.0"], ["fluid.sound_speed", "largest declared speed"]),  # of the rim
        (["body.0.radius=0.26", "body.0.random.count=2"], ["box.size", "two periodic images"]),
        (["fluid.vortices={amplitude=0.1}"], ["fluid.vortices", "box of equal sides", "1 and 2"]),
        (["fluid.abc={amplitude=0.1}"], ["fluid.abc", "two sides"]),
        (["fluid.disorder={amplitude=0.5, seed=1}"], ["fluid.disorder.amplitude", "0.5", "[0, 0.25]"]),
        (["fluid.disorder={amplitude=0.1, seed=-1}"], ["fluid.disorder.seed", "-1"]),
        (['force.wave={amplitude=0.1, direction="x", gradient="y"}'], ["force.solid", "balance", "uniform force only"]),
        (['force.wave={amplitude=0.1, direction="x"}'], ["force.wave.gradient", "missing"]),
    ],
)
@pytest.mark.parametrize("ranks", [0, 1])
def test_the_message_names_key_value_and_fix(tmp_path: Path, ranks: int, settings: list[str], parts: list[str]) -> None:
    message = only_error(call(Options(ranks=ranks, overrides=tuple(settings)), tmp_path), INPUT)
    for part in parts:
        assert part in message


@pytest.mark.parametrize(
    ("setting", "parts"),
    [
        ("body.2.extent.to=0.875", ["body.2.extent.to", "0.875", "open to the fluid"]),
        ("body.2.extent.to=1.25", ["body.2.position", "overlaps the wall body.0", "extent"]),
        ("body.2.extent.axis=x", ["body.2.extent.axis", "normal"]),
        ("body.2.extent.from=1.0", ["body.2.extent.from", "less than to"]),
        ("body.0.thickness=0.24", ["body.0", "whole multiples"]),
    ],
)
def test_walls_that_cannot_be(tmp_path: Path, setting: str, parts: list[str]) -> None:
    message = only_error(call(override(setting), tmp_path, SCENES / "cavity.toml"), INPUT)
    for part in parts:
        assert part in message


def test_a_step_near_the_last_stable_one_is_a_warning(tmp_path: Path) -> None:
    finished = call(Options(steps=1, overrides=("run.step_factor=1.2",)), tmp_path)
    assert finished.returncode == 0
    assert "warning: run.step_factor = 1.2" in finished.stderr


def test_a_missing_key_and_overlapping_solids_name_the_file(tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    text = SCENE.read_text()
    scene.write_text(text.replace("viscosity = 0.002\n", ""))
    message = only_error(call(Options(), tmp_path / "out", scene), INPUT)
    assert str(scene) in message
    assert "fluid.viscosity" in message
    scene.write_text(text.replace("random = { count = 8, seed = 11, gap = 0.01 }",
                                  "positions = [[0.5, 0.5], [0.6, 0.5]]"))
    message = only_error(call(Options(), tmp_path / "out", scene), INPUT)
    assert str(scene) in message
    assert "overlap" in message


def test_one_message_over_many_ranks(tmp_path: Path) -> None:
    assert "fluid.colour" in only_error(call(Options(ranks=3, overrides=("fluid.colour=1",)), tmp_path), INPUT)


@pytest.mark.parametrize(
    ("options", "parts"),
    [
        (Options(ranks=4, domains="3x1"), ["--domains", "3x1", "4"]),
        (Options(ranks=4, domains="two"), ["--domains", "two"]),
        (Options(ranks=12), ["--domains", "12", "h > 2R", "at most 7"]),  # slabs narrower than a solid allows
    ],
)
def test_a_grid_of_domains_that_cannot_be(tmp_path: Path, options: Options, parts: list[str]) -> None:
    message = only_error(call(options, tmp_path), INPUT)
    for part in parts:
        assert part in message


def test_an_instruction_set_that_the_program_lacks(tmp_path: Path) -> None:
    best = best_instruction_set()
    other = "avx2" if best == "plain" else "plain"
    message = only_error(call(Options(ranks=2, isa=other), tmp_path), INPUT)
    for part in ("--isa", other, best, "leave --isa out"):
        assert part in message


def test_paths_that_cannot_be_used(tmp_path: Path) -> None:
    assert "nowhere.toml" in only_error(call(Options(), tmp_path, tmp_path / "nowhere.toml"), INPUT)
    blocking = tmp_path / "file"
    blocking.write_text("")
    assert str(blocking) in only_error(call(Options(steps=1), blocking / "out"), INPUT)
    assert str(tmp_path) in only_error(call(Options(resume=tmp_path), tmp_path), INPUT)  # holds no checkpoint


def test_the_command_line_is_checked_too(tmp_path: Path) -> None:
    for words in ([], ["walk"], ["run"], ["run", str(SCENE), "--speed", "3"], ["run", str(SCENE), "--threads", "0"],
                  ["run", str(SCENE), "--steps", "-5"], ["run", str(SCENE), "--rebalance", "-1"],
                  ["run", str(SCENE), "--isa", "sse2"], ["run", str(SCENE), "--trace", "7"], ["run", str(SCENE), "--trace", "7@-1"],
                  ["run", str(SCENE), "--trace", "7@20", "--steps", "20"],
                  ["run", str(SCENE), "--resume", "x", "--overwrite"],
                  ["run", str(SCENE), "--steps", "0x10"], ["run", str(SCENE), "--steps", "99999999999999999999"],
                  ["run", str(SCENE), "--steps", ""], ["run", str(SCENE), "--rebalance", "18446744073709551616"],
                  ["run", str(SCENE), "--threads", "257"], ["run", str(SCENE), "--domains", "1x99999999999"],
                  ["run", str(SCENE), "--domains", ""], ["run", str(SCENE), "--out", ""],
                  ["run", str(SCENE), "--resume", ""],
                  ["run", str(SCENE), "--isa", ""], ["run", str(SCENE), "--set", ""], ["run", ""]):
        finished = subprocess.run([program("mappm"), *words], cwd=tmp_path, capture_output=True, text=True)
        assert finished.returncode == INPUT
        assert finished.stderr.strip()
        assert not list(tmp_path.iterdir()), words


def test_numbers_are_decimal(tmp_path: Path) -> None:
    line = [program("mappm"), "run", str(SCENE), "--steps", "010", "--threads", "02", "--out", str(tmp_path)]
    subprocess.run(line, check=True, capture_output=True)
    record = json.loads((tmp_path / "run.json").read_text())
    assert (record["steps"], record["threads"]) == (10, 2)



def with_checkpoint(folder: Path) -> Path:
    overrides = ("output.checkpoint=50",)
    run(SCENE, folder, Options(steps=50, overrides=overrides))
    (checkpoint,) = (folder / "checkpoints").iterdir()
    return checkpoint


def test_a_checkpoint_of_another_scene_is_refused(tmp_path: Path) -> None:
    checkpoint = with_checkpoint(tmp_path)
    message = only_error(call(Options(resume=checkpoint, overrides=("fluid.viscosity=0.003",)), tmp_path), INPUT)
    assert str(checkpoint) in message
    assert "viscosity" in message


def test_a_damaged_checkpoint_is_refused_and_the_older_one_offered(tmp_path: Path) -> None:
    overrides = ("output.checkpoint=50",)
    run(SCENE, tmp_path, Options(steps=100, overrides=overrides))
    older, newer = sorted((tmp_path / "checkpoints").iterdir())
    newer.write_bytes(newer.read_bytes()[:-1000])
    message = only_error(call(Options(resume=newer, overrides=overrides), tmp_path), INPUT)
    assert str(newer) in message
    assert str(older) in message
    newer.write_bytes(b"something else")
    assert str(older) in only_error(call(Options(resume=newer, overrides=overrides), tmp_path), INPUT)
    finished = call(Options(resume=tmp_path, steps=60, overrides=overrides), tmp_path)  # of a folder: the newest sound
    assert finished.returncode == 0, finished.stderr
    assert f"resumed from {older}" in finished.stderr


def test_a_full_disk_leaves_the_checkpoint_before_it(tmp_path: Path) -> None:
    # Of the reference: the limit would keep Open MPI from starting. The parallel solver writes by the same code.
    older = with_checkpoint(tmp_path)
    kept = older.read_bytes()
    overrides = ("output.checkpoint=50",)
    # No file may grow beyond half a checkpoint, as on a disk without space: that is seen before the first step.
    options = Options(ranks=0, steps=150, overrides=overrides, resume=older)
    finished = subprocess.run(
        ["prlimit", f"--fsize={len(kept) // 2}", *options.command(SCENE, tmp_path)],
        capture_output=True,
        text=True,
    )
    message = only_error(finished, INPUT)
    assert "000000150" in message and "File too large" in message
    assert [path.name for path in (tmp_path / "checkpoints").iterdir()] == [older.name]
    assert older.read_bytes() == kept
    resumed = run(SCENE, tmp_path, Options(steps=100, overrides=overrides, resume=older))
    through = run(SCENE, tmp_path / "through", Options(steps=100, overrides=overrides))
    assert resumed.record["digest"] == through.record["digest"]


@pytest.mark.parametrize("ranks", [0, 1, 2])
def test_a_run_that_leaves_its_range_says_so(tmp_path: Path, ranks: int) -> None:
    # A force that gains the fluid several times the sound speed in one step, without a limit on the step to stop it.
    options = Options(ranks=ranks, steps=200, overrides=("run.step=0.02", "force.fluid=[0.0,30.0]"))
    message = only_error(call(options, tmp_path), RANGE)
    assert "step" in message
    assert "particle" in message or "solid" in message
