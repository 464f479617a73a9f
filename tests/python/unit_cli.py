"""The interfaces that scripts rely on: options, the last line, run.json, series.csv, snapshots, signals, the judge's
command line.

Oracle: the interface as README.md describes it, and pyvista as a reader of snapshots that knows nothing of this project.
"""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import pyvista

from verification.codes.mappm import INSTRUCTION_SETS, MPI_ENVIRONMENT, Options, best_instruction_set, program, run
from verification.protocol.machine import ROOT
from verification.protocol.run import Run

SCENE = ROOT / "cases" / "crossing_2d" / "case.toml"
# mpirun kills a second after SIGTERM, which is short on a loaded machine; the second name is that of Open MPI 5.
PATIENT = {f"{prefix}_MCA_odls_base_sigkill_timeout": "10" for prefix in ("OMPI", "PRTE")}
LAST_LINE = re.compile(r"digest [0-9a-f]{16} step 20 particles \d+ ranks (\d) particle-steps/s [0-9.e+]+")


def called(options: Options, out: Path, *more: str) -> subprocess.CompletedProcess:
    return subprocess.run(
        [*options.command(SCENE, out), *more], env=os.environ | MPI_ENVIRONMENT, capture_output=True, text=True,
        check=True,
    )


@pytest.mark.parametrize("ranks", [0, 1, 2])
def test_the_last_line_and_the_record(tmp_path: Path, ranks: int) -> None:
    overrides = ("output.sample=10", "fluid.viscosity=0.003")
    stdout = called(Options(ranks=ranks, steps=20, overrides=overrides), tmp_path).stdout
    last = LAST_LINE.fullmatch(stdout.splitlines()[-1])
    assert last, stdout
    assert int(last[1]) == max(ranks, 1)

    finished = Run(tmp_path)
    record = finished.record
    assert record["state"] == "finished"
    assert record["steps"] == 20
    assert record["ranks"] == max(ranks, 1)
    assert record["digest"] in stdout.splitlines()[-1]
    assert finished.scene["fluid"]["viscosity"] == 0.003  # the scene as it was run
    assert "rotation of solids" in record["terms"]
    for key in ("commit", "compiler", "flags", "instruction_set", "host", "date", "wall_seconds", "particles", "threads"):
        assert record[key], key
    sent = record["exchange"]
    if ranks == 2:  # two slabs of a periodic box: one neighbour; a message for the halo, one of densities and one home
        assert sent["neighbours"] == 1
        assert 3 <= sent["messages_per_step"] < 4  # in a step whose lists end unforeseen the halo is sent once more
        assert sent["bytes_per_step"] > 1000
    else:
        assert set(sent.values()) == {0}
    assert (record["orderings"] > 0) == (ranks > 0)
    momentum = record["momentum"]
    for start, end, impulse in zip(momentum["start"], momentum["end"], momentum["impulse"], strict=True):
        assert int(end) - int(start) == int(impulse)
        assert isinstance(end, str)

    series = finished.series
    assert list(series["step"]) == [0, 10, 20]
    for name in ("time", "fluid_velocity_x", "solid_velocity_y", "slip_y", "drag_y", "fluid_energy",
                 "lowest_density_ratio", "momentum_x", "impulse_x", "digest"):
        assert name in series
    assert series["digest"][-1] == record["digest"]


def test_lists_of_pairs_last_where_particles_move_little(tmp_path: Path) -> None:
    called(Options(steps=100, overrides=("run.step_factor=0.1", "output.sample=100")), tmp_path)
    assert Run(tmp_path).record["orderings"] < 50  # in the first steps, until it is known how far the PPs go, in each


def test_quiet_prints_the_last_line_only(tmp_path: Path) -> None:
    lines = called(Options(steps=20), tmp_path, "--quiet").stdout.splitlines()
    assert len(lines) == 1
    assert LAST_LINE.fullmatch(lines[0])


def test_help_and_version() -> None:
    for name in ("mappm", "mappm-reference"):
        for words, expected in ((["run", "--help"], "--set"), (["--version"], name)):
            finished = subprocess.run([program(name), *words], capture_output=True, text=True, check=True)
            assert expected in finished.stdout


def test_the_instruction_set_may_be_named(tmp_path: Path) -> None:
    best = best_instruction_set()
    assert best in INSTRUCTION_SETS
    assert run(SCENE, tmp_path, Options(steps=1, isa=best)).record["instruction_set"] == best


