"""Points of a case, references that are computed or looked up, values extrapolated. Oracles: manifests and results written here."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from support import ANY_CODE
from tiny_code import Tiny, tiny

from verification.measures.curve import NODES, Chart, Curve, chart_of, kept_chart
from verification.measures.measures import Point, measures_in
from verification.protocol.errors import CaseError
from verification.protocol.quantity import Level, Measured, Quantity, Result, read_result, write_result
from verification.protocol.scene import in_si, with_overrides
from verification.report.figures import family_figures
from verification.report.headline import changes_of_standards
from verification.store.laboratory import Laboratory
from verification.store.store import Found
from verification.suite import references, result
from verification.suite.case import Case, Observable
from verification.suite.judge import FAILED, INCONCLUSIVE, SKIPPED, VALIDATED, Outcome, _at_zero, judge
from verification.suite.ladder import extrapolated
from verification.suite.manifest import find_case, find_cases, read_cases
from verification.suite.references import Reference, obtain_reference, reference_request, resolved
from verification.suite.result import CaseResult, Exactness, Way, collect, run_case
from verification.suite.runner import Entry, Job, jobs_of

MANIFEST = """
name = "x"
[case]
purpose = "p"
tier = "quick"
cost = 10
[case.live]
code = "openfoam"
problem = "drag"
quick = ["levels=8"]
full = ["levels=8,16"]
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
since = 2026-11-22
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
    assert [job.overrides for job in jobs_of(dense, "quick", ANY_CODE)] == [(*base, "fluid.spacing=0.2"), base]
    assert Job(dense, (*base, "fluid.spacing=0.2"), ANY_CODE).weight == pytest.approx(30 / 8)


def test_a_point_may_be_without_band_from_a_day_on(tmp_path: Path) -> None:
    file = written(tmp_path, "goal = 0.02", "goal = 0.02\norder = [1.0, 2.0]")
    text = file.read_text().replace("[[case.level]]", "[[case.level]]\nset = []\n[[case.level]]", 1)
    file.write_text(text.replace('name = "dense"', 'name = "dense"\nunbanded = { since = 2026-11-24, why = "noise" }'))
    thin, dense = read_cases(file)
    assert (thin.observables[0].order, thin.remark) == ((1.0, 2.0), "")
    assert (dense.observables[0].order, dense.remark) == (None, "noise")
    (change,) = changes_of_standards([thin, dense])
    assert (change.case, change.kind, f"{change.day}", change.why) == ("family.dense", "looser", "2026-11-24", "noise")


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
        ('"levels=8"', '"--levels", "8"', "case.live.quick: '--levels': write KEY=VALUE"),
        ("goal = 0.02", "goal = 0.02\nextrapolated = 0.01", "extrapolated: needs three levels"),
        ("goal = 0.02", "goal = 0.02\nextrapolated = -0.01", "must be finite, and not be negative"),
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
    quick, full = (reference_request(dense, tier, {}, ANY_CODE) for tier in ("quick", "full"))
    assert (quick.options, full.options) == ({"problem": "drag", "levels": "8"}, {"problem": "drag", "levels": "8,16"})
    assert full.scene == dense.scene and full.scene["box"]["size"] == [2.0, 2.0] and full.scene["fluid"]["spacing"] == 0.1
    assert quick.key != full.key


def test_options_may_follow_from_what_was_measured(tmp_path: Path) -> None:
    file = written(tmp_path)
    (file.parent / "measure.py").write_text("""from verification.measures.measures import Measures

MEASURES = Measures(reference_options=lambda runs: {"mass": str(sum(one.values["mass"] / one.scene["n"] for one in runs))})
""")
    entries = {(str(n),): SimpleNamespace(scene={"n": n}, figures={"mass": 3.0 * n}) for n in (1, 2)}
    asked = reference_request(read_cases(file)[0], "quick", entries, ANY_CODE)
    assert asked.options == {"problem": "drag", "levels": "8", "mass": "6.0"}


FOUND = Result("OpenFOAM", "1912", "command", quantities={"drag": Quantity(24.8, 0.1, note="Richardson")})
LIVE = Reference("OpenFOAM", "1912", "command", quantities=FOUND.quantities)


