"""The benchmark of solids as a whole, on small suspensions: that it measures, not what. Slowness fails nothing here."""

import sys
from pathlib import Path

import pytest
from benchmarks import assert_drawn, measured

from bench import solids
from bench.meter import entered
from bench.solids import Cost
from verification.report.solid_charts import costs_of_solids
from verification.store.store import Made


def test_it_prints_and_enters_figures_of_every_suspension(tmp_path: Path) -> None:
    figures, _ = measured("solids", tmp_path / "lab", "--out", str(tmp_path / "runs"))
    assert all(row.value > 0 for row in figures.rows)
    assert all(row.value < 1 for row in figures.where("share"))
    assert figures.settings("suspension") == sorted(solids.SUSPENSIONS) == sorted(solids.QUICK_SUSPENSIONS)
    assert_drawn(costs_of_solids, figures, tmp_path)


def test_solids_in_contact_touch_from_the_first_step(tmp_path: Path) -> None:
    """Else the packings would measure no contact: those that move only meet those at rest."""
    for name in ("alone_2d", "alone_3d"):
        scene = solids.QUICK_SUSPENSIONS[name]
        digests = {solids.cost_of(scene, (*scene.solids, f"contact.restitution={loss}"), 20, 1, tmp_path).digest
                   for loss in (0.9, 0.5)}
        assert len(digests) == 2, name


def test_shares_are_of_all_phases() -> None:
    cost = Cost(1.0, "", {"solids": 1.0, "copies": 2.0, "frozen_pairs": 3.0, "pairs": 6.0}, 4, 0.5)
    assert cost.share("frozen_pairs") == 0.25
    scene = solids.SUSPENSIONS["dense_2d"]
    rows = solids.rows_of("dense_2d", scene, {f"{kind}_{ranks}": [cost] for kind in ("solids", "fluid") for ranks in (1, 2)})
    figures = entered("solids", rows, Made("", "", ""))
    assert figures.value("share", suspension="dense_2d", ranks=1, part="solids") == 0.25
    assert figures.value("us_per_solid_and_step", suspension="dense_2d", ranks=1) == pytest.approx(0.25 * 0.5 / 4 * 1e6)


def test_a_run_that_fails_is_no_figure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    broken = solids.in_shear_wave((32.0, 32.0), [solids.ball(2, -8.0, "position=[16.0, 16.0]")])
    monkeypatch.setattr(solids, "QUICK_SUSPENSIONS", {"13_2d": broken})
    monkeypatch.setattr(sys, "argv", ["solids", "--quick", "--out", str(tmp_path)])
    assert solids.main() == 1
    captured = capsys.readouterr()
    assert "body.0.radius" in captured.err
    assert not captured.out
