"""The verdict logic. Oracles: series whose limit and order are known, and arithmetic done by hand."""

import json
import math
import os
import subprocess
from dataclasses import replace
from datetime import date
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from support import ANY_CODE

from verification.protocol.errors import CaseError
from verification.protocol.ledger import defects_of
from verification.protocol.quantity import Measured
from verification.protocol.series import Table
from verification.report.headline import changes_of_standards, of_families, standard_text
from verification.report.history import changes
from verification.store.store import Found, Ledger
from verification.suite.case import Case, Observable, Standard, Vary
from verification.suite.judge import CODE_TO_CODE, FAILED, INCONCLUSIVE, VALIDATED, WITHIN_GOAL, Outcome, _converge, _varied, judge
from verification.suite.ladder import CONVERGING, DIVERGING, NOT_CONVERGING
from verification.suite.manifest import all_cases, read_cases
from verification.suite.result import Exactness, exactness
from verification.suite.runner import Job, jobs_of

GIVEN = Observable("drag", "F", reference=50.0, uncertainty=0.0, source="nobody", goal=0.02)


def outcome(value: float, sources: dict[str, float], observable: Observable = GIVEN, **more) -> Outcome:
    return Outcome(observable, Measured(value, 0.0), sources, **more)


def test_a_value_is_validated_where_both_bounds_say_so() -> None:
    judged = outcome(50.4, {"step": 0.3, "resolution": 0.4})  # u_num = 0.5, of 50: 1 %, k u = 2 %
    assert judged.bound == pytest.approx(0.02) and judged.verdict == VALIDATED
    assert "VALIDATED: k u = 2 %, goal 2 %" in judged.line
    assert outcome(49.6, {"resolution": 0.3}).verdict == VALIDATED


def test_what_is_beyond_the_goal_or_not_explained_by_its_uncertainty_has_failed() -> None:
    assert outcome(51.2, {"resolution": 5.0}).verdict == FAILED  # 2.4 %: noise does not widen the goal
    assert outcome(48.8, {"resolution": 5.0}).verdict == FAILED
    few = outcome(50.4, {"resolution": 0.1})  # 0.8 % within the goal, but k u is 0.4 %
    assert few.verdict == FAILED and "not explained by its uncertainty, k u = 0.4 %" in few.reason
    assert outcome(49.6, {"resolution": 0.1}).verdict == FAILED


def test_where_the_uncertainty_is_wider_than_the_goal_nothing_is_resolved() -> None:
    judged = outcome(50.4, {"resolution": 2.0})  # the referee's sphere: k u 8 % where the goal is 2 %
    assert judged.verdict == WITHIN_GOAL and judged.holds and "k u = 8 %, goal 2 %" in judged.line


def test_uncertainties_of_reference_and_inputs_count() -> None:
    given = Observable("drag", "F", 50.0, uncertainty=0.3, source="nobody", goal=0.05, input=0.4)
    assert outcome(50.9, {"step": 1e-9}, given).verdict == VALIDATED  # 1.8 %, u_val = 1 %
    assert outcome(51.1, {"step": 1e-9}, given).verdict == FAILED


def test_few_starts_widen_k() -> None:
    starts = outcome(50.0, {"disorder": 0.1}, freedom={"disorder": 4})
    assert starts.coverage == pytest.approx(2.776, abs=1e-3) and starts.bound == pytest.approx(2.776 * 0.1 / 50, rel=1e-3)
    assert outcome(50.0, {"disorder": 0.1}).coverage == 2.0


def test_a_norm_has_failed_beyond_its_goal_alone() -> None:
    norm = Observable("rms", "e", reference=0.0, uncertainty=0.0, source="exact", goal=0.005)
    assert outcome(0.004, {"resolution": 0.0022}, norm).verdict == VALIDATED  # converges to 0: 0.004 <= 0.0044 <= goal
    assert outcome(0.004, {"resolution": 1e-6}, norm).verdict == WITHIN_GOAL  # it stands at its floor
    assert outcome(0.004, {"resolution": 1.0}, norm).verdict == WITHIN_GOAL
    assert outcome(0.006, {"resolution": 1.0}, norm).verdict == FAILED
    assert outcome(-0.004, {"resolution": 1e-6}, norm).verdict == FAILED  # no norm: it is resolved, and not 0
    assert outcome(0.0, {}, replace(norm, goal=0.0)).verdict == VALIDATED  # exactly


