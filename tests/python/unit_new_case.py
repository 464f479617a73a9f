"""A case is one folder: it is listed, run, judged and given a ctest entry without touching any other file.

Oracle: a cheap scene written here, whose measure is known beforehand: a uniform flow keeps its velocity.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from verification.protocol.machine import ROOT

MANIFEST = """
name = "drifting"
units = "dimensionless"

[case]
purpose = "A fluid that drifts uniformly keeps its velocity."
tier = "quick"
cost = 1

[[case.observable]]
name = "mean_velocity"
symbol = "u / u_0"
reference = {reference}
uncertainty = 0.0
source = "no force acts on the fluid"
goal = 1e-9
since = 2026-11-22

[box]
size = [1.0, 1.0]

[fluid]
density = 1.0
viscosity = 0.01
spacing = 0.125
rcut = 0.375
sound_speed = 1.0
velocity = [0.05, 0.0]

[run]
steps = 20

[output]
sample = 10
"""

MEASURE = '''
"""Mean velocity at the end over that at the start."""

from verification.measures.curve import Chart, Curve
from verification.measures.measures import Measures, by_name
from verification.protocol.quantity import Measured


def mean_velocity(run):
    return Measured(run.series["fluid_velocity_x"][-1] / 0.05, 0.0)


def curves(run):
    return [Chart("velocity", "time", "u", (Curve("measured", run.series["time"], run.series["fluid_velocity_x"]),))]


MEASURES = Measures(observables=by_name(mean_velocity), charts=curves)
'''


@pytest.fixture
def cases(tmp_path: Path) -> Path:
    for name, reference in (("drifting", 1.0), ("faster", 1.5)):
        folder = tmp_path / "cases" / name
        folder.mkdir(parents=True)
        (folder / "case.toml").write_text(MANIFEST.format(reference=reference))
        (folder / "measure.py").write_text(MEASURE)
    return tmp_path / "cases"


def verification(cases: Path, *arguments: str) -> subprocess.CompletedProcess:
    command = [sys.executable, "-m", "verification", *arguments]
    return subprocess.run(command, cwd=ROOT, env=os.environ | {"MAPPM_CASES": str(cases)}, capture_output=True, text=True)


def test_a_new_case_is_listed(cases: Path) -> None:
    lines = verification(cases, "list").stdout.splitlines()
    assert [line.split()[0] for line in lines] == ["drifting", "faster"]


@pytest.mark.parametrize(("name", "code", "verdict"), [("drifting", 0, "WITHIN GOAL"), ("faster", 1, "FAILED")])
def test_a_new_case_is_run_and_judged_by_its_own_measure(
    cases: Path, tmp_path: Path, name: str, code: int, verdict: str
) -> None:
    ended = verification(cases, "run", name, "--lab", str(tmp_path / "runs"))
    assert ended.returncode == code, ended.stderr
    assert ended.stdout.startswith("u / u_0 = 1 ")
    assert verdict in ended.stdout


def test_a_new_case_appears_in_ctest(cases: Path, tmp_path: Path) -> None:
    build = tmp_path / "build"
    subprocess.run(["cmake", "--preset", "fast", "-B", str(build), "-D", f"MAPPM_CASES={cases}"], cwd=ROOT, check=True)
    listed = subprocess.run(["ctest", "-N", "-R", "verification.case"], cwd=build, check=True, capture_output=True, text=True)
    names = [line.split(": ")[1] for line in listed.stdout.splitlines() if ": verification.case" in line]
    assert names == ["verification.case.drifting", "verification.case.faster"]
