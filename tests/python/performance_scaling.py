"""The benchmarks of scaling and of the cost model as a whole, on small fluids: that they measure, not what."""

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest

from bench import cost_model, scaling
from bench.meter import Broken
from bench.scaling import Point
from verification.report.speed_charts import costs, scalings

ROOT = Path(__file__).parents[2]


def measured(module: str, *options: str, kept: Path) -> dict[str, float]:
    done = subprocess.run([sys.executable, "-m", module, "--quick", "--json", str(kept), *options], cwd=ROOT, capture_output=True,
                          text=True)
    assert done.returncode == 0, done.stderr
    figures = json.loads(kept.read_text())["figures"]
    assert [line.rsplit(" ", 1)[0] for line in done.stdout.splitlines()] == list(figures)
    assert all(math.isfinite(value) for value in figures.values())
    return figures


def test_scaling_measures_and_64_processes_end_as_one(tmp_path: Path) -> None:
    figures = measured("bench.scaling", "--processes", "2", kept=tmp_path / "scaling.json")
    assert figures["figure many.processes"] == 64
    assert figures["figure many.runs_of_equal_digest"] == 4
    assert figures["figure strong_2d.2.messages_per_step"] == (2 * 10 + 2 * 2) / 10  # states and densities, in 10 steps and 2 samples
    assert figures["ratio weak_2d.2.efficiency"] > 0
    scalings(figures, tmp_path / "scaling.svg")
    assert (tmp_path / "scaling.svg").stat().st_size > 1000


def test_the_cost_model_is_fitted_and_applied(tmp_path: Path) -> None:
    figures = measured("bench.cost_model", kept=tmp_path / "cost_model.json")
    assert figures["figure nanoseconds_per_particle"] > 0
    assert figures["ratio paper.1.efficiency"] == 1
    times = [value for name, value in figures.items() if name.startswith("figure paper.") and name.endswith("per_step")]
    assert len(times) == len(cost_model.PAPER_PROCESSES)
    costs(figures, tmp_path / "costs.svg")
    assert (tmp_path / "costs.svg").stat().st_size > 1000


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
    assert scaling.efficiency(found, 2) == pytest.approx(0.8)
