"""The runs that a case needs: taken from the laboratory or made there, a few at a time, and measured."""

import os
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Protocol

from verification.codes.code import Code, end_all
from verification.measures.curve import kept_chart
from verification.measures.measures import Measure, Measures, measures_in
from verification.measures.observables import OBSERVABLES
from verification.measures.source import measure_id
from verification.protocol.errors import Beyond, CaseError, SolverError
from verification.protocol.quantity import Measured
from verification.protocol.run import Run
from verification.store.laboratory import Laboratory, Request
from verification.store.store import Found, Store, StoredRun
from verification.suite.case import Case
from verification.suite.parameters import scene_of

OWN, FIGURE = "own", "figure "  # kind of the charts of a run; before the names of figures that are no observables


class Shelf(Protocol):
    """What has a store: a laboratory, or what was published."""

    store: Store


@dataclass(frozen=True)
class Entry:
    """A run of a case as the store has it, and what was measured of it."""

    stored: StoredRun
    found: Found

    @property
    def scene(self) -> dict:
        return self.stored.scene

    @property
    def record(self) -> dict:
        return self.stored.record

    @property
    def figures(self) -> dict[str, float]:
        """All values by name, observables and others."""
        return {name.removeprefix(FIGURE): one.value for name, one in self.found.values.items()}


@dataclass(frozen=True)
class Job:
    """One run of a case. Jobs with the same overrides are run once."""

    case: Case
    overrides: tuple[str, ...]
    code: Code
    finest: bool = False  # of a tier: then its charts and its last field are kept
    cores: int = 1

    @property
    def label(self) -> str:
        return " ".join(self.overrides[len(self.case.base) :]) or "as declared"

    @cached_property
    def request(self) -> Request:
        return Request(self.code, scene_of(self.case, self.overrides), f"{self.case.name}: {self.label}", cores=self.cores, field=self.finest)

    @property
    def weight(self) -> float:
        """Core-seconds, about: the cost of the case, and from it by particles times steps where the spacing is another."""
        declared = self.case.scene.get("fluid", {}).get("spacing")
        spacing = scene_of(self.case, self.overrides).get("fluid", {}).get("spacing")
        if not isinstance(declared, (int, float)) or not isinstance(spacing, (int, float)):
            return self.case.cost
        return self.case.cost * (declared / spacing) ** (len(self.case.scene["box"]["size"]) + 1)


def jobs_of(case: Case, tier: str, code: Code, cores: int = 1) -> list[Job]:
    """Levels, variations and what is measured beside, without repeats."""
    if not case.observables:
        return []
    base = case.quick_finest().overrides
    sets = [level.overrides for level in case.levels_of(tier)]
    sets += [base + chosen for vary in case.vary for chosen in vary.sets]
    sets += [base] if case.vary else []
    sets += [base + beside.overrides for beside in case.beside]
    finest = {base, case.levels_of("full")[-1].overrides}
    return [Job(case, one, code, one in finest, cores) for one in dict.fromkeys(sets)]


# Measuring.


def measures_of(folder: Path) -> dict[str, Measure]:
    """By their names, those that all cases share and those of the case in a folder. Throws CaseError."""
    return OBSERVABLES | dict(measures_in(folder).observables)


def _names(case: Case, measures: Measures) -> list[str]:
    """Of what is measured of every run of a case. Throws CaseError where an observable does not exist."""
    known = measures_of(case.file.parent)
    names = list(dict.fromkeys(observable.name for observable in case.observables if not observable.skipped))
    for name in names:
        if name not in known:
            raise CaseError(f"{case.file}: case.observable.name = {name!r}: unknown; define it in "
                            f"{case.file.parent / 'measure.py'} or take one of {', '.join(sorted(known))}")
    return names + [FIGURE + name for name in measures.figures]


def _value(name: str, case: Case, run: Run) -> Measured:
    """A figure that the code states itself under that name counts in place of a measure."""
    if name.startswith(FIGURE):
        return Measured(float(measures_in(case.file.parent).figures[name.removeprefix(FIGURE)](run)), 0.0)
    stated = run.record.get("quantities", {}).get(name)
    if stated is not None:
        return Measured(stated["value"], stated["uncertainty"], run.record.get("objection", ""))
    return measures_of(case.file.parent)[name](run)


