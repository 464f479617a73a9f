"""Studies: many runs of one case, declared in one file beside it. See README.md of this folder."""

import itertools
import math
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from verification.codes.code import Code, find_code
from verification.protocol.errors import Beyond, CaseError, refuse
from verification.protocol.toml_text import value_text
from verification.store.laboratory import Laboratory
from verification.suite.ability import stated_alone
from verification.suite.case import Case
from verification.suite.judge import Outcome
from verification.suite.manifest import cases_folder, find_cases
from verification.suite.parameters import scene_of
from verification.suite.progress import time_left
from verification.suite.references import resolved
from verification.suite.runner import Entry, Job, Shelf, look_up, perform

DESIGNS = ("factorial", "one at a time")
KEYS = ("purpose", "design", "codes", "point", "factors")

Setting = tuple[str, ...]  # KEY=VALUE of each factor


@dataclass(frozen=True)
class Study:
    name: str  # CASE.NAME
    case: Case
    purpose: str
    design: str
    codes: tuple[str, ...]
    factors: dict[str, tuple[str, ...]]  # KEY=VALUE, by KEY

    @property
    def settings(self) -> list[Setting]:
        """One a run; of "one at a time" the case as it stands comes first, with nothing set."""
        if self.design == "factorial":
            return list(itertools.product(*self.factors.values()))
        return [(), *((text,) for values in self.factors.values() for text in values)]


@dataclass(frozen=True)
class Result:
    """One run of a study, and how far its first observable is from the reference."""

    setting: Setting
    code: Code
    entry: Entry
    outcome: Outcome


def _factors(where: str, table: dict) -> dict[str, tuple[str, ...]]:
    if not isinstance(table, dict) or not table:
        refuse(where, "factors", table, "write a table [study.factors] of lists")
    for key, values in table.items():
        if not isinstance(values, list) or not values:
            refuse(where, f"factors.{key}", values, "write a list of values")
        if len({value_text(value) for value in values}) < len(values):
            refuse(where, f"factors.{key}", values, "a value stands twice; remove one")
    return {key: tuple(f"{key}={value_text(value)}" for value in values) for key, values in table.items()}


def read_study(file: Path) -> Study:
    """Throws CaseError."""
    try:
        table = tomllib.loads(file.read_text()).get("study")
    except tomllib.TOMLDecodeError as error:
        raise CaseError(f"{file}: {error}; mend the TOML") from None
    if not isinstance(table, dict):
        raise CaseError(f"{file}: study: missing; add a table [study]")
    where = f"{file}: study"
    for key in table:
        if key not in KEYS:
            refuse(where, key, table[key], f"unknown; known are {', '.join(KEYS)}")
    family, design, codes = file.parent.name, table.get("design", DESIGNS[0]), table.get("codes", ["mappm"])
    if design not in DESIGNS:
        refuse(where, "design", design, f"unknown; known are {', '.join(DESIGNS)}")
    if not isinstance(codes, list) or not codes or not all(isinstance(code, str) for code in codes):
        refuse(where, "codes", codes, "write a list of names of codes")
    points = find_cases(f"{family}.{table['point']}" if "point" in table else family)
    if len(points) > 1:
        refuse(where, "point", None, f"choose one of {', '.join(case.name.partition('.')[2] for case in points)}")
    name = f"{family}.{file.stem.removeprefix('study_')}"
    study = Study(name, points[0], " ".join(str(table.get("purpose", "")).split()), design, tuple(codes),
                  _factors(where, table.get("factors")))
    if all(observable.live for observable in study.case.observables):
        refuse(where, "factors", table["factors"], f"{family} measures nothing that stands without another code; give it an observable")
    for setting in study.settings:
        scene_of(study.case, study.case.base + setting)
    return study


def all_studies() -> list[Path]:
    return sorted(cases_folder().glob("*/study_*.toml"))


def find_study(name: str) -> Study:
    """By CASE.NAME. Throws CaseError."""
    known = {f"{file.parent.name}.{file.stem.removeprefix('study_')}": file for file in all_studies()}
    if name not in known:
        raise CaseError(f"{name}: no such study; known are {', '.join(known) or 'none'}")
    return read_study(known[name])


def jobs_of(study: Study, say: Callable[[str], None] = print) -> list[Job]:
    """Of all codes that are installed and can do the case; the others are told to `say`."""
    jobs = []
    for code in map(find_code, study.codes):
        try:
            if code.missing:
                raise Beyond(code.missing)
            case = stated_alone(study.case, code)
            jobs += [Job(case, study.case.base + setting, code) for setting in study.settings]
        except Beyond as error:
            say(f"{study.name}: {code.name} SKIPPED: {error}")
    return jobs


def run_study(laboratory: Laboratory, study: Study, workers: int, say: Callable[[str], None]) -> None:
    """What is missing, the cheapest first, so that there is something to see early. Throws what a run throws; what was made stays."""
    jobs, left = jobs_of(study, say), time_left()

    def told(job: Job, share: float) -> None:
        say(f"{study.name}: {job.code.name}, {job.label}: done; {left(share):.0f} s to go")

    def skipped(job: Job, why: Beyond) -> None:
        say(f"{study.name}: {job.code.name}, {job.label}: SKIPPED: {why}")

    perform(laboratory, jobs, workers, told, cheapest_first=True, skipped=skipped)


def results_of(shelf: Shelf, study: Study) -> list[Result]:
    """Of the runs that are there."""
    found = []
    for job in jobs_of(study, lambda text: None):
        entry = look_up(shelf, job)
        if entry is not None:
            (observable,) = resolved(replace(job.case, scene=entry.scene), None).observables
            outcome = Outcome(observable, entry.found.values[observable.name])
            found.append(Result(job.overrides[len(study.case.base) :], job.code, entry, outcome))
    return found


def lines_of(study: Study, results: list[Result]) -> list[str]:
    """A table: what was set, error and core-seconds."""
    symbol = results[0].outcome.observable.symbol if results else ""
    lines = [f"{study.name}: {len(results)} of {len(study.settings) * len(study.codes)} runs; {symbol}, error and core-seconds"]
    width = max((len(" ".join(result.setting)) for result in results), default=0)
    for result in results:
        error = "no value" if math.isnan(result.outcome.error) else result.outcome.error_text
        lines.append(f"{result.code.name:12} {' '.join(result.setting) or 'as declared':{width}}  {error:>10}  "
                     f"{result.entry.stored.cost.core_seconds:8.3g} s")
    return lines
