"""A folder belongs to one run: it is refused to another unless that resumes it or is told to overwrite it.

Oracle: the files themselves, before and after.
"""

import os
import signal
import subprocess
import time
from pathlib import Path

import pytest

from verification.codes.mappm import MPI_ENVIRONMENT, Options, run
from verification.protocol.run import Run

SCENE = Path(__file__).parent / "scenes" / "random_discs.toml"
OUTPUTS = ("output.snapshot=10", "output.checkpoint=10")
FIRST = Options(steps=40, overrides=OUTPUTS)
SECOND = Options(steps=20, overrides=(*OUTPUTS, "fluid.viscosity=0.003"), overwrite=False)
ENDLESS = Options(steps=10_000_000, overrides=("output.checkpoint=20", "output.sample=10"), overwrite=False)


def call(options: Options, out: Path) -> subprocess.CompletedProcess:
    return subprocess.run(options.command(SCENE, out), env=os.environ | MPI_ENVIRONMENT, capture_output=True, text=True)


def refused(options: Options, out: Path) -> str:
    finished = call(options, out)
    assert finished.returncode == 2, finished.stderr
    (error,) = (line for line in finished.stderr.splitlines() if line.startswith("error: "))
    return error


def content(out: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}


@pytest.mark.parametrize("ranks", [0, 1, 2])
def test_a_second_run_is_refused_and_overwrites_where_it_is_told_to(tmp_path: Path, ranks: int) -> None:
    out = tmp_path / "out"
    run(SCENE, out, FIRST)
    (out / "notes").write_text("kept")
    before = content(out)
    second = Options(ranks=ranks, steps=SECOND.steps, overrides=SECOND.overrides, overwrite=False)
    message = refused(second, out)
    for part in ("--out", str(out), "--resume", "--overwrite"):
        assert part in message
    assert content(out) == before

    over = Options(ranks=ranks, steps=SECOND.steps, overrides=SECOND.overrides)
    alone = run(SCENE, tmp_path / "alone", over)
    run(SCENE, out, over)
    assert {path.relative_to(out) for path in content(out)} == {
        Path("notes"), *(path.relative_to(alone.folder) for path in content(alone.folder))
    }
    assert (out / "series.csv").read_bytes() == (alone.folder / "series.csv").read_bytes()


@pytest.mark.parametrize("ranks", [0, 1, 2])
def test_a_run_that_is_refused_replaces_nothing(tmp_path: Path, ranks: int) -> None:
    run(SCENE, tmp_path, FIRST)
    before = content(tmp_path)
    line = [*Options(ranks=ranks, steps=20).command(SCENE, tmp_path), "--trace", "99999999@1"]
    finished = subprocess.run(line, env=os.environ | MPI_ENVIRONMENT, capture_output=True, text=True)
    assert finished.returncode == 2
    assert "--trace = 99999999: no PP has this id" in finished.stderr
    assert content(tmp_path) == before


@pytest.mark.parametrize("ranks", [0, 1])
def test_a_folder_that_is_taken_away_is_named(tmp_path: Path, ranks: int) -> None:
    out = tmp_path / "out"
    options = Options(ranks=ranks, steps=ENDLESS.steps, overrides=ENDLESS.overrides)
    process = subprocess.Popen(options.command(SCENE, out), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    until = time.monotonic() + 60
    while not (out / "series.csv").exists():
        assert time.monotonic() < until
        time.sleep(0.1)
    out.rename(tmp_path / "elsewhere")
    _, stderr = process.communicate(timeout=60)
    assert process.returncode == 2, stderr
    assert str(out) in stderr


def test_the_folder_of_another_scene_is_not_resumed_in(tmp_path: Path) -> None:
    run(SCENE, tmp_path / "one", FIRST)
    run(SCENE, tmp_path / "other", SECOND)
    before = content(tmp_path / "other")
    message = refused(Options(steps=50, overrides=OUTPUTS, resume=tmp_path / "one"), tmp_path / "other")
    assert str(tmp_path / "other" / "run.json") in message
    assert "viscosity" in message
    assert content(tmp_path / "other") == before
    resumed = run(SCENE, tmp_path / "new", Options(steps=50, overrides=OUTPUTS, resume=tmp_path / "one"))
    assert resumed.record["first_step"] == 40


@pytest.mark.parametrize("ranks", [0, 1, 2])
def test_a_folder_is_locked_while_its_run_lasts(tmp_path: Path, ranks: int) -> None:
    process = subprocess.Popen(ENDLESS.command(SCENE, tmp_path), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        until = time.monotonic() + 60
        while not list(tmp_path.glob("checkpoints/*.h5")):
            assert time.monotonic() < until
            time.sleep(0.05)
        for options in (
            Options(ranks=ranks, steps=5, overwrite=False),
            Options(ranks=ranks, steps=5),
            Options(ranks=ranks, overrides=ENDLESS.overrides, resume=tmp_path),
        ):
            assert "another run is at work" in refused(options, tmp_path)
    finally:
        process.send_signal(signal.SIGKILL)
        process.wait()
    assert Run(tmp_path).record["state"] == "running"  # nobody could say otherwise
    table = (tmp_path / "series.csv").read_text().splitlines()
    steps = [int(row.partition(",")[0]) for row in table[1:]]
    assert steps == sorted(set(steps)), "rows of one run alone"
    goes_on = Options(ranks=ranks, steps=steps[-1] + 20, overrides=ENDLESS.overrides, resume=tmp_path)
    resumed = run(SCENE, tmp_path, goes_on)
    assert resumed.record["state"] == "finished"
    assert not (tmp_path / "run.lock").exists()
