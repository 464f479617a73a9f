"""A figure of the page: its file, what is seen, the numbers behind it and what makes it again."""

import csv
import io
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from verification.measures.curve import Chart
from verification.suite.judge import Outcome
from verification.suite.result import CaseResult

DRAW = "python3 -m verification report --only-draw"
ROWS = 200  # of one curve in the data of a figure; the series of the run has all


@dataclass(frozen=True)
class Figure:
    file: Path
    caption: str
    data: str = ""  # CSV; empty where the figure is a field
    command: str = DRAW


def csv_of(head: Sequence[str], rows: Iterable[Sequence]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows([[f"{value:.6g}" if isinstance(value, float) else value for value in row] for row in rows])
    return text.getvalue()


def run_line(result: CaseResult) -> str:
    """Runs what is missing of a case and prints its verdicts."""
    return f"python3 -m verification run {result.case.name}{' --tier full' if result.tier == 'full' else ''}"


def curves_csv(chart: Chart) -> str:
    """A row a point, of every curve in turn."""
    rows = []
    for curve in chart.curves:
        every = 1 + len(curve.x) // ROWS
        errors = [""] * len(curve.x) if curve.error is None else map(float, curve.error)
        rows += list(zip([curve.label] * len(curve.x), map(float, curve.x), map(float, curve.y), errors, strict=True))[::every]
    return csv_of(("curve", chart.x_label, chart.y_label, "error"), rows)


def curves_caption(name: str, chart: Chart) -> str:
    """Which curves are which."""
    reference = [curve.label for curve in chart.curves if curve.reference and curve.label]
    measured = [curve.label for curve in chart.curves if not curve.reference and curve.label]
    title = chart.title or chart.y_label
    parts = [f"{name}: {title[0].lower() + title[1:]}" + ("" if chart.x_label in title else f", over {chart.x_label}")]
    parts += [f"In colour: {'; '.join(measured)}"] if measured else []
    parts += [f"Reference: {'; '.join(reference)}"] if reference else []
    return ". ".join(parts) + "."


def levels_csv(outcome: Outcome, refined: str) -> str:
    reference = outcome.observable.reference
    rows = [(spacing, level.value, level.uncertainty, (level.value - reference) / outcome.scale)
            for spacing, level in zip(outcome.spacings, outcome.levels, strict=True)]
    return csv_of((refined, outcome.observable.symbol, "uncertainty in time", "error"), rows)


def levels_caption(name: str, outcome: Outcome, refined: str) -> str:
    kind = "error" if outcome.observable.reference == 0 else "relative error"
    state = f" {outcome.state_text}." if outcome.state else ""
    return (f"{name}: {kind} of {outcome.observable.symbol} over {len(outcome.levels)} levels of the {refined}; the finest is "
            f"{outcome.error_text} off, the goal {outcome.in_words(outcome.observable.goal)}.{state}")


def sources_csv(outcomes: Sequence[Outcome]) -> str:
    rows = [(one.observable.against, source, value, value / one.scale / one.observable.goal)
            for one in outcomes for source, value in one.sources.items()]
    return csv_of(("observable", "source", "standard uncertainty", "over the goal"), rows)


def sources_caption(name: str, outcomes: Sequence[Outcome]) -> str:
    shares = [(value / one.scale / one.observable.goal, source, one) for one in outcomes for source, value in one.sources.items()]
    share, source, one = max(shares, key=lambda entry: entry[0] if math.isfinite(entry[0]) else 0.0)
    return (f"{name}: what each source adds to the uncertainty of the value, over its goal. Largest is {source}, "
            f"{100 * share:.2g} % of the goal of {one.observable.symbol}.")
