"""Studies: many runs of one case, declared in one file beside it. See README.md of this folder."""

import itertools
import math
import shlex
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from verification.codes.code import Code, find_code
from verification.measures.health import HEALTH
from verification.protocol.errors import Beyond, CaseError, SolverError, refuse
from verification.protocol.machine import ROOT
from verification.protocol.quantity import Measured
from verification.protocol.sources import checksum_of_sources
from verification.protocol.toml_text import value_text
from verification.store.laboratory import Laboratory
from verification.store.store import Found
from verification.studies.classes import class_of, class_of_failure
from verification.studies.grid import between, is_number
from verification.suite.ability import stated_alone
from verification.suite.case import Case, Observable
from verification.suite.judge import Outcome
from verification.suite.manifest import cases_folder, find_cases
from verification.suite.parameters import overrides_of, scene_of
from verification.suite.progress import time_left
from verification.suite.references import Reference, look_up_reference, obtain_reference, resolved
from verification.suite.refusals import remember, why_not
from verification.suite.runner import Entry, Job, Shelf, look_up, perform

DESIGNS = ("factorial", "one at a time")
CHARTS = ("precision", "map")
KEYS = ("purpose", "point", "observable", "chart", "refine", "block")
HEALTH_FILE = ROOT / "verification" / "measures" / "health.py"
BLOCK_KEYS = ("name", "codes", "design", "factors")

Setting = tuple[str, ...]  # KEY=VALUE of each factor


@dataclass(frozen=True)
class Block:
    """Runs that belong together: every code with every setting."""

    name: str
    codes: tuple[str, ...]
    factors: tuple[str, ...]  # their keys
    settings: tuple[Setting, ...]


@dataclass(frozen=True)
class Study:
    name: str  # CASE.NAME
    case: Case
    purpose: str
    observable: Observable  # the one that is judged
    chart: str  # of CHARTS, or empty
    refine: int  # of a map: rounds in which points are added between neighbours that come out differently
    blocks: tuple[Block, ...]

    @property
    def runs(self) -> dict[tuple[str, Setting], str]:
        """(code, setting): the first block that asks for it."""
        found: dict[tuple[str, Setting], str] = {}
        for block in self.blocks:
            for pair in itertools.product(block.codes, block.settings):
                found.setdefault(pair, block.name)
        return found

    @property
    def codes(self) -> list[str]:
        return list(dict.fromkeys(code for block in self.blocks for code in block.codes))

    @property
    def tier(self) -> str:
        """At which the reference code runs, where there is one."""
        return self.case.tier


@dataclass(frozen=True)
class Trial:
    """A run that a study asks for."""

    block: str
    setting: Setting
    job: Job


@dataclass(frozen=True)
class Result:
    """A run of a study as it came out: how far its observable is from the reference, or why there is no value."""

    block: str
    setting: Setting
    code: Code
    job: Job
    entry: Entry | None = None
    outcome: Outcome | None = None
    why: str = ""
    health: Mapping[str, float] = field(default_factory=dict)  # of a map, see verification/measures/health.py

    @property
    def kind(self) -> str:
        """Its class, one of CLASSES."""
        if self.outcome is None:
            return class_of_failure(self.why)
        return class_of(self.outcome.error, self.outcome.objection, self.health)


def _factors(where: str, table: dict) -> dict[str, tuple[str, ...]]:
    if not isinstance(table, dict) or not table:
        refuse(where, "factors", table, "write a table of lists")
    for key, values in table.items():
        if not isinstance(values, list) or not values:
            refuse(where, f"factors.{key}", values, "write a list of values")
        if len({value_text(value) for value in values}) < len(values):
            refuse(where, f"factors.{key}", values, "a value stands twice; remove one")
    return {key: tuple(f"{key}={value_text(value)}" for value in values) for key, values in table.items()}


def _block(where: str, table: dict) -> Block:
    for key in table:
        if key not in BLOCK_KEYS:
            refuse(where, key, table[key], f"unknown; known are {', '.join(BLOCK_KEYS)}")
    name, design, codes = table.get("name", ""), table.get("design", DESIGNS[0]), table.get("codes", ["mappm"])
    if not isinstance(name, str):
        refuse(where, "name", name, "write a text")
    if design not in DESIGNS:
        refuse(where, "design", design, f"unknown; known are {', '.join(DESIGNS)}")
    if not isinstance(codes, list) or not codes or not all(isinstance(code, str) for code in codes):
        refuse(where, "codes", codes, "write a list of names of codes")
    factors = _factors(where, table.get("factors"))
    return Block(name, tuple(codes), tuple(factors), _settings(design, factors))


def _settings(design: str, factors: dict[str, tuple[str, ...]]) -> tuple[Setting, ...]:
    """Of "one at a time" the case as it stands comes first, with nothing set."""
    if design == "factorial":
        return tuple(itertools.product(*factors.values()))
    return ((), *((text,) for values in factors.values() for text in values))


