"""What a run leaves and how it ends: files that others read, signals, damaged checkpoints, errors said once.

Oracle: the same scene run without interruption by the serial reference; VTK's own reader; the exit codes of the README.
"""

import json
import os
import shlex
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
import pyvista

from verification.codes.mappm import MPI_ENVIRONMENT, Options, program, run, start
from verification.protocol.machine import ROOT

SCENE = ROOT / "cases" / "crossing_2d" / "case.toml"
LONG_SCENE = ROOT / "cases" / "gas_solid_small" / "case.toml"
RANKS = (0, 1, 3)


def end_of(scene: Path, out: Path, options: Options) -> tuple[int, str, str]:
    process = start(scene, out, options)
    stdout, stderr = process.communicate(timeout=120)
    return process.returncode, stdout, stderr


def errors_in(stderr: str) -> list[str]:
    return [line for line in stderr.splitlines() if line.startswith("error:")]


def test_vtk_reads_the_same_points_from_both_programs(tmp_path: Path) -> None:
    found = []
    for ranks in RANKS:
        finished = run(SCENE, tmp_path / str(ranks), Options(ranks=ranks, steps=20))
        fluid = pyvista.read(finished.snapshots()[-1])
        solids = pyvista.read(finished.snapshots("solids")[-1])
        assert fluid.n_cells == fluid.n_points == finished.record["particles"]
        assert solids.n_points == 12
        assert np.all(fluid.celltypes == pyvista.CellType.VERTEX)
        assert fluid.field_data["TimeValue"][0] == pytest.approx(20 * finished.record["time_step"], rel=1e-15)
        order = np.lexsort((fluid["id"], fluid["solid"]))
        arrays = {name: fluid[name][order] for name in sorted(fluid.point_data.keys())} | {"points": fluid.points[order]}
        by_id = np.argsort(solids["id"])
        arrays |= {"solids " + name: solids[name][by_id] for name in sorted(solids.point_data.keys())}
        found.append(arrays)
    for other in found[1:]:
        assert other.keys() == found[0].keys()
        for name, values in other.items():
            assert np.array_equal(values, found[0][name]), name


def test_tables_have_the_same_bytes(tmp_path: Path) -> None:
    runs = [run(SCENE, tmp_path / str(ranks), Options(ranks=ranks, steps=100)) for ranks in RANKS]
    for name in ("series.csv", "solids.csv"):
        texts = {(finished.folder / name).read_bytes() for finished in runs}
        assert len(texts) == 1, name


@pytest.mark.parametrize("ranks", RANKS)
def test_a_signal_ends_a_run_that_can_be_resumed(tmp_path: Path, ranks: int) -> None:
    overrides = ("output.sample=10", "output.solids=true", "output.snapshot=0")
    process = start(LONG_SCENE, tmp_path, Options(ranks=ranks, overrides=overrides))
    series = tmp_path / "series.csv"
    for _ in range(600):
        if series.exists() and len(series.read_text().splitlines()) > 3:
            break
        time.sleep(0.1)
    process.send_signal(signal.SIGTERM)
    stdout, _ = process.communicate(timeout=60)
    if ranks < 2:  # mpirun itself ends with 1 where it is asked to end
        assert process.returncode == 0
    record = json.loads((tmp_path / "run.json").read_text())
    assert record["state"] == "stopped"
    assert record["message"] in stdout or ranks > 1  # mpirun of Open MPI 5 does not pass on what ranks say after SIGTERM
    hint = record["message"].partition("resume with: ")[2]
    words = shlex.split(hint)
    assert words[0] == ("mpirun" if ranks > 1 else "mappm" if ranks else "mappm-reference")
    assert Path(words[words.index("--resume") + 1]).exists()
    assert "output.sample=10" in words

    steps = record["steps"] + 15
    resumed = run(LONG_SCENE, tmp_path, Options(ranks=2, steps=steps, overrides=overrides, resume=tmp_path))
    through = run(LONG_SCENE, tmp_path / "through", Options(ranks=1, steps=steps, overrides=overrides))
    assert resumed.record["first_step"] == record["steps"]
    assert (tmp_path / "series.csv").read_bytes() == (through.folder / "series.csv").read_bytes()
    assert (tmp_path / "solids.csv").read_bytes() == (through.folder / "solids.csv").read_bytes()


