"""The benchmark of flow time as a whole, on small scenes, this build beside itself: that it measures, not what."""

import math
from pathlib import Path

from benchmarks import benchmark, measured

from bench.flow_time import NEW, OLD, QUICK_SCENES, FlowTime, rows_of
from bench.meter import entered
from verification.codes.mappm import build_folder
from verification.store.store import Made


def test_it_prints_and_enters_what_two_builds_cost(tmp_path: Path) -> None:
    figures, _ = measured("flow_time", tmp_path / "lab", "--old", str(build_folder()), "--out", str(tmp_path / "runs"))
    assert all(row.value > 0 for row in figures.rows)
    assert f"--old {build_folder()}" in figures.made.command
    assert figures.settings("scene") == sorted(QUICK_SCENES)
    for scene in QUICK_SCENES:
        step = figures.value("step", scene=scene, build=NEW)
        assert figures.value("step", scene=scene, build=OLD) == step
        for ranks in (1, 2):
            cost = ranks / step / figures.value("particle_steps_per_s", scene=scene, build=NEW, ranks=ranks)
            assert math.isclose(figures.value("core_s_per_pp", scene=scene, build=NEW, ranks=ranks), cost, rel_tol=1e-12)
            assert figures.get("old_cost_over_new", scene=scene, ranks=ranks)


def test_a_build_of_twice_the_step_and_the_same_speed_costs_half() -> None:
    """And a machine that halves its speed for one round does not show in the ratio."""
    found = {(build, ranks): [FlowTime(rate * ranks, step=step, cost=1 / (rate * step)) for rate in (4.0, 2.0, 4.0)]
             for build, step in ((OLD, 0.25), (NEW, 0.5)) for ranks in (1, 2)}
    figures = entered("flow_time", rows_of("2d", found), Made("", "", ""))
    assert [row.value for row in figures.where("old_cost_over_new", scene="2d")] == [2, 2]
    assert figures.value("two_processes_over_one", scene="2d", build=OLD) == 2
    assert figures.value("core_s_per_pp", scene="2d", build=NEW, ranks=1) == 0.5


def test_a_folder_without_a_build_is_told() -> None:
    done = benchmark("flow_time", "--old", "/no/build")
    assert done.returncode == 1 and "--old /no/build: there is no bin/mappm" in done.stderr
    assert benchmark("flow_time").returncode == 2
