"""What an error costs: the results of a study as points of error against core-seconds, and the front of the cheapest."""

import math
import statistics
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from verification.codes.code import Code
from verification.store.key import canonical_scene, hash_of
from verification.store.store import Store
from verification.studies.study import Result, Setting, Study, command_of
from verification.suite.runner import Job

ASKED = 0.01  # the error whose price is told
WIDE = 10.0  # ratio of costs that a front must span for a slope


@dataclass(frozen=True)
class Point:
    """One setting of one code. Errors are relative to the reference, or absolute where that is zero."""

    block: str
    setting: Setting  # of the first start
    code: Code
    job: Job  # of the first start
    errors: tuple[float, ...] = ()  # signed, one a start; empty where no run has a value
    seconds: tuple[float, ...] = ()  # core-seconds without set-up, of all starts and repeats on one machine
    setup: float = 0.0  # core-seconds of set-up, the median
    machine: str = ""
    commit: str = ""
    objection: str = ""  # why the error may not be trusted
    why: str = ""  # of a setting that failed or was refused

    @property
    def error(self) -> float:
        """Root mean square over the starts: what one run has to expect. NaN without a value."""
        return math.sqrt(float(np.mean(np.square(self.errors)))) if self.errors else math.nan

    @property
    def error_range(self) -> tuple[float, float]:
        """Smallest and largest magnitude over the starts."""
        sizes = [abs(one) for one in self.errors]
        return min(sizes), max(sizes)

    @property
    def cost(self) -> float:
        """The median of core-seconds without set-up."""
        return statistics.median(self.seconds) if self.seconds else math.nan

    @property
    def counts(self) -> bool:
        """Whether it may lie on a front."""
        return math.isfinite(self.error) and self.cost > 0 and not self.objection


def _point(store: Store, results: list[Result]) -> Point:
    """Of the starts of one setting."""
    first = results[0]
    made = [result for result in results if result.entry is not None]
    if len(made) < len(results):
        failed = next(result for result in results if result.entry is None)
        return Point(first.block, first.setting, first.code, failed.job, why=failed.why)
    costs = [(run_made.machine, cost) for result in made for run_made, cost in store.costs(result.entry.stored.key)]
    machine = made[-1].entry.stored.made.machine
    here = [cost for where, cost in costs if where == machine]
    objection = next((result.outcome.objection for result in made if result.outcome.objection), "")
    return Point(
        first.block, first.setting, first.code, first.job, tuple(result.outcome.error for result in made),
        tuple(cost.core_seconds for cost in here), statistics.median(cost.setup_core_seconds for cost in here) if here else 0.0,
        machine, made[-1].entry.stored.made.source, objection,
    )


def _without_start(scene: dict) -> str:
    """What runs of one point have in common: all of the scene but the seed of its disorder."""
    fluid = dict(scene.get("fluid", {}))
    if isinstance(fluid.get("disorder"), dict):
        fluid["disorder"] = {key: value for key, value in fluid["disorder"].items() if key != "seed"}
    return hash_of(canonical_scene(scene | {"fluid": fluid}))


def points_of(store: Store, results: list[Result]) -> list[Point]:
    """In the order of the study. Scenes that differ in the seed of their disorder alone are starts of one point."""
    groups: dict[tuple[str, str], list[Result]] = {}
    for result in results:
        groups.setdefault((result.code.name, _without_start(result.job.request.scene)), []).append(result)
    return [_point(store, group) for group in groups.values()]


def front_of(points: list[Point], floor: float = 0.0) -> list[Point]:
    """Those that no other undercuts in error and in cost at once, from cheap to dear. Errors below the floor are alike."""
    front: list[Point] = []
    for point in sorted((one for one in points if one.counts), key=lambda one: (one.cost, one.error)):
        if not front or max(point.error, floor) < max(front[-1].error, floor):
            front.append(point)
    return front


def floor_of(results: list[Result]) -> float:
    """Twice the standard uncertainty of the reference, relative as the errors are: below it no error means anything."""
    found = [2 * one.outcome.observable.uncertainty / one.outcome.scale for one in results if one.outcome is not None]
    return max(found, default=0.0)


