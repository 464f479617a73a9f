"""Curves, drawn with matplotlib as SVG."""

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import cycle
from pathlib import Path

import matplotlib
import numpy as np

from verification.measures.budget import body_work
from verification.measures.curve import Chart
from verification.protocol.run import Run
from verification.suite.judge import CODE_TO_CODE, SKIPPED, VALIDATED, WITHIN_GOAL, Outcome
from verification.suite.result import CaseResult

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of a backend without a display)
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator  # noqa: E402

STYLE = {"font.size": 10, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.alpha": 0.3,
         "svg.fonttype": "none", "svg.hashsalt": "mappm"}
REFERENCE_LINES = ("--", ":", "-.", (0, (1, 3)))
NAMED = 12  # observables that a chart of all of them names
MOST_VECTOR_POINTS = 300  # of a curve; those with more are drawn as pixels
BLUE, GREEN, RED, GREY, DARK = "#1f5a96", "#17663a", "#b00020", "#888888", "#333333"


@contextmanager
def figure_of(file: Path, width: float, height: float, rows: int = 1, columns: int = 1) -> Iterator:
    """Axes to draw on; the file is written at the end."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(rows, columns, figsize=(width, height), layout="constrained")
        yield axes
        figure.savefig(file, dpi=130)
        plt.close(figure)


def _with_unit(name: str, unit: str) -> str:
    return f"{name} ({unit})" if unit else name


def slip_and_drag(run: Run, file: Path) -> None:
    """Mean slip velocity of the solids and mean drag per solid along the body force, against time."""
    series = run.series
    axis = "xyz"[int(np.argmax(np.abs(run.scene["force"]["fluid"])))]
    curves = (("slip_" + axis, "slip velocity of the solids", 0), ("drag_" + axis, "drag per solid", 1))
    with figure_of(file, 8, 5.6, rows=2) as axes:
        axes[0].sharex(axes[1])
        for axes_of, (column, title, skipped) in zip(axes, curves, strict=True):  # no drag before the first sample
            axes_of.plot(series["time"][skipped:], series[column][skipped:], color=BLUE, linewidth=1.4)
            axes_of.axhline(0.0, color=GREY, linewidth=0.8)
            axes_of.set_ylabel(_with_unit(title, series.units[column]))
        axes[-1].set_xlabel(_with_unit("time", series.units["time"]))


def energy_budget(run: Run, file: Path) -> None:
    """Where the work of the body forces went: kinetic energies, compression, and what viscosity and contacts took."""
    series = run.series
    time, unit = series["time"], series.units["fluid_energy"]
    parts = {"kinetic, fluid": "fluid_energy", "kinetic, solids": "solid_energy", "spin of solids": "spin_energy",
             "compression of the fluid": "internal_energy"}
    held = {label: series[name] - series[name][0] for label, name in parts.items() if name in series}
    work = body_work(run)
    lost = work - sum(held.values())
    with figure_of(file, 8, 3.6) as axes:
        axes.plot(time, work, color=DARK, linewidth=1.6, label="work of the body forces")
        axes.plot(time, lost, color=RED, linewidth=1.4, label="dissipated: work less what is held")
        for label, values in held.items():
            axes.plot(time, values, linewidth=1.2, label=label + ", change")
        axes.set_xlabel(_with_unit("time", series.units["time"]))
        axes.set_ylabel(_with_unit("energy", unit))
        axes.legend(frameon=False, fontsize=8)


def overview(outcomes: list[tuple[str, Outcome]], file: Path) -> None:
    """Error over goal of every observable, with k u as bars: inside the band is within the goal."""
    shown = [(name, outcome) for name, outcome in outcomes if outcome.observable.goal > 0 and outcome.verdict != SKIPPED][::-1]
    with figure_of(file, 8.5, 0.6 + 0.27 * len(shown)) as axes:
        axes.axvspan(-1, 1, color=GREEN, alpha=0.08)
        axes.axvline(0, color=DARK, linewidth=0.8)
        for row, (_, outcome) in enumerate(shown):
            goal = outcome.observable.goal
            bar = outcome.bound / goal if outcome.is_estimated else 0.0
            colour = {VALIDATED: GREEN, WITHIN_GOAL: BLUE, CODE_TO_CODE: GREY}.get(outcome.verdict, RED)
            position = float(np.clip(outcome.error / goal, -1.9, 1.9))
            axes.errorbar(position, row, xerr=min(bar, 4.0), fmt="o", color=colour, markersize=4, capsize=2, linewidth=1)
        axes.set_yticks(range(len(shown)), [f"{name}: {outcome.observable.against}" for name, outcome in shown], fontsize=8)
        axes.set_xlim(-2, 2)
        axes.set_xlabel("error / goal; bars: k u_val; points at the edge lie beyond")


def convergence(outcome: Outcome, refined: str, file: Path) -> None:
    """|error| against what is refined, with lines of first and second order through the finest level."""
    spacings = np.array(outcome.spacings)
    errors = np.array([abs(level.value - outcome.observable.reference) / outcome.scale for level in outcome.levels])
    bars = np.array([level.uncertainty / outcome.scale for level in outcome.levels])
    with figure_of(file, 4.6, 3.4) as axes:
        axes.errorbar(spacings, errors, yerr=np.minimum(bars, 0.9 * errors), fmt="o-", color=BLUE, capsize=2, linewidth=1.2,
                      label="measured")
        for order, style in ((1, ":"), (2, "--")):
            axes.plot(spacings, errors[-1] * (spacings / spacings[-1]) ** order, style, color=GREY, linewidth=1,
                      label=f"order {order}")
        axes.axhline(outcome.observable.goal, color=GREEN, linewidth=1, label="goal")
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xticks(spacings, [f"{value:.3g}" for value in spacings], fontsize=8)
        axes.xaxis.set_minor_locator(NullLocator())
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=8))
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.yaxis.set_minor_locator(NullLocator())
        axes.set_xlabel(refined)
        axes.set_ylabel("|error|" if outcome.observable.reference == 0 else "|relative error|")
        axes.set_title(outcome.observable.symbol, fontsize=10)
        axes.legend(frameon=False, fontsize=8)


def uncertainty_split(result: CaseResult, file: Path) -> None:
    """Where u_num comes from: one bar a source, of every observable, relative to its goal."""
    shown = [one for one in result.outcomes if one.sources and one.observable.goal > 0 and one.verdict != SKIPPED]
    sources = list(dict.fromkeys(source for outcome in shown for source in outcome.sources))
    with figure_of(file, 4.6, 0.9 + 0.3 * len(sources) * max(1, 0.6 * len(shown))) as axes:
        height = 0.8 / len(shown)
        for k, outcome in enumerate(shown):
            values = [100 * outcome.sources.get(source, 0.0) / outcome.scale / outcome.observable.goal for source in sources]
            axes.barh(np.arange(len(sources)) + k * height, values, height, label=outcome.observable.against)
        axes.set_yticks(np.arange(len(sources)) + 0.5 * (len(shown) - 1) * height, sources, fontsize=8)
        axes.set_xlabel("standard uncertainty, % of the goal", loc="right")  # the names of the sources leave it little room
        if len(shown) > 1:
            axes.figure.legend(frameon=False, fontsize=7, loc="outside lower center")


def draw(chart: Chart, file: Path) -> None:
    reference_lines = cycle(REFERENCE_LINES)
    with figure_of(file, 5.6, 3.8) as axes:
        for curve in chart.curves:
            style = {"color": DARK if curve.reference else None, "label": curve.label}
            if curve.points:
                style |= {"fmt": curve.marker, "markersize": 4, "mfc": "none", "capsize": 2, "linewidth": 1}
                axes.errorbar(curve.x, curve.y, yerr=curve.error, **style)
            else:
                axes.plot(curve.x, curve.y, linestyle=next(reference_lines) if curve.reference else "-", linewidth=1.3, **style)
        for line in axes.get_lines():  # thousands of points would make a page of many megabytes
            line.set_rasterized(len(line.get_xdata()) > MOST_VECTOR_POINTS)
        if chart.log:
            axes.set_yscale("log")
        else:
            low, high = axes.get_ylim()
            if high - low < 1e-6 * max(abs(low), abs(high)):  # the same but for rounding
                axes.set_ylim(0.5 * (low + high) - 0.1 * abs(high), 0.5 * (low + high) + 0.1 * abs(high))
        axes.set_title(chart.title, fontsize=10)
        axes.set_xlabel(chart.x_label)
        axes.set_ylabel(chart.y_label)
        if any(curve.label for curve in chart.curves):
            axes.legend(frameon=False, fontsize=8)


def trend(history: list[dict], keys: list[str], file: Path) -> None:
    """|error| over goal of every observable, report by report; the furthest of the last report are named."""
    last = history[-1]["errors"]
    named = set(sorted(last, key=lambda key: -abs(last[key]["error"] or 0) / (last[key]["goal"] or 1))[:NAMED])
    with figure_of(file, 8, 4.2) as axes:
        for key in keys:
            points = [(k, abs(entry["errors"][key]["error"]) / entry["errors"][key]["goal"])
                      for k, entry in enumerate(history) if key in entry["errors"] and entry["errors"][key]["goal"] > 0]
            if points:
                style = {"label": key} if key in named else {"color": GREY, "alpha": 0.4}
                axes.plot(*zip(*points, strict=True), "o-", markersize=3, linewidth=1, **style)
        axes.axhline(1.0, color=GREEN, linewidth=1)
        axes.set_yscale("log")
        shown = range(0, len(history), 1 + len(history) // 8)
        axes.set_xticks(list(shown), [f"{history[k]['date'][:10]}\n{history[k]['commit'][:8]}" for k in shown], fontsize=8)
        axes.set_ylabel("|error| / goal")
        axes.figure.legend(frameon=False, fontsize=6, ncols=2, loc="outside lower center")
