"""python3 -m verification store list | show | export | import | prune."""

import json
from pathlib import Path

from verification.codes.code import find_code
from verification.protocol.errors import CaseError
from verification.store.export import export, import_into
from verification.store.laboratory import Laboratory
from verification.store.store import Store, StoredRun


def _code_of(run: StoredRun) -> str:
    return f"{run.code} {run.version}" if run.numerics is None else f"{run.code} numerics {run.numerics}"


def list_runs(store: Store, code: str | None) -> int:
    runs = store.runs(code)
    for run in runs:
        cost = f"{run.cost.core_seconds:8.3g} core-s" if run.cost else ""
        print(f"{run.key[:12]}  {_code_of(run):24} {run.made.made[:16]} {cost:16}  {run.label}")
    print(f"{len(runs)} runs in {store.file}")
    return 0


def show(store: Store, start: str) -> int:
    found = [run for run in store.runs() if run.key.startswith(start)]
    if len(found) != 1:
        raise CaseError(f"{start}: {len(found)} runs have a key that starts so; `store list` prints them")
    (run,) = found
    print(f"{run.label}\n{_code_of(run)}, made {run.made.when} on {run.made.machine}, source {run.made.source}\n{run.made.command}")
    for made, cost in store.costs(run.key):
        print(f"took {cost.core_seconds:.3g} core-seconds and {cost.setup_core_seconds:.3g} to set up, {cost.wall_seconds:.3g} s on "
              f"{cost.cores} cores, {cost.peak_memory / 2**20:.0f} MiB, {made.when} on {made.machine}")
    for measure, name, one in store.all_found(run.key):
        print(f"{name} = {one.value:.10g} +- {one.uncertainty:.2g}{' (' + one.objection + ')' if one.objection else ''}, measure {measure}")
    print(json.dumps({"scene": run.scene, "options": run.options, "steps": run.steps}, indent=1))
    return 0


def export_store(store: Store, file: Path) -> int:
    print(f"{export(store, file)} rows in {file}")
    return 0


def import_store(store: Store, file: Path) -> int:
    print(f"{import_into(store, file)} rows of {file} are new")
    return 0


def _numerics_of(name: str) -> int | None:
    """Of a code that is here; None where it is not."""
    try:
        return find_code(name).numerics_version
    except CaseError:
        return None


def prune(laboratory: Laboratory, folders: bool) -> int:
    """Stale are runs of an older numerics version of a code that is here."""
    if folders:
        print(f"{laboratory.drop_folders() / 2**20:.0f} MiB of folders removed; the store is as it was")
    counted = [run for run in laboratory.store.runs() if run.numerics is not None]
    now = {code: _numerics_of(code) for code in {run.code for run in counted}}
    stale = [run.key for run in counted if now[run.code] not in (None, run.numerics)]
    print(f"{laboratory.store.remove(stale)} stale runs removed, and what codes refused or failed at is forgotten")
    laboratory.store.forget_refusals()
    return 0
