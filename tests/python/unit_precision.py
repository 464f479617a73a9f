"""Error against cost: fronts, prices, slopes, and the line that makes a run again.

Oracles: made-up points whose front is seen by eye, and power laws, whose price and slope are known in closed form.
"""

import csv
import io
import math
from pathlib import Path

import pytest

from verification.codes.code import find_code
from verification.protocol.errors import SolverError
from verification.report.precision_chart import draw_precision
from verification.store.laboratory import Laboratory
from verification.studies.precision import Point, digit_of, front_of, points_of, price_of, slope_of
from verification.studies.study import command_of, find_study, read_study, results_of, run_study
from verification.suite import runner

STUDY = """
[study]
purpose = "to see"
chart = "precision"

[[study.block]]
name = "spacing"
codes = ["exact"]
factors = { N = [8, 16], "fluid.disorder" = [{ amplitude = 0.1, seed = 1 }, { amplitude = 0.1, seed = 2 }] }
"""


def point(error: float, seconds: float, *more: float, objection: str = "") -> Point:
    return Point("", (f"at {seconds}",), None, None, (error,), (seconds, *more), objection=objection)


@pytest.fixture
def study_file(shear_wave: Path) -> Path:
    file = shear_wave / "study_cost.toml"
    file.write_text(STUDY)
    return file


def test_a_front_has_what_nothing_undercuts() -> None:
    cheap, better, worse, best, doubtful = point(0.1, 1), point(-0.03, 2), point(0.05, 3), point(0.01, 9), point(1e-4, 1, objection="drifts")
    assert front_of([worse, best, doubtful, cheap, better]) == [cheap, better, best]


def test_points_of_one_cost_and_one_error_leave_one() -> None:
    assert len(front_of([point(0.1, 1), point(0.1, 1)])) == 1


def test_a_setting_without_a_value_is_on_no_front() -> None:
    assert front_of([Point("", (), None, None, why="blew up"), point(math.nan, 1)]) == []


def test_the_price_lies_on_the_power_law_between_two_points() -> None:
    front = [point(0.08 * cost**-0.5, cost) for cost in (1.0, 16.0, 256.0)]
    assert price_of(front, 0.01) == pytest.approx(64.0)
    assert price_of(front, 0.001) is None
    assert price_of(front, 0.5) == 1.0  # the cheapest is better than was asked


def test_the_slope_leaves_out_what_the_reference_cannot_tell() -> None:
    front = [point(cost**-0.75, cost) for cost in (1.0, 4.0, 16.0)] + [point(0.1, 1e4)]
    assert slope_of(front, floor=0.11) == pytest.approx(-0.75)
    assert slope_of(front[:2], floor=0.0) is None
    assert slope_of([point(0.1 / k, k) for k in (1.0, 2.0, 3.0)], floor=0.0) is None  # over less than a decade of cost


def test_errors_below_the_floor_are_alike() -> None:
    cheap, finer = point(0.004, 1), point(0.001, 9)
    assert front_of([cheap, finer], floor=0.005) == [cheap]
    assert price_of([cheap], 0.001, floor=0.005) is None


def test_a_digit_costs_by_the_slope() -> None:
    assert digit_of(-0.5) == pytest.approx(100.0)
    assert digit_of(-1e-5) == math.inf and digit_of(0.1) == math.inf and digit_of(None) is None


def test_starts_are_one_point_and_timings_one_cost(study_file: Path, tmp_path: Path) -> None:
    laboratory, study = Laboratory(tmp_path / "lab"), read_study(study_file)
    run_study(laboratory, study, 1, lambda text: None, repeats=2)
    points = points_of(laboratory.store, results_of(laboratory, study))
    assert [one.setting[0] for one in points] == ["N=8", "N=16"]
    assert all(len(one.errors) == 2 and len(one.seconds) == 4 for one in points)


def test_the_chart_has_a_row_a_point(study_file: Path, tmp_path: Path) -> None:
    laboratory, study = Laboratory(tmp_path / "lab"), read_study(study_file)
    run_study(laboratory, study, 1, lambda text: None)
    drawn = draw_precision(laboratory.store, study, results_of(laboratory, study), tmp_path / "charts" / "cost.svg")
    rows = list(csv.DictReader(io.StringIO((tmp_path / "charts" / "cost.csv").read_text())))
    assert [row["setting"].split()[0] for row in rows] == ["N=8", "N=16"] and "yes" in {row["on the front"] for row in rows}
    assert "<svg" in drawn.figure.file.read_text() and drawn.runs == drawn.asked == 4


def test_a_run_that_fails_stays_in_the_study(study_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    laboratory, said, whole = Laboratory(tmp_path / "lab"), [], runner.obtain

    def obtain(laboratory: Laboratory, job: runner.Job, anew: bool = False) -> runner.Entry:
        if "N=16" in job.overrides:
            raise SolverError("step 3: the fluid tears")
        return whole(laboratory, job, anew)

    monkeypatch.setattr(runner, "obtain", obtain)
    study = read_study(study_file)
    run_study(laboratory, study, 1, said.append)
    assert any("FAILED: step 3: the fluid tears" in line for line in said)
    cheap, failed = points_of(laboratory.store, results_of(laboratory, study))
    assert cheap.counts and failed.why == "step 3: the fluid tears" and not failed.counts
    said.clear()
    run_study(laboratory, study, 1, said.append)
    assert not said  # nothing is tried again as long as the sources are the same


def test_the_line_of_a_point_gives_its_scene() -> None:
    study = find_study("taylor_green.precision")
    setting = ("N=32", "rcut_over_dx=3")
    job = runner.Job(study.case, setting, find_code("mappm"))
    line = command_of(study, job)
    assert line.startswith("mappm run cases/taylor_green/case.toml --set ")
    assert "--set fluid.spacing=0.03125" in line and "--set fluid.rcut=0.09375" in line