@pytest.mark.parametrize("ranks", RANKS)
def test_a_damaged_checkpoint_is_refused_and_the_older_one_offered(tmp_path: Path, ranks: int) -> None:
    run(SCENE, tmp_path, Options(ranks=1, steps=20, overrides=("output.checkpoint=10",)))
    older, newer = sorted((tmp_path / "checkpoints").iterdir())
    content = newer.read_bytes()
    newer.write_bytes(content[: len(content) // 2])
    code, _, stderr = end_of(SCENE, tmp_path, Options(ranks=ranks, steps=30, resume=newer))
    (error,) = errors_in(stderr)
    assert code == 2
    assert newer.name in error and f"--resume {older}" in error

    newer.write_bytes(content)
    code, _, stderr = end_of(SCENE, tmp_path, Options(ranks=ranks, resume=newer, overrides=("fluid.viscosity=0.003",)))
    (error,) = errors_in(stderr)
    assert code == 2
    assert "viscosity = 0.003" in error and "belongs to another scene" in error


@pytest.mark.parametrize("ranks", RANKS)
def test_a_run_that_leaves_its_range_says_so_once(tmp_path: Path, ranks: int) -> None:
    # A force that gives every PP a quarter of the sound speed a step: 0.25 h / c long, with g = c^2 / h.
    scene = tmp_path / "runaway.toml"
    scene.write_text(
        "name = 'runaway'\nunits = 'dimensionless'\n[box]\nsize = [1.0, 2.0]\n"
        "[fluid]\ndensity = 1.0\nviscosity = 0.001\nspacing = 0.0416666667\nrcut = 0.125\nsound_speed = 1.0\n"
        "[force]\nfluid = [0.0, 16.0]\n[run]\nsteps = 100000\n[output]\nsample = 10\ncheckpoint = 10\n"
    )
    code, stdout, stderr = end_of(scene, tmp_path / "out", Options(ranks=ranks))
    (error,) = errors_in(stderr)
    assert code == 3
    assert "step" in error
    assert "digest" not in stdout
    record = json.loads((tmp_path / "out" / "run.json").read_text())
    assert record["state"] == "range error"
    assert "error: " + record["message"] == error
    assert not list((tmp_path / "out").glob("snapshots/*"))


# Four discs that move at once more than rcut / 4 in their first step. On several processes the first disc is not with
# the first process.
THROWN = """
name = "thrown"
units = "dimensionless"
box.size = [4.0, 4.0]
fluid = { density = 1.0, viscosity = 0.05, spacing = 0.0625, sound_speed = 10.0 }
run.steps = 100
[[body]]
shape = "disc"
radius = 0.25
density = 3.0
positions = [[0.5, 3.5], [3.5, 3.4], [0.5, 0.5], [3.5, 0.6]]
velocity = [0.0, 8.0]
"""


@pytest.mark.parametrize("ranks", [0, 1, 2, 3])
def test_the_first_fault_is_the_same_on_any_number_of_processes(tmp_path: Path, ranks: int) -> None:
    scene = tmp_path / "thrown.toml"
    scene.write_text(THROWN)
    code, _, stderr = end_of(scene, tmp_path / "out", Options(ranks=ranks))
    (error,) = errors_in(stderr)
    assert code == 3
    assert error.startswith("error: step 0: solid 0: a point of it moves more than rcut/4")


@pytest.mark.parametrize("ranks", RANKS)
def test_a_scene_may_come_through_a_pipe(tmp_path: Path, ranks: int) -> None:
    line = Options(ranks=ranks, steps=20).command(Path("/dev/stdin"), tmp_path / "piped")
    environment = os.environ | MPI_ENVIRONMENT
    piped = subprocess.run(line, env=environment, input=SCENE.read_text(), capture_output=True, text=True)
    assert piped.returncode == 0, piped.stderr
    through = run(SCENE, tmp_path / "file", Options(ranks=1, steps=20))
    assert through.record["digest"] in piped.stdout.splitlines()[-1]


@pytest.mark.parametrize("ranks", RANKS)
@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["run", "none.toml"], "none.toml"),
        (["run", str(SCENE), "--out", "/proc/none"], "/proc/none"),
        (["run", str(SCENE), "--resume", "/proc/none"], "/proc/none"),
        (["run", str(SCENE), "--bogus"], "--bogus"),
        (["run"], "scene"),
        (["run", str(SCENE), "--set", "fluid.colour=3"], "fluid.colour"),
    ],
)
def test_bad_input_is_said_once_with_exit_code_two(tmp_path: Path, ranks: int, words: list[str], message: str) -> None:
    line = [str(program("mappm" if ranks else "mappm-reference")), *words]
    if ranks > 1:
        line = ["mpirun", "-np", str(ranks), *line]
    ended = subprocess.run(line, cwd=tmp_path, env=os.environ | MPI_ENVIRONMENT, capture_output=True, text=True)
    assert ended.returncode == 2
    assert ended.stderr.count(message) >= 1
    assert len([text for text in ended.stderr.splitlines() if message in text]) == 1, ended.stderr
