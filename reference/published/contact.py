"""Contact of spheres: the figures of Chung and Ooi (2011)."""

import numpy as np

from reference.published.table import read_table

READING = 0.01  # uncertainty, of the largest ordinate of a curve


def chung_ooi(test: int, figure: str) -> tuple[np.ndarray, np.ndarray]:
    """(x, y) of a curve: tests 1 and 2 "force"; 4 "tangential_restitution", "angular_velocity" or "rebound_angle".

    Throws KeyError on another.
    """
    table = read_table("chung_ooi_2011")
    rows = [row for row in table.rows if (row["test"], row["figure"]) == (str(test), figure)]
    if not rows:
        known = sorted({f"{row['test']} {row['figure']}" for row in table.rows})
        raise KeyError(f"test {test}, figure {figure}: not in the table; there are {', '.join(known)}")
    x, y = (np.array([float(row[key]) for row in rows]) for key in ("x", "y"))
    return x, y
