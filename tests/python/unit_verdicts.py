"""The verdict logic. Oracles: series whose limit and order are known, and arithmetic done by hand."""

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from support import ANY_CODE

from verification.protocol.errors import CaseError
from verification.protocol.ledger import defects_of
from verification.protocol.quantity import Measured
from verification.protocol.series import Table
from verification.report.history import changes
from verification.store.store import Ledger
from verification.suite.case import Observable, Vary
from verification.suite.judge import CONVERGING, CORRECT, NOT_CONVERGING, OPEN, STALLED, WRONG, Outcome, _varied
from verification.suite.ladder import converge, error_order, extrapolated, observed_order
from verification.suite.manifest import read_cases
from verification.suite.result import Exactness, exactness
from verification.suite.runner import Job, jobs_of

GIVEN = Observable("drag", "F", reference=50.0, uncertainty=0.0, source="nobody", goal=0.02)


def power_series(h: list[float], limit: float = 50.0, factor: float = 3.0, order: float = 2.0) -> list[float]:
    return [limit + factor * value**order for value in h]


@pytest.mark.parametrize("h", [[0.4, 0.2, 0.1], [0.3, 0.2, 0.1], [0.2, 0.15, 0.1]])
@pytest.mark.parametrize("order", [1.0, 2.0, 3.0])
def test_the_order_of_a_power_law_is_found_for_any_ratio(h: list[float], order: float) -> None:
    values = power_series(h, order=order)
    assert observed_order(h, values) == pytest.approx(order, rel=1e-6)
    assert error_order(h, [value - 50.0 for value in values]) == pytest.approx(order, rel=1e-9)
    assert converge(h, values).richardson == pytest.approx(50.0, rel=1e-9)


def test_the_index_bounds_the_error_of_a_power_law_by_its_safety_factor() -> None:
    h = [0.4, 0.2, 0.1]
    values = power_series(h)
    assert converge(h, values).gci == pytest.approx(1.25 * (values[-1] - 50.0), rel=1e-9)


def test_levels_that_swing_have_no_order_and_a_wider_index() -> None:
    found = converge([0.4, 0.2, 0.1], [50.3, 49.9, 50.1])
    assert math.isnan(found.order) and math.isnan(found.richardson)
    assert found.gci == pytest.approx(3.0 * 0.2)  # first order, ratio 2, factor 3


def test_two_levels_give_an_index_without_order() -> None:
    assert converge([0.2, 0.1], [50.2, 50.1]).gci == pytest.approx(0.3)


def test_a_level_that_is_no_number_has_no_order_and_no_limit() -> None:
    h, values = [0.4, 0.2, 0.1], [50.3, math.nan, 50.1]
    assert math.isnan(error_order(h, values)) and math.isnan(observed_order(h, values))
    assert math.isnan(extrapolated(h, values).value) and math.isnan(converge(h, values).gci)
    given = Observable("drag", "F", 50.0, 0.0, "nobody", goal=0.1, order=(1.5, 2.5))
    levels = tuple(Measured(value, 0.0) for value in values)
    assert not Outcome(given, levels[-1], {"resolution": 5.0}, tuple(h), levels).holds


def outcome(value: float, sources: dict[str, float], observable: Observable = GIVEN, **more) -> Outcome:
    return Outcome(observable, Measured(value, 0.0), sources, **more)


def test_the_tolerance_is_two_u_val_and_no_wider_than_the_goal() -> None:
    judged = outcome(50.4, {"step": 0.3, "resolution": 0.4})  # u_num = 0.5, of 50: 1 %, k u = 2 %
    assert judged.tolerance == pytest.approx(0.02)
    assert judged.verdict == CORRECT
    assert outcome(51.2, {"resolution": 5.0}).verdict == WRONG  # 2.4 %: noise does not widen the goal
    assert outcome(50.4, {"resolution": 0.1}).verdict == WRONG  # 0.8 % within the goal, but k u is 0.4 %
    assert "not explained by its uncertainty" in outcome(50.4, {"resolution": 0.1}).reason
    assert outcome(49.6, {"resolution": 0.3}).verdict == CORRECT
    assert outcome(49.6, {"resolution": 0.1}).verdict == WRONG


def test_uncertainties_of_reference_and_inputs_count() -> None:
    given = Observable("drag", "F", 50.0, uncertainty=0.3, source="nobody", goal=0.05, input=0.4)
    assert outcome(50.9, {"step": 1e-9}, given).verdict == CORRECT  # 1.8 %, u_val = 1 %
    assert outcome(51.1, {"step": 1e-9}, given).verdict == WRONG


