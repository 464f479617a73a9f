"""What an error costs: the results of a study as points of error against core-seconds, and the front of the cheapest."""

import math
import shlex
import statistics
from dataclasses import dataclass

import numpy as np

from verification.codes.code import Code
from verification.protocol.machine import ROOT
from verification.store.store import Store
from verification.studies.study import Result, Setting, Study
from verification.suite.parameters import overrides_of
from verification.suite.runner import Job

START = "fluid.disorder="  # settings that differ in it alone are starts of one point


@dataclass(frozen=True)
class Point:
    """One setting of one code. Errors are relative to the reference, or absolute where that is zero."""

    block: str
    setting: Setting  # without the start
    code: Code
    job: Job  # of the first start
    errors: tuple[float, ...] = ()  # signed, one a start; empty where no run has a value
    seconds: tuple[float, ...] = ()  # core-seconds without set-up, of all starts and repeats on one machine
    setup: float = 0.0  # core-seconds of set-up, the median
    machine: str = ""
    commit: str = ""
    objection: str = ""  # why the value may not be trusted
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
        return bool(self.errors) and math.isfinite(self.error) and not self.objection


def _point(store: Store, results: list[Result]) -> Point:
    """Of the starts of one setting."""
    first = results[0]
    made = [result for result in results if result.entry is not None]
    setting = tuple(text for text in first.setting if not text.startswith(START))
    if len(made) < len(results):
        failed = next(result for result in results if result.entry is None)
        return Point(first.block, setting, first.code, failed.job, why=failed.why)
    costs = [(run_made.machine, cost) for result in made for run_made, cost in store.costs(result.entry.stored.key)]
    machine = made[-1].entry.stored.made.machine
    here = [cost for where, cost in costs if where == machine]
    objection = next((result.outcome.measured.objection for result in made if result.outcome.measured.objection), "")
    return Point(
        first.block, setting, first.code, first.job, tuple(result.outcome.error for result in made),
        tuple(cost.core_seconds for cost in here), statistics.median(cost.setup_core_seconds for cost in here) if here else 0.0,
        machine, made[-1].entry.stored.made.source, objection,
    )


def points_of(store: Store, results: list[Result]) -> list[Point]:
    """In the order of the study."""
    groups: dict[tuple, list[Result]] = {}
    for result in results:
        setting = tuple(text for text in result.setting if not text.startswith(START))
        groups.setdefault((result.code.name, setting), []).append(result)
    return [_point(store, group) for group in groups.values()]


def front_of(points: list[Point]) -> list[Point]:
    """Those that no other undercuts in error and in cost at once, from cheap to dear."""
    front: list[Point] = []
    for point in sorted((one for one in points if one.counts), key=lambda one: (one.cost, one.error)):
        if not front or point.error < front[-1].error:
            front.append(point)
    return front


def floor_of(results: list[Result]) -> float:
    """Twice the standard uncertainty of the reference, relative as the errors are: below it no error means anything."""
    found = [2 * one.outcome.observable.uncertainty / one.outcome.scale for one in results if one.outcome is not None]
    return max(found, default=0.0)


def slope_of(front: list[Point], floor: float) -> float | None:
    """d log(error) / d log(core-seconds) along a front, of its points above the floor; None of fewer than three."""
    above = [point for point in front if point.error > floor]
    if len(above) < 3:
        return None
    return float(np.polyfit(np.log([point.cost for point in above]), np.log([point.error for point in above]), 1)[0])


def price_of(front: list[Point], error: float) -> float | None:
    """Core-seconds for an error, between two points of the front along a power law; None where the front does not come so far."""
    if not front or front[-1].error > error:
        return None
    after = next(k for k, point in enumerate(front) if point.error <= error)
    if after == 0:
        return front[0].cost
    low, high = front[after - 1], front[after]
    if high.error <= 0:
        return high.cost
    share = math.log(low.error / error) / math.log(low.error / high.error)
    return math.exp(math.log(low.cost) + share * math.log(high.cost / low.cost))


def line_of(study: Study, point: Point) -> str:
    """Makes the run of a point again: by the solver itself, or by the suite where the code is another."""
    if point.code.name == "mappm":
        file = study.case.file.relative_to(ROOT) if study.case.file.is_relative_to(ROOT) else study.case.file
        words = ["mappm", "run", str(file), *(f"--set {shlex.quote(text)}" for text in overrides_of(study.case, point.job.overrides))]
        return " ".join(words)
    sets = [f"--set {shlex.quote(text)}" for text in point.setting]
    return " ".join(["python3 -m verification run", study.case.name, "--code", point.code.name, *sets])


def lines_of_fronts(study: Study, points: list[Point], floor: float) -> list[str]:
    """The front of each code, what an error of 1 % costs, and what one digit more does."""
    lines = []
    for name, members in by_code(points).items():
        front = front_of(members)
        if not front:
            continue
        slope, price = slope_of(front, floor), price_of(front, 0.01)
        costs = f"1 % costs {price:.3g} core-seconds" if price is not None else f"no setting comes below {100 * front[-1].error:.2g} %"
        digit = f", one digit more {10 ** (-1 / slope):.3g} times as much" if slope is not None and slope < 0 else ""
        lines.append(f"front of {name}: {costs}{digit}")
        lines += [f"  {100 * point.error:8.3g} %  {point.cost:8.3g} s  {line_of(study, point)}" for point in front]
    return lines


def by_code(points: list[Point]) -> dict[str, list[Point]]:
    """By the name of the code, in the order of the points."""
    found: dict[str, list[Point]] = {}
    for point in points:
        found.setdefault(point.code.name, []).append(point)
    return found


HEAD = ("code", "block", "setting", "error", "least error", "largest error", "core-seconds", "least core-seconds", "most core-seconds",
        "set-up core-seconds", "starts", "timings", "on the front", "why no value, or no trust", "commit", "machine", "command")


def rows_of(study: Study, points: list[Point]) -> list[tuple]:
    """As HEAD names them, a row a point."""
    on_front = {id(point) for members in by_code(points).values() for point in front_of(members)}
    rows = []
    for point in points:
        low, high = point.error_range if point.errors else (math.nan, math.nan)
        least, most = (min(point.seconds), max(point.seconds)) if point.seconds else (math.nan, math.nan)
        rows.append((point.code.name, point.block, " ".join(point.setting) or "as declared", point.error, low, high, point.cost, least, most,
                     point.setup, len(point.errors), len(point.seconds), "yes" if id(point) in on_front else "no",
                     point.why or point.objection, point.commit, point.machine, line_of(study, point)))
    return rows
