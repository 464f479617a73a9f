"""The roofline as a whole, on small fluids: that it measures, not what. Slowness fails nothing here."""

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest

from bench import roofline
from bench.roofline import PARTS, Costs, apart, figures_of
from verification.report.speed_charts import bounds

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> dict:
    kept = tmp_path_factory.mktemp("roofline") / "roofline.json"
    done = subprocess.run([sys.executable, "-m", "bench.roofline", "--quick", "--json", str(kept)],
                          cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    table = json.loads(kept.read_text())
    assert figures_of(done.stdout).keys() == table["figures"].keys()
    return table


def test_it_keeps_figures_that_a_chart_is_made_of(table: dict, tmp_path: Path) -> None:
    figures = table["figures"]
    assert all(math.isfinite(value) for value in figures.values())
    for fluid in roofline.FLUIDS:
        for share in ("candidates_inside", "blocks_within_cutoff", "lanes_used"):
            assert 0 < figures[f"ratio {fluid}.{share}"] <= 1
        assert figures[f"figure {fluid}.ns_per_pair_pass"] > 0
    bounds(figures, tmp_path / "roofline.svg")
    assert (tmp_path / "roofline.svg").stat().st_size > 1000


def test_the_census_counts_what_the_law_writes(table: dict) -> None:
    """By hand, Wendland C2 with transport velocity in the plane. Multiplications: W 5; r 2, G 3, pressure, shift and
    friction 4, impulse 4, shift 4, agitation 3, shear 3. Additions: q cut 1 and W 2; q cut 1, r 2, v 2, volume terms 2,
    G 1, impulse 2, agitation 1, and 7 roundings, which keep their excess. Integers: 7 sums, added to both."""
    work = "figure fluid_2d_39.block_pairs."
    counted = {name.removeprefix(work): value for name, value in table["figures"].items() if name.startswith(work)}
    assert counted == {"multiplications": 28, "additions": 21, "roots": 2, "integers": 14, "loads": 17, "stores": 9}


def test_instructions_repeat_exactly() -> None:
    first = roofline.instructions(pytest.skip)
    assert first == roofline.instructions(pytest.skip)
    assert all(value > 0 for value in first.values())


def test_a_bound_is_the_work_of_blocks_over_a_limit() -> None:
    """3 pairs a particle in 6 blocks of two lanes: 2 blocks a pair."""
    counts = {"multiplications": (1, 3), "additions": (2, 5), "roots": (0, 0.25), "integers": (0, 1), "loads": (2, 0.75),
              "stores": (1, 0.5)}
    own = {"pairs_per_particle": 3, "blocks_per_particle": 6, "bytes_per_particle_memory": 60}
    for name, (distances, pairs) in counts.items():
        own |= {f"block_distances.{name}": distances, f"block_pairs.{name}": pairs}
    machine = {"lanes": 2, "multiplications_per_s": 1e9, "additions_per_s": 2e9,
               "multiplications_and_additions_per_s": 3e9, "roots_per_s": 1e8, "integer_additions_per_s": 4e9,
               "l1_load_bytes_per_s": 8e9, "l1_store_bytes_per_s": 4e9, "memory_triad_bytes_per_s": 2e10}
    costs = Costs({f"figure machine.{name}": value for name, value in machine.items()}
                  | {f"figure fluid.{name}": value for name, value in own.items()}, "fluid")
    assert costs.bounds() == pytest.approx({"multiplications": 16, "additions": 14, "both": 44 / 3, "roots": 10,
                                            "integers": 1, "loads": 11, "stores": 12, "memory": 1})
    assert costs.full_lanes() == pytest.approx(3)
    assert costs.operations == 2 * (8 + 14 + 0.5)


def test_parts_add_up_to_the_pass() -> None:
    parts = apart(dict(zip(PARTS, (1.0, 2.0, 3.0, 5.0, 20.0), strict=True)))
    assert parts == {"sort": 1, "search": 2, "lay_out": 3, "distances": 5, "pairs": 12, "pass": 20}


def test_a_census_that_fails_is_no_figure(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    monkeypatch.setattr(roofline, "census", lambda build, sides, rounds: ["false"])
    monkeypatch.setattr(sys, "argv", ["roofline", "--quick"])
    assert roofline.main() == 1
    assert "ended with 1" in capsys.readouterr().err