def test_a_result_survives_its_file(tmp_path: Path) -> None:
    write_result(FOUND, tmp_path)
    assert read_result(tmp_path) == FOUND


def judged(live: Reference, tmp_path: Path, value: float = 24.9) -> Outcome:
    (thin, _) = read_cases(written(tmp_path))
    (observable,) = resolved(thin, live).observables
    return Outcome(observable, Measured(value, 0.0), {"resolution": 0.1})


def test_the_figure_of_the_reference_code_is_what_is_judged_against(tmp_path: Path) -> None:
    found = judged(LIVE, tmp_path)
    assert found.observable.reference == 24.8 and found.observable.uncertainty == 0.1
    assert found.observable.source == "OpenFOAM 1912, drag: Richardson"
    assert found.verdict == VALIDATED  # 0.4 %; k u is 1.1 %
    assert judged(LIVE, tmp_path, 25.5).verdict == FAILED


def test_a_missing_code_is_skipped_and_neither_passes_nor_fails(tmp_path: Path) -> None:
    found = judged(Reference("OpenFOAM", missing="simpleFoam is not installed: apt-get install openfoam"), tmp_path)
    assert found.verdict == SKIPPED and found.holds
    assert "SKIPPED: simpleFoam is not installed" in found.line


@pytest.mark.parametrize("live", [replace(LIVE, objection="drifts by 1 %"), replace(LIVE, quantities={}),
                                  Reference("OpenFOAM", objection="it diverged")])
def test_a_reference_that_cannot_serve_fails(tmp_path: Path, live: Reference) -> None:
    found = judged(live, tmp_path)
    assert found.verdict == INCONCLUSIVE and not found.holds and found.reason


H = [0.4, 0.2, 0.1]


def test_levels_of_a_power_law_are_extrapolated_by_richardson() -> None:
    found = extrapolated(H, [50 + 3 * h**2 for h in H])
    assert found.value == pytest.approx(50.0, rel=1e-9) and found.how == "three levels, order 2.00"
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
    finest = Outcome(given, levels[-1], {"resolution": 0.02, "Mach": 0.2}, spacings=tuple(H), levels=levels)
    found = _at_zero(finest, given)
    assert found.measured.value == pytest.approx(50.3) and found.observable.goal == 0.01
    assert set(found.sources) == {"Mach", "extrapolation (three levels, order 2.00)"} and found.verdict == VALIDATED
    tight = replace(given, extrapolated=0.005)
    failed = _at_zero(replace(finest, observable=tight), tight)
    assert failed.verdict == FAILED and not failed.passes


def test_an_explanation_of_the_extrapolated_value_excuses_it_alone() -> None:
    given = Observable("drag", "F", 50.0, 0.01, "nobody at all", goal=0.001, extrapolated=0.005, explained="the levels", explained_goal=0.05)
    levels = tuple(Measured(50.3 + 3 * h**2, 0.0) for h in H)
    for row, excused in (("value", False), ("extrapolated", True), ("all", True)):
        asked = replace(given, explains=row)
        found = _at_zero(Outcome(asked, levels[-1], {"Mach": 0.2}, spacings=tuple(H), levels=levels), asked)
        assert found.verdict == FAILED and found.passes is excused


def test_an_objection_on_a_level_that_is_used_bars_the_extrapolation() -> None:
    given = Observable("drag", "F", 50.0, 0.01, "nobody at all", goal=0.02, extrapolated=0.01)
    levels = (Measured(51.0, 0.0, "not settled"), Measured(50.2, 0.0), Measured(50.1, 0.0))
    assert _at_zero(Outcome(given, levels[-1], spacings=tuple(H), levels=levels), given).verdict == INCONCLUSIVE
    settled = tuple(Measured(50 + 3 * h**2, 0.0) for h in H)
    assert _at_zero(Outcome(given, settled[-1], {"Mach": 0.1}, spacings=tuple(H), levels=settled), given).verdict == VALIDATED


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
since = 2026-11-22
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
    (case,) = read_cases(tmp_path / "case.toml")
    entries = {(f"fluid.spacing={h}",): SimpleNamespace(scene={"fluid": {"spacing": h}}, found=Found({"found": Measured(50.0 + h, 0.0)}))
               for h in (0.4, 0.2, 0.1)}
    assert [outcome.observable.symbol for outcome in judge(case, "quick", entries)] == ["F"]
    _, at_zero = judge(case, "full", entries)
    assert at_zero.measured.value == pytest.approx(50.0)  # first order, exactly


