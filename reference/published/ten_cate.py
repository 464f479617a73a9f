"""The spheres of ten Cate et al. (2002), which fall in a closed tank."""

import math

import numpy as np

from reference.published.cell import cell_of
from reference.published.sphere import abraham
from reference.published.table import read_table
from reference.published.value import Published

GRAVITY = 9.81
SPHERE_DENSITY = 1120.0
DIAMETER = 0.015
TEMPERATURE = 0.01  # of the viscosity: what silicone oil loses in half a degree
START, END = 6.5, 2.0  # gaps over the diameter between which the fall is timed
WIDTH = 0.8  # likewise: what lies so near to one of them tells when it is passed
READING = 0.03  # of a gap over the diameter: scatter of the readings about a smooth curve


def velocity_in_wide_fluid(density: float, viscosity: float) -> float:
    """Of the sphere, by Abraham's drag law, from which the paper takes it; m/s."""
    weight = (SPHERE_DENSITY - density) * GRAVITY * math.pi * DIAMETER**3 / 6
    slow, fast = 1e-4, 1.0
    while fast - slow > 1e-12:
        middle = 0.5 * (slow + fast)
        drag = abraham(middle * DIAMETER * density / viscosity) * 0.5 * density * middle**2 * math.pi * DIAMETER**2 / 4
        slow, fast = (middle, fast) if drag < weight else (slow, middle)
    return slow


def _half_digit(printed: str) -> float:
    """Standard deviation of a number that is rounded to the digits printed."""
    decimals = len(printed.partition(".")[2])
    return 10.0**-decimals / math.sqrt(12)


def input_uncertainty(density: str, viscosity: str) -> float:
    """Of a velocity, relative: by Abraham's law from densities and viscosity, rounded as printed, and the temperature."""
    rho, mu = float(density), float(viscosity)
    middle = velocity_in_wide_fluid(rho, mu)
    by_density = abs(velocity_in_wide_fluid(rho + 1, mu) / middle - 1)  # a kg/m3 more of the fluid, or less of the sphere
    by_viscosity = abs(velocity_in_wide_fluid(rho, 1.01 * mu) / middle - 1) / 0.01
    return math.hypot(by_density * _half_digit(density), by_density * _half_digit("1120"),
                      by_viscosity * math.hypot(_half_digit(viscosity) / mu, TEMPERATURE))


def largest_velocity(scene: dict) -> Published:
    """u_max in m/s of the experiment with the density and the viscosity of the scene. Throws ValueError."""
    table = read_table("ten_cate_2002")
    row = _experiment(scene)
    speed = velocity_in_wide_fluid(float(row["density"]), float(row["viscosity"]))
    value, rounding = float(row["ratio"]) * speed, _half_digit(row["ratio"])
    return Published(value, rounding * speed, f"{row['name']} of {table.source}",
                     value * input_uncertainty(row["density"], row["viscosity"]))


def gap_of(scene: dict) -> tuple[np.ndarray, np.ndarray, str]:
    """(time in s, gap between sphere and bottom over the diameter, source), read off the figure. Throws ValueError."""
    if (name := _experiment(scene)["name"]) != "E1":
        raise ValueError(f"{name}: no reading of its fall; there is E1")
    table = read_table("ten_cate_2002_gap")
    return np.array(table.column("time")), np.array(table.column("gap")), table.source


def time_of_fall(time: np.ndarray, gap: np.ndarray) -> float:
    """s from a gap of START diameters to one of END."""
    return _passing(time, gap, END)[0] - _passing(time, gap, START)[0]


def _passing(time: np.ndarray, gap: np.ndarray, level: float) -> tuple[float, float, int]:
    """The straight line through what lies within WIDTH of a gap: (time there, s for each diameter, number of points)."""
    near = np.abs(gap - level) < WIDTH
    slope, middle = np.polyfit(gap[near] - level, time[near], 1)
    return float(middle), abs(float(slope)), int(np.sum(near))


def fall(scene: dict) -> Published:
    """Time of fall in s of E1. Throws ValueError."""
    row = _experiment(scene)
    time, gap, source = gap_of(scene)
    value = time_of_fall(time, gap)
    readings = [READING * slope / math.sqrt(points) for _, slope, points in (_passing(time, gap, level) for level in (START, END))]
    return Published(value, math.hypot(*readings), source, value * input_uncertainty(row["density"], row["viscosity"]))


def _experiment(scene: dict) -> dict[str, str]:
    """That with the density and the viscosity of the scene. Throws ValueError."""
    cell, table = cell_of(scene, 3), read_table("ten_cate_2002")
    for row in table.rows:
        if (cell.density, cell.viscosity) == (float(row["density"]), float(row["viscosity"])):
            return row
    known = ", ".join(f"{row['density']} and {row['viscosity']}" for row in table.rows)
    raise ValueError(f"fluid.density and viscosity = {cell.density:g} and {cell.viscosity:g}: "
                     f"no experiment of ten Cate et al.; there are {known}")
