"""Verdicts. CORRECT: against a reference. CONVERGING: over levels. UNCHANGED: bit by bit (equivalence.py).

The tolerance of CORRECT is worked out from uncertainties (ASME V&V 20): |S - D| <= k sqrt(u_num^2 + u_ref^2 + u_input^2)
with k = 2, and capped by the goal of the manifest, so that a noisy run cannot widen its way to a pass. All u are standard
uncertainties; 95 % bounds are halved. Where the reference is 0 the observable is itself the error (a norm): its tolerance
is the goal. Where a manifest offers no source of u_num, the goal alone decides, and the line says so.
"""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from verification.protocol.quantity import COVERAGE, Measured
from verification.suite.case import Case, Observable, Vary
from verification.suite.ladder import SAFETY, Convergence, converge, error_order, extrapolated
from verification.suite.runner import Entry

CORRECT, WRONG, OPEN, SKIPPED = "CORRECT", "WRONG", "NOT ACCEPTED", "SKIPPED"
NOT_MEASURED = Measured(math.nan, 0.0)  # of an observable that is beyond the code
CONVERGING, NOT_CONVERGING, STALLED = "CONVERGING", "NOT CONVERGING", "STALLED"


Entries = dict[tuple[str, ...], Entry]


@dataclass(frozen=True)
class Outcome:
    """One observable: what was measured on the finest level, and on the levels below it."""

    observable: Observable
    measured: Measured
    sources: dict[str, float] = field(default_factory=dict)  # standard uncertainties that make up u_num, absolute
    spacings: tuple[float, ...] = ()  # of the levels, coarse to fine; the spacing or the step
    levels: tuple[Measured, ...] = ()
    convergence: Convergence | None = None
    stalls: str = ""

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
    def uncertainty(self) -> float:
        """u_val, relative: numerical, of the reference and of the inputs together."""
        return math.hypot(self.u_num, self.u_ref, self.observable.input / self.scale)

    @property
    def by_goal_alone(self) -> bool:
        return self.observable.reference == 0 or set(self.sources) <= {"time"}

    @property
    def tolerance(self) -> float:
        if self.by_goal_alone:
            return self.observable.goal
        return min(self.observable.goal, COVERAGE * self.uncertainty)

    @property
    def objection(self) -> str:
        """Why neither number may be held against the other, if so."""
        return "; ".join(filter(None, (self.measured.objection, self.observable.unusable)))

    @property
    def verdict(self) -> str:
        if self.observable.skipped:
            return SKIPPED
        if self.objection:
            return OPEN
        return CORRECT if abs(self.error) <= self.tolerance else WRONG

    @property
    def order(self) -> float:
        """Observed order: of the error where the reference is exact, of the differences of levels where it is not."""
        if len(self.levels) < 3:
            return math.nan
        if self.observable.uncertainty == 0.0:
            return error_order(list(self.spacings), [level.value - self.observable.reference for level in self.levels])
        return self.convergence.order

    @property
    def order_text(self) -> str:
        return "none: not monotonic" if math.isnan(self.order) else f"{self.order:.2f}"

    @property
    def u_ref(self) -> float:
        """Standard uncertainty of the reference, relative, as u_num is."""
        return self.observable.uncertainty / self.scale

    @property
    def convergence_verdict(self) -> str:
        """Empty where the manifest asks for none."""
        if self.observable.order is None or self.verdict == SKIPPED:
            return STALLED if self.stalls and len(self.levels) > 2 else ""
        lowest, highest = self.observable.order
        return CONVERGING if lowest <= self.order <= highest else NOT_CONVERGING

    @property
    def holds(self) -> bool:
        """Nothing speaks against it. What was skipped neither passes nor fails."""
        return self.verdict in (CORRECT, SKIPPED) and self.convergence_verdict != NOT_CONVERGING

    @property
    def explained(self) -> str:
        """Why it is WRONG, where the manifest knows, and by no more than that explains."""
        known = self.verdict == WRONG and abs(self.error) <= self.observable.explained_goal
        return self.observable.explained if known and self.convergence_verdict != NOT_CONVERGING else ""

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
    def reason(self) -> str:
        """Of a verdict other than CORRECT."""
        if self.verdict == OPEN:
            return self.objection
        if self.verdict == SKIPPED:
            return self.observable.skipped
        if self.verdict == CORRECT:
            return ""
        if math.isnan(self.error):
            return "not a number"
        if abs(self.error) > self.observable.goal:
            why = f"; explained: {self.explained}" if self.explained else ""
            return f"beyond the goal {self.in_words(self.observable.goal)}{why}"
        return f"within the goal, but not explained by its uncertainty (k u = {self.in_words(self.tolerance)})"

    @property
    def line(self) -> str:
        observable, measured = self.observable, self.measured
        if self.verdict == SKIPPED:
            return f"{observable.symbol} = {measured.value:.6g} ({SKIPPED}: {self.reason})"
        half_width = COVERAGE * self.u_num * self.scale if self.sources else measured.uncertainty
        basis = f"goal {self.in_words(observable.goal)}"
        if not self.by_goal_alone:
            basis = f"k u = {self.in_words(COVERAGE * self.uncertainty)}, {basis}"
        text = (
            f"{observable.symbol} = {measured.value:.6g} +- {half_width:.2g} (reference {observable.reference:g} +- "
            f"{observable.uncertainty:g}, error {self.error_text}, {self.verdict}"
        )
        text += f": {self.reason}" if self.reason else f" by {basis}"
        if self.convergence_verdict:
            text += f"; {self.convergence_verdict}, observed order {self.order_text}"
            if observable.order:
                text += f" in [{observable.order[0]:g}, {observable.order[1]:g}]"
        return text + ")"


