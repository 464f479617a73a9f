"""The paper that charts are drawn on: what holds for all of them. Every axis has labelled ticks, and legends lie below the axes,
where they cover nothing."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from textwrap import fill

import matplotlib
from matplotlib.ticker import FixedFormatter, FixedLocator, MaxNLocator, NullLocator
from matplotlib.transforms import ScaledTranslation

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of a backend without a display)

STYLE = {"font.size": 10, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.alpha": 0.3,
         "svg.fonttype": "none", "svg.hashsalt": "mappm"}
BLUE, GREEN, RED, GREY, DARK = "#1f5a96", "#17663a", "#b00020", "#888888", "#333333"
SMALL = 8  # points, of a legend
CHARACTER, HANDLE, LINE = 0.062, 0.44, 0.17  # inches: width of a letter of a legend, of its sample, and height of its lines
TICKS, NAME = 20, 16  # points below the axes that labels of ticks and the name of the axis take
FEW, MANY = 3, 7  # ticks of a logarithmic axis
ERROR = {"elinewidth": 0.8, "capsize": 2}  # of bars that show the range over rounds


@contextmanager
def figure_of(file: Path, width: float, height: float, rows: int = 1, columns: int = 1, cut: bool = False) -> Iterator:
    """Axes to draw on, in inches; ticks and legends are set and the file is written at the end, `cut` to what is drawn."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(rows, columns, figsize=(width, height), layout="constrained")
        yield axes
        drawn = [one for one in figure.axes if one.get_label() != "<colorbar>"]
        lines = [_legend_below(one, 0.82 * width / columns) for one in drawn]
        figure.set_figheight(height + LINE * max(lines))
        for one in drawn:
            for axis in (one.xaxis, one.yaxis):
                _label(axis)
        figure.savefig(file, dpi=130, bbox_inches="tight" if cut else None)
        plt.close(figure)


def _legend_below(axes, width: float) -> int:
    """Of what is labelled, in columns that fit the width in inches. Returns how many lines of text it has."""
    handles, labels = axes.get_legend_handles_labels()
    if not handles:
        return 0
    labels = [fill(label, int((width - HANDLE) / CHARACTER)) for label in labels]
    longest = max(len(line) for label in labels for line in label.splitlines())
    columns = min(len(labels), max(1, int(width / (HANDLE + CHARACTER * longest))))
    rows = math.ceil(len(labels) / columns)
    below = TICKS + (NAME if axes.get_xlabel() else 0)
    place = axes.transAxes + ScaledTranslation(0, -below / 72, axes.figure.dpi_scale_trans)
    axes.legend(handles, labels, frameon=False, fontsize=SMALL, ncols=columns, loc="upper center", bbox_to_anchor=(0.5, 0.0),
                bbox_transform=place, borderaxespad=0, borderpad=0.2, columnspacing=1.2, labelspacing=0.3)
    return rows * max(label.count("\n") + 1 for label in labels) + 1


def number(value: float) -> str:
    """Of a tick: 0.02, 300, or 2e-5 as powers of ten."""
    if value == 0 or 1e-3 <= abs(value) < 1e5:
        return f"{value:g}"
    mantissa, exponent = f"{value:e}".split("e")
    factor = "" if float(mantissa) == 1 else rf"{float(mantissa):g}\cdot "
    return rf"${factor}10^{{{int(exponent)}}}$"


def log_ticks(low: float, high: float) -> list[float]:
    """FEW or more between two positive limits: powers of ten, or 1, 2 and 5 times them, or round numbers where these are few."""
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    stride = max(1, math.ceil((last - first) / MANY))
    powers = [10.0**k for k in range(first, last + 1, stride)]
    choices = ([digit * power for power in powers for digit in digits] for digits in ((1,), (1, 3), (1, 2, 5)))
    round_numbers = (MaxNLocator(count, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high) for count in (4, 6, 10))
    for ticks in (*choices, *round_numbers):
        inside = [float(tick) for tick in ticks if low <= tick <= high and tick > 0]
        if len(inside) >= FEW:
            return inside
    return inside


def labelled_ticks(axis) -> list[float]:
    """Places inside the limits at which a tick has a label."""
    low, high = sorted(axis.get_view_interval())
    margin = 1e-9 * (high - low)
    places = axis.get_majorticklocs()
    labels = axis.get_major_formatter().format_ticks(places)
    return [place for place, label in zip(places, labels, strict=True) if label and low - margin <= place <= high + margin]


def _label(axis) -> None:
    """Sees to it that there are two labelled ticks at least, where the chart has not set its own."""
    axis.axes.get_xlim(), axis.axes.get_ylim()  # limits are worked out where they are asked for
    if isinstance(axis.get_major_locator(), FixedLocator | NullLocator):
        return
    low, high = sorted(axis.get_view_interval())
    if axis.get_scale() == "log":
        ticks = log_ticks(low, high)
        axis.set_major_locator(FixedLocator(ticks))
        axis.set_major_formatter(FixedFormatter([number(tick) for tick in ticks]))
        axis.set_minor_locator(NullLocator())
    elif len(labelled_ticks(axis)) < 2:
        ticks = MaxNLocator(6, min_n_ticks=4).tick_values(low, high)
        axis.set_major_locator(FixedLocator(ticks[(ticks >= low) & (ticks <= high)]))


def bars(off: list[tuple[float, float]]) -> list[list[float]]:
    """Below and above, as matplotlib takes them."""
    return [[low for low, _ in off], [high for _, high in off]]
