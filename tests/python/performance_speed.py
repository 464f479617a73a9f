"""The benchmark of speed as a whole, on small fluids: that it measures, not what. Slowness fails nothing here."""

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest

from bench import speed
from bench.speed import Broken, Meter, Speed
from reference.liggghts.program import installed
from verification.speed_charts import speeds

ROOT = Path(__file__).parents[2]


def test_it_prints_and_keeps_ratios_of_finished_runs(tmp_path: Path) -> None:
    kept = tmp_path / "speed.json"
    done = subprocess.run([sys.executable, "-m", "bench.speed", "--quick", "--json", str(kept), "--out", str(tmp_path)],
                          cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == (0 if installed() else speed.SKIPPED_CODE), done.stderr
    table = json.loads(kept.read_text())
    lines = dict(line.rsplit(" ", 1) for line in done.stdout.splitlines())
    assert lines.keys() == table["figures"].keys()
    assert all(math.isfinite(value) and value > 0 for value in table["figures"].values())
    shares = [value for name, value in table["figures"].items() if name.startswith("ratio fluid_2d_39.share_")]
    assert math.isclose(sum(shares), 1, rel_tol=1e-9)
    for ratio in ("over_liggghts_1", "without_transport_over_liggghts_2"):
        assert (f"ratio fluid_3d_77.{ratio}" in table["figures"]) == installed()
    speeds(table["figures"], tmp_path / "speed.svg")
    assert (tmp_path / "speed.svg").stat().st_size > 1000


def test_rounds_that_end_with_other_digests_are_broken() -> None:
    digests = iter("ab")
    with pytest.raises(Broken, match="fluid, one: rounds end with different digests"):
        Meter(2, lambda text: None).rounds("fluid", {"one": lambda: Speed(1.0, next(digests))})


def test_a_ratio_is_the_median_of_ratios_within_a_round() -> None:
    """A machine that halves its speed for one round moves neither figure of the others."""
    over, under = [Speed(4.0), Speed(1.0), Speed(6.0)], [Speed(2.0), Speed(0.5), Speed(2.0)]
    assert speed.median_ratio(over, under) == 2.0
    assert speed.median_rate(over) == 4.0


def test_a_run_that_fails_is_no_figure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    monkeypatch.setattr(speed, "scene_of", lambda dimension, sides: ("fluid.rcut=-1",))
    monkeypatch.setattr(sys, "argv", ["speed", "--quick", "--out", str(tmp_path)])
    assert speed.main() == 1
    captured = capsys.readouterr()
    assert "fluid.rcut" in captured.err
    assert "ratio" not in captured.out