def test_quantities_and_overrides_of_a_scene_are_read_as_the_solver_does() -> None:
    assert in_si("2.5 mm") == pytest.approx(2.5e-3) and in_si(3) == 3.0
    scene = {"fluid": {"spacing": 0.1}, "body": [{"radius": 1.0}]}
    with_overrides(scene, ["fluid.disorder.seed=3", "body.0.radius=2.5", "fluid.method=classic", 'box.size=["1 mm", 2]'])
    assert scene["fluid"] == {"spacing": 0.1, "disorder": {"seed": 3}, "method": "classic"}
    assert scene["body"][0]["radius"] == 2.5 and scene["box"]["size"] == ["1 mm", 2]
    assert math.isclose(in_si("10 GPa"), 1e10)


# --- a reference code that is run: tiny, which states the drag 24.8 of any problem


@pytest.fixture
def other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Tiny:
    """In place of OpenFOAM."""
    found = tiny(tmp_path / "other")
    for module in (references, result):
        monkeypatch.setattr(module, "find_code", lambda name: found.code)
    return found


@pytest.fixture
def laboratory(tmp_path: Path) -> Laboratory:
    return Laboratory(tmp_path / "runs")


def family(folder: Path, *changes: tuple[str, str]) -> tuple[Case, ...]:
    """Scenes without bodies, which tiny runs as they stand."""
    file = written(folder, "[[body]]\nradius = 0.25\n", "")
    text = file.read_text().replace(', "body.0.radius=0.5"', "")
    text = text.replace("spacing = 0.1", "spacing = 0.1\ndensity = 1.0\nviscosity = 1.0\nvelocity = [24.9, 0.0]")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    file.write_text(text)
    (file.parent / "measure.py").write_text("""from verification.measures.measures import Measures
from verification.protocol.quantity import Measured

MEASURES = Measures(observables={"drag": lambda run: Measured(float(run.series["fluid_velocity_x"][-1]), 0.0)})
""")
    return tuple(read_cases(file))


def test_a_reference_is_run_once_and_survives_the_store(tmp_path: Path, laboratory: Laboratory, other: Tiny) -> None:
    thin, dense = family(tmp_path)
    first, again = (obtain_reference(laboratory, thin, "full", {}) for _ in range(2))
    levels = (Level("N 8", 0.125, 24.8, 1.5), Level("N 16", 0.0625, 24.8, 1.5))
    assert first.quantities == {"drag": Quantity(24.8, 0.1, levels, 2.0, "Richardson", "N/m")}
    assert first == again and (first.code, first.version, first.inputs, other.calls) == ("tiny", "1", "12ab", 1)
    assert "run --scene" in first.command
    obtain_reference(laboratory, thin, "quick", {})
    obtain_reference(laboratory, dense, "full", {})
    assert other.calls == 3  # other options, and another scene


def test_a_reference_that_fails_is_an_objection_and_is_not_kept(tmp_path: Path, laboratory: Laboratory, other: Tiny) -> None:
    (thin, _) = family(tmp_path, ('"levels=8"', '"levels="'))
    found = obtain_reference(laboratory, thin, "quick", {})
    assert found.objection == "the reference code failed: tiny: no levels are given" and not found.quantities
    assert laboratory.store.runs() == []
    outcome = Outcome(resolved(thin, found).observables[0], Measured(24.9, 0.0), {"resolution": 0.1})
    assert outcome.verdict == INCONCLUSIVE and "no levels are given" in outcome.line


def test_results_of_single_points_are_kept_side_by_side(tmp_path: Path, laboratory: Laboratory, other: Tiny) -> None:
    code = tiny(tmp_path / "subject", ("fluid", "exact-ledger", "digest"), 2).code
    thin, dense = family(tmp_path, ('"box.size=[2.0, 2.0]"', '"box.size=[2.0, 2.0]", "fluid.velocity=[30.0, 0.0]"'))
    wanted = {case.name: run_case(laboratory, case, tier, code, Way(), print) for case, tier in
              ((dense, "full"), (thin, "quick"), (thin, "full"), (dense, "full"))}
    for case in (thin, dense):
        kept = collect(laboratory, case, "full", code)
        assert kept == wanted[case.name] and kept.live.code == "tiny"
    right, wrong = (wanted[name].outcomes[0] for name in ("family.thin", "family.dense"))
    assert (right.measured.value, right.error_text, right.observable.source) == (24.9, "+0.40 %", "tiny 1, drag: Richardson")
    assert wrong.reason == "beyond the goal 2 %" and right.u_ref == pytest.approx(0.1 / 24.8)
    assert collect(laboratory, dense, "quick", code) is None