def test_a_norm_is_judged_by_its_goal() -> None:
    norm = Observable("rms", "e", reference=0.0, uncertainty=0.0, source="exact", goal=0.005)
    assert outcome(0.004, {"resolution": 1e-6}, norm).verdict == CORRECT
    assert outcome(0.006, {"resolution": 1.0}, norm).verdict == WRONG


def test_without_a_source_of_uncertainty_the_goal_decides_and_the_line_says_so() -> None:
    judged = outcome(50.4, {"time": 0.01})
    assert judged.by_goal_alone and judged.verdict == CORRECT
    assert "CORRECT by goal 2 %" in judged.line


def test_an_objection_is_never_correct() -> None:
    judged = Outcome(GIVEN, Measured(50.0, 0.0, "forces out of balance by 3 %"))
    assert judged.verdict == OPEN and not judged.holds


LEVELS = {"spacings": (0.4, 0.2, 0.1)}


def levels(h: tuple[float, ...], order: float) -> tuple[Measured, ...]:
    return tuple(Measured(value, 0.0) for value in power_series(list(h), order=order))


@pytest.mark.parametrize(("order", "verdict"), [(2.0, CONVERGING), (0.5, NOT_CONVERGING), (3.5, NOT_CONVERGING)])
def test_the_observed_order_must_lie_in_its_band(order: float, verdict: str) -> None:
    given = Observable("drag", "F", 50.0, 0.0, "nobody", goal=0.1, order=(1.5, 2.5))
    found = levels(LEVELS["spacings"], order)
    judged = Outcome(given, found[-1], {"resolution": 5.0}, LEVELS["spacings"], found)
    assert judged.convergence_verdict == verdict
    assert judged.holds == (verdict == CONVERGING)


def test_a_stall_is_said_and_does_not_fail() -> None:
    found = levels(LEVELS["spacings"], 0.1)
    judged = Outcome(GIVEN, found[-1], {"resolution": 5.0}, LEVELS["spacings"], found, stalls="the kernel's own error")
    assert judged.convergence_verdict == STALLED


def test_a_varied_source_is_extrapolated_by_its_order() -> None:
    # Step halved, first order: the error is twice the change; half of 1.25 times that is the standard uncertainty.
    assert _varied(Vary("step", (("a",),), 2.0, 1.0), Measured(50.0, 0.0), [50.1]) == pytest.approx(0.125)
    # Sound speed doubled, second order: 4/3 of the change.
    assert _varied(Vary("Mach", (("a",),), 2.0, 2.0), Measured(50.0, 0.0), [49.7]) == pytest.approx(0.25)
    # Seeds: the scatter of all runs, 50.0 among them.
    assert _varied(Vary("disorder", (("a",), ("b",)), None, 1.0), Measured(50.0, 0.0), [50.1, 49.9]) == pytest.approx(0.1)


MANIFEST = """
name = "x"
[case]
purpose = "p"
tier = "quick"
cost = 10
{}
[box]
size = [1.0, 1.0]
[fluid]
spacing = 0.1
"""
OBSERVABLE = """
[[case.observable]]
name = "drag"
symbol = "F"
reference = 1.0
uncertainty = 0.0
source = "nobody at all"
goal = 0.1
"""


def written(folder: Path, extra: str) -> Path:
    file = folder / "case.toml"
    file.write_text(MANIFEST.format(extra))
    return file


def test_a_case_runs_each_set_of_overrides_once(tmp_path: Path) -> None:
    extra = OBSERVABLE + """
[[case.level]]
set = ["fluid.spacing=0.2"]
[[case.level]]
set = []
[[case.level]]
set = ["fluid.spacing=0.05"]
tier = "full"
[[case.vary]]
source = "step"
sets = [["run.step_factor=0.5"]]
ratio = 2
[[case.beside]]
label = "classic"
set = ["fluid.method=classic"]
"""
    (case,) = read_cases(written(tmp_path, extra))
    quick = [job.overrides for job in jobs_of(case, "quick", ANY_CODE)]
    assert quick == [("fluid.spacing=0.2",), (), ("run.step_factor=0.5",), ("fluid.method=classic",)]
    full = [job.overrides for job in jobs_of(case, "full", ANY_CODE)]
    assert set(full) - set(quick) == {("fluid.spacing=0.05",)}
    finer = Job(case, ("fluid.spacing=0.05",), ANY_CODE)
    assert finer.weight == pytest.approx(80.0)  # its cost is 10; half the spacing: four times the PPs, twice the steps


