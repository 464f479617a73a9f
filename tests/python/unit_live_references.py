"""Points of a case, references that are computed or looked up, values extrapolated. Oracles: manifests and results written here."""

import json
import math
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from verification.protocol.errors import CaseError
from verification.protocol.quantity import Measured, Quantity, Result, read_result, write_result
from verification.protocol.scene import in_si, with_overrides
from verification.report.figures import stored_figures
from verification.report.stored import store, stored_families
from verification.suite.case import Observable
from verification.suite.judge import CORRECT, OPEN, SKIPPED, WRONG, Outcome, _at_zero, judge, own
from verification.suite.ladder import extrapolated
from verification.suite.manifest import find_cases, read_cases
from verification.suite.references import LiveRun, live_command, resolved
from verification.suite.runner import Job, jobs_of

MANIFEST = """
name = "x"
[case]
purpose = "p"
tier = "quick"
cost = 10
[case.live]
code = "openfoam"
problem = "drag"
quick = ["--levels", "8"]
full = ["--levels", "8,16"]
[[case.point]]
name = "thin"
set = ["box.size=[4.0, 4.0]"]
[[case.point]]
name = "dense"
set = ["box.size=[2.0, 2.0]", "body.0.radius=0.5"]
tier = "full"
cost = 30
[[case.observable]]
name = "drag"
symbol = "F"
live = "drag"
goal = 0.02
[[case.level]]
set = ["fluid.spacing=0.2"]
[[case.level]]
set = []
[box]
size = [1.0, 1.0]
[fluid]
spacing = 0.1
[[body]]
radius = 0.25
"""


def written(folder: Path, old: str = "", new: str = "") -> Path:
    file = folder / "family" / "case.toml"
    file.parent.mkdir(exist_ok=True)
    assert old in MANIFEST
    file.write_text(MANIFEST.replace(old, new) if old else MANIFEST)
    return file


def test_each_point_is_a_case_with_its_own_scene_and_runs(tmp_path: Path) -> None:
    thin, dense = read_cases(written(tmp_path))
    assert (thin.name, thin.tier, thin.cost, thin.family) == ("family.thin", "quick", 10.0, "family")
    assert (dense.name, dense.tier, dense.cost) == ("family.dense", "full", 30.0)
    assert dense.scene["box"]["size"] == [2.0, 2.0] and dense.scene["body"][0]["radius"] == 0.5
    assert thin.scene["body"][0]["radius"] == 0.25
    base = ("box.size=[2.0, 2.0]", "body.0.radius=0.5")
    assert [job.overrides for job in jobs_of(dense, "quick")] == [(*base, "fluid.spacing=0.2"), base]
    assert Job(dense, (*base, "fluid.spacing=0.2")).weight == pytest.approx(1 / 8)


def test_a_point_that_stalls_has_no_band(tmp_path: Path) -> None:
    file = written(tmp_path, "goal = 0.02", "goal = 0.02\norder = [1.0, 2.0]")
    text = file.read_text().replace("[[case.level]]", "[[case.level]]\nset = []\n[[case.level]]", 1)
    file.write_text(text.replace('name = "dense"', 'name = "dense"\nstalls = "noise"'))
    thin, dense = read_cases(file)
    assert (thin.observables[0].order, thin.stalls) == ((1.0, 2.0), "")
    assert (dense.observables[0].order, dense.stalls) == (None, "noise")


