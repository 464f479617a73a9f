"""Charts of the whole suite: every observable against its goal, and how that changed from report to report."""

from datetime import datetime
from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.dates import AutoDateLocator, ConciseDateFormatter
from matplotlib.lines import Line2D

from verification.report.canvas import BLUE, DARK, GREEN, GREY, RED, figure_of, number
from verification.suite.judge import CODE_TO_CODE, SKIPPED, VALIDATED, WITHIN_GOAL, Outcome

COLOURS = {VALIDATED: GREEN, WITHIN_GOAL: BLUE, CODE_TO_CODE: GREY}  # RED: what does not hold
WIDEST = 8.0  # goals, of the axis of the overview
UNSEEN = 2e-3  # goals: a point and bar no larger lie on zero
TICKS = (0.1, 0.5, 1, 2, 4, 8)
ROW = 0.2  # inches
FLOOR, CEILING = 0.02, 20.0  # goals, of the trend: three decades
NAMED = 8  # observables that the trend names
MARKS = "osD^vP<>"


def _extent(outcome: Outcome) -> tuple[float, float]:
    """(error, k u), in goals."""
    goal = outcome.observable.goal
    return outcome.error / goal, outcome.bound / goal if outcome.is_estimated else 0.0


def _signed_root(value):
    return np.sign(value) * np.sqrt(np.abs(value))


def _signed_square(value):
    return np.sign(value) * np.square(value)


def _sections(outcomes: list[tuple[str, Outcome]]) -> list[tuple[str, list[tuple[str, Outcome | None]]]]:
    """(heading, rows) of what is held against the truth and of what is held against a code with the same law. Rows that the
    picture would show as points on zero are one, without an outcome."""
    judged = [(name, one) for name, one in outcomes if one.observable.goal > 0 and one.verdict != SKIPPED]
    found = []
    for heading, same_law in (("Against exact, published and independent results", False), ("Code to code, the same law", True)):
        rows = [(f"{name}: {one.observable.against}", one) for name, one in judged if one.observable.code_to_code == same_law]
        seen = [(name, one) for name, one in rows if not max(map(abs, _extent(one))) < UNSEEN]
        if hidden := len(rows) - len(seen):
            seen.append((f"{hidden} rows, all below {UNSEEN:g} goals", None))
        if rows:
            found.append((heading, seen))
    return found


def _beyond(axes, row: float, edge: float, value: float, colour: str) -> None:
    """An arrow at the edge, and beside it the number that lies there."""
    side = 1 if edge > 0 else -1
    axes.plot(edge, row, marker=">" if side > 0 else "<", color=colour, markersize=5, clip_on=False)
    axes.annotate(number(float(f"{value:.2g}")), (edge, row), (-6 * side, 0), textcoords="offset points", va="center", fontsize=7,
                  ha="right" if side > 0 else "left", color=colour, bbox={"color": "white", "pad": 0.8})


def _draw_row(axes, row: float, outcome: Outcome, limit: float) -> None:
    error, bound = _extent(outcome)
    colour = COLOURS.get(outcome.verdict, RED)
    if not np.isfinite(error):
        axes.text(0, row, "no value", ha="center", va="center", fontsize=7, color=colour)
        return
    bar = np.clip([error - bound, error + bound], -limit, limit)
    if bound > 0:
        axes.plot(bar, [row, row], color=colour, linewidth=1.1, marker="|", markersize=4)
    if abs(error) <= limit:
        axes.plot(error, row, "o", color=colour, markersize=4)
    beyond = {1: error + bound > limit, -1: error - bound < -limit}
    for side in (1, -1):
        if beyond[side]:
            _beyond(axes, row, side * limit, error if side * error > limit else error + side * bound, colour)


def _limit(sections: list[tuple[str, list[tuple[str, Outcome | None]]]]) -> float:
    """Of the axis, in goals: up to the farthest end of a bar, WIDEST at most."""
    reach = [abs(error) + bound for _, rows in sections for _, one in rows if one for error, bound in [_extent(one)]]
    return float(np.clip(1.05 * max([value for value in reach if np.isfinite(value)], default=0.0), 2.0, WIDEST))


def _set_axes(axes, names: list[tuple[int, str]], rows: int, limit: float) -> None:
    """`names`, (row, name): of the rows that are no headings."""
    axes.axvspan(-1, 1, color=GREEN, alpha=0.08)
    axes.axvline(0, color=DARK, linewidth=0.8, zorder=0)
    axes.set_yticks([row for row, _ in names], [name for _, name in names], fontsize=7)
    axes.set_xscale("function", functions=(_signed_root, _signed_square))
    ticks = [tick for tick in TICKS if tick <= limit]
    ticks = [*(-tick for tick in ticks[::-1]), 0, *ticks]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set(xlim=(-limit, limit), ylim=(rows - 0.4, -0.8))
    axes.set_xlabel("error / goal (signed square root); bars: k u; arrows: beyond")
    for verdict, colour in (*COLOURS.items(), ("FAILED or INCONCLUSIVE", RED)):
        axes.add_line(Line2D([], [], color=colour, marker="o", markersize=4, label=verdict))


