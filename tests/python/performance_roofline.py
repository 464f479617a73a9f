"""The roofline as a whole, on small fluids: that it measures, not what. Slowness fails nothing here."""

import sys
from pathlib import Path

import pytest
from benchmarks import assert_drawn, measured

from bench import roofline
from bench.roofline import PARTS, Costs, apart
from verification.report.speed_charts import bounds
from verification.store.figures import Figures


@pytest.fixture(scope="module")
def figures(tmp_path_factory: pytest.TempPathFactory) -> Figures:
    return measured("roofline", tmp_path_factory.mktemp("roofline"))[0]


def test_it_enters_figures_that_a_chart_is_made_of(figures: Figures, tmp_path: Path) -> None:
    assert figures.settings("fluid") == list(roofline.FLUIDS)
    for fluid in roofline.FLUIDS:
        for share in ("candidates_inside", "blocks_within_cutoff", "lanes_used"):
            assert 0 < figures.value(share, fluid=fluid) <= 1
        assert figures.value("ns_per_pair", fluid=fluid, part="pass") > 0
    assert_drawn(bounds, figures, tmp_path)


def test_the_census_counts_what_the_law_writes(figures: Figures) -> None:
    """By hand, Wendland C2 with transport velocity in the plane. Multiplications: W 5; r 2, G 3, pressure, shift and
    friction 4, impulse 4, shift 4, agitation 3, shear 3. Additions: q cut 1 and W 2; q cut 1, r 2, v 2, volume terms 2,
    G 1, impulse 2, agitation 1, and 7 roundings, which keep their excess. Integers: 7 sums, added to both."""
    counted = {row.settings["kind"]: row.value for row in figures.where("registers_per_block", fluid="2d_39", part="pairs")}
    assert counted == {"multiplications": 28, "additions": 21, "roots": 2, "integers": 14, "loads": 17, "stores": 9}


def test_instructions_repeat_exactly() -> None:
    first = roofline.instructions(pytest.skip)
    assert first == roofline.instructions(pytest.skip)
    assert all(row.value > 0 for row in first)


def test_a_bound_is_the_work_of_blocks_over_a_limit() -> None:
    """3 pairs a particle in 6 blocks of two lanes: 2 blocks a pair."""
    counts = {"multiplications": (1, 3), "additions": (2, 5), "roots": (0, 0.25), "integers": (0, 1), "loads": (2, 0.75),
              "stores": (1, 0.5)}
    own = {"pairs_per_particle": 3, "blocks_per_particle": 6, "bytes_per_particle_memory": 60}
    blocks = {part: {name: count[k] for name, count in counts.items()} for k, part in enumerate(("distances", "pairs"))}
    machine = {"lanes": 2, "multiplications_per_s": 1e9, "additions_per_s": 2e9,
               "multiplications_and_additions_per_s": 3e9, "roots_per_s": 1e8, "integer_additions_per_s": 4e9,
               "l1_load_bytes_per_s": 8e9, "l1_store_bytes_per_s": 4e9, "memory_triad_bytes_per_s": 2e10}
    costs = Costs(machine, own, blocks)
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