def measured(case: Case, run: Run, code: Code, with_charts: bool) -> Found:
    """All that the case asks of one run. Throws CaseError where the code did not leave what a measure needs."""
    measures = measures_in(case.file.parent)
    values = {}
    for name in _names(case, measures):
        try:
            values[name] = _value(name, case, run)
        except (KeyError, IndexError, FileNotFoundError) as error:
            raise CaseError(f"{case.name}: {name} by {code.name}: {error} in {run.folder}") from error
    charts = {OWN: _charts(measures, run)} if with_charts and measures.charts is not None else {}
    return Found(values, charts)


def _charts(measures: Measures, run: Run) -> list[dict]:
    """None where the code did not leave what they draw: a code that states its drag has no history of it."""
    try:
        return [kept_chart(chart) for chart in measures.charts(run)]
    except (KeyError, IndexError, FileNotFoundError):
        return []


def look_up(laboratory: Shelf, job: Job) -> Entry | None:
    """What the store has of a job; None where the run or something measured of it is missing. What was imported has no charts."""
    stored = laboratory.store.run(job.request.key)
    if stored is None:
        return None
    measures = measures_in(job.case.file.parent)
    found = laboratory.store.found(stored.key, measure_id(job.case.file.parent))
    whole = all(name in found.values for name in _names(job.case, measures))
    undrawn = job.finest and measures.charts is not None and OWN not in found.charts
    return None if not whole or (undrawn and laboratory.store.has_files(stored.key)) else Entry(stored, found)


def obtain(laboratory: Laboratory, job: Job, anew: bool = False) -> Entry:
    """From the store, or run and measured now. Throws SolverError, CaseError, Beyond and StoreError."""
    if not anew and (known := look_up(laboratory, job)) is not None:
        return known
    stored = laboratory.obtain(job.request, anew, folder_too=True)
    found = measured(job.case, laboratory.run(stored.key), job.code, job.finest)
    laboratory.store.enter_found(stored.key, measure_id(job.case.file.parent), found)
    return Entry(stored, found)


@contextmanager
def workers_of(count: int) -> Iterator[ThreadPoolExecutor]:
    """Threads that make runs. An error or an interruption ends what runs, and drops what waits."""
    with ThreadPoolExecutor(max(1, min(count, os.cpu_count() or 1))) as pool:
        try:
            yield pool
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            end_all()
            raise


Told = Callable[[Job, float], None]
Failed = Callable[[Job, Beyond | SolverError | CaseError], None]


def perform(laboratory: Laboratory, jobs: list[Job], workers: int, told: Told = lambda job, share: None, anew: bool = False,
            cheapest_first: bool = False, failed: Failed | None = None) -> None:
    """Makes all that is missing, the longest first, or the cheapest, `workers` at a time.

    `told` is called after each with the share of the expected work that is behind. A run that fails does not stop the others: it is
    told to `failed`, or its error is thrown when all have ended.
    """
    waiting = jobs if anew else [job for job in jobs if look_up(laboratory, job) is None]
    weights = {id(job): job.weight for job in waiting}
    total = sum(weights.values()) or 1.0
    behind, lock, failures = 0.0, threading.Lock(), []

    def one(job: Job) -> None:
        nonlocal behind
        try:
            obtain(laboratory, job, anew)
        except (Beyond, SolverError, CaseError) as error:
            with lock:
                behind += weights[id(job)]
            if failed is None:
                failures.append(error)
            else:
                failed(job, error)
            return
        with lock:
            behind += weights[id(job)]
            told(job, behind / total)

    ordered = sorted(waiting, key=lambda job: weights[id(job)], reverse=not cheapest_first)
    with workers_of(workers) as pool:
        for future in [pool.submit(one, job) for job in ordered]:
            future.result()
    if failures:
        raise failures[0]