def test_without_an_estimate_of_its_error_a_value_is_not_validated_and_the_line_says_so() -> None:
    judged = outcome(50.4, {"time": 0.01})
    assert not judged.is_estimated and judged.verdict == WITHIN_GOAL
    assert "WITHIN GOAL: goal 2 %, no estimate of its own error" in judged.line


def test_agreement_with_a_code_of_the_same_law_is_no_validation() -> None:
    same = replace(GIVEN, live="drag", code_to_code=True)
    assert outcome(50.4, {"step": 0.5}, same).verdict == CODE_TO_CODE
    assert outcome(51.4, {"step": 5.0}, same).verdict == FAILED


def test_an_objection_is_inconclusive() -> None:
    judged = Outcome(GIVEN, Measured(50.0, 0.0, "forces out of balance by 3 %"))
    assert judged.verdict == INCONCLUSIVE and not judged.holds


def test_an_estimate_that_rests_on_a_run_with_an_objection_is_none() -> None:
    doubted = replace(judged_levels(of_order(2.0)), doubt="R_over_dx=3: velocity 0.7 % from its extrapolation")
    assert judged_levels(of_order(2.0)).verdict == VALIDATED
    assert doubted.verdict == WITHIN_GOAL and doubted.state == ""
    assert "no estimate of its own error: R_over_dx=3: velocity 0.7 %" in doubted.line


H = (0.4, 0.2, 0.1)


def judged_levels(values: list[float], observable: Observable = GIVEN, case: SimpleNamespace | None = None) -> Outcome:
    found = tuple(Measured(value, 0.0) for value in values)
    return _converge(case or SimpleNamespace(refined="spacing"), Outcome(observable, found[-1], {"Mach": 0.4}, spacings=H, levels=found))


def of_order(order: float) -> list[float]:
    return [50.0 + 3.0 * h**order for h in H]


@pytest.mark.parametrize(("order", "state", "holds"), [(2.0, CONVERGING, True), (0.6, NOT_CONVERGING, False), (3.5, NOT_CONVERGING, False)])
def test_a_declared_band_must_be_met(order: float, state: str, holds: bool) -> None:
    given = replace(GIVEN, goal=0.1, order=(1.5, 2.5))
    judged = judged_levels(of_order(order), given)
    assert (judged.state, judged.holds) == (state, holds)


def test_without_a_band_levels_that_do_not_converge_are_said_and_do_not_fail() -> None:
    judged = judged_levels(of_order(0.1), replace(GIVEN, goal=0.1))
    assert judged.state == NOT_CONVERGING and judged.converges_as_asked and "NOT CONVERGING, observed order 0.10" in judged.line


def test_what_diverges_fails_whatever_the_error() -> None:
    judged = judged_levels([50.0, 50.1, 50.4], replace(GIVEN, uncertainty=1e-6))
    assert judged.verdict == WITHIN_GOAL and judged.state == DIVERGING and not judged.holds
    assert "observed order below 0" in judged.line and "in [" not in judged.line


def test_the_bound_of_the_levels_is_a_source() -> None:
    judged = judged_levels(of_order(2.0))
    assert judged.sources["resolution"] == pytest.approx(1.25 * 0.03 / 2, rel=1e-6)
    assert judged_levels(of_order(2.0), case=SimpleNamespace(refined="step")).sources["step"] == judged.sources["resolution"]


