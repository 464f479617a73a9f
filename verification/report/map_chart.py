"""Stability maps: how the runs of a study over two factors came out, and where one class borders on another."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.colors import ListedColormap

from verification.report.canvas import figure_of
from verification.report.figure import Figure, csv_of
from verification.studies.classes import ABOUT, BLOWN_UP, CLASSES, CLUMPED, DRIFTING, JAMMED, LEAKED, NO_VALUE, REFUSED, RIGHT, WRONG
from verification.studies.grid import place_of
from verification.studies.study import Result, Study, charted, command_of
from verification.suite.runner import Shelf

# Told apart by marks without colour; the colours are those of Okabe and Ito (2008), which the colour-blind tell apart.
LOOKS = {RIGHT: ("#0072b2", "o"), DRIFTING: ("#56b4e9", "s"), WRONG: ("#d55e00", "X"), CLUMPED: ("#cc79a7", "P"), JAMMED: ("#e69f00", "v"),
         LEAKED: ("#f0e442", "D"), BLOWN_UP: ("#000000", "x"), NO_VALUE: ("#009e73", "1"), REFUSED: ("#999999", "_")}
GRAIN = 160  # cells of the ground along each axis
HEAD = ("class", "setting", "error", "objection or last words", "nearest PP (dx)", "share inside solids", "flow / declared", "core-seconds", "commit",
        "machine", "command")


@dataclass(frozen=True)
class Map:
    name: str
    purpose: str
    figure: Figure
    counts: tuple[tuple[str, int, str], ...]  # class, runs, what it means
    wrong: tuple[tuple[str, str], ...]  # error and command of what is wrong but alive, the worst first


def _rows(study: Study, results: list[Result]) -> list[tuple]:
    rows = []
    for one in results:
        known = one.outcome is not None
        rows.append((one.kind, " ".join(one.setting), one.outcome.error if known else math.nan, one.outcome.measured.objection if known else one.why,
                     *(float(one.health.get(name, math.nan)) for name in ("nearest", "inside", "flow")),
                     one.entry.stored.cost.core_seconds if known and one.entry.stored.cost else math.nan, one.entry.stored.made.source if known else "",
                     one.entry.stored.made.machine if known else "", command_of(study, one.job)))
    return rows


def _ground(axes, places: np.ndarray, kinds: list[str]) -> None:
    """Each place in the pale colour of the nearest run, distances taken in shares of the logarithmic axes."""
    logs = np.log(places)
    low, high = logs.min(axis=0), logs.max(axis=0)
    span = np.where(high > low, high - low, 1.0)
    low, high = low - 0.06 * span, high + 0.06 * span
    grid = np.stack(np.meshgrid(*(np.linspace(low[k], high[k], GRAIN) for k in (0, 1)), indexing="xy"), axis=-1)
    off = (grid[:, :, None, :] - logs) / span
    nearest = np.argmin((off**2).sum(axis=-1), axis=-1)
    numbers = np.array([CLASSES.index(kind) for kind in kinds])[nearest]
    shades = ListedColormap([LOOKS[kind][0] for kind in CLASSES])
    axes.pcolormesh(np.exp(grid[:, :, 0]), np.exp(grid[:, :, 1]), numbers, cmap=shades, vmin=-0.5, vmax=len(CLASSES) - 0.5, alpha=0.22,
                    shading="nearest", rasterized=True, zorder=0)
    axes.set_xlim(np.exp([low[0], high[0]]))
    axes.set_ylim(np.exp([low[1], high[1]]))


def draw_map(study: Study, results: list[Result], file: Path) -> Map:
    """Writes the map and, beside it, its CSV."""
    file.parent.mkdir(parents=True, exist_ok=True)
    places, kinds = np.array([place_of(one.setting) for one in results]), [one.kind for one in results]
    with figure_of(file, 6.0, 4.6) as axes:
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.grid(False)
        _ground(axes, places, kinds)
        for kind in CLASSES:
            members = places[[one == kind for one in kinds]]
            if len(members):
                colour, mark = LOOKS[kind]
                axes.plot(members[:, 0], members[:, 1], mark, color=colour, markeredgecolor="black" if mark not in "x_1" else colour,
                          markeredgewidth=0.5 if mark not in "x_1" else 1.4, markersize=6, label=f"{kind} ({len(members)})")
        axes.set_xlabel(study.blocks[0].factors[0])
        axes.set_ylabel(study.blocks[0].factors[1])
    text = csv_of(HEAD, _rows(study, results))
    file.with_suffix(".csv").write_text(text)
    wrong = sorted((one for one in results if one.kind == WRONG), key=lambda one: -abs(one.outcome.error))
    caption = f"{study.name}: how {len(results)} runs came out, over {' and '.join(study.blocks[0].factors)}. A place has the colour of the nearest run."
    return Map(study.name, study.purpose, Figure(file, caption, text, f"python3 -m verification study {study.name}"),
               tuple((kind, kinds.count(kind), ABOUT[kind]) for kind in CLASSES if kind in kinds),
               tuple((one.outcome.error_text, command_of(study, one.job)) for one in wrong))


def maps(shelf: Shelf, page: Path) -> list[Map]:
    """Of all studies that ask for one and have runs."""
    return [draw_map(study, results, page / f"{study.name}.svg") for study, results in charted(shelf, "map")]
