"""What measure.py of a case gives to draw: `def curves(run: Run) -> list[Chart]`."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Curve:
    """`reference` curves are drawn as dark lines, or as circles where `points`; measured ones in colour."""

    label: str
    x: np.ndarray
    y: np.ndarray
    reference: bool = False
    points: bool = False
    error: np.ndarray | None = None  # of y, drawn as bars
    marker: str = "o"  # of points, as matplotlib names them


@dataclass(frozen=True)
class Chart:
    title: str
    x_label: str
    y_label: str
    curves: tuple[Curve, ...] = ()
    log: bool = False  # of y


POINTS, NODES = 1500, 600  # of a curve that is kept, drawn as points or as a line


def _numbers(values: np.ndarray, chosen: np.ndarray) -> list[float | None]:
    """Rounded to what a picture can show; NaN and infinity, which JSON lacks, as None."""
    return [float(f"{value:.6g}") if np.isfinite(value) else None for value in np.asarray(values, dtype=float)[chosen]]


def _kept_curve(curve: Curve) -> dict:
    count, most = len(curve.x), POINTS if curve.points else NODES
    chosen = np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int)) if count else np.arange(0)
    found = {"label": curve.label, "x": _numbers(curve.x, chosen), "y": _numbers(curve.y, chosen)}
    if curve.error is not None:
        found["error"] = _numbers(np.broadcast_to(curve.error, np.shape(curve.x)), chosen)
    return found | {"reference": curve.reference, "points": curve.points, "marker": curve.marker}


def _curve(kept: dict) -> Curve:
    arrays = {name: np.array([np.nan if value is None else value for value in kept[name]], dtype=float)
              for name in ("x", "y", "error") if name in kept}
    return Curve(**(kept | arrays))


def kept_chart(chart: Chart) -> dict:
    """As JSON, thinned."""
    return {"title": chart.title, "x_label": chart.x_label, "y_label": chart.y_label, "log": chart.log,
            "curves": [_kept_curve(curve) for curve in chart.curves]}


def chart_of(kept: dict) -> Chart:
    return Chart(**(kept | {"curves": tuple(_curve(curve) for curve in kept["curves"])}))
