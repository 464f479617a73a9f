"""Curves over time, drawn with matplotlib."""

from pathlib import Path

import matplotlib
import numpy as np

from verification.solver import Run

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of a backend without a display)

STYLE = {"font.size": 10, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.alpha": 0.3}


def _with_unit(name: str, unit: str) -> str:
    return f"{name} ({unit})" if unit else name


def slip_and_drag(run: Run, file: Path) -> None:
    """Mean slip velocity of the solids and mean drag per solid along the body force, against time."""
    series = run.series
    axis = "xyz"[int(np.argmax(np.abs(run.scene["force"]["fluid"])))]
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, 1, sharex=True, figsize=(8, 5.6), layout="constrained")
        curves = (("slip_" + axis, "slip velocity of the solids", 0), ("drag_" + axis, "drag per solid", 1))
        for axes_of, (column, title, skipped) in zip(axes, curves, strict=True):  # no drag before the first sample
            axes_of.plot(series["time"][skipped:], series[column][skipped:], color="#1f5a96", linewidth=1.4)
            axes_of.axhline(0.0, color="#888888", linewidth=0.8)
            axes_of.set_ylabel(_with_unit(title, series.units[column]))
        axes[-1].set_xlabel(_with_unit("time", series.units["time"]))
        figure.savefig(file, dpi=130)
        plt.close(figure)