def test_a_snapshot_opens_in_pyvista(tmp_path: Path) -> None:
    finished = run(SCENE, tmp_path, Options(ranks=2, steps=20))
    fluid = pyvista.read(finished.snapshots()[-1])
    solids = pyvista.read(finished.snapshots("solids")[-1])
    assert fluid.n_points == finished.record["particles"]
    assert solids.n_points == finished.record["solids"]
    assert np.all((fluid.points >= 0) & (fluid.points <= [1.0, 3.0, 0.0]))
    pps = fluid["kind"] == 0
    assert len(np.unique(fluid["id"][pps])) == pps.sum()
    # The mean of the velocities in the picture is that of the series: two ways of the same numbers, equal to rounding.
    assert fluid["velocity"][pps].mean(axis=0)[1] == pytest.approx(fluid_velocity(finished, 20), rel=1e-6)
    assert np.allclose(solids["radius"], 0.11)


def fluid_velocity(finished: Run, step: int) -> float:
    series = run(SCENE, finished.folder / "sampled", Options(steps=step, overrides=("output.sample=10",))).series
    return float(series["fluid_velocity_y"][-1])


SIGNALS = [(0, signal.SIGTERM), (1, signal.SIGINT), (2, signal.SIGTERM), (1, signal.SIGHUP), (0, signal.SIGUSR1),
           (1, signal.SIGUSR2), (1, signal.SIGXCPU)]


@pytest.mark.parametrize(("ranks", "number"), SIGNALS)
def test_a_signal_leaves_a_checkpoint_to_go_on_from(tmp_path: Path, ranks: int, number: signal.Signals) -> None:
    endless = Options(ranks=ranks, steps=10_000_000, overrides=("output.sample=10",))
    process = subprocess.Popen(
        endless.command(SCENE, tmp_path), env=os.environ | MPI_ENVIRONMENT | PATIENT, stdout=subprocess.PIPE, text=True
    )
    until = time.monotonic() + 60
    while not (tmp_path / "series.csv").exists() or len((tmp_path / "series.csv").read_text().splitlines()) < 4:
        assert time.monotonic() < until
        time.sleep(0.1)
    process.send_signal(number)
    stdout, _ = process.communicate(timeout=60)
    record = json.loads((tmp_path / "run.json").read_text())
    assert record["state"] == "stopped", stdout
    (checkpoint,) = (tmp_path / "checkpoints").iterdir()
    assert str(checkpoint) in record["message"]
    assert str(checkpoint) in stdout or ranks > 1  # mpirun of Open MPI 5 does not pass on what ranks say after SIGTERM
    goal = record["steps"] + 20
    resumed = run(SCENE, tmp_path, Options(ranks=3, steps=goal, overrides=endless.overrides, resume=checkpoint))
    through = run(SCENE, tmp_path / "through", Options(steps=goal, overrides=endless.overrides))
    assert resumed.record["digest"] == through.record["digest"]


def verification(*words: str) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, "-m", "verification", *words], cwd=ROOT, capture_output=True, text=True)


def test_the_judge_lists_and_runs_cases(tmp_path: Path) -> None:
    listed = verification("list")
    assert listed.returncode == 0
    assert {line.split()[0] for line in listed.stdout.splitlines()} >= {"gas_solid_small", "rest", "sphere_stokes.phi_0.064"}
    judged = verification("run", "rest", "--lab", str(tmp_path), "--set", "run.steps=10")
    assert judged.returncode == 0, judged.stderr
    assert judged.stdout.splitlines() == [
        "max(|v|) / c = 0 +- 0 (reference 0 +- 0, error 0, VALIDATED: met exactly)",
        "mass and momentum: EXACT at 2 samples of 1 runs",
    ]
    assert verification("run", "nothing").returncode != 0


def test_compare_bits(tmp_path: Path) -> None:
    finished = verification("compare-bits", str(SCENE), "--ranks", "1,2", "--steps", "20", "--every", "10")
    assert finished.returncode == 0, finished.stderr
    assert finished.stdout.startswith("equal at all 3 samples up to step 20, digest ")
    assert finished.stdout.endswith(": serial reference; P=1; P=2\n")


def test_a_module_is_run_by_the_python_of_the_environment_whichever_was_called() -> None:
    """The one without the packages starts the other, with the same module and words."""
    for words in (["verification", "list"], ["verification.codes.exact", "describe"]):
        called, own = (subprocess.run([python, "-m", *words], cwd=ROOT, capture_output=True, text=True)
                       for python in (sys._base_executable, sys.executable))
        assert (called.returncode, called.stdout) == (0, own.stdout), called.stderr


def test_a_reader_that_has_seen_enough_ends_a_list_quietly() -> None:
    words = f"set -o pipefail; {sys.executable} -m verification list | head -1"
    finished = subprocess.run(["bash", "-c", words], cwd=ROOT, capture_output=True, text=True)
    assert finished.stderr == "" and len(finished.stdout.splitlines()) == 1
