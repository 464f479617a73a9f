"""Published velocities on the centre lines of the lid-driven cavity."""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

PUBLISHED = Path(__file__).parent / "published"


@dataclass(frozen=True)
class CentreLine:
    """u over y at x = 1/2, or v over x at y = 1/2; ascending."""

    position: np.ndarray
    velocity: np.ndarray


def centre_line(component: str, reynolds: int, source: str = "ghia_1982") -> CentreLine:
    """component: "u" or "v"; reynolds: 100 or 1000; source: "ghia_1982", or "botella_1998" (1000 only)."""
    with (PUBLISHED / f"{source}.csv").open() as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        found = [(float(row["position"]), float(row[f"re{reynolds}"])) for row in rows if row["component"] == component]
    return CentreLine(*np.array(found).T)
