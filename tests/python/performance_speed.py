"""The benchmark of speed as a whole, on small fluids: that it measures, not what. Slowness fails nothing here."""

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest

from bench import codes, meter, speed
from bench.codes import peers
from bench.meter import Broken, Meter, Speed
from verification.report.speed_charts import speeds

ROOT = Path(__file__).parents[2]


def test_it_prints_and_keeps_ratios_of_finished_runs(tmp_path: Path) -> None:
    kept = tmp_path / "speed.json"
    installed, missing = peers()
    done = subprocess.run([sys.executable, "-m", "bench.speed", "--quick", "--json", str(kept), "--out", str(tmp_path)],
                          cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == (speed.SKIPPED_CODE if missing else 0), done.stderr
    assert done.stderr.count("rows SKIPPED") == len(missing)
    table = json.loads(kept.read_text())
    lines = dict(line.rsplit(" ", 1) for line in done.stdout.splitlines())
    assert lines.keys() == table["figures"].keys()
    assert all(math.isfinite(value) and value > 0 for value in table["figures"].values())
    shares = [value for name, value in table["figures"].items() if name.startswith("ratio fluid_2d_39.share_")]
    assert math.isclose(sum(shares), 1, rel_tol=1e-9)
    names = {peer.name for peer in installed}
    for peer in ("liggghts", "lammps"):
        for ratio in (f"over_{peer}_1", f"flow_time_over_{peer}_2", f"without_transport_over_{peer}_2"):
            assert (f"ratio fluid_3d_77.{ratio}" in table["figures"]) == (peer in names)
    for code in ("", "without_transport_", *(f"{name}_" for name in names)):
        step = table["figures"][f"figure fluid_2d_39.{code}largest_step"]
        assert 0.05 <= step <= 3.2
        for ranks in (1, 2):
            rate = table["figures"][f"figure fluid_2d_39.{code}particle_steps_per_s_{ranks}"]
            flow_time = table["figures"][f"figure fluid_2d_39.{code}flow_time_per_core_s_{ranks}"]
            assert math.isclose(flow_time, step * rate / ranks, rel_tol=1e-12)
    speeds(table["figures"], tmp_path / "speed.svg")
    assert (tmp_path / "speed.svg").stat().st_size > 1000


def test_rounds_that_end_with_other_digests_are_broken() -> None:
    digests = iter("ab")
    with pytest.raises(Broken, match="fluid, one: rounds end with different digests"):
        Meter(2, lambda text: None).rounds("fluid", {"one": lambda: Speed(1.0, next(digests))})


def test_a_ratio_is_the_median_of_ratios_within_a_round() -> None:
    """A machine that halves its speed for one round moves neither figure of the others."""
    over, under = [Speed(4.0), Speed(1.0), Speed(6.0)], [Speed(2.0), Speed(0.5), Speed(2.0)]
    assert meter.median_ratio(over, under) == 2.0
    assert meter.median_rate(over) == 4.0


def test_a_run_that_fails_is_no_figure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    monkeypatch.setattr(codes, "overrides_of", lambda fluid, every=1: ("fluid.rcut=-1",))
    monkeypatch.setattr(sys, "argv", ["speed", "--quick", "--out", str(tmp_path)])
    assert speed.main() == 1
    captured = capsys.readouterr()
    assert "fluid.rcut" in captured.err
    assert "ratio" not in captured.out
