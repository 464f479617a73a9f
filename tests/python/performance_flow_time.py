"""The benchmark of flow time as a whole, on small scenes, this build beside itself: that it measures, not what."""

import json
import math
import subprocess
import sys
from pathlib import Path

from bench.flow_time import NEW, OLD, QUICK_SCENES, FlowTime, figures_of
from verification.codes.mappm import build_folder

ROOT = Path(__file__).parents[2]


def flow_time(*arguments: str) -> subprocess.CompletedProcess:
    command = [sys.executable, "-m", "bench.flow_time", "--quick", *arguments]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True)


def test_it_prints_and_keeps_what_two_builds_cost(tmp_path: Path) -> None:
    kept = tmp_path / "flow_time.json"
    done = flow_time("--old", str(build_folder()), "--json", str(kept), "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr
    table = json.loads(kept.read_text())
    figures = table["figures"]
    assert {line.rsplit(" ", 1)[0] for line in done.stdout.splitlines()} == figures.keys()
    assert all(math.isfinite(value) and value > 0 for value in figures.values())
    assert f"--old {build_folder()}" in table["command"]
    for scene in QUICK_SCENES:
        name = f"figure flow_time.{scene}"
        assert figures[f"{name}.old_step"] == figures[f"{name}.new_step"]
        for ranks in (1, 2):
            cost = ranks / figures[f"{name}.new_step"] / figures[f"{name}.new_particle_steps_per_s_{ranks}"]
            assert math.isclose(figures[f"{name}.new_core_s_per_pp_{ranks}"], cost, rel_tol=1e-12)
            assert f"ratio flow_time.{scene}_{ranks}" in figures


def test_a_build_of_twice_the_step_and_the_same_speed_costs_half() -> None:
    """And a machine that halves its speed for one round does not show in the ratio."""
    found = {(build, ranks): [FlowTime(rate * ranks, step=step, cost=1 / (rate * step)) for rate in (4.0, 2.0, 4.0)]
             for build, step in ((OLD, 0.25), (NEW, 0.5)) for ranks in (1, 2)}
    figures = figures_of("2d", found)
    assert figures["ratio flow_time.2d_1"] == figures["ratio flow_time.2d_2"] == 2
    assert figures["ratio flow_time.2d.old_two_over_one"] == 2
    assert figures["figure flow_time.2d.new_core_s_per_pp_1"] == 0.5


def test_a_folder_without_a_build_is_told() -> None:
    done = flow_time("--old", "/no/build")
    assert done.returncode == 1 and "--old /no/build: there is no bin/mappm" in done.stderr
    assert flow_time().returncode == 2
