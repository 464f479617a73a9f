"""References that are not written in a manifest: computed by another code in the same report, or looked up for the scene."""

import shutil
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

from reference.published import look_up
from verification.protocol.errors import CaseError
from verification.protocol.machine import ROOT, cores
from verification.protocol.quantity import Result, read_result
from verification.protocol.run import Run
from verification.suite.case import Case, Observable
from verification.suite.judge import own
from verification.suite.parameters import overrides_of

USAGE = 2  # exit code of a reference program on input that a user can mend


@dataclass(frozen=True)
class LiveRun:
    """A run of the reference code: its result, and the folder of the files that the result names."""

    result: Result
    folder: Path


def _from_root(path: Path) -> str:
    """As a command called in the root of the repository may name it."""
    whole = path.resolve()
    return str(whole.relative_to(ROOT) if whole.is_relative_to(ROOT) else whole)


def live_command(case: Case, tier: str, runs: dict[tuple[str, ...], Run], folder: Path) -> list[str]:
    """For the finest level of the tier; measure.py of the case may add options that depend on the runs."""
    options = own(case, "live_options")
    measured = options(runs) if options else []
    line = ["python3", "-m", f"reference.{case.live.code}", case.live.problem]
    line += ["--scene", _from_root(case.file), "--out", _from_root(folder)]
    for override in overrides_of(case, case.levels_of(tier)[-1].overrides):
        line += ["--set", override]
    return [*line, *case.live.options(tier), *measured]


def run_live(case: Case, tier: str, runs: dict[tuple[str, ...], Run], out: Path) -> LiveRun:
    """Runs the reference code into out/CASE/live. Where it fails the result carries its last words as an objection."""
    folder = out / case.name / "live"
    shutil.rmtree(folder, ignore_errors=True)
    line = live_command(case, tier, runs, folder)
    done = subprocess.run([sys.executable, *line[1:]], cwd=ROOT, capture_output=True, text=True)
    last = (done.stderr.strip().splitlines() or ["no message"])[-1]
    if done.returncode == USAGE:
        raise CaseError(last)
    if done.returncode != 0:
        failed = Result(case.live.code, command=" ".join(line), objection=f"the reference code failed: {last}")
        return LiveRun(failed, folder)
    return LiveRun(read_result(folder), folder)


Say = Callable[[str], None]


def run_all_live(cases: list[Case], tier: str, runs: dict[str, dict], out: Path, say: Say) -> dict[str, LiveRun]:
    """Of all `cases` that have one, by their names; `runs` likewise."""
    with ThreadPoolExecutor(cores()) as pool:
        futures = {case.name: pool.submit(run_live, case, tier, runs[case.name], out) for case in cases if case.live}
        found = {}
        for name, future in futures.items():
            found[name] = future.result()
            say(f"{len(found)} of {len(futures)}, last {name}")
        return found


def _from_live(observable: Observable, live: Result, case: Case) -> Observable:
    if live.missing:
        return replace(observable, skipped=live.missing, source=live.missing)
    if observable.live not in live.quantities:
        why = live.objection or f"{live.code} gave no {observable.live}; it gave {', '.join(live.quantities)}"
        return replace(observable, unusable=why, source=live.code)
    found = live.quantities[observable.live]
    source = f"{live.code} {live.version}, {case.live.problem}" + (f": {found.note}" if found.note else "")
    return replace(observable, reference=found.value, uncertainty=found.uncertainty, source=source, unusable=live.objection)


def _from_table(observable: Observable, case: Case) -> Observable:
    try:
        found = look_up(observable.published, case.scene)
    except (KeyError, ValueError) as error:
        raise CaseError(f"{case.file}: case.observable.published = {observable.published!r}: {error}") from None
    return replace(observable, reference=found.value, uncertainty=found.uncertainty, source=found.source)


def resolved(case: Case, live: Result | None) -> Case:
    """The case with every reference filled in, or with why there is none. Throws CaseError."""
    found = []
    for observable in case.observables:
        if observable.live:
            found.append(_from_live(observable, live, case))
        else:
            found.append(_from_table(observable, case) if observable.published else observable)
    return replace(case, observables=tuple(found))
