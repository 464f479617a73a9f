"""The chart of what solids cost: figures of bench/solids.py."""

from pathlib import Path

from verification.report.canvas import BLUE, DARK, ERROR, GREY, bars, figure_of
from verification.store.figures import Figures

SUSPENSIONS = {"13_2d": "discs, 13 %", "13_3d": "spheres, 13 %", "dense_2d": "discs, 70 %, in contact",
               "dense_3d": "spheres, 55 %, in contact", "sizes_2d": "discs, radii 1:10", "sizes_3d": "spheres, radii 1:10"}
GOAL = 0.1  # share of solids at a fraction of 13 %


def costs_of_solids(figures: Figures, file: Path) -> None:
    """Shares of a step on one process, and what a PP costs beside one of the fluid alone."""
    with figure_of(file, 9, 3.2, columns=2) as (shares, costs):
        _shares(shares, figures)
        _costs(costs, figures)
        for axes in (shares, costs):
            axes.invert_yaxis()
            axes.grid(axis="y", visible=False)


def _shares(axes, figures: Figures) -> None:
    """In per cent of a step on one process, a row a suspension."""
    parts = {"solids": ("solids and their copies", BLUE), "frozen_pairs": ("pairs of PPs and FPs", GREY)}
    values = {part: [100 * figures.value("share", suspension=name, ranks=1, part=part) for name in SUSPENSIONS] for part in parts}
    passed = [0.0] * len(SUSPENSIONS)
    for part, (words, color) in parts.items():
        axes.barh(range(len(SUSPENSIONS)), values[part], 0.6, left=passed, color=color, label=words)
        passed = [before + value for before, value in zip(passed, values[part], strict=True)]
    for row, share in enumerate(values["solids"]):
        axes.annotate(f"{share:.2g} %", (passed[row], row), (4, 0), textcoords="offset points", va="center", fontsize=8, color=BLUE,
                      bbox={"color": "white", "pad": 1})
    axes.axvline(100 * GOAL, color=DARK, linewidth=1, zorder=0, label="goal at 13 %")
    axes.set_yticks(range(len(SUSPENSIONS)), SUSPENSIONS.values())
    axes.set_xlim(0, 1.12 * max(passed))
    axes.set_xlabel("per cent of a step")


def _costs(axes, figures: Figures) -> None:
    """Of a PP over one of the fluid alone, on one process and on two, a row a suspension."""
    for ranks, words, color, side in ((1, "one process", BLUE, -0.18), (2, "two", GREY, 0.18)):
        values = [figures.value("cost_per_pp_over_fluid", suspension=name, ranks=ranks) for name in SUSPENSIONS]
        off = [figures.off("cost_per_pp_over_fluid", suspension=name, ranks=ranks) for name in SUSPENSIONS]
        axes.barh([row + side for row in range(len(values))], values, 0.34, color=color, label=words, xerr=bars(off), error_kw=ERROR)
        for row, (value, (_, high)) in enumerate(zip(values, off, strict=True)):
            axes.text(value + high, row + side, f" {value:.2g}", va="center", fontsize=7)
    axes.axvline(1.0, color=DARK, linewidth=1)
    axes.set_yticks(range(len(SUSPENSIONS)), [])
    axes.set_xlabel("cost of a PP over one of the fluid alone")
