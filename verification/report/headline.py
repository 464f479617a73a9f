"""What the first lines of the report count, and what changed of goals and bands since they were first set."""

from collections import Counter
from dataclasses import dataclass
from datetime import date
from itertools import pairwise

from verification.suite.case import Case, Observable, Retired, Standard
from verification.suite.judge import VERDICTS
from verification.suite.ladder import CONVERGING, DIVERGING, NOISE_LIMITED, NOT_CONVERGING
from verification.suite.result import CaseResult

STATES = (DIVERGING, NOT_CONVERGING, NOISE_LIMITED, CONVERGING)


@dataclass(frozen=True)
class Headline:
    """Of both tiers together."""

    verdicts: dict[str, int]  # every verdict, none left out
    states: dict[str, int]  # what levels show
    explained: int  # of those that do not hold
    unjudged: tuple[str, ...]  # cases whose manifest asks for no verdict on a value
    absent: int  # cases that were not run at this numerics version
    stale: int  # runs of an older one

    @property
    def text(self) -> str:
        """One line."""
        counts = ", ".join(f"{number} {verdict}" for verdict, number in self.verdicts.items() if number)
        more = ((self.states[DIVERGING], DIVERGING), (self.explained, "of the failed explained"), (len(self.unjudged), "cases without a verdict on a value"),
                (self.absent, "cases not run"), (self.stale, "stale runs"))
        return "; ".join([counts, *(f"{number} {what}" for number, what in more if number)])


def headline(results: list[CaseResult], absent: list[str], stale: int) -> Headline:
    outcomes = [outcome for result in results for outcome in result.outcomes]
    verdicts, states = Counter(outcome.verdict for outcome in outcomes), Counter(outcome.state for outcome in outcomes)
    unjudged = tuple(sorted({result.case.family for result in results if not result.outcomes}))
    return Headline({verdict: verdicts[verdict] for verdict in VERDICTS}, {state: states[state] for state in STATES},
                    sum(bool(outcome.explained) for outcome in outcomes), unjudged, len(absent), stale)


@dataclass(frozen=True)
class Change:
    """Of what an observable has to meet; `after` is None where it is judged no more."""

    case: str
    symbol: str
    day: date
    before: Standard | None  # None where only the reason of the first is told
    after: Standard | None
    why: str

    @property
    def kind(self) -> str:
        if self.after is None:
            return "left out"
        if self.before is None:
            return "set"
        return "looser" if self.after.is_looser_than(self.before) else "tighter"


def standard_text(standard: Standard | None) -> str:
    """The goal as the manifest has it: relative, or absolute where the reference is 0."""
    if standard is None:
        return ""
    band = f", order in [{standard.order[0]:g}, {standard.order[1]:g}]" if standard.order else ""
    return f"{standard.goal:g}{band}" + (f", dx to 0 {standard.extrapolated:g}" if standard.extrapolated is not None else "")


def _of_one(case: str, one: Observable | Retired) -> list[Change]:
    standards = [*one.earlier, one.standard]
    told = [Change(case, one.symbol, standards[0].since, None, standards[0], standards[0].why)] if standards[0].why else []
    told += [Change(case, one.symbol, after.since, before, after, after.why) for before, after in pairwise(standards)]
    return told + ([Change(case, one.symbol, one.until, one.standard, None, one.reason)] if isinstance(one, Retired) else [])


def of_families(cases: list[Case]) -> list[tuple[str, Case]]:
    """(name, case): one point stands for a family, and points whose goals differ from its stand for themselves."""
    found: dict[str, Case] = {}
    for case in cases:
        held = found.get(case.family)
        if held is None or (len(case.observables), _bands(case)) > (len(held.observables), _bands(held)):
            found[case.family] = case
    others = [(case.name, case) for case in cases if case.observables and _bands(case) != _bands(found[case.family])]
    return [*found.items(), *others]


def _bands(case: Case) -> int:
    return sum(observable.order is not None for observable in case.observables)


def changes_of_standards(cases: list[Case]) -> list[Change]:
    """The loosened first, then by day."""
    families = of_families(cases)
    found = [change for name, case in families for one in (*case.observables, *case.retired) for change in _of_one(name, one)]
    order = ("left out", "looser", "set", "tighter")
    return sorted(dict.fromkeys(found), key=lambda change: (order.index(change.kind), change.day, change.case))
