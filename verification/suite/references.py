"""References that are not written in a manifest: computed by another code for the case, or looked up for the scene."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from reference.published import look_up
from verification.codes.code import Code, find_code
from verification.measures.measures import Values, measures_in
from verification.protocol.errors import Beyond, CaseError, SolverError, last_line
from verification.protocol.quantity import Quantity, quantity_of
from verification.store.export import without_folders
from verification.store.laboratory import Laboratory, Request
from verification.suite.case import Case, Observable
from verification.suite.judge import Entries
from verification.suite.parameters import scene_of
from verification.suite.runner import Shelf


@dataclass(frozen=True)
class Reference:
    """What a reference code said of a case."""

    code: str
    version: str = ""
    command: str = ""  # makes it again
    inputs: str = ""  # SHA-256 of the files that the code was given
    quantities: Mapping[str, Quantity] = field(default_factory=dict)
    objection: str = ""  # why it cannot serve, if so
    missing: str = ""  # what is not installed, and how to get it
    key: str = ""  # of its run in the store


def reference_request(case: Case, tier: str, entries: Entries, code: Code) -> Request:
    """For the finest level of the tier; measure.py of the case may add options that follow from what was measured."""
    more = measures_in(case.file.parent).reference_options
    measured = more([Values(entry.scene, entry.figures) for entry in entries.values()]) if more else {}
    options = {"problem": case.live.problem} | case.live.options(tier) | measured
    return Request(code, scene_of(case, case.levels_of(tier)[-1].overrides), f"{case.name}: reference", options=options, field=True)


def look_up_reference(laboratory: Shelf, case: Case, tier: str, entries: Entries, code: Code) -> Reference | None:
    """What the store has; None where the code is to be run."""
    if code.missing:
        return Reference(code.title, missing=code.missing)
    stored = laboratory.store.run(reference_request(case, tier, entries, code).key)
    if stored is None:
        return None
    record = stored.record
    return Reference(code.title, stored.version, without_folders(record["command"]), record.get("inputs", ""),
                     {name: quantity_of(stated) for name, stated in record.get("quantities", {}).items()},
                     record.get("objection", ""), key=stored.key)


def obtain_reference(laboratory: Laboratory, case: Case, tier: str, entries: Entries) -> Reference:
    """From the store, or run now. Where the code fails, its last words are an objection, and nothing is kept."""
    code = find_code(case.live.code)
    known = look_up_reference(laboratory, case, tier, entries, code)
    if known is not None:
        return known
    try:
        laboratory.obtain(reference_request(case, tier, entries, code))
    except (SolverError, Beyond) as error:
        return Reference(code.title, code.version, objection=f"the reference code failed: {last_line(str(error))}")
    return look_up_reference(laboratory, case, tier, entries, code)


def _from_live(observable: Observable, live: Reference, case: Case) -> Observable:
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
    return replace(observable, reference=found.value, uncertainty=found.uncertainty, source=found.source,
                   input=observable.input or found.input)


def resolved(case: Case, live: Reference | None) -> Case:
    """The case with every reference filled in, or with why there is none. Throws CaseError."""
    found = []
    for observable in case.observables:
        if observable.live:
            found.append(_from_live(observable, live, case))
        else:
            found.append(_from_table(observable, case) if observable.published else observable)
    return replace(case, observables=tuple(found))