@pytest.mark.parametrize(
    ("extra", "message"),
    [
        (OBSERVABLE + "order = [2.0, 1.0]", "order = [2.0, 1.0]: write the band as [lowest, highest]"),
        (OBSERVABLE + "order = [1.0, 2.0]", "an order needs three levels"),
        ('[[case.vary]]\nsource = "step"\nsets = [["a=1"]]', "one entry without a ratio says nothing"),
        ('[[case.vary]]\nsource = "step"\nsets = [["a=1"]]\nratio = 1', "must be above 1"),
        ('[[case.level]]\nset = "a=1"', "wrong type"),
        ('[[case.level]]\nset = []\ntier = "slow"', "tier = 'slow': unknown"),
        (OBSERVABLE + "goal2 = 1", "goal2: unknown"),
        (OBSERVABLE.replace("goal = 0.1", "goal = -0.1"), "must not be negative"),
    ],
)
def test_a_bad_entry_is_refused_with_its_fix(tmp_path: Path, extra: str, message: str) -> None:
    file = written(tmp_path, extra)
    with pytest.raises(CaseError) as caught:
        read_cases(file)
    assert str(file) in str(caught.value) and message in str(caught.value)


def ledger(columns: dict[str, list]) -> Ledger:
    """Of a run with these columns in its series."""
    table = Table({name: np.array(values) for name, values in columns.items()}, dict.fromkeys(columns, ""))
    return Ledger(*defects_of(SimpleNamespace(series=table)))


def test_a_momentum_defect_and_a_lost_particle_are_seen() -> None:
    exact = {"step": [0, 1], "momentum_defect_x": ["0", "0"], "fluid_particles": [9.0, 9.0]}
    assert ledger(exact) == Ledger(2)
    (defect,) = ledger(exact | {"momentum_defect_x": ["0", "1"]}).defects
    assert defect == "momentum - start - impulse: 1 at step 1, wrong at 1 of 2 samples"
    (defect,) = ledger(exact | {"momentum_defect_x": ["0", "0"], "momentum_defect_y": ["-2", "0"]}).defects
    assert defect == "momentum - start - impulse: 2 at step 0, wrong at 1 of 2 samples"
    (defect,) = ledger(exact | {"fluid_particles": [9.0, 8.0]}).defects
    assert defect == "change of the number of PPs: 1 at step 1, wrong at 1 of 2 samples"


def test_a_case_is_exact_where_all_its_runs_are() -> None:
    def of(name: str, kept: Ledger | None) -> SimpleNamespace:
        return SimpleNamespace(stored=SimpleNamespace(label=name, ledger=kept))

    entries = {("a",): of("one", Ledger(3)), ("b",): of("two", Ledger(4)), ("c",): of("no ledger", None)}
    assert exactness(entries) == Exactness(2, 7, ())
    assert exactness(entries | {("d",): of("wrong", Ledger(1, ("a defect",)))}) == Exactness(3, 8, ("wrong: a defect",))


def entry(error: float, uncertainty: float = 0.001, goal: float = 0.02) -> dict:
    return {"error": error, "uncertainty": uncertainty, "goal": goal, "value": 1.0, "verdict": CORRECT}


def test_the_trend_names_what_moved_by_more_than_its_uncertainty() -> None:
    before = [{"errors": {"a": entry(0.010), "b": entry(0.010), "gone": entry(0.0)}}]
    found = changes(before, {"a": entry(0.0105), "b": entry(0.015), "c": entry(0.0)})
    assert {row["key"]: row["what"] for row in found} == {"b": "moved", "gone": "no longer judged", "c": "new"}
    assert changes([], {"a": entry(1.0)}) == []


def test_a_miss_that_is_explained_stays_wrong_and_says_why() -> None:
    known = Observable("drag", "F", 1.0, 0.0, "made up", goal=0.01, explained="the lattice resists",
                       explained_goal=0.15)
    missed, met = Outcome(known, Measured(1.1, 0.0)), Outcome(known, Measured(1.001, 0.0))
    assert not Outcome(known, Measured(1.2, 0.0)).passes and not Outcome(known, Measured(float("nan"), 0.0)).passes
    assert missed.verdict == WRONG and not missed.holds and missed.passes
    assert "beyond the goal 1 %; explained: the lattice resists" in missed.line
    assert met.verdict == CORRECT and met.holds and not met.explained and "explained" not in met.line
    unknown = Outcome(Observable("drag", "F", 1.0, 0.0, "made up", goal=0.01), Measured(1.1, 0.0))
    assert not unknown.passes
