"""Published velocities on the centre lines of the lid-driven cavity."""

from dataclasses import dataclass

import numpy as np

from reference.published.table import read_table


@dataclass(frozen=True)
class CentreLine:
    """u over y at x = 1/2, or v over x at y = 1/2; ascending."""

    position: np.ndarray
    velocity: np.ndarray


def centre_line(component: str, reynolds: int, source: str = "ghia_1982") -> CentreLine:
    """component: "u" or "v"; reynolds: 100 or 1000; source: "ghia_1982", or "botella_1998" (1000 only)."""
    rows = [row for row in read_table(source).rows if row["component"] == component]
    return CentreLine(*(np.array([float(row[key]) for row in rows]) for key in ("position", f"re{reynolds}")))