def overview(outcomes: list[tuple[str, Outcome]], file: Path) -> None:
    """Error over goal of every observable, k u as bars, on an axis of signed square roots: in the band is within the goal."""
    sections = _sections(outcomes)
    limit = _limit(sections)
    names, row = [], 0
    with figure_of(file, 9.0, 0.9 + ROW * sum(len(rows) + 1 for _, rows in sections)) as axes:
        for heading, rows in sections:
            axes.text(0, row, heading, ha="center", va="center", fontsize=9, fontweight="bold")
            for name, outcome in rows:
                row += 1
                names.append((row, name))
                if outcome:
                    _draw_row(axes, row, outcome, limit)
                else:
                    axes.plot(0, row, "o", color=DARK, mfc="white", markersize=5)
            row += 1
        _set_axes(axes, names, row, limit)


def _moment(entry: dict) -> datetime:
    return datetime.strptime(entry["date"][:16], "%Y-%m-%d %H:%M")


def _in_goals(row: dict | None) -> float:
    """|error| over goal; NaN where there is none."""
    if not row or row["error"] is None or not row["goal"] > 0:
        return np.nan
    return abs(row["error"]) / row["goal"]


def _named(values: np.ndarray) -> list[int]:
    """Columns of values (reports, observables): those that are furthest from their reference now, and those that moved most."""
    known = [k for k, last in enumerate(values[-1]) if np.isfinite(last)]
    moved = {k: float(np.ptp(values[np.isfinite(values[:, k]), k])) for k in known}
    furthest = sorted(known, key=lambda k: -values[-1, k])[: NAMED // 2]
    movers = [k for k in sorted(known, key=lambda k: -moved[k]) if k not in furthest and moved[k] > UNSEEN]
    return sorted([*furthest, *movers[: NAMED - len(furthest)]], key=lambda k: -values[-1, k])


def _middle_half(history: list[dict]) -> np.ndarray:
    """(3, reports): quartiles and median over the observables that are off at all."""
    found = []
    for entry in history:
        values = np.array([_in_goals(row) for row in entry["errors"].values()])
        found.append(np.quantile(values, (0.25, 0.5, 0.75)) if (values := values[values > UNSEEN]).size else [np.nan] * 3)
    return np.array(found).T


def _spread(heights: np.ndarray, gap: float) -> np.ndarray:
    """Heights of labels, descending, moved apart to `gap` at least and kept within 0 and 1."""
    placed = np.array(heights)
    for k in range(1, len(placed)):
        placed[k] = min(placed[k], placed[k - 1] - gap)
    placed += max(0.0, -placed[-1]) if len(placed) else 0.0
    return placed


def _name_lines(axes, moments: list[datetime], ends: list[float], names: list[str], colours: list[str], top: float) -> None:
    """To the right of the chart, with a thin line from each label to the end of its curve."""
    heights = np.array([np.log(np.clip(end, FLOOR, top) / FLOOR) / np.log(top / FLOOR) for end in ends])
    for end, name, colour, height in zip(ends, names, colours, _spread(heights, 0.1), strict=True):
        axes.annotate(fill(name, 34), (moments[-1], end), (1.05, height), textcoords=axes.transAxes, fontsize=7, color=colour,
                      va="center", annotation_clip=False,
                      arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.6, "relpos": (0.0, 0.5)})


def trend(history: list[dict], keys: list[str], file: Path) -> None:
    """|error| over goal, by the time of the report: the middle half of the observables, and by name those that are the furthest
    from their reference now and those that moved most."""
    moments = [_moment(entry) for entry in history]
    values = np.array([[_in_goals(entry["errors"].get(key)) for key in keys] for entry in history])
    low, middle, high = _middle_half(history)
    named = _named(values)
    top = float(np.clip(1.5 * np.nan_to_num(values[:, named]).max(initial=0.0), 2.0, CEILING))
    with figure_of(file, 9, 4.4) as axes:
        axes.fill_between(moments, low, high, color=GREY, alpha=0.2, linewidth=0,
                          label=f"middle half of the observables that are off by more than {UNSEEN:g} goals")
        axes.plot(moments, middle, color=DARK, linewidth=1.6, label="their median")
        axes.axhline(1.0, color=GREEN, linewidth=1.2, label="goal")
        colours = [f"C{k}" for k in range(len(named))]
        for k, colour, mark in zip(named, colours, MARKS, strict=False):
            shown = np.clip(values[:, k], FLOOR, top)
            axes.plot(moments, shown, color=colour, marker=mark, markersize=4.5, linewidth=1.1, mfc="none", clip_on=False)
        axes.set_yscale("log")
        axes.set(ylim=(FLOOR, top), ylabel="|error| / goal", xlabel="time of the report")
        dates = AutoDateLocator(minticks=3, maxticks=8)
        axes.xaxis.set_major_locator(dates)
        axes.xaxis.set_major_formatter(ConciseDateFormatter(dates))
        names = [f"{keys[k]}: {values[-1, k]:.2g}" for k in named]
        _name_lines(axes, moments, [np.clip(values[-1, k], FLOOR, top) for k in named], names, colours, top)
