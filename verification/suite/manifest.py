"""The manifest of a case: the table [case] of cases/NAME/case.toml. A case is that folder and nothing else.

    [case]
    purpose = "one paragraph"
    equations = ["u = U sin(k y) exp(-nu k^2 t)"]   # what the flow obeys, a line each; may be left out
    chapter = "waves and decay"     # of the report, one of CHAPTERS in case.py; "other" if left out
    section = "shear waves"         # cases of one section stand together there; may be left out
    tier = "quick"                  # or "full"
    cost = 20                       # core-seconds of the quick tier, about
    refined = "spacing"             # or "step": what gets finer from level to level
    remark = "why the error stops falling"  # on what the levels show; may be left out

    [case.parameters]               # what a point, a level or --set may choose: a number, a text or a list each. May be left out
    phi = 0.2                       # with the value that the scene as it stands has
    R_over_dx = 8

    [case.formulas]                 # what follows from parameters, in this order; see verification/suite/formulas.py
    side = "sqrt(pi / phi)"         # a name without a dot: a helper of those that follow
    "box.size" = "[side, side]"     # a key of the scene, which holds the value at the defaults
    "fluid.spacing" = "1 / R_over_dx"

    [[case.point]]                  # one member of a family that shares all else; the case NAME.POINT. May be left out
    name = "phi_0.1"
    set = ["phi=0.1", "run.duration=4"]  # KEY=VALUE, before those of the level: a parameter, or a key of the scene, which wins
    tier = "full"                   # that of the case if left out
    cost = 20                       # likewise
    unbanded = { since = 2026-11-22, why = "why" }  # here no band need be met, from that day on; may be left out
    explained = "why it misses its goal"  # as of an observable, of this point alone; explained_goal comes with it

    [case.live]                     # a reference code, run after the code that is judged: an adapter of verification/codes
    code = "openfoam"
    problem = "drag"
    quick = ["levels=16,32"]        # options of it in that tier
    full = ["levels=16,32,64"]
    same_law = false                # true: the code has the solver's law, and agreement is CODE-TO-CODE; false if left out

    [[case.observable]]
    name = "drag"                   # a function of measure.py in the folder of the case, or of verification/measures/observables.py
    symbol = "F/(mu U)"
    reference = 51.53
    uncertainty = 0.005             # standard uncertainty of the reference, absolute
    # or, in place of reference, uncertainty and source:
    live = "drag"                   # a quantity of the result of [case.live]
    published = "square_array_stokes"  # a table of reference/published, looked up for the scene
    explained = "why it misses its goal"  # of a miss whose cause is known: it stays FAILED, is shown with the cause, and fails no test
    explained_goal = 0.05           # largest error, as goal, that this explains; comes with it
    explains = "value"              # or "starts": the mean of disordered starts, see from_lattice; "extrapolated": that at dx to 0;
                                    # "all" of them; "value" if left out
    points = ["phi_0.1"]            # it is judged at these alone; at all if left out
    needs = ["force-on-body"]       # capabilities of a code beside those that the scene asks for; may be left out
    input = 0.0                     # standard uncertainty from the inputs, absolute; 0 if left out
    source = "Sangani and Acrivos 1982, table 1"
    goal = 0.03                     # largest relative error that can count as correct; absolute where the reference is 0
    order = [1.5, 2.5]              # band of the observed order, by theory, within [0.5, 2.5]; may be left out
    extrapolated = 0.01             # goal of the value extrapolated over three levels or more, judged as well; may be left out
    since = 2026-11-22              # the day from which on goal, band and extrapolated are these
    why = "why they are these"      # must be there if what came before asked for more

    [[case.observable.earlier]]     # what they were before, the oldest first; may be left out
    since = 2026-11-20
    goal = 0.02                     # order, extrapolated and why likewise

    [[case.retired]]                # an observable that is judged no more; may be left out
    name = "drag"
    symbol = "F/(mu U)"
    since = 2026-11-20              # of its last goal
    goal = 0.02                     # order, extrapolated, why and earlier likewise
    until = 2026-11-22
    reason = "why it was left out"

    [[case.level]]                  # from coarse to fine; `set = []` is the scene as it stands
    set = ["R_over_dx=12"]
    tier = "full"                   # only in that tier; may be left out

    [[case.vary]]                   # one source of numerical error, changed alone on the finest quick level
    source = "step"                 # step, Mach, disorder, ...
    sets = [["run.step_factor=0.5"]]
    ratio = 2                       # by which the source is refined, and the order of its error: the error is estimated
    order = 1                       # as the change / (1 - ratio^-order). Without ratio: other choices, whose range counts
    # or, in place of sets: other starts, four or more, whose scatter counts, with that of the finest quick level itself
    seeds = [["seed=2"], ["seed=3"], ["seed=4"], ["seed=5"]]
    from_lattice = false            # true: that level starts from a bare lattice and is none of them, which then are five or
                                    # more; their mean is judged as well; false if left out

    [[case.beside]]                 # measured and reported, without a verdict
    label = "classic"
    set = ["fluid.method=classic"]

    [case.equivalence]              # see verification/bits/equivalence.py

measure.py beside it exports one object MEASURES, see verification/measures/measures.py.
"""