def test_points_are_found_by_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    written(tmp_path)
    monkeypatch.setenv("MAPPM_CASES", str(tmp_path))
    assert [case.name for case in find_cases("family")] == ["family.thin", "family.dense"]
    assert [case.name for case in find_cases("family.dense")] == ["family.dense"]
    with pytest.raises(CaseError, match="family has no such point; known are family.thin, family.dense"):
        find_cases("family.thick")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('name = "dense"', 'name = "thin"', "two points have the same name"),
        ("body.0.radius=0.5", "body.3.radius=0.5", "point[1].set = ['box.size=[2.0, 2.0]', 'body.3.radius=0.5']: no such key"),
        ('live = "drag"', 'live = "drag"\npublished = "t"', "live and published given; give one of"),
        ('live = "drag"', "", "no reference given; give one of reference, live, published"),
        ('live = "drag"', 'live = "drag"\nsource = "s"', "source: comes with live; remove it"),
        ('code = "openfoam"', 'code = "fluent"', "code = 'fluent': unknown; known are"),
        ("goal = 0.02", "goal = 0.02\nextrapolated = 0.01", "extrapolated: needs three levels"),
        ("goal = 0.02", "goal = 0.02\nextrapolated = -0.01", "must not be negative"),
    ],
)
def test_a_bad_entry_is_refused_with_its_fix(tmp_path: Path, old: str, new: str, message: str) -> None:
    file = written(tmp_path, old, new)
    with pytest.raises(CaseError) as caught:
        read_cases(file)
    assert str(file) in str(caught.value) and message in str(caught.value)


def test_a_live_quantity_needs_a_code(tmp_path: Path) -> None:
    live = MANIFEST[MANIFEST.index("[case.live]") : MANIFEST.index("[[case.point]]")]
    with pytest.raises(CaseError, match=r"add \[case.live\]"):
        read_cases(written(tmp_path, live, ""))


def test_the_reference_code_gets_the_scene_of_the_finest_level_and_the_options_of_the_tier(tmp_path: Path) -> None:
    _, dense = read_cases(written(tmp_path))
    line = live_command(dense, "full", {}, tmp_path / "out")
    assert line[:4] == ["python3", "-m", "reference.openfoam", "drag"]
    assert line[4:] == ["--scene", str(dense.file.resolve()), "--out", str((tmp_path / "out").resolve()), "--set", "box.size=[2.0, 2.0]",
                        "--set", "body.0.radius=0.5", "--levels", "8,16"]


FOUND = Result("OpenFOAM", "1912", "command", quantities={"drag": Quantity(24.8, 0.1, note="Richardson")})


def test_a_result_survives_its_file(tmp_path: Path) -> None:
    write_result(FOUND, tmp_path)
    assert read_result(tmp_path) == FOUND


def judged(live: Result, tmp_path: Path, value: float = 24.9) -> Outcome:
    (thin, _) = read_cases(written(tmp_path))
    (observable,) = resolved(thin, live).observables
    return Outcome(observable, Measured(value, 0.0), {"resolution": 0.1})


def test_the_figure_of_the_reference_code_is_what_is_judged_against(tmp_path: Path) -> None:
    found = judged(FOUND, tmp_path)
    assert found.observable.reference == 24.8 and found.observable.uncertainty == 0.1
    assert found.observable.source == "OpenFOAM 1912, drag: Richardson"
    assert found.verdict == CORRECT  # 0.4 %; k u is 1.1 %
    assert judged(FOUND, tmp_path, 25.5).verdict == WRONG


def test_a_missing_code_is_skipped_and_neither_passes_nor_fails(tmp_path: Path) -> None:
    found = judged(Result("OpenFOAM", missing="simpleFoam is not installed: apt-get install openfoam"), tmp_path)
    assert found.verdict == SKIPPED and found.holds
    assert "SKIPPED: simpleFoam is not installed" in found.line


@pytest.mark.parametrize("live", [replace(FOUND, objection="drifts by 1 %"), replace(FOUND, quantities={}),
                                  Result("OpenFOAM", objection="it diverged")])
def test_a_reference_that_cannot_serve_fails(tmp_path: Path, live: Result) -> None:
    found = judged(live, tmp_path)
    assert found.verdict == OPEN and not found.holds and found.reason


H = [0.4, 0.2, 0.1]