def test_a_varied_source_is_extrapolated_by_its_order() -> None:
    # Step halved, first order: the error is twice the change; half of 1.25 times that is the standard uncertainty.
    assert _varied(Vary("step", (("a",),), 2.0, 1.0), 50.0, [50.1]) == pytest.approx(0.125)
    # Sound speed doubled, second order: 4/3 of the change.
    assert _varied(Vary("Mach", (("a",),), 2.0, 2.0), 50.0, [49.7]) == pytest.approx(0.25)
    # Starts: the scatter of all runs, 50.0 among them.
    assert _varied(Vary("disorder", (("a",), ("b",)), None, 1.0, seeds=True), 50.0, [50.1, 49.9]) == pytest.approx(0.1)
    # Other choices: anywhere in their range.
    assert _varied(Vary("shift", (("a",), ("b",)), None, 1.0), 50.0, [50.3, 50.1]) == pytest.approx(0.3 / math.sqrt(3))


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
since = 2026-11-22
"""

EARLIER = """
[[case.observable.earlier]]
since = 2026-11-20
goal = 0.05
"""
RETIRED = """
[[case.retired]]
name = "lift"
symbol = "L"
since = 2026-11-20
goal = 0.05
until = 2026-11-22
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
        ('[[case.vary]]\nsource = "start"\nseeds = [["a=1"], ["a=2"], ["a=3"]]', "4 starts in all; 5 are the fewest"),
        ('[[case.vary]]\nsource = "start"\nseeds = [["a=1"]]\nratio = 2', "ratio: does not go with seeds"),
        ('[[case.vary]]\nsource = "start"\nseeds = [["a=1"], ["a=2"], ["a=3"], ["a=4"]]\nfrom_lattice = true', "4 starts in all"),
        ('[[case.vary]]\nsource = "resolution"\nsets = [["a=1"]]\nratio = 2', "take another word"),
        (2 * '[[case.vary]]\nsource = "step"\nsets = [["a=1"]]\nratio = 2\n', "two have the same source"),
        (OBSERVABLE.replace("goal = 0.1", "goal = inf"), "must be finite"),
        (OBSERVABLE.replace("uncertainty = 0.0", "uncertainty = inf"), "must be finite"),
        (OBSERVABLE + "explained_goal = 0.2", "there is none; add explained"),
        (OBSERVABLE + "order = [1.0, 3.0]", "beyond [0.5, 2.5]"),
        (OBSERVABLE.replace("since = 2026-11-22", ""), "since: missing; add the day"),
        (OBSERVABLE.replace("2026-11-22", '"2026-11-22"'), "write a day, such as 2026-11-22, without quotes"),
        (OBSERVABLE + EARLIER, "observable[0].why: missing; it asks for less than what was there before"),
        (OBSERVABLE + 'why = "it missed it"\n' + EARLIER.replace("11-20", "11-24"), "put the oldest first"),
        (RETIRED, "retired[0].reason: missing"),
        ('[[case.level]]\nset = "a=1"', "wrong type"),
        ('[[case.level]]\nset = []\ntier = "slow"', "tier = 'slow': unknown"),
        (OBSERVABLE + "goal2 = 1", "goal2: unknown"),
        (OBSERVABLE.replace("goal = 0.1", "goal = -0.1"), "must be finite, and not be negative"),
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


def entry(error: float, goal: float = 0.02) -> dict:
    return {"error": error, "uncertainty": 0.001, "goal": goal, "value": 1.0 + error, "verdict": VALIDATED}


def test_the_trend_names_all_that_moved() -> None:
    """Runs are exact to the bit: what is another value by a little is another program."""
    before = [{"errors": {"a": entry(0.01), "b": entry(0.01), "d": entry(0.01), "gone": entry(0.0)}}]
    found = changes(before, {"a": entry(0.01 + 1e-13), "b": entry(0.0101), "c": entry(0.0), "d": entry(0.02)})
    assert [(row["key"], row["what"]) for row in found] == [("gone", "no longer judged"), ("c", "new"), ("d", "moved"), ("b", "moved")]
    assert changes([], {"a": entry(1.0)}) == []


