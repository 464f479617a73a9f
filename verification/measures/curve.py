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
