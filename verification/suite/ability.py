"""What of a case a code can do."""

from dataclasses import replace

from verification.codes.code import Code
from verification.protocol.capability import DIGEST, asked_by, lacking
from verification.protocol.errors import Beyond
from verification.suite.case import Case, Observable

SOLVERS = ("mappm", "mappm-reference")  # what is varied, and run beside, is a knob of their method


def _with_reason(observable: Observable, code: Code) -> Observable:
    words = lacking(code.capabilities, set(observable.needs))
    return replace(observable, skipped=f"{code.name} lacks {', '.join(words)}") if words else observable


def able(case: Case, code: Code) -> Case:
    """The case as this code is asked it: an observable that is beyond it is marked as skipped, and bits are compared only of a code
    that has a digest. Throws Beyond where the scene itself is too much."""
    words = lacking(code.capabilities, asked_by(case.scene))
    if words:
        raise Beyond(f"{code.name} lacks {', '.join(words)}")
    own = {} if code.name in SOLVERS else {"vary": (), "beside": ()}
    observables = tuple(_with_reason(observable, code) for observable in case.observables)
    return replace(case, observables=observables, equivalence=case.equivalence if DIGEST in code.capabilities else None, **own)


def stated_alone(case: Case, code: Code, asked: Observable | None = None) -> Case:
    """What any code can be asked of the case: one observable, on one level and judged by its goal alone, with none of the knobs of one
    code: the one that is asked for, or the first that is held against no other code. Throws Beyond where this code cannot tell it."""
    found = able(case, code)
    observable = next(one for given, one in zip(case.observables, found.observables, strict=True)
                      if (given == asked if asked else not given.live))
    if observable.skipped:
        raise Beyond(observable.skipped)
    live = case.live if observable.live else None
    if live and live.code == code.name:
        raise Beyond("it is the reference")
    return replace(found, observables=(replace(observable, order=None, extrapolated=None),), levels=(), live=live, vary=(), beside=())