def test_a_miss_that_is_explained_has_failed_and_says_why() -> None:
    known = Observable("drag", "F", 1.0, 0.0, "made up", goal=0.01, explained="the lattice resists",
                       explained_goal=0.15)
    missed, met = Outcome(known, Measured(1.1, 0.0)), Outcome(known, Measured(1.001, 0.0))
    assert not Outcome(known, Measured(1.2, 0.0)).passes and not Outcome(known, Measured(float("nan"), 0.0)).passes
    assert missed.verdict == FAILED and not missed.holds and missed.passes
    assert "beyond the goal 1 %; explained: the lattice resists" in missed.line
    assert met.verdict == WITHIN_GOAL and met.holds and not met.explained and "explained" not in met.line
    unknown = Outcome(Observable("drag", "F", 1.0, 0.0, "made up", goal=0.01), Measured(1.1, 0.0))
    assert not unknown.passes


def test_an_explanation_excuses_neither_divergence_nor_a_missed_band() -> None:
    known = replace(GIVEN, goal=0.002, uncertainty=1e-6, explained="it is coarse", explained_goal=0.5)
    diverges = judged_levels([50.0, 50.1, 50.4], known)
    assert diverges.verdict == FAILED and diverges.state == DIVERGING and not diverges.passes
    assert not judged_levels(of_order(0.6), replace(known, order=(1.5, 2.5))).passes


def test_no_number_is_inconclusive_but_for_the_value_itself() -> None:
    assert outcome(50.0, {"resolution": math.nan}).verdict == INCONCLUSIVE
    assert outcome(50.0, {"step": 0.1}, replace(GIVEN, reference=math.nan)).verdict == INCONCLUSIVE
    assert outcome(math.nan, {"step": 0.1}).verdict == FAILED
    starts = outcome(50.0, {"disorder": math.nan}, freedom={"disorder": 4})
    assert starts.verdict == INCONCLUSIVE and "no number" in starts.line


def test_a_value_that_meets_its_reference_by_chance_is_not_validated_unresolved() -> None:
    assert outcome(50.0, {"resolution": 5.0}).verdict == WITHIN_GOAL
    assert outcome(50.0, {}).verdict == WITHIN_GOAL


STARTS = """
[[case.vary]]
source = "disordered"
seeds = [["a=1"], ["a=2"], ["a=3"], ["a=4"], ["a=5"]]
from_lattice = true
"""


def test_the_mean_of_disordered_starts_is_judged_beside_the_lattice(tmp_path: Path) -> None:
    """The lattice meets its goal of 10 %, all five starts miss it by 20: the scatter of these says nothing of the lattice."""
    (case,) = read_cases(written(tmp_path, OBSERVABLE + STARTS))
    values = {(): 1.02, ("a=1",): 1.19, ("a=2",): 1.21, ("a=3",): 1.2, ("a=4",): 1.18, ("a=5",): 1.22}
    entries = {key: SimpleNamespace(scene={"fluid": {"spacing": 0.1}}, found=Found({"drag": Measured(value, 0.0)}))
               for key, value in values.items()}
    lattice, starts = judge(case, "quick", entries)
    assert lattice.sources["lattice"] == pytest.approx(0.18) and lattice.sources["disordered"] == pytest.approx(0.0158, rel=0.01)
    assert lattice.freedom == {"disordered": 4} and len(lattice.seeds["disordered"]) == 5
    assert (starts.observable.symbol, starts.verdict) == ("F, disordered", FAILED) and starts.measured.value == pytest.approx(1.2)
    assert starts.sources["mean of starts"] == pytest.approx(0.0158 / math.sqrt(5), rel=0.01)