def _check_map(where: str, blocks: list[Block]) -> None:
    """A map has two axes, and one code."""
    if len(blocks) != 1 or len(blocks[0].factors) != 2 or len(blocks[0].codes) != 1:
        refuse(where, "block", [block.factors for block in blocks], "a map takes one block, of one code and two factors")
    for setting in blocks[0].settings:
        for text in setting:
            if not is_number(text.partition("=")[2]) or float(text.partition("=")[2]) <= 0:
                refuse(where, "block.factors", text, "an axis of a map takes numbers above 0")


def _observable(where: str, case: Case, table: dict) -> Observable:
    """Without a name the first that stands without another code."""
    if "observable" in table:
        found = [one for one in case.observables if one.name == table["observable"]]
        if not found:
            names = ", ".join(dict.fromkeys(one.name for one in case.observables))
            refuse(where, "observable", table["observable"], f"unknown; the case has {names}")
        return found[0]
    found = [one for one in case.observables if not one.live]
    if not found:
        refuse(where, "observable", None, "the case measures nothing that stands without another code; name the observable to judge")
    return found[0]


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
    family, blocks = file.parent.name, table.get("block")
    points = find_cases(f"{family}.{table['point']}" if "point" in table else family)
    if len(points) > 1:
        refuse(where, "point", None, f"choose one of {', '.join(case.name.partition('.')[2] for case in points)}")
    if not isinstance(blocks, list) or not blocks or not all(isinstance(block, dict) for block in blocks):
        refuse(where, "block", blocks, "write tables [[study.block]]")
    if table.get("chart", "") not in ("", *CHARTS):
        refuse(where, "chart", table["chart"], f"unknown; known are {', '.join(CHARTS)}")
    name = f"{family}.{file.stem.removeprefix('study_')}"
    made = [_block(f"{where}.block", block) for block in blocks]
    refine = table.get("refine", 0)
    if not isinstance(refine, int) or isinstance(refine, bool) or refine < 0 or (refine and table.get("chart") != "map"):
        refuse(where, "refine", refine, 'write a whole number of rounds, of a study with chart = "map"')
    if table.get("chart") == "map":
        _check_map(where, made)
    study = Study(name, points[0], " ".join(str(table.get("purpose", "")).split()), _observable(where, points[0], table),
                  table.get("chart", ""), refine, tuple(made))
    for _, setting in study.runs:
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


def trials_of(study: Study, say: Callable[[str], None] = print) -> list[Trial]:
    """Of all codes that are installed and can do the case; the others are told to `say`."""
    able: dict[str, tuple[Code, Case]] = {}
    for code in map(find_code, study.codes):
        try:
            if code.missing:
                raise Beyond(code.missing)
            able[code.name] = code, stated_alone(study.case, code, study.observable)
        except Beyond as error:
            say(f"{study.name}: {code.name} SKIPPED: {error}")
    whole = study.chart == "map"  # keeps the last state, from which the class is told
    return [Trial(block, setting, Job(case, study.case.base + setting, code, finest=whole))
            for (name, setting), block in study.runs.items() if name in able for code, case in [able[name]]]


def _health_id() -> str:
    """Of the measures of health: edited, they measure anew."""
    return checksum_of_sources((HEALTH_FILE,))[:16]


def _health_of(shelf: Shelf, job: Job) -> dict[str, float]:
    """What is stored of it."""
    return {name: one.value for name, one in shelf.store.found(job.request.key, _health_id()).values.items()}


def _measure_health(laboratory: Laboratory, job: Job) -> None:
    """What a code did not leave the files for is NaN, which speaks for no class."""
    found = {}
    with laboratory.kept(job.request.key) as run:
        for name, measure in HEALTH.items():
            try:
                found[name] = Measured(measure(run), 0.0)
            except (KeyError, IndexError, FileNotFoundError):
                found[name] = Measured(math.nan, 0.0)
    laboratory.store.enter_found(job.request.key, _health_id(), Found(found, {}))


def is_there(shelf: Shelf, study: Study, job: Job) -> bool:
    """With all that the study asks of a run."""
    return look_up(shelf, job) is not None and (study.chart != "map" or bool(_health_of(shelf, job)))


def run_study(laboratory: Laboratory, study: Study, workers: int, say: Callable[[str], None], repeats: int = 1) -> None:
    """What is missing, the cheapest first, so that there is something to see early, then between the points of a map, and then each
    run again until its cost was measured `repeats` times. What a code refuses, and what fails, is told and remembered; what was made
    stays."""
    if study.observable.live and (why := _why_unusable(obtain_reference(laboratory, study.case, study.tier, {}), study)):
        say(f"{study.name}: {study.case.live.code}, the reference: {why}")
    for _ in range(study.refine + 1):
        whole = refined(laboratory, study)
        jobs = [trial.job for trial in trials_of(whole, say) if not why_not(laboratory, trial.job)]
        _make(laboratory, whole, [job for job in jobs if not is_there(laboratory, study, job)], workers, say)
    for count in range(2, repeats + 1):
        again = [job for job in jobs if 0 < len(laboratory.store.costs(job.request.key)) < count]
        # What the store keeps of a run is kept: its last state may be in a picture of the suite.
        _make(laboratory, study, [replace(job, finest=laboratory.store.has_files(job.request.key)) for job in again], workers, say, anew=True)