import math
import os
import tomllib
from dataclasses import dataclass, replace
from datetime import date, datetime
from itertools import pairwise
from pathlib import Path

from verification.bits.equivalence import read_equivalence
from verification.codes.code import all_codes
from verification.protocol.capability import CAPABILITIES
from verification.protocol.errors import CaseError
from verification.protocol.machine import ROOT
from verification.suite.case import CHAPTERS, EXPLAINS, REFINED, TIERS, Beside, Case, Level, Live, Observable, Retired, Standard, Vary
from verification.suite.ladder import BAND
from verification.suite.parameters import derived, read_parameters, scene_of, split


def cases_folder() -> Path:
    """Where the cases are: MAPPM_CASES, or cases/ of this tree."""
    return Path(os.environ.get("MAPPM_CASES", ROOT / "cases"))


NUMBER = (int, float)


def _entry(table: dict, key: str, kind: type | tuple[type, ...], where: str, default=None):
    if key not in table:
        if default is None:
            raise CaseError(f"{where}.{key}: missing; add it")
        return default
    if not isinstance(table[key], kind) or isinstance(table[key], bool):
        raise CaseError(f"{where}.{key} = {table[key]!r}: wrong type")
    return table[key]


def _choice(table: dict, key: str, known: tuple[str, ...], where: str, default: str | None = None) -> str:
    value = _entry(table, key, str, where, default)
    if value not in known:
        raise CaseError(f"{where}.{key} = {value!r}: unknown; known are {', '.join(known)}")
    return value


def _only(table: dict, keys: tuple[str, ...], where: str) -> None:
    for key in table:
        if key not in keys:
            raise CaseError(f"{where}.{key}: unknown; known are {', '.join(keys)}")


def _texts(table: dict, key: str, where: str, default: list | None = None) -> tuple[str, ...]:
    values = _entry(table, key, list, where, default)
    if not all(isinstance(value, str) for value in values):
        raise CaseError(f"{where}.{key} = {values!r}: write a list of texts")
    return tuple(values)


REFERENCES = ("reference", "live", "published")  # exactly one of them


def _reference(table: dict, where: str) -> dict:
    given = [key for key in REFERENCES if key in table]
    if len(given) != 1:
        raise CaseError(f"{where}: {' and '.join(given) or 'no reference'} given; give one of {', '.join(REFERENCES)}")
    if given == ["reference"]:
        return {key: _entry(table, key, kind, where) for key, kind in
                {"reference": NUMBER, "uncertainty": NUMBER, "source": str}.items()}
    for key in ("uncertainty", "source"):
        if key in table:
            raise CaseError(f"{where}.{key}: comes with {given[0]}; remove it")
    return {given[0]: _entry(table, given[0], str, where), "reference": math.nan, "uncertainty": math.nan, "source": ""}