def test_an_objection_to_a_level_below_or_to_a_varied_run_takes_the_estimate_away(tmp_path: Path) -> None:
    (case,) = read_cases(written(tmp_path, OBSERVABLE + STARTS))
    keys = [(), *(chosen for vary in case.vary for chosen in vary.sets)]
    for doubted in ((), ("a=3",)):
        entries = {key: SimpleNamespace(scene={"fluid": {"spacing": 0.1}}, found=Found({"drag": Measured(
            1.0, 0.0, "still faster at the end" if key == doubted else "")})) for key in keys}
        lattice, starts = judge(case, "quick", entries)
        if doubted:
            assert (lattice.verdict, starts.verdict) == (WITHIN_GOAL, INCONCLUSIVE) and "a=3: still faster" in lattice.reason
        else:
            assert (lattice.verdict, starts.verdict) == (INCONCLUSIVE, WITHIN_GOAL)


def test_an_explanation_of_the_starts_excuses_them_alone(tmp_path: Path) -> None:
    told = OBSERVABLE + 'explained = "disorder"\nexplained_goal = 0.5\nexplains = "starts"\n'
    (case,) = read_cases(written(tmp_path, told + STARTS))
    entries = {key: SimpleNamespace(scene={"fluid": {"spacing": 0.1}}, found=Found({"drag": Measured(1.2, 0.0)}))
               for key in ((), *(chosen for vary in case.vary for chosen in vary.sets))}
    lattice, starts = judge(case, "quick", entries)
    assert (lattice.verdict, lattice.passes, starts.verdict, starts.passes) == (FAILED, False, FAILED, True)
    with pytest.raises(CaseError, match="explains = 'lattice': unknown; known are value, starts, extrapolated, all"):
        read_cases(written(tmp_path, told.replace('"starts"', '"lattice"')))


# --- the register of goals


def test_a_goal_has_its_days_and_reasons(tmp_path: Path) -> None:
    (case,) = read_cases(written(tmp_path, OBSERVABLE + 'why = "it missed it"\n' + EARLIER + RETIRED + 'reason = "no reference"\n'))
    (one,), (gone,) = case.observables, case.retired
    assert one.earlier == (Standard(date(2026, 11, 20), 0.05),) and one.standard == Standard(date(2026, 11, 22), 0.1, why="it missed it")
    assert one.standard.is_looser_than(one.earlier[0]) and not one.earlier[0].is_looser_than(one.standard)
    assert (gone.symbol, gone.until, gone.reason) == ("L", date(2026, 11, 22), "no reference")
    left, looser = changes_of_standards([case])
    assert (left.kind, left.symbol, left.after) == ("left out", "L", None)
    assert (looser.kind, looser.why, standard_text(looser.before), standard_text(looser.after)) == ("looser", "it missed it", "0.05", "0.1")


@pytest.mark.parametrize(("before", "after", "looser"), [
    ({}, {"goal": 0.2}, True), ({}, {"goal": 0.05}, False), ({"order": (1.0, 2.0)}, {}, True), ({}, {"order": (1.0, 2.0)}, False),
    ({"order": (1.0, 2.0)}, {"order": (0.9, 2.0)}, True), ({"order": (1.0, 2.0)}, {"order": (1.2, 1.8)}, False),
    ({"extrapolated": 0.01}, {}, True), ({"extrapolated": 0.01}, {"extrapolated": 0.02}, True)])
def test_what_asks_for_less_is_looser(before: dict, after: dict, looser: bool) -> None:
    day = date(2026, 11, 22)
    assert Standard(day, **({"goal": 0.1} | after)).is_looser_than(Standard(day, **({"goal": 0.1} | before))) == looser


def lines_of(name: str, case: Case) -> list[str]:
    """What of the register is in the manifest of a case, oldest first, a line each."""
    found = []
    for one in (*case.observables, *case.retired):
        symbol = one.against if isinstance(one, Observable) else one.symbol
        found += [[name, symbol, f"{standard.since}", standard_text(standard)] for standard in (*one.earlier, one.standard)]
    found += [[name, one.symbol, f"left out {one.until}"] for one in case.retired]
    return [json.dumps(line, ensure_ascii=False) for line in found]


