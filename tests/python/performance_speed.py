"""The benchmark of speed as a whole, on small fluids: that it measures, not what. Slowness fails nothing here."""

import math
import sys
from pathlib import Path

import pytest
from benchmarks import assert_drawn, measured

from bench import codes, meter, speed
from bench.codes import peers
from bench.meter import Broken, Meter, Speed
from verification.report.speed_charts import speeds
from verification.store.figures import Figures


def test_it_prints_and_enters_ratios_of_finished_runs(tmp_path: Path) -> None:
    installed, missing = peers()
    code = speed.SKIPPED_CODE if missing else 0
    figures, done = measured("speed", tmp_path / "lab", "--out", str(tmp_path / "runs"), code=code)
    assert done.stderr.count("rows SKIPPED") == len(missing)
    assert all(row.value > 0 for row in figures.rows)
    shares = figures.where("share", fluid="2d_39", code="mappm")
    assert math.isclose(sum(row.value for row in shares), 1, rel_tol=1e-9)
    names = sorted(peer.name for peer in installed)
    assert figures.settings("peer") == names
    assert figures.settings("code") == sorted([*names, "mappm", "without_transport"])
    for name in ("rate_over_peer", "flow_time_over_peer"):
        assert len(figures.where(name, fluid="3d_77", ranks=2)) == 2 * len(names)
    for code in figures.settings("code"):
        assert_flow_time_is_steps_times_their_length(figures, code)
    assert_drawn(speeds, figures, tmp_path)


def assert_flow_time_is_steps_times_their_length(figures: Figures, code: str) -> None:
    step = figures.value("largest_step", fluid="2d_39", code=code)
    assert 0.05 <= step <= 3.2
    for ranks in (1, 2):
        rate = figures.value("particle_steps_per_s", fluid="2d_39", code=code, ranks=ranks)
        flow_time = figures.value("flow_time_per_core_s", fluid="2d_39", code=code, ranks=ranks)
        assert math.isclose(flow_time, step * rate / ranks, rel_tol=1e-12)


def test_rounds_that_end_with_other_digests_are_broken() -> None:
    digests = iter("ab")
    with pytest.raises(Broken, match="fluid, one: rounds end with different digests"):
        Meter(2, lambda text: None).rounds("fluid", {"one": lambda: Speed(1.0, next(digests))})


def test_a_ratio_is_the_median_of_ratios_within_a_round() -> None:
    """A machine that halves its speed for one round moves neither figure of the others."""
    over, under = [Speed(4.0), Speed(1.0), Speed(6.0)], [Speed(2.0), Speed(0.5), Speed(2.0)]
    assert meter.ratio_of(over, under) == meter.Spread(2.0, 2.0, 3.0)
    assert meter.rate_of(over).value == 4.0


def test_a_run_that_fails_is_no_figure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    monkeypatch.setattr(codes, "overrides_of", lambda fluid, every=1: ("fluid.rcut=-1",))
    monkeypatch.setattr(sys, "argv", ["speed", "--quick", "--out", str(tmp_path)])
    assert speed.main() == 1
    captured = capsys.readouterr()
    assert "fluid.rcut" in captured.err
    assert not captured.out