def _needs(table: dict, where: str) -> tuple[str, ...]:
    words = _texts(table, "needs", where, [])
    for word in words:
        if word not in CAPABILITIES:
            raise CaseError(f"{where}.needs: {word!r}: unknown; known are {', '.join(CAPABILITIES)}")
    return words


STANDARD = ("since", "goal", "order", "extrapolated", "why")


def _day(table: dict, key: str, where: str) -> date:
    if key not in table:
        raise CaseError(f"{where}.{key}: missing; add the day, such as 2026-11-22, without quotes")
    if not isinstance(table[key], date) or isinstance(table[key], datetime):
        raise CaseError(f"{where}.{key} = {table[key]!r}: write a day, such as 2026-11-22, without quotes")
    return table[key]


def _standard(table: dict, where: str) -> Standard:
    band = table.get("order")
    if band is not None and not (isinstance(band, list) and len(band) == 2 and band[0] < band[1]):
        raise CaseError(f"{where}.order = {band!r}: write the band as [lowest, highest]")
    found = Standard(_day(table, "since", where), float(_entry(table, "goal", NUMBER, where)), tuple(band) if band else None,
                     float(_entry(table, "extrapolated", NUMBER, where)) if "extrapolated" in table else None,
                     " ".join(_entry(table, "why", str, where, "").split()))
    if not all(0 <= value < math.inf for value in (found.goal, found.extrapolated or 0.0)):
        raise CaseError(f"{where}: goal and extrapolated must be finite, and not be negative")
    return found


def _earlier(table: dict, now: Standard, where: str) -> tuple[Standard, ...]:
    """Throws CaseError where days are out of order, or where less is asked for without a reason."""
    found = []
    for i, entry in enumerate(table.get("earlier", [])):
        _only(entry, STANDARD, f"{where}.earlier[{i}]")
        found.append(_standard(entry, f"{where}.earlier[{i}]"))
    for i, (before, after) in enumerate(pairwise([*found, now])):
        if after.since < before.since:
            raise CaseError(f"{where}.earlier[{i}].since = {before.since}: later than what came after, {after.since}; put the oldest first")
        if after.is_looser_than(before) and not after.why:
            at = f"{where}.earlier[{i + 1}]" if i + 1 < len(found) else where
            raise CaseError(f"{at}.why: missing; it asks for less than what was there before, say why")
    return tuple(found)


def _retired(table: dict, where: str) -> Retired:
    _only(table, (*STANDARD, "name", "symbol", "earlier", "until", "reason"), where)
    name, symbol, reason = (" ".join(_entry(table, key, str, where).split()) for key in ("name", "symbol", "reason"))
    standard = _standard(table, where)
    return Retired(name, symbol, standard, _earlier(table, standard, where), _day(table, "until", where), reason)


EXPLAINED = ("explained", "explained_goal", "explains")


def _explanation(table: dict, where: str) -> dict:
    if "explained" not in table and (more := [key for key in EXPLAINED[1:] if key in table]):
        raise CaseError(f"{where}.{more[0]}: says something of an explanation, and there is none; add explained")
    return {"explained": " ".join(_entry(table, "explained", str, where, "").split()),
            "explains": _choice(table, "explains", EXPLAINS, where, "value"),
            "explained_goal": _entry(table, "explained_goal", NUMBER, where, 0.0 if "explained" not in table else None)}