def test_the_register_is_only_added_to() -> None:
    """register.jsonl holds every goal there ever was. A goal that was changed without leaving the old one in its manifest, or an
    observable that was taken out without a word, is missed here."""
    kept = (Path(__file__).parent / "register.jsonl").read_text().splitlines()
    now = sorted(line for name, case in of_families(all_cases()) for line in lines_of(name, case))
    lost = [line for line in kept if line not in now]
    assert not lost, "write them back, as [[case.observable.earlier]] or [[case.retired]]: " + "; ".join(lost)
    new = [line for line in now if line not in kept]
    assert not new, "add to tests/python/register.jsonl:\n" + "\n".join(new)


# Written in another form on the day after.
REWRITTEN = ['["falling_sphere_light", "t at 63 % of w at the end", "2026-11-22", "0.1", "left out 2026-11-22"]']


def test_no_line_ever_left_the_register() -> None:
    """The test before cannot see a goal that was changed in its manifest and in register.jsonl alike: the history can."""
    if (shallow := git("rev-parse", "--is-shallow-repository").strip()) != "false":
        pytest.skip("no history: " + (shallow or "no repository"))
    file = Path(__file__).parent / "register.jsonl"
    ever = [line[1:] for line in git("log", "--patch", "--format=", "--", str(file)).splitlines() if line.startswith("+[")]
    assert len(ever) > 100
    kept = file.read_text().splitlines()
    assert [line for line in dict.fromkeys(ever) if line not in kept] == REWRITTEN


def git(*words: str) -> str:
    return subprocess.run(["git", "-C", str(Path(__file__).parent), *words], capture_output=True, text=True).stdout


def test_a_point_may_have_an_explanation_of_its_own(tmp_path: Path) -> None:
    points = '[[case.point]]\nname = "a"\nset = []\nexplained = "it sticks"\nexplained_goal = 0.3\n[[case.point]]\nname = "b"\nset = []\n'
    known, other = read_cases(written(tmp_path, OBSERVABLE + points))
    assert (known.observables[0].explained, known.observables[0].explained_goal) == ("it sticks", 0.3)
    assert other.observables[0].explained == ""
    with pytest.raises(CaseError, match=r"point\[0\].explained_goal: missing"):
        read_cases(written(tmp_path, OBSERVABLE + points.replace("explained_goal = 0.3\n", "")))


def decided(case: Case) -> dict:
    """All of a case that decides its verdicts, beside its scene and its measures."""
    rows = [{"symbol": one.against, "name": one.name, "reference": one.reference, "uncertainty": one.uncertainty, "input": one.input,
             "published": one.published, "live": one.live, "code_to_code": one.code_to_code, "needs": list(one.needs),
             "standard": standard_text(one.standard), "explained_goal": one.explained_goal, "explains": one.explains} for one in case.observables]
    varied = [[vary.source, [list(chosen) for chosen in vary.sets], vary.ratio, vary.order, vary.seeds, vary.from_lattice] for vary in case.vary]
    live = [case.live.code, case.live.problem, list(case.live.quick), list(case.live.full)] if case.live else []
    return {"case": case.name, "tier": case.tier, "refined": case.refined, "observables": rows, "live": live, "vary": varied,
            "levels": [[list(level.overrides), level.tier] for level in case.levels]}


def test_what_decides_a_verdict_is_changed_on_purpose() -> None:
    """decided.jsonl holds it, a line a case or a point, so that a changed reference, uncertainty, level or explanation is seen in
    two places. MAPPM_DECIDED=write writes it anew."""
    file = Path(__file__).parent / "decided.jsonl"
    now = [json.dumps(decided(case), ensure_ascii=False) for case in sorted(all_cases(), key=lambda case: case.name)]
    if os.environ.get("MAPPM_DECIDED") == "write":
        file.write_text("\n".join(now) + "\n")
    kept = file.read_text().splitlines()
    apart = [json.loads(line)["case"] for line in set(kept) ^ set(now)]
    assert not apart, f"{', '.join(sorted(set(apart)))}: what decides verdicts has changed; if that is meant, MAPPM_DECIDED=write"
