"""Verdicts on values, and what levels show. Equality of bits has its own: verification/bits/equivalence.py.

A value is held against its reference by ASME V&V 20: u_val = sqrt(u_num^2 + u_ref^2 + u_input^2), all standard uncertainties, 95 %
bounds halved, and k from Student's t where a source is the scatter of a few starts (student.py). With the goal of the manifest:

VALIDATED      |E| <= k u_val <= goal
WITHIN GOAL    |E| <= goal, but k u_val > goal, or no uncertainty is known, as where one of the runs that it is estimated from may
               not be used: nothing contradicts, nothing is resolved
FAILED         |E| > k u_val, or |E| > goal
CODE-TO-CODE   |E| <= goal, the reference being another code with the same law: a check of programming, no validation
INCONCLUSIVE   the value or the reference may not be used: forces out of balance, a reference code that failed, no number on a
               level or of a reference
SKIPPED        the reference or the capability is not there

Where the reference is 0 the value is itself an error, a norm for instance. It need not lie within its own uncertainty, as no limit
of it can be below 0: with |E| > k u_val it is WITHIN GOAL, unless it is below 0 and so no norm. A value that must be met exactly, with a goal of 0, is VALIDATED where it is met.

Where the finest level starts from a bare lattice and the scatter of disordered starts is known, the mean of these is judged as
well, as a value of its own.

What levels show is in ladder.py. DIVERGING fails whatever the error; a band that the manifest declares for the order must be met.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from verification.protocol.quantity import COVERAGE, Measured
from verification.suite.case import Case, Observable, Vary
from verification.suite.ladder import BAND, CONVERGING, DIVERGING, SAFETY, Convergence, converge, extrapolated, order_text
from verification.suite.runner import Entry
from verification.suite.student import coverage_of, factor_of

VALIDATED, WITHIN_GOAL, INCONCLUSIVE, FAILED = "VALIDATED", "WITHIN GOAL", "INCONCLUSIVE", "FAILED"
CODE_TO_CODE, SKIPPED = "CODE-TO-CODE", "SKIPPED"
VERDICTS = (FAILED, INCONCLUSIVE, VALIDATED, WITHIN_GOAL, CODE_TO_CODE, SKIPPED)  # as they are listed
GOOD = (VALIDATED, WITHIN_GOAL, CODE_TO_CODE, SKIPPED)  # nothing speaks against these
NOT_MEASURED = Measured(math.nan, 0.0)  # of an observable that is beyond the code


Entries = dict[tuple[str, ...], Entry]


@dataclass(frozen=True)
class Outcome:
    """One observable: what was measured on the finest level, and on the levels below it."""

    observable: Observable
    measured: Measured
    sources: Mapping[str, float] = field(default_factory=dict)  # standard uncertainties that make up u_num, absolute
    freedom: Mapping[str, int] = field(default_factory=dict)  # degrees of freedom of sources that are the scatter of a sample
    spacings: tuple[float, ...] = ()  # of the levels, coarse to fine; the spacing or the step
    levels: tuple[Measured, ...] = ()
    seeds: Mapping[str, tuple[float, ...]] = field(default_factory=dict)  # source: every value of its sample
    convergence: Convergence | None = None
    remark: str = ""  # of the manifest, on what the levels show
    doubt: str = ""  # why a run that the estimate of its error rests on may not be used, if so

    @property
    def scale(self) -> float:
        """What errors and goals are relative to."""
        reference = abs(self.observable.reference)
        return reference if reference > 0 else 1.0

    @property
    def error(self) -> float:
        """Relative to the reference; absolute where the reference is zero."""
        return (self.measured.value - self.observable.reference) / self.scale

    @property
    def u_num(self) -> float:
        """Relative, as the error is."""
        return math.hypot(*self.sources.values()) / self.scale

    @property
    def u_ref(self) -> float:
        """Standard uncertainty of the reference, relative, as u_num is."""
        return self.observable.uncertainty / self.scale

    @property
    def u_input(self) -> float:
        return self.observable.input / self.scale

    @property
    def uncertainty(self) -> float:
        """u_val, relative: numerical, of the reference and of the inputs together."""
        return math.hypot(self.u_num, self.u_ref, self.u_input)

    @property
    def coverage(self) -> float:
        """k."""
        known = [(u, self.freedom.get(source)) for source, u in self.sources.items()]
        return coverage_of([*known, (self.observable.uncertainty, None), (self.observable.input, None)])

    @property
    def bound(self) -> float:
        """k u_val, relative."""
        return self.coverage * self.uncertainty

    @property
    def is_estimated(self) -> bool:
        """Whether there is an estimate of the numerical error at all, beyond that of averages over time."""
        return not self.doubt and not set(self.sources) <= {"time"}

    @property
    def objection(self) -> str:
        """Why neither number may be held against the other, if so."""
        return "; ".join(filter(None, (self.measured.objection, self.observable.unusable, self._no_number)))

    @property
    def _no_number(self) -> str:
        """What of the judging is none, the value itself apart, which then has failed."""
        if math.isnan(self.observable.reference) and not self.observable.unusable:
            return "the reference is no number"
        return "" if math.isfinite(self.uncertainty) else "an estimate of its error is no number"

    @property
    def verdict(self) -> str:
        if self.observable.skipped:
            return SKIPPED
        if self.objection:
            return INCONCLUSIVE
        if not abs(self.error) <= self.observable.goal:
            return FAILED
        if self.observable.code_to_code:
            return CODE_TO_CODE
        return self._resolved

    @property
    def _resolved(self) -> str:
        """Of an error within the goal."""
        if self.observable.goal == 0.0:
            return VALIDATED
        if not self.is_estimated or not self.bound <= self.observable.goal:
            return WITHIN_GOAL
        if abs(self.error) <= self.bound:
            return VALIDATED
        return WITHIN_GOAL if self.observable.reference == 0 <= self.measured.value else FAILED

    @property
    def band(self) -> tuple[float, float]:
        return self.observable.order or BAND

    @property
    def state(self) -> str:
        """What the levels show; empty where there are fewer than three, or one of them may not be used."""
        return self.convergence.state if self.convergence and not self.doubt and self.verdict != SKIPPED else ""

    @property
    def converges_as_asked(self) -> bool:
        return self.state != DIVERGING and (self.observable.order is None or self.state in ("", CONVERGING))

    @property
    def holds(self) -> bool:
        """Nothing speaks against it. What was skipped neither passes nor fails."""
        return self.verdict in GOOD and self.converges_as_asked

    @property
    def explained(self) -> str:
        """Why it FAILED, where the manifest knows, and by no more than that explains. What levels show has no such excuse."""
        known = self.verdict == FAILED and self.converges_as_asked and abs(self.error) <= self.observable.explained_goal
        return self.observable.explained if known else ""

    @property
    def passes(self) -> bool:
        """It holds, or its miss is explained."""
        return self.holds or bool(self.explained)

    def in_words(self, value: float) -> str:
        return f"{100 * value:.2g} %" if self.observable.reference else f"{value:.2g}"

    @property
    def error_text(self) -> str:
        return f"{100 * self.error:+.2f} %" if self.observable.reference else f"{self.error:.2g}"

    @property
    def bound_text(self) -> str:
        """Empty where no uncertainty is known."""
        return self.in_words(self.bound) if self.is_estimated and self.verdict != SKIPPED else ""

    @property
    def state_text(self) -> str:
        """With the order; empty where there are no three levels."""
        if not self.state:
            return ""
        band = f" in [{self.band[0]:g}, {self.band[1]:g}]" if self.state == CONVERGING else ""
        return f"{self.state}, observed order {order_text(self.convergence.order)}{band}"

    @property
    def reason(self) -> str:
        """Of a verdict, in words."""
        goal = f"goal {self.in_words(self.observable.goal)}"
        if self.verdict == INCONCLUSIVE:
            return self.objection
        if self.verdict == SKIPPED:
            return self.observable.skipped
        if math.isnan(self.error):
            return "not a number"
        if abs(self.error) > self.observable.goal:
            return f"beyond the {goal}"
        if self.observable.goal == 0.0:
            return "met exactly"
        if not self.is_estimated:
            return f"{goal}, no estimate of its own error" + (f": {self.doubt}" if self.doubt else "")
        bound = f"k u = {self.bound_text}"
        if self.verdict == FAILED:
            return f"within the {goal}, but not explained by its uncertainty, {bound}"
        return f"{bound}, {goal}"

    @property
    def line(self) -> str:
        observable, measured = self.observable, self.measured
        if self.verdict == SKIPPED:
            return f"{observable.symbol} = {measured.value:.6g} ({SKIPPED}: {self.reason})"
        half_width = self.coverage * self.u_num * self.scale if self.sources else measured.uncertainty
        text = (
            f"{observable.symbol} = {measured.value:.6g} +- {half_width:.2g} (reference {observable.reference:g} +- "
            f"{observable.uncertainty:g}, error {self.error_text}, {self.verdict}: {self.reason}"
        )
        text += f"; {self.state_text}" if self.state else ""
        return text + (f"; explained: {self.explained})" if self.explained else ")")


def _height(case: Case, entry: Entry) -> float:
    """What levels refine."""
    return entry.scene["fluid"]["spacing"] if case.refined == "spacing" else entry.record["time_step"]


def _varied(vary: Vary, base: float, values: list[float]) -> float:
    """Standard uncertainty from one source of error."""
    if vary.seeds:
        return float(np.std(_starts(vary, base, values), ddof=1))
    if vary.ratio is None:  # a choice that might have been another: anywhere as far from it as the farthest tried
        return max(abs(value - base) for value in values) / math.sqrt(3)
    return SAFETY * abs(values[0] - base) / (1 - vary.ratio**-vary.order) / COVERAGE


def _starts(vary: Vary, base: float, values: list[float]) -> list[float]:
    """Of one distribution: the run itself is one of them unless it starts from a bare lattice."""
    return values if vary.from_lattice else [base, *values]


def _converge(case: Case, outcome: Outcome) -> Outcome:
    """With what its levels show."""
    observable = outcome.observable
    noise = max((math.sqrt(2) * factor_of(freedom) * outcome.sources[source] for source, freedom in outcome.freedom.items()), default=0.0)
    allowed = COVERAGE * math.hypot(*outcome.sources.values(), observable.uncertainty, observable.input)
    found = converge(outcome.spacings, [level.value for level in outcome.levels], observable.reference,
                     COVERAGE * observable.uncertainty, noise, allowed, outcome.band)
    source = "resolution" if case.refined == "spacing" else "step"
    return replace(outcome, convergence=found, sources={source: found.estimate.bound / COVERAGE} | outcome.sources)


def judge(case: Case, tier: str, entries: Entries) -> list[Outcome]:
    """`entries` by their overrides, those of runner.jobs_of."""
    outcomes = []
    for observable in case.observables:
        def of(overrides: tuple[str, ...], observable: Observable = observable) -> Measured:
            return entries[overrides].found.values.get(observable.name, NOT_MEASURED)

        def doubts(*sets: tuple[str, ...], of: Callable[[tuple[str, ...]], Measured] = of) -> str:
            return "; ".join(f"{' '.join(one)}: {of(one).objection}" for one in sets if of(one).objection)

        finished = [entries[level.overrides] for level in case.levels_of(tier)]
        levels = [of(level.overrides) for level in case.levels_of(tier)]
        sources = {"time": levels[-1].uncertainty} if levels[-1].uncertainty else {}
        base, freedom, seeds = case.quick_finest().overrides, {}, {}
        doubt = doubts(*dict.fromkeys([*(level.overrides for level in case.levels_of(tier)[:-1]), base,
                                       *(base + chosen for vary in case.vary for chosen in vary.sets)]))
        for vary in case.vary:
            values = [of(base + chosen).value for chosen in vary.sets]
            sources[vary.source] = _varied(vary, of(base).value, values)
            if vary.seeds:
                starts = _starts(vary, of(base).value, values)
                freedom[vary.source], seeds[vary.source] = len(starts) - 1, tuple(starts)
            if vary.from_lattice:
                sources["lattice"] = abs(float(np.mean(values)) - of(base).value)
        outcome = Outcome(_explained_for("value", observable), levels[-1], sources, freedom, tuple(_height(case, one) for one in finished), tuple(levels), seeds,
                          remark=case.remark, doubt=doubt)
        finest = _converge(case, outcome) if len(levels) > 1 else outcome
        outcomes.append(finest)
        if observable.extrapolated is not None and len(levels) > 2:
            outcomes.append(_at_zero(finest, observable))
        outcomes += [_of_starts(observable, finest, vary, seeds[vary.source], doubts(*(base + chosen for chosen in vary.sets)))
                     for vary in case.vary if vary.from_lattice]
    return outcomes


def _explained_for(row: str, observable: Observable) -> Observable:
    """Without an explanation that is of another row."""
    return observable if observable.explains in (row, "all") else replace(observable, explained="", explained_goal=0.0)


def _of_starts(observable: Observable, finest: Outcome, vary: Vary, values: tuple[float, ...], objection: str) -> Outcome:
    """The mean over disordered starts as an outcome of its own, with the same goal; the other errors are those of the lattice."""
    observable = replace(_explained_for("starts", observable), symbol=f"{observable.symbol}, {vary.source}", order=None, extrapolated=None)
    mean, scatter = float(np.mean(values)), float(np.std(values, ddof=1)) / math.sqrt(len(values))
    others = {name: u for name, u in finest.sources.items() if name not in (vary.source, "lattice")}
    return Outcome(observable, replace(finest.measured, value=mean, objection=objection), others | {"mean of starts": scatter},
                   {"mean of starts": len(values) - 1}, seeds={vary.source: values}, doubt=finest.doubt)


def _at_zero(finest: Outcome, asked: Observable) -> Outcome:
    """The value extrapolated over the levels as an outcome of its own, with its own goal."""
    found = extrapolated(finest.spacings, [level.value for level in finest.levels])
    objection = "; ".join(dict.fromkeys(filter(None, (level.objection for level in finest.levels))))
    observable = replace(_explained_for("extrapolated", asked), symbol=f"{asked.symbol}, dx to 0", goal=asked.extrapolated, order=None,
                         extrapolated=None)
    sources = {name: value for name, value in finest.sources.items() if name != "resolution"}
    return Outcome(observable, Measured(found.value, 0.0, objection), sources | {f"extrapolation ({found.how})": found.uncertainty},
                   finest.freedom, doubt=finest.doubt)


def beside(case: Case, entries: Entries) -> list[tuple[str, Outcome]]:
    """What the manifest asks to measure beside its case, by its label: reported as it is."""
    base = case.quick_finest().overrides
    return [
        (entry.label, Outcome(replace(observable, order=None), entries[base + entry.overrides].found.values[observable.name]))
        for entry in case.beside
        for observable in case.observables
        if not observable.skipped
    ]