def _height(case: Case, entry: Entry) -> float:
    """What levels refine."""
    return entry.scene["fluid"]["spacing"] if case.refined == "spacing" else entry.record["time_step"]


def _varied(vary: Vary, base: Measured, values: list[float]) -> float:
    """Standard uncertainty from one source of error."""
    if vary.ratio is None:
        return float(np.std([base.value, *values], ddof=1))
    return SAFETY * abs(values[0] - base.value) / (1 - vary.ratio**-vary.order) / COVERAGE


def judge(case: Case, tier: str, entries: Entries) -> list[Outcome]:
    """`entries` by their overrides, those of runner.jobs_of."""
    outcomes = []
    for observable in case.observables:
        def of(overrides: tuple[str, ...], observable: Observable = observable) -> Measured:
            return entries[overrides].found.values.get(observable.name, NOT_MEASURED)

        finished = [entries[level.overrides] for level in case.levels_of(tier)]
        levels = [of(level.overrides) for level in case.levels_of(tier)]
        heights = [_height(case, one) for one in finished]
        sources, convergence = {"time": levels[-1].uncertainty} if levels[-1].uncertainty else {}, None
        if len(levels) > 1:
            convergence = converge(heights, [level.value for level in levels])
            sources["resolution" if case.refined == "spacing" else "step"] = convergence.gci / COVERAGE
        base = case.quick_finest().overrides
        for vary in case.vary:
            values = [of(base + chosen).value for chosen in vary.sets]
            sources[vary.source] = _varied(vary, of(base), values)
        outcomes.append(
            Outcome(observable, levels[-1], sources, tuple(heights), tuple(levels), convergence, case.stalls)
        )
        if observable.extrapolated is not None and len(levels) > 2:
            outcomes.append(_at_zero(outcomes[-1]))
    return outcomes


def _at_zero(finest: Outcome) -> Outcome:
    """The value extrapolated over the levels as an outcome of its own, with its own goal."""
    found = extrapolated(list(finest.spacings), [level.value for level in finest.levels])
    objection = "; ".join(dict.fromkeys(filter(None, (level.objection for level in finest.levels[-found.used :]))))
    observable = replace(finest.observable, symbol=f"{finest.observable.symbol}, dx to 0",
                         goal=finest.observable.extrapolated, order=None, extrapolated=None)
    sources = {name: value for name, value in finest.sources.items() if name != "resolution"}
    return Outcome(observable, Measured(found.value, 0.0, objection), sources | {f"extrapolation ({found.how})": found.uncertainty})


def beside(case: Case, entries: Entries) -> list[tuple[str, Outcome]]:
    """What the manifest asks to measure beside its case, by its label: reported as it is."""
    base = case.quick_finest().overrides
    return [
        (entry.label, Outcome(replace(observable, order=None), entries[base + entry.overrides].found.values[observable.name]))
        for entry in case.beside
        for observable in case.observables
        if not observable.skipped
    ]