def _make(laboratory: Laboratory, study: Study, jobs: list[Job], workers: int, say: Callable[[str], None], anew: bool = False) -> None:
    """Runs them; of a map, what the store has without figures of its last state is measured where that is kept, and else run anew."""
    left = time_left()

    def told(job: Job, share: float) -> None:
        if study.chart == "map":
            _measure_health(laboratory, job)
        say(f"{study.name}: {job.code.name}, {job.label}: done; {left(share):.0f} s to go")

    def failed(job: Job, error: Beyond | SolverError | CaseError) -> None:
        verdict = "SKIPPED" if isinstance(error, Beyond) else "FAILED"
        say(f"{study.name}: {job.code.name}, {job.label}: {verdict}: {remember(laboratory, job, error)}")

    known = [job for job in jobs if look_up(laboratory, job) is not None] if study.chart == "map" and not anew else []
    for job in known:
        if laboratory.store.has_files(job.request.key):
            _measure_health(laboratory, job)
    lost = [job for job in known if not is_there(laboratory, study, job)]
    perform(laboratory, [job for job in jobs if job not in known], workers, told, anew=anew, cheapest_first=True, failed=failed)
    perform(laboratory, lost, workers, told, anew=True, cheapest_first=True, failed=failed)


def refined(shelf: Shelf, study: Study) -> Study:
    """A map with the points that its rounds add, as far as their neighbours are there; any other study as it is."""
    for _ in range(study.refine):
        results = _results(shelf, study)
        if len(results) < len(study.runs):
            break
        first = study.blocks[0]
        more = between(first.factors, {result.setting: result.kind for result in results})
        if not more:
            break
        study = replace(study, blocks=(*study.blocks, Block("refined", first.codes, first.factors, tuple(more))))
    return study


def _why_unusable(reference: Reference | None, study: Study) -> str:
    """Why a reference cannot serve; empty where it can."""
    if reference is None:
        return "was not run"
    return reference.missing or reference.objection or ("" if study.observable.live in reference.quantities else "gave no such quantity")


def reference_of(shelf: Shelf, study: Study) -> Reference | None:
    """Of the code that the observable is held against; None where there is no such code, or it was not run."""
    if not study.observable.live:
        return None
    return look_up_reference(shelf, study.case, study.tier, {}, find_code(study.case.live.code))


def results_of(shelf: Shelf, study: Study) -> list[Result]:
    """Of the runs that are there, and of those that failed or were refused."""
    return _results(shelf, refined(shelf, study))


def _results(shelf: Shelf, study: Study) -> list[Result]:
    found, reference = [], reference_of(shelf, study)
    if study.observable.live and _why_unusable(reference, study):
        return []
    for trial in trials_of(study, lambda text: None):
        job = trial.job
        entry, why = look_up(shelf, job), why_not(shelf, job)
        if is_there(shelf, study, job):
            (observable,) = resolved(replace(job.case, scene=entry.scene), reference).observables
            outcome = Outcome(observable, entry.found.values[observable.name])
            found.append(Result(trial.block, trial.setting, job.code, job, entry, outcome, health=_health_of(shelf, job)))
        elif why:
            found.append(Result(trial.block, trial.setting, job.code, job, why=why))
    return found


def charted(shelf: Shelf, chart: str) -> Iterator[tuple[Study, list[Result]]]:
    """The studies that ask for a kind of chart and have runs."""
    for study in map(read_study, all_studies()):
        if study.chart == chart and (results := results_of(shelf, study)):
            yield study, results


def command_of(study: Study, job: Job) -> str:
    """Makes a run again, as a line for a shell: by the solver itself, or by the suite where the code is another."""
    if job.code.name == "mappm":
        file = study.case.file.relative_to(ROOT) if study.case.file.is_relative_to(ROOT) else study.case.file
        words, sets = ["mappm", "run", str(file)], overrides_of(study.case, job.overrides)
    else:
        words = ["python3", "-m", "verification", "run", study.case.name, "--code", job.code.name]
        sets = job.overrides[len(study.case.base) :]
    return shlex.join([*words, *(word for text in sets for word in ("--set", text))])


def lines_of(study: Study, results: list[Result]) -> list[str]:
    """A table: what was set, error and core-seconds."""
    made = sum(result.entry is not None for result in results)
    asked = max(len(results), len(study.runs))
    lines = [f"{study.name}: {made} of {asked} runs; {study.observable.symbol}, error and core-seconds"]
    width = max((len(" ".join(result.setting)) for result in results), default=0)
    for result in results:
        head = f"{result.code.name:12} {' '.join(result.setting) or 'as declared':{width}}"
        if result.entry is None:
            lines.append(f"{head}  {result.why}")
            continue
        error = "no value" if math.isnan(result.outcome.error) else result.outcome.error_text
        kind = f"  {result.kind}" if study.chart == "map" else ""
        cost = result.entry.stored.cost
        lines.append(f"{head}  {error:>10}  {f'{cost.core_seconds:8.3g} s' if cost else 'no cost'}{kind}")
    return lines
