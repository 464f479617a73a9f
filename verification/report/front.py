"""The first figure: what was measured against the reference, of all rows, and bias and spread of each chapter.

Bias and spread as in the validation guide of the Fire Dynamics Simulator: of ln(measured / reference), the mean as a factor and
the standard deviation.
"""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from verification.report.chapters import Chapter, tier_of
from verification.report.charts import DARK, GREY, figure_of
from verification.report.figure import Figure, csv_of
from verification.suite.case import CHAPTERS
from verification.suite.judge import CODE_TO_CODE, INCONCLUSIVE, SKIPPED, Outcome

COLOURS = ("#333333", "#5b4b8a", "#1f5a96", "#2a8c82", "#17663a", "#b8860b", "#888888", "#b00020", "#c65102")
LOOKS = dict(zip(CHAPTERS, zip("hos^Dv<P>", COLOURS, strict=True), strict=True))  # mark and colour of each chapter
EDGE = 10.0  # per cent: what lies further off is drawn at the edge


@dataclass(frozen=True)
class Point:
    case: str
    tier: str
    outcome: Outcome

    @property
    def ratio(self) -> float:
        return self.outcome.measured.value / self.outcome.observable.reference


@dataclass(frozen=True)
class Class:
    """The rows of a chapter that have a reference other than 0."""

    name: str
    points: tuple[Point, ...]

    @property
    def logarithms(self) -> np.ndarray:
        return np.log([point.ratio for point in self.points])

    @property
    def bias(self) -> float:
        """Factor by which what is measured lies above its references, in the geometric mean."""
        return float(np.exp(self.logarithms.mean()))

    @property
    def spread(self) -> float:
        """Standard deviation of the logarithm of the ratio, which is relative; NaN of one row."""
        return float(self.logarithms.std(ddof=1)) if len(self.points) > 1 else math.nan

    @property
    def furthest(self) -> Point:
        return max(self.points, key=lambda point: abs(math.log(point.ratio)))

    @property
    def code_to_code(self) -> int:
        return sum(point.outcome.verdict == CODE_TO_CODE for point in self.points)


def _has_ratio(outcome: Outcome) -> bool:
    reference, value = outcome.observable.reference, outcome.measured.value
    return outcome.verdict not in (SKIPPED, INCONCLUSIVE) and math.isfinite(value) and reference * value > 0


def classes_of(chapters: list[Chapter]) -> list[Class]:
    """Chapters without such a row are left out."""
    found = []
    for chapter in chapters:
        points = tuple(Point(result.case.name, tier_of(result), outcome)
                       for result in chapter.results for outcome in result.outcomes if _has_ratio(outcome))
        found += [Class(chapter.name, points)] if points else []
    return found


def _marks(axes, classes: list[Class], height) -> None:
    """`height` of every point; filled where it can validate, hollow where it is code to code."""
    for one in classes:
        mark, colour = LOOKS[one.name]
        for judged in (True, False):
            points = [point for point in one.points if (point.outcome.verdict != CODE_TO_CODE) == judged]
            label = one.name if judged or one.code_to_code == len(one.points) else None
            axes.plot([abs(point.outcome.observable.reference) for point in points], [height(point) for point in points], mark,
                      markersize=5, color=colour, mfc=colour if judged else "none", alpha=0.8, label=label if points else None)
    axes.set(xscale="log", xlabel="|reference|, in its own unit")


def _draw_scatter(classes: list[Class], file: Path) -> None:
    with figure_of(file, 5.4, 5.0) as axes:
        _marks(axes, classes, lambda point: abs(point.outcome.measured.value))
        axes.set(yscale="log", ylabel="|measured|")
        references = [abs(point.outcome.observable.reference) for one in classes for point in one.points]
        ends = np.array([min(references), max(references)])
        for factor, line in ((1.0, "-"), (1.1, ":"), (0.9, ":")):
            axes.plot(ends, factor * ends, line, color=DARK if factor == 1 else GREY, linewidth=0.9, zorder=0)
        axes.legend(frameon=False, fontsize=8, loc="upper left")


def _off(point: Point) -> float:
    """Per cent."""
    return 100 * (point.ratio - 1)


def _draw_apart(classes: list[Class], file: Path) -> None:
    with figure_of(file, 5.4, 5.0) as axes:
        _marks(axes, classes, lambda point: float(np.clip(_off(point), -EDGE, EDGE)))
        axes.set(ylabel="measured, off the reference (%)", ylim=(-1.05 * EDGE, 1.05 * EDGE))
        axes.axhline(0, color=DARK, linewidth=0.9, zorder=0)


def _table(classes: list[Class]) -> str:
    rows = [(one.name, point.case, point.outcome.observable.symbol, point.tier, float(point.outcome.observable.reference),
             float(point.outcome.measured.value), point.outcome.verdict) for one in classes for point in one.points]
    return csv_of(("chapter", "case", "observable", "tier", "reference", "measured", "verdict"), rows)


def front_figures(classes: list[Class], out: Path) -> tuple[Figure, ...]:
    """All decades, and by how many per cent each is off; none where nothing was measured."""
    points = [point for one in classes for point in one.points]
    if not points:
        return ()
    files = (out / "scatter.svg", out / "apart.svg")
    _draw_scatter(classes, files[0])
    _draw_apart(classes, files[1])
    near = sum(abs(_off(point)) < 1 for point in points)
    beyond = sum(abs(_off(point)) > EDGE for point in points)
    last = f" {beyond} of them lie further off than {EDGE:g} %, and stand at the edge." if beyond else ""
    captions = (f"What was measured against its reference: {len(points)} rows of both tiers that have one other than 0, a colour "
                "a chapter. Dotted: 10 % off. Hollow: against a code that has the same law.",
                f"The same by how many per cent: {near} of {len(points)} rows are less than 1 % off.{last}")
    return tuple(Figure(file, caption, _table(classes)) for file, caption in zip(files, captions, strict=True))
