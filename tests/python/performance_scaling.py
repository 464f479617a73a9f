"""The benchmarks of scaling and of the cost model as a whole, on small fluids: that they measure, not what."""

import math
from pathlib import Path

import pytest
from benchmarks import assert_drawn, benchmark, measured

from bench import cost_model, scaling
from bench.meter import Broken
from bench.scaling import Point
from verification.report.speed_charts import costs, scalings


def test_scaling_measures_and_64_processes_end_as_one(tmp_path: Path) -> None:
    figures, _ = measured("scaling", tmp_path, "--processes", "2")
    assert figures.value("runs_of_equal_digest", ranks=64) == 4
    messages = (2 * 10 + 2 * 2) / 10  # states and densities, in 10 steps and 2 samples
    assert figures.value("messages_per_step", scaling="strong", fluid="2d", ranks=2) == messages
    assert figures.value("efficiency", scaling="weak", fluid="2d", ranks=2) > 0
    assert "--processes 2" in figures.made.command
    assert_drawn(scalings, figures, tmp_path)


def test_one_process_is_too_few_to_scale() -> None:
    done = benchmark("scaling", "--processes", "1")
    assert done.returncode == 2 and "--processes: 1: must be a number of at least 2" in done.stderr


def test_the_cost_model_is_fitted_and_applied(tmp_path: Path) -> None:
    figures, _ = measured("cost_model", tmp_path)
    assert figures.value("nanoseconds_per_particle") > 0
    assert figures.value("efficiency", system="paper", ranks=1) == 1
    assert len(figures.where("microseconds_per_step", system="paper")) == len(cost_model.PAPER_PROCESSES)
    assert_drawn(costs, figures, tmp_path)


def test_digests_that_differ_are_broken() -> None:
    one, two = (Point("fluid", count, 100, {}, 0, 0, digest) for count, digest in ((1, "a"), (2, "b")))
    with pytest.raises(Broken, match="fluid on 1: a, fluid on 2: b"):
        scaling.require_one_digest([one, two])


def test_the_fit_finds_the_terms_it_was_given() -> None:
    points = [Point("", 2, 2 * own, {"pairs": 2e-7 * own + 3e-9 * sent, "exchange": 1.0, "steps": 2.0}, 1, sent, "")
              for own, sent in ((1e5, 1e4), (1e5, 1e6), (1e4, 1e6))]
    particle, ghost_byte = cost_model.fit_work(points)
    assert math.isclose(particle, 2e-7, rel_tol=1e-6)
    assert math.isclose(ghost_byte, 3e-9, rel_tol=1e-6)


def test_margins_and_neighbours_of_a_grid() -> None:
    assert cost_model.margin_of((10.0, 40.0), (1, 4)) == pytest.approx(22.0)  # two strips of 10 x 1.1
    assert cost_model.margin_of((10.0, 40.0), (2, 4)) == pytest.approx(7.2 * 12.2 - 5 * 10)
    assert [cost_model.neighbours_of(grid) for grid in ((1, 1), (1, 2), (1, 4), (2, 2), (4, 4))] == [0, 1, 2, 3, 8]


def test_efficiency_is_taken_within_a_round() -> None:
    """A machine that halves its speed for one round moves nothing."""

    def point(processes: int, seconds: float) -> Point:
        return Point("", processes, 100 * processes, {"steps": seconds}, 0, 0, "")

    found = {1: [point(1, 1.0), point(1, 2.0)], 2: [point(2, 1.25), point(2, 2.5)]}
    assert scaling.efficiency(found, 2).value == pytest.approx(0.8)