def slope_of(front: list[Point], floor: float) -> float | None:
    """d log(error) / d log(core-seconds) along a front, of its points above the floor; None of fewer than three, or over less than a
    decade of cost."""
    above = [point for point in front if point.error > floor]
    if len(above) < 3 or above[-1].cost < WIDE * above[0].cost:
        return None
    return float(np.polyfit(np.log([point.cost for point in above]), np.log([point.error for point in above]), 1)[0])


def digit_of(slope: float | None) -> float | None:
    """By how much a tenth of the error costs more, where a front has a slope; infinite where it is flat."""
    if slope is None:
        return None
    return 10 ** (-1 / slope) if slope < -0.01 else math.inf


def price_of(front: list[Point], error: float, floor: float = 0.0) -> float | None:
    """Core-seconds for an error, between two points of the front along a power law; None where the front does not come so far, or the
    reference cannot tell."""
    if not front or error < floor or front[-1].error > error:
        return None
    after = next(k for k, point in enumerate(front) if point.error <= error)
    if after == 0:
        return front[0].cost
    low, high = front[after - 1], front[after]
    if high.error <= 0:
        return high.cost
    share = math.log(low.error / error) / math.log(low.error / high.error)
    return math.exp(math.log(low.cost) + share * math.log(high.cost / low.cost))


@dataclass(frozen=True)
class Front:
    """Of one code: its cheapest settings, and what they cost."""

    name: str
    title: str
    price: float | None  # core-seconds for ASKED; None where no setting comes so far
    least: float  # error, or the floor where it is below that
    slope: float | None
    digit: float | None  # times the cost for a tenth of the error
    lines: tuple[tuple[float, float, float, str], ...]  # error, core-seconds, those of set-up, command


def fronts_of(study: Study, points: list[Point], floor: float) -> list[Front]:
    """Of the codes that have one."""
    found = []
    for name, members in by_code(points).items():
        if front := front_of(members, floor):
            slope = slope_of(front, floor)
            lines = tuple((point.error, point.cost, point.setup, command_of(study, point.job)) for point in front)
            found.append(Front(name, front[0].code.title, price_of(front, ASKED, floor), max(front[-1].error, floor), slope,
                               digit_of(slope), lines))
    return found


def lines_of_fronts(fronts: Iterable[Front]) -> list[str]:
    """What an error of 1 % costs, the slope, what one digit more costs, and the settings."""
    lines = []
    for front in fronts:
        reached = f"1 % costs {front.price:.3g} core-seconds" if front.price is not None else ""
        digit = f", slope {front.slope:.2g}, one digit more {front.digit:.3g} times as much" if front.slope is not None else ""
        lines.append(f"front of {front.name}: {reached or f'1 % is not reached; the least is {100 * front.lines[-1][0]:.2g} %'}{digit}")
        lines += [f"  {100 * error:8.3g} %  {cost:8.3g} s and {setup:.2g} s of set-up  {line}" for error, cost, setup, line in front.lines]
    return lines


def by_code(points: list[Point]) -> dict[str, list[Point]]:
    """By the name of the code, in the order of the points."""
    found: dict[str, list[Point]] = {}
    for point in points:
        found.setdefault(point.code.name, []).append(point)
    return found


HEAD = ("code", "block", "setting", "error", "signed error of the first start", "least error", "largest error", "core-seconds",
        "least core-seconds", "most core-seconds", "set-up core-seconds", "starts", "timings", "on the front", "why no value, or no trust", "commit", "machine", "command")


def rows_of(study: Study, points: list[Point], floor: float) -> list[tuple]:
    """As HEAD names them, a row a point."""
    on_front = {id(point) for members in by_code(points).values() for point in front_of(members, floor)}
    rows = []
    for point in points:
        low, high = point.error_range if point.errors else (math.nan, math.nan)
        least, most = (min(point.seconds), max(point.seconds)) if point.seconds else (math.nan, math.nan)
        rows.append((point.code.name, point.block, " ".join(point.setting) or "as declared", point.error,
                     point.errors[0] if point.errors else math.nan, low, high, point.cost, least, most,
                     point.setup, len(point.errors), len(point.seconds), "yes" if id(point) in on_front else "no",
                     point.why or point.objection, point.commit, point.machine, command_of(study, point.job)))
    return rows