def test_levels_of_a_power_law_are_extrapolated_by_richardson() -> None:
    found = extrapolated(H, [50 + 3 * h**2 for h in H])
    assert found.value == pytest.approx(50.0, rel=1e-9) and found.how == "Richardson, order 2.00"
    assert found.uncertainty == pytest.approx(0.25 * 0.03 / 2)  # a quarter of the correction 3 x 0.01, halved
    first = extrapolated(H, [50 + 3 * h for h in H])
    assert first.value == pytest.approx(50.0, rel=1e-9)
    assert first.uncertainty == pytest.approx(0.1)  # half of what second order would differ by: 50.3 - 0.1 = 50.2


def test_scattered_levels_are_fitted_with_the_scatter_as_uncertainty() -> None:
    found = extrapolated([0.4, 0.3, 0.2, 0.1], [50.6, 49.9, 50.3, 50.1])
    assert found.how.startswith("least squares") and found.value == pytest.approx(50.05, abs=0.2)
    assert 0.05 < found.uncertainty < 1.0


def test_the_extrapolated_value_has_its_own_goal() -> None:
    given = Observable("drag", "F", 50.0, 0.01, "nobody at all", goal=0.02, extrapolated=0.01)
    values = [50.3 + 3 * h**2 for h in H]
    levels = tuple(Measured(value, 0.0) for value in values)
    finest = Outcome(given, levels[-1], {"resolution": 0.02, "Mach": 0.2}, tuple(H), levels)
    found = _at_zero(finest)
    assert found.measured.value == pytest.approx(50.3) and found.observable.goal == 0.01
    assert set(found.sources) == {"Mach", "extrapolation (Richardson, order 2.00)"} and found.verdict == CORRECT
    tight = Outcome(replace(given, extrapolated=0.005), levels[-1], finest.sources, tuple(H), levels)
    assert _at_zero(tight).verdict == WRONG


def test_an_objection_on_a_level_that_is_used_bars_the_extrapolation() -> None:
    given = Observable("drag", "F", 50.0, 0.01, "nobody at all", goal=0.02, extrapolated=0.01)
    levels = (Measured(51.0, 0.0, "not settled"), Measured(50.2, 0.0), Measured(50.1, 0.0))
    assert _at_zero(Outcome(given, levels[-1], {}, tuple(H), levels)).verdict == OPEN
    coarser = (Measured(55.0, 0.0, "not settled"), *(Measured(50 + 3 * h**2, 0.0) for h in H))
    assert _at_zero(Outcome(given, coarser[-1], {"Mach": 0.1}, (0.8, *H), coarser)).verdict == CORRECT  # three levels count


LEVELS = """
[case]
purpose = "p"
tier = "quick"
cost = 1
[[case.observable]]
name = "found"
symbol = "F"
reference = 50.0
uncertainty = 0.1
source = "nobody at all"
goal = 0.02
extrapolated = 0.01
[[case.level]]
set = ["fluid.spacing=0.4"]
[[case.level]]
set = ["fluid.spacing=0.2"]
[[case.level]]
set = ["fluid.spacing=0.1"]
tier = "full"
"""


