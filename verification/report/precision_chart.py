"""Error against core-seconds of the runs of a study, with the front of each code."""

import math
from dataclasses import dataclass
from pathlib import Path

from verification.report.canvas import BLUE, DARK, GREEN, GREY, figure_of
from verification.report.figure import Figure, csv_of
from verification.store.store import Store
from verification.studies.precision import ASKED, HEAD, Front, Point, by_code, floor_of, front_of, fronts_of, points_of, rows_of
from verification.studies.study import Result, Study, charted
from verification.suite.runner import Shelf

ORANGE, PURPLE = "#c96a00", "#7a4a9c"
LOOKS = {"mappm": (BLUE, "-"), "openfoam": (DARK, "--"), "lammps": (ORANGE, "-."), "pysph": (GREEN, ":"), "liggghts": (PURPLE, (0, (1, 3)))}
OWN_MARKS, MARKS = "os^vDP*X<>", {"openfoam": "s", "lammps": "^", "pysph": "D", "liggghts": "v"}
LEAST = 1e-6  # of an error, that a logarithmic axis can show


def _spread(axes, point: Point, colour: str) -> None:
    """Bars over the starts and over the timings, where there are several."""
    low, high = (max(one, LEAST) for one in point.error_range)
    if high > low:
        axes.plot([point.cost, point.cost], [low, high], color=colour, linewidth=0.8, alpha=0.6)
    least, most = min(point.seconds, default=0.0), max(point.seconds, default=0.0)
    if most > least:
        axes.plot([least, most], [max(point.error, LEAST)] * 2, color=colour, linewidth=0.8, alpha=0.6)


def _points(axes, points: list[Point], colour: str, mark: str, label: str) -> None:
    """Filled where the value may be trusted, hollow where not."""
    for trusted in (True, False):
        members = [one for one in points if math.isfinite(one.error) and one.cost > 0 and one.counts is trusted]
        for point in members:
            _spread(axes, point, colour)
        if members:
            axes.plot([one.cost for one in members], [max(one.error, LEAST) for one in members], mark, color=colour, markersize=4,
                      alpha=0.7, markerfacecolor=colour if trusted else "white", label=label if trusted else f"{label}, objected to")


def _draw(axes, study: Study, points: list[Point], floor: float) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    blocks = list(dict.fromkeys(block.name for block in study.blocks))
    for code, members in by_code(points).items():
        colour, line = LOOKS.get(code, (GREY, "-"))
        title = members[0].code.title
        if code == "mappm":
            for block in dict.fromkeys(one.block for one in members):
                label = f"{title}: {block}" if block else title
                _points(axes, [one for one in members if one.block == block], colour, OWN_MARKS[blocks.index(block) % len(OWN_MARKS)], label)
        else:
            _points(axes, members, colour, MARKS.get(code, "P"), title)
        front = front_of(members, floor)
        axes.plot([one.cost for one in front], [max(one.error, LEAST) for one in front], linestyle=line, color=colour, linewidth=1.6,
                  zorder=3, label=f"{title}, the cheapest" if front else None)
    low, high = axes.get_ylim()
    low, high = min(low, ASKED / 1.5), max(high, 1.5 * ASKED)
    if floor > low:
        axes.axhspan(low, floor, facecolor="none", edgecolor=GREY, hatch="///", alpha=0.35, linewidth=0,
                     label="below twice the uncertainty of the reference")
    axes.set_ylim(low, high)
    _order_two(axes, study, points, floor)
    axes.axhline(ASKED, color=GREY, linewidth=0.8)
    axes.annotate("1 %", (1, ASKED), xycoords=("axes fraction", "data"), xytext=(-2, 2), textcoords="offset points", ha="right",
                  fontsize=8, color=GREY)
    axes.set_xlabel("core-seconds, without set-up")
    axes.set_ylabel(f"error of {study.observable.symbol}" if is_absolute(study) else f"relative error of {study.observable.symbol}")


def _order_two(axes, study: Study, points: list[Point], floor: float) -> None:
    """The slope of a method of order two whose step falls with its spacing: cost as dx^-(D+1), error as dx^2. From the first point of
    the front of MaPPM on."""
    front = front_of(by_code(points).get("mappm", []), floor)
    if len(front) < 2:
        return
    power = -2 / (len(study.case.scene["box"]["size"]) + 1)
    costs = [front[0].cost, front[-1].cost]
    axes.plot(costs, [front[0].error * (cost / front[0].cost) ** power for cost in costs], linestyle=(0, (6, 2, 1, 2, 1, 2)), color=GREY,
              linewidth=1, label="slope of order 2")


def is_absolute(study: Study) -> bool:
    """Errors against zero have no scale."""
    observable = study.observable
    return observable.reference == 0 and not observable.live and not observable.published


@dataclass(frozen=True)
class Precision:
    """The chart of a study, and what is read off it."""

    name: str
    purpose: str
    runs: int
    asked: int  # runs that the study asks for
    figure: Figure
    fronts: tuple[Front, ...]


def draw_precision(store: Store, study: Study, results: list[Result], file: Path) -> Precision:
    """Writes the chart and, beside it, its CSV."""
    points, floor = points_of(store, results), floor_of(results)
    file.parent.mkdir(parents=True, exist_ok=True)
    with figure_of(file, 6.4, 4.4) as axes:
        _draw(axes, study, points, floor)
    text = csv_of(HEAD, rows_of(study, points, floor))
    file.with_suffix(".csv").write_text(text)
    made = sum(result.entry is not None for result in results)
    machines = ", ".join(dict.fromkeys(point.machine for point in points if point.machine))
    caption = f"{study.name}: {'error' if is_absolute(study) else 'relative error'} of {study.observable.symbol} over core-seconds on {machines}."
    figure = Figure(file, caption, text, f"python3 -m verification study {study.name}")
    return Precision(study.name, study.purpose, made, len(study.runs), figure, tuple(fronts_of(study, points, floor)))


def precision_charts(shelf: Shelf, page: Path) -> list[Precision]:
    """Of all studies that ask for one and have runs."""
    return [draw_precision(shelf.store, study, results, page / f"{study.name}.svg") for study, results in charted(shelf, "precision")]
