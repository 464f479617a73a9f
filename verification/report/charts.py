"""Charts of a case: curves, levels, sources of uncertainty; drawn as SVG."""

from itertools import cycle
from pathlib import Path

import numpy as np
from matplotlib.ticker import NullLocator
from matplotlib.transforms import ScaledTranslation

from verification.measures.budget import body_work
from verification.measures.curve import Chart, Curve
from verification.protocol.run import Run
from verification.report.canvas import BLUE, DARK, GREEN, GREY, RED, figure_of
from verification.suite.judge import SKIPPED, Outcome
from verification.suite.result import CaseResult

REFERENCE_LINES = ("--", ":", "-.", (0, (1, 3)))
MARKS = "osD^vP*X"
BESIDE = 9.0  # points between marks that would cover each other
FEW_POINTS = 30  # of a curve whose marks are told apart by their shape
MOST_VECTOR_POINTS = 300  # of a curve; those with more are drawn as pixels


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
        axes.set_xlabel(refined)
        axes.set_ylabel("|error|" if outcome.observable.reference == 0 else "|relative error|")
        axes.set_title(outcome.observable.symbol, fontsize=10)


def uncertainty_split(result: CaseResult, file: Path) -> None:
    """Where u_num comes from: one bar a source, of every observable, relative to its goal."""
    shown = [one for one in result.outcomes if one.sources and one.observable.goal > 0 and one.verdict != SKIPPED]
    sources = list(dict.fromkeys(source for outcome in shown for source in outcome.sources))
    with figure_of(file, 4.6, 0.9 + 0.3 * len(sources) * max(1, 0.6 * len(shown))) as axes:
        height = 0.8 / len(shown)
        for k, outcome in enumerate(shown):
            values = [100 * outcome.sources.get(source, 0.0) / outcome.scale / outcome.observable.goal for source in sources]
            named = outcome.observable.against if len(shown) > 1 else None
            axes.barh(np.arange(len(sources)) + k * height, values, height, label=named)
        axes.set_yticks(np.arange(len(sources)) + 0.5 * (len(shown) - 1) * height, sources, fontsize=8)
        axes.set_xlabel("standard uncertainty, % of the goal", loc="right")  # the names of the sources leave it little room


def _apart(curves: tuple[Curve, ...]) -> dict[int, tuple[str, float, str]]:
    """(marker, shift to the left in points, label) by place, of reference points of which several lie at one abscissa."""
    alone = [k for k, curve in enumerate(curves) if curve.reference and curve.points and len(curve.x) == 1]
    places, marks, found = [float(curves[k].x[0]) for k in alone], cycle(MARKS), {}
    for rank, (k, place) in enumerate(zip(alone, places, strict=True)):
        if places.count(place) > 1:
            found[k] = next(marks), BESIDE * places[:rank].count(place), f"{curves[k].label}: {curves[k].y[0]:.3g}"
    return found


def _draw_points(axes, curve: Curve, colour: str | None, apart: tuple[str, float, str]) -> None:
    marker, left, label = apart
    style = {"fmt": marker, "markersize": 4, "mfc": "none", "capsize": 2, "linewidth": 1, "color": colour, "label": label}
    if left:
        style["transform"] = axes.transData + ScaledTranslation(-left / 72, 0, axes.figure.dpi_scale_trans)
    axes.errorbar(curve.x, curve.y, yerr=curve.error, **style)


def draw(chart: Chart, file: Path) -> None:
    reference_lines, marks, apart = cycle(REFERENCE_LINES), cycle(MARKS), _apart(chart.curves)
    several = sum(curve.points and not curve.reference and len(curve.x) <= FEW_POINTS for curve in chart.curves) > 1
    with figure_of(file, 5.6, 3.8) as axes:
        for k, curve in enumerate(chart.curves):
            colour = DARK if curve.reference else None
            if curve.points:
                mark = next(marks) if several and not curve.reference and curve.marker == "o" else curve.marker
                _draw_points(axes, curve, colour, apart.get(k, (mark, 0.0, curve.label)))
            else:
                line = next(reference_lines) if curve.reference else "-"
                axes.plot(curve.x, curve.y, linestyle=line, linewidth=1.3, color=colour, label=curve.label)
        if apart:
            axes.margins(x=0.12)
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