def _observable(table: dict, where: str) -> Observable:
    kinds = {"name": str, "symbol": str}
    _only(table, (*kinds, *REFERENCES, *STANDARD, "earlier", "uncertainty", "source", "input", "needs", "points", *EXPLAINED), where)
    standard = _standard(table, where)
    if standard.order and not (BAND[0] <= standard.order[0] and standard.order[1] <= BAND[1]):
        raise CaseError(f"{where}.order = {table['order']!r}: beyond {list(BAND)}, what theory can give of a method of second order")
    observable = Observable(
        **{key: _entry(table, key, kind, where) for key, kind in kinds.items()},
        **_reference(table, where),
        goal=standard.goal,
        since=standard.since,
        why=standard.why,
        earlier=_earlier(table, standard, where),
        needs=_needs(table, where),
        points=_texts(table, "points", where, []),
        **_explanation(table, where),
        input=_entry(table, "input", NUMBER, where, 0.0),
        order=standard.order,
        extrapolated=standard.extrapolated,
    )
    computed = "reference" not in table
    if not (0 <= observable.input < math.inf and (computed or 0 <= observable.uncertainty < math.inf)):
        raise CaseError(f"{where}: uncertainty and input must be finite, and not be negative")
    return observable


def _level(table: dict, where: str) -> Level:
    _only(table, ("set", "tier"), where)
    return Level(_texts(table, "set", where), _choice(table, "tier", TIERS, where, "quick"))


FEWEST_STARTS = 5
OWN_SOURCES = ("time", "resolution", "lattice")


def _sets(table: dict, key: str, where: str) -> tuple[tuple[str, ...], ...]:
    sets = _entry(table, key, list, where)
    if not sets or not all(isinstance(entry, list) for entry in sets):
        raise CaseError(f"{where}.{key} = {sets!r}: write a list of lists of overrides")
    return tuple(tuple(entry) for entry in sets)


def _vary(table: dict, where: str) -> Vary:
    _only(table, ("source", "sets", "seeds", "from_lattice", "ratio", "order"), where)
    source = _entry(table, "source", str, where)
    if source in OWN_SOURCES:
        raise CaseError(f"{where}.source = {source!r}: is what the judge itself calls an estimate; take another word")
    if "seeds" in table:
        if more := [key for key in ("sets", "ratio", "order") if key in table]:
            raise CaseError(f"{where}.{more[0]}: does not go with seeds; remove one of them")
        seeds, from_lattice = _sets(table, "seeds", where), _flag(table, "from_lattice", where)
        starts = len(seeds) + (0 if from_lattice else 1)
        if starts < FEWEST_STARTS:
            raise CaseError(f"{where}.seeds: {len(seeds)} of them, {starts} starts in all; {FEWEST_STARTS} are the fewest that count")
        return Vary(source, seeds, None, 1.0, seeds=True, from_lattice=from_lattice)
    sets, ratio = _sets(table, "sets", where), table.get("ratio")
    if ratio is not None and (len(sets) != 1 or not isinstance(ratio, NUMBER) or ratio <= 1):
        raise CaseError(f"{where}.ratio = {ratio!r}: needs one entry in sets, and must be above 1")
    if ratio is None and len(sets) < 2:
        raise CaseError(f"{where}.sets: one entry without a ratio says nothing; give the ratio, or several choices")
    return Vary(source, sets, ratio, float(_entry(table, "order", NUMBER, where, 1.0)))


def _beside(table: dict, where: str) -> Beside:
    _only(table, ("label", "set"), where)
    return Beside(_entry(table, "label", str, where), _texts(table, "set", where))


def _flag(table: dict, key: str, where: str) -> bool:
    if not isinstance(table.get(key, False), bool):
        raise CaseError(f"{where}.{key} = {table[key]!r}: write true or false")
    return table.get(key, False)


def _live(table: dict, where: str) -> Live:
    _only(table, ("code", "problem", "quick", "full", "same_law"), where)
    for key in ("quick", "full"):
        for text in _texts(table, key, where):
            if "=" not in text:
                raise CaseError(f"{where}.{key}: {text!r}: write KEY=VALUE")
    return Live(_choice(table, "code", tuple(all_codes()), where), _entry(table, "problem", str, where), _texts(table, "quick", where),
                _texts(table, "full", where), _flag(table, "same_law", where))


