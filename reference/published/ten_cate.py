"""The spheres of ten Cate et al. (2002), which fall in a closed tank."""

import math

from reference.published.cell import cell_of
from reference.published.sphere import abraham
from reference.published.table import read_table
from reference.published.value import Published

GRAVITY = 9.81
SPHERE_DENSITY = 1120.0
DIAMETER = 0.015
ACCURACY = 0.01  # of the largest velocity


def velocity_in_wide_fluid(density: float, viscosity: float) -> float:
    """Of the sphere, by Abraham's drag law, from which the paper takes it; m/s."""
    weight = (SPHERE_DENSITY - density) * GRAVITY * math.pi * DIAMETER**3 / 6
    slow, fast = 1e-4, 1.0
    while fast - slow > 1e-12:
        middle = 0.5 * (slow + fast)
        drag = abraham(middle * DIAMETER * density / viscosity) * 0.5 * density * middle**2 * math.pi * DIAMETER**2 / 4
        slow, fast = (middle, fast) if drag < weight else (slow, middle)
    return slow


def largest_velocity(scene: dict) -> Published:
    """u_max in m/s of the experiment with the density and the viscosity of the scene. Throws ValueError."""
    cell, table = cell_of(scene, 3), read_table("ten_cate_2002")
    for row in table.rows:
        if (cell.density, cell.viscosity) == (float(row["density"]), float(row["viscosity"])):
            value = float(row["ratio"]) * velocity_in_wide_fluid(cell.density, cell.viscosity)
            return Published(value, ACCURACY * value, f"{row['name']} of {table.source}")
    known = ", ".join(f"{row['density']} and {row['viscosity']}" for row in table.rows)
    raise ValueError(f"fluid.density and viscosity = {cell.density:g} and {cell.viscosity:g}: "
                     f"no experiment of ten Cate et al.; there are {known}")