def test_a_tier_of_two_levels_is_not_extrapolated(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(LEVELS)
    (tmp_path / "measure.py").write_text("""from verification.protocol.quantity import Measured

def found(run):
    return Measured(50.0 + run.scene["fluid"]["spacing"], 0.0)
""")
    (case,) = read_cases(tmp_path / "case.toml")
    runs = {(f"fluid.spacing={h}",): SimpleNamespace(scene={"fluid": {"spacing": h}}) for h in (0.4, 0.2, 0.1)}
    assert [outcome.observable.symbol for outcome in judge(case, "quick", runs)] == ["F"]
    _, at_zero = judge(case, "full", runs)
    assert at_zero.measured.value == pytest.approx(50.0)  # first order, exactly


def test_quantities_and_overrides_of_a_scene_are_read_as_the_solver_does() -> None:
    assert in_si("2.5 mm") == pytest.approx(2.5e-3) and in_si(3) == 3.0
    scene = {"fluid": {"spacing": 0.1}, "body": [{"radius": 1.0}]}
    with_overrides(scene, ["fluid.disorder.seed=3", "body.0.radius=2.5", "fluid.method=classic", 'box.size=["1 mm", 2]'])
    assert scene["fluid"] == {"spacing": 0.1, "disorder": {"seed": 3}, "method": "classic"}
    assert scene["body"][0]["radius"] == 2.5 and scene["box"]["size"] == ["1 mm", 2]
    assert math.isclose(in_si("10 GPa"), 1e10)



def test_results_of_single_cases_are_kept_side_by_side(tmp_path: Path) -> None:
    (thin, dense) = read_cases(written(tmp_path))
    run = SimpleNamespace(record={"commit": "abc"})
    file = tmp_path / "full.json"
    for case, value in ((dense, 24.9), (thin, 30.0), (dense, 24.7)):
        known = resolved(case, FOUND)
        outcome = Outcome(known.observables[0], Measured(value, 0.0), {"resolution": 0.1})
        store(SimpleNamespace(case=known, tier="full", runs={(): run}, live=LiveRun(FOUND, tmp_path), outcomes=(outcome,)), file)
    kept = json.loads(file.read_text())
    assert list(kept) == ["family.dense", "family.thin"] and kept["family.thin"]["code"] == "OpenFOAM 1912"
    (row,) = kept["family.dense"]["rows"]
    assert row["measured"] == "24.7" and row["error"] == "-0.40 %" and row["verdict"] == CORRECT
    assert row["numbers"]["measured"] == 24.7 and row["numbers"]["u_num"] == 0.1
    assert kept["family.thin"]["rows"][0]["reason"] == "beyond the goal 2 %"


def test_stored_points_of_a_family_are_drawn_together(tmp_path: Path) -> None:
    # Drags of Zick and Homsy, J. Fluid Mech. 115, 1982, 13-26, two per cent too large; Stokes' law is 1 in this unit.
    def entry(drag: float) -> dict:
        numbers = {"measured": 1.02 * drag, "reference": drag, "u_ref": 0.0, "u_num": 0.01 * drag, "goal": 0.03}
        return {"tier": "full", "rows": [{"symbol": "F", "source": "Zick and Homsy", "numbers": numbers}]}

    entries = {f"sphere_stokes.phi_{phi}": entry(drag) for phi, drag in ((0.027, 2.008), (0.064, 2.810), (0.125, 4.292))}
    (results,) = stored_families(entries | {"a_case_that_is_gone": entry(1.0)})
    errors, alone = own(results[0].case, "stored_curves")(results)
    assert errors.curves[0].y == pytest.approx(np.full(3, 2.0)) and errors.curves[0].error == pytest.approx(np.full(3, 2.0))
    assert alone.curves[-1].y == pytest.approx(1.02, abs=0.01)
    assert [file.name for file in stored_figures(entries, tmp_path)] == ["sphere_stokes_stored0.svg", "sphere_stokes_stored1.svg"]


def test_nothing_is_lost_where_several_store_at_once(tmp_path: Path) -> None:
    known = resolved(read_cases(written(tmp_path))[0], FOUND)
    outcome = Outcome(known.observables[0], Measured(30.0, 0.0), {"resolution": 0.1})

    def keep(number: int) -> None:
        case = replace(known, name=str(number))
        run = SimpleNamespace(record={"commit": "abc"})
        result = SimpleNamespace(case=case, tier="full", runs={(): run}, live=LiveRun(FOUND, tmp_path), outcomes=(outcome,))
        store(result, tmp_path / "full.json")

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(keep, range(64)))
    assert len(json.loads((tmp_path / "full.json").read_text())) == 64


def test_a_scene_that_was_changed_is_not_kept() -> None:
    line = [sys.executable, "-m", "verification", "run", "rest", "--set", "run.steps=1", "--store"]
    done = subprocess.run(line, capture_output=True, text=True)
    assert done.returncode != 0 and "leave out --set or --store" in done.stderr