@dataclass(frozen=True)
class _Unbanded:
    since: date
    why: str


def _unbanded(table: dict, where: str) -> _Unbanded | None:
    if "unbanded" not in table:
        return None
    entry, at = _entry(table, "unbanded", dict, where), f"{where}.unbanded"
    _only(entry, ("since", "why"), at)
    return _Unbanded(_day(entry, "since", at), " ".join(_entry(entry, "why", str, at).split()))


def _of_point(observable: Observable, unbanded: _Unbanded | None, table: dict, where: str) -> Observable:
    made = _without_band(observable, unbanded) if unbanded else observable
    return replace(made, **_explanation(table, where)) if set(EXPLAINED) & set(table) else made


def _without_band(observable: Observable, unbanded: _Unbanded) -> Observable:
    """As its manifest has it, and from a day on without a band."""
    if observable.order is None:
        return observable
    days = [standard for standard in (*observable.earlier, observable.standard) if standard.since <= unbanded.since] or [observable.standard]
    return replace(observable, order=None, earlier=tuple(days), since=unbanded.since, why=unbanded.why)


def _points(case: Case, tables: list[dict], where: str) -> list[Case]:
    """The case once for each point, or the case itself where there are none."""
    found = []
    names = [table.get("name") for table in tables]
    for i, observable in enumerate(case.observables):
        for name in observable.points:
            if name not in names:
                raise CaseError(f"{where}.observable[{i}].points: {name!r}: no such point; known are {', '.join(map(str, names))}")
    for i, table in enumerate(tables):
        at = f"{where}.point[{i}]"
        _only(table, ("name", "set", "tier", "cost", "unbanded", *EXPLAINED), at)
        base = _texts(table, "set", at)
        unbanded = _unbanded(table, at)
        try:
            scene = derived(case.plain, case.parameters, case.formulas, base, f"{case.file}: case")
        except CaseError:
            raise
        except (KeyError, IndexError, ValueError) as error:
            raise CaseError(f"{at}.set = {list(base)}: no such key: {error}") from None
        found.append(replace(
            case, name=f"{case.name}.{_entry(table, 'name', str, at)}", base=base, scene=scene,
            tier=_choice(table, "tier", TIERS, at, case.tier), cost=_cost(table, at, case.cost),
            levels=tuple(replace(level, overrides=base + level.overrides) for level in case.levels),
            remark=unbanded.why if unbanded else case.remark,
            observables=tuple(_of_point(one, unbanded, table, at) for one in case.observables
                              if not one.points or table["name"] in one.points),
        ))
    if len({point.name for point in found}) < len(found):
        raise CaseError(f"{where}.point: two points have the same name; rename one")
    return found or [case]


def _check_sets(case: Case, where: str) -> None:
    """That each name without a dot is that of a parameter, with a value of its kind. Throws CaseError."""
    named = [(f"level[{i}]", level.overrides) for i, level in enumerate(case.levels)]
    named += [(f"vary[{i}]", chosen) for i, vary in enumerate(case.vary) for chosen in vary.sets]
    named += [(f"beside[{i}]", beside.overrides) for i, beside in enumerate(case.beside)]
    for name, sets in named:
        split(sets, case.parameters, case.plain, f"{where}.{name}")


def _cost(table: dict, where: str, default: float | None = None) -> float:
    cost = float(_entry(table, "cost", NUMBER, where, default))
    if cost <= 0:
        raise CaseError(f"{where}.cost = {table['cost']!r}: must be above 0")
    return cost


def _all_of(table: dict, key: str, read, where: str) -> tuple:
    return tuple(read(entry, f"{where}.{key}[{i}]") for i, entry in enumerate(table.get(key, [])))


def _of_one_law(observables: tuple[Observable, ...], live: Live | None) -> tuple[Observable, ...]:
    """Those held against a code that has the solver's law are marked as such."""
    return tuple(replace(one, code_to_code=bool(one.live and live and live.same_law)) for one in observables)


