"""Charts: two labelled ticks on every axis, legends off the data, nothing cut off. Oracles: what matplotlib says it has drawn."""

from datetime import datetime, timedelta
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.text import Text

from verification.measures.curve import Chart, Curve
from verification.protocol.machine import ROOT
from verification.protocol.quantity import Measured
from verification.report import canvas, charts, suite_charts
from verification.report.canvas import labelled_ticks, log_ticks, number
from verification.report.speed_charts import CHARTS
from verification.store.figures import read_benches
from verification.suite.case import Observable
from verification.suite.judge import FAILED, Outcome

BENCHES = read_benches(ROOT / "reports" / "published" / "bench.jsonl")


def outcome(error: float, uncertainty: float = 0.01, goal: float = 0.02, levels: tuple[float, ...] = (), **given) -> Outcome:
    """Of a value whose reference is 1."""
    return Outcome(Observable("drag", "F", 1.0, 0.0, "nobody", goal, **given), Measured(1 + error, 0.0),
                   {"step": uncertainty, "Mach": 0.1 * uncertainty}, spacings=tuple(0.1 / 2**k for k in range(len(levels))),
                   levels=tuple(Measured(1 + one, 1e-4) for one in levels))


def report(day: float, errors: dict[str, float]) -> dict:
    rows = {key: {"error": error, "goal": 0.02, "value": 1.0} for key, error in errors.items()}
    return {"date": f"{datetime(2026, 1, 1) + timedelta(days=day):%Y-%m-%d %H:%M} UTC", "commit": "0123456789", "errors": rows}


X = np.linspace(0.0, 1.0, 50)
CURVES = {
    "linear": Chart("t", "x", "y", (Curve("a", X, X**2), Curve("b", X, X, reference=True))),
    "constant": Chart("t", "x", "y", (Curve("a", X, np.full(50, 3.0)),)),
    "far from zero": Chart("t", "x", "y", (Curve("a", X, 1e6 + 1e-3 * X),)),
    "less than a decade": Chart("t", "x", "y", (Curve("a", X, 0.61 + 0.05 * X),), log=True),
    "within one power": Chart("t", "x", "y", (Curve("a", X, 2.0 + 6 * X, points=True),), log=True),
    "many decades": Chart("t", "x", "y", (Curve("a", X, 10.0 ** (-12 * X)),), log=True),
    "many long labels": Chart("t", "x", "y", tuple(Curve(f"{k}: {2 * 'a law of many words, '}", X, k * X) for k in range(9))),
}
HISTORIES = {
    "two": [report(0, {"a": 0.01, "b": 0.0}), report(0.01, {"a": 0.012, "b": 0.0})],
    "many in a day": [report(0.02 * k, {f"case_{n}: a long name of an observable": 0.019 - 1e-4 * n for n in range(20)})
                      for k in range(30)],
    "years": [report(70.0 * k, {"a": 0.5, "b": 1e-9, "c": 0.001 * k}) for k in range(20)],
    "new and gone": [report(0, {"old": 0.01}), report(1, {"new": np.nan, "other": 0.01})],
}
ROWS = [("validated", outcome(0.001)), ("wide", outcome(0.01, 0.4)), ("failed", outcome(-0.9)), ("none", outcome(np.nan)),
        *((f"same{k}", outcome(1e-9, 0.0, code_to_code=True)) for k in range(30)), ("law", outcome(0.01, code_to_code=True))]
LEVELS = {"a decade": (0.08, 0.02, 0.005), "hardly": (0.0131, 0.013, 0.0129), "far": (0.5, 1e-3, 1e-7), "two": (0.02, 0.019)}
KINDS = {f"curves, {name}": lambda file, chart=chart: charts.draw(chart, file) for name, chart in CURVES.items()}
KINDS |= {f"levels, {name}": lambda file, errors=errors: charts.convergence(outcome(errors[-1], levels=errors), "spacing", file)
          for name, errors in LEVELS.items()}
KINDS |= {f"trend, {name}": lambda file, history=history: suite_charts.trend(history, list(history[-1]["errors"]), file)
          for name, history in HISTORIES.items()}
KINDS |= {f"bench, {name}": lambda file, name=name: CHARTS[name](BENCHES[name], file) for name in BENCHES if name in CHARTS}
KINDS["overview"] = lambda file: suite_charts.overview(ROWS, file)
KINDS["sources"] = lambda file: charts.uncertainty_split(SimpleNamespace(outcomes=[outcome(0.001), outcome(0.002)]), file)


@pytest.mark.parametrize("kind", KINDS)
def test_every_axis_has_two_labelled_ticks(kind: str, drawn: list, tmp_path: Path) -> None:
    KINDS[kind](tmp_path / "chart.svg")
    for axes in drawn[0].axes:
        for axis in (axes.xaxis, axes.yaxis):
            named = any(label.get_visible() and label.get_text() for label in axis.get_ticklabels())
            shared = axes.get_subplotspec().colspan.start > 0 and not named  # with the panel to the left
            assert shared or len(labelled_ticks(axis)) >= 2, f"{axis.axis_name}: {labelled_ticks(axis)}"