def test_without_what_the_reference_said_there_is_no_result(tmp_path: Path, laboratory: Laboratory, other: Tiny) -> None:
    code = tiny(tmp_path / "subject", ("fluid", "exact-ledger", "digest"), 2).code
    (thin, _) = family(tmp_path)
    key = run_case(laboratory, thin, "quick", code, Way(), print).live.key
    laboratory.store.remove([key])
    assert collect(laboratory, thin, "quick", code) is None

# --- families


def spheres() -> list[CaseResult]:
    """Drags of Zick and Homsy, J. Fluid Mech. 115, 1982, 13-26, two per cent too large; Stokes' law is 1 in this unit."""
    found = []
    for phi, drag in ((0.027, 2.008), (0.064, 2.810), (0.125, 4.292)):
        case = replace(find_case(f"sphere_stokes.phi_{phi}"), live=None, levels=())
        observable = Observable("drag", "F", drag, 0.0, "Zick and Homsy", goal=0.03)
        outcome = Outcome(observable, Measured(1.02 * drag, 0.0), {"resolution": 0.01 * drag})
        stored = SimpleNamespace(scene=case.scene)
        entry = Entry(stored, Found({"drag": outcome.measured, "figure mass": Measured(2.0, 0.0)}))
        found.append(CaseResult(case, ANY_CODE, "quick", {case.base: entry}, (outcome,), (), Exactness(0, 0, ())))
    return found


def test_the_points_of_a_family_are_drawn_together(tmp_path: Path) -> None:
    results = spheres()
    drawn = measures_in(results[0].case.file.parent).charts_of_family([one.point for one in results])
    errors, alone = (chart_of(kept_chart(chart)) for chart in drawn)
    assert errors.curves[0].y == pytest.approx(np.full(3, 2.0)) and errors.curves[0].error == pytest.approx(np.full(3, 2.0))
    assert alone.curves[-1].y == pytest.approx(1.02, abs=0.01)
    assert [one.file.name for one in family_figures(results, tmp_path)] == ["sphere_stokes_family0.svg", "sphere_stokes_family1.svg"]
    assert all((tmp_path / f"sphere_stokes_family{i}.svg").exists() for i in range(2))
    assert family_figures(results[:1], tmp_path) == ()


def test_a_point_holds_what_charts_of_families_need() -> None:
    point = replace(spheres()[0], live=LIVE).point
    expected = Point("sphere_stokes", "phi_0.027", point.scene, {"drag": 1.02 * 2.008, "mass": 2.0}, {"drag": 24.8}, 1.02 * 2.008,
                     point.error, 2 * 0.01 * 2.008, 2.008)
    assert point.half_width == pytest.approx(expected.half_width) and point.error == pytest.approx(0.02)
    assert replace(point, half_width=0.0) == replace(expected, half_width=0.0)


def test_charts_keep_what_a_picture_shows() -> None:
    """Thinned, ends included, and with gaps where there is no number."""
    x = np.linspace(0.0, 1.0, 5001)
    y = np.where(x == 0.0, np.nan, x**2)
    kept = kept_chart(Chart("t", "x", "y", (Curve("c", x, y, error=np.full(5001, 0.1), reference=True),), log=True))
    chart = chart_of(kept)
    (curve,) = chart.curves
    assert len(curve.x) == NODES and (curve.x[0], curve.x[-1]) == (0.0, 1.0) and kept["curves"][0]["y"][0] is None
    assert np.isnan(curve.y[0]) and curve.y[1:] == pytest.approx(curve.x[1:] ** 2, rel=1e-4, abs=1e-6)
    assert (chart.title, chart.log, curve.reference, curve.points, curve.error[3]) == ("t", True, True, False, 0.1)