def read_cases(file: Path) -> list[Case]:
    """The points of a case, or the case itself where it has none. Throws CaseError."""
    try:
        scene = tomllib.loads(file.read_text())
    except tomllib.TOMLDecodeError as error:
        raise CaseError(f"{file}: {error}; mend the TOML") from None
    table = scene.get("case")
    if table is None:
        raise CaseError(f"{file}: case: missing; add a table [case]")
    where = f"{file}: case"
    lists = {"observable": _observable, "retired": _retired, "level": _level, "vary": _vary, "beside": _beside}
    _only(table, ("purpose", "chapter", "section", "equations", "tier", "cost", "refined", "remark", "equivalence", "live", "point",
                  "parameters", "formulas", *lists), where)
    found = {key: _all_of(table, key, read, where) for key, read in lists.items()}
    sources = [vary.source for vary in found["vary"]]
    if len(set(sources)) < len(sources):
        raise CaseError(f"{where}.vary: two have the same source; rename one")
    for i, observable in enumerate(found["observable"]):
        if observable.order and len(found["level"]) < 3:
            raise CaseError(f"{where}.observable[{i}].order: an order needs three levels; add [[case.level]]")
        if observable.extrapolated is not None and len(found["level"]) < 3:
            raise CaseError(f"{where}.observable[{i}].extrapolated: needs three levels; add [[case.level]]")
        if observable.live and "live" not in table:
            raise CaseError(f"{where}.observable[{i}].live: no reference code is run; add [case.live]")
    parameters, formulas = read_parameters(table, scene, where)
    equivalence = table.get("equivalence")
    live = _live(table["live"], f"{where}.live") if "live" in table else None
    case = Case(
        name=file.parent.name,
        file=file,
        purpose=" ".join(_entry(table, "purpose", str, where).split()),
        tier=_choice(table, "tier", TIERS, where),
        cost=_cost(table, where),
        chapter=_choice(table, "chapter", CHAPTERS, where, CHAPTERS[-1]),
        section=_entry(table, "section", str, where, ""),
        equations=_texts(table, "equations", where, []),
        refined=_choice(table, "refined", REFINED, where, "spacing"),
        remark=" ".join(_entry(table, "remark", str, where, "").split()),
        observables=_of_one_law(found["observable"], live),
        retired=found["retired"],
        levels=found["level"],
        vary=found["vary"],
        beside=found["beside"],
        equivalence=None if equivalence is None else read_equivalence(equivalence, f"{where}.equivalence"),
        live=live,
        plain=scene,
        parameters=parameters,
        formulas=formulas,
    )
    _check_sets(case, where)
    case = replace(case, scene=scene_of(case, ()))
    return _points(case, table.get("point", []), where)


def all_cases() -> list[Case]:
    return [case for file in sorted(cases_folder().glob("*/case.toml")) for case in read_cases(file)]


def find_cases(name: str) -> list[Case]:
    """By name, by CASE.POINT, or by the path of its scene: all points of a case that has some."""
    family, _, point = ("", "", "") if name.endswith(".toml") else name.partition(".")
    file = cases_folder() / family / "case.toml" if family else Path(name)
    if not file.exists():
        known = ", ".join(path.parent.name for path in sorted(cases_folder().glob("*/case.toml")))
        raise CaseError(f"{name}: no such case; known are {known}")
    found = read_cases(file)
    chosen = [case for case in found if not point or case.name == name]
    if not chosen:
        raise CaseError(f"{name}: {family} has no such point; known are {', '.join(case.name for case in found)}")
    return chosen


def find_case(name: str) -> Case:
    """As find_cases, where there is only one."""
    found = find_cases(name)
    if len(found) > 1:
        raise CaseError(f"{name}: has several points; choose one of {', '.join(case.name for case in found)}")
    return found[0]