@pytest.mark.parametrize("kind", KINDS)
def test_legends_lie_below_the_axes_and_inside_the_picture(kind: str, drawn: list, tmp_path: Path) -> None:
    KINDS[kind](tmp_path / "chart.svg")
    figure = drawn[0]
    figure.draw_without_rendering()
    for axes in figure.axes:
        if (legend := axes.get_legend()) is not None:
            box = legend.get_window_extent()
            assert not any(box.overlaps(other.bbox) for other in figure.axes)
            assert box.y0 >= -1 and box.x0 >= -1 and box.x1 <= figure.bbox.x1 + 1
            assert not box.overlaps(axes.xaxis.label.get_window_extent())


@pytest.mark.parametrize(("low", "high"), [(1.0, 1e9), (0.9, 1.2), (2.1, 2.9), (1e-12, 1.0), (3e-5, 4e-4), (0.5, 50.0),
                                           (1.0001, 1.0002)])
def test_ticks_of_a_logarithmic_axis_are_few_and_inside(low: float, high: float) -> None:
    ticks = log_ticks(low, high)
    assert 3 <= len(ticks) <= 12 and low <= min(ticks) and max(ticks) <= high


def test_numbers_of_ticks_are_short() -> None:
    assert [number(value) for value in (0, 0.02, 300, 1e-6, 2.5e-6, -3e7)] == [
        "0", "0.02", "300", "$10^{-6}$", r"$2.5\cdot 10^{-6}$", r"$-3\cdot 10^{7}$"]


def test_the_overview_cuts_nothing_off(drawn: list, tmp_path: Path) -> None:
    """Points and bars lie inside the axis, and what is beyond is written at the edge."""
    suite_charts.overview(ROWS, tmp_path / "overview.svg")
    (axes,) = drawn[0].axes
    limit = axes.get_xlim()[1]
    for line in axes.get_lines():
        assert np.abs(np.asarray(line.get_xdata(), dtype=float)).max(initial=0.0) <= limit + 1e-9
    words = [text.get_text() for text in axes.texts]
    assert "-45" in words and "no value" in words  # -0.9 over 0.02; the bar of the second reaches -40 to 40
    names = [label.get_text() for label in axes.get_yticklabels()]
    assert "30 rows, all below 0.002 goals" in names and not any("same" in name for name in names)
    assert names.index("law: F") > names.index("none: F") and outcome(-0.9).verdict == FAILED
    heads = [words.index(head) for head in ("Against exact, published and independent results", "Code to code, the same law")]
    assert heads == sorted(heads)


def test_colours_of_the_overview_are_those_of_the_verdicts(drawn: list, tmp_path: Path) -> None:
    suite_charts.overview(ROWS, tmp_path / "overview.svg")
    legend = drawn[0].axes[0].get_legend()
    found = {text.get_text(): line.get_color() for text, line in zip(legend.get_texts(), legend.get_lines(), strict=True)}
    assert found == {"VALIDATED": canvas.GREEN, "WITHIN GOAL": canvas.BLUE, "CODE-TO-CODE": canvas.GREY,
                     "FAILED or INCONCLUSIVE": canvas.RED}


@pytest.mark.parametrize("name", HISTORIES)
def test_a_trend_shows_three_decades_and_labels_that_do_not_meet(name: str, drawn: list, tmp_path: Path) -> None:
    KINDS[f"trend, {name}"](tmp_path / "trend.svg")
    figure = drawn[0]
    figure.draw_without_rendering()
    (axes,) = figure.axes
    low, high = axes.get_ylim()
    assert high / low <= 1000
    dates = [label.get_window_extent() for label in axes.get_xticklabels() if label.get_text()]
    assert not any(one.overlaps(other) for one, other in zip(dates, dates[1:], strict=False))
    names = [Text.get_window_extent(text) for text in axes.texts]  # without the lines that lead to them
    assert not any(one.overlaps(other) for k, one in enumerate(names) for other in names[k + 1 :])


def test_references_at_one_place_are_told_apart(drawn: list, tmp_path: Path) -> None:
    known = [Curve(f"law {k}", np.zeros(1), np.array([2 + 0.01 * k]), reference=True, points=True) for k in range(4)]
    charts.draw(Chart("t", "x", "y", (*known, Curve("measured", X[1:], X[1:], points=True))), tmp_path / "chart.svg")
    (axes,) = drawn[0].axes
    marks = [line.get_marker() for line in axes.get_lines() if line.get_color() == canvas.DARK]
    assert len(marks) == len(set(marks)) == 4
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names[:4] == ["law 0: 2", "law 1: 2.01", "law 2: 2.02", "law 3: 2.03"]
