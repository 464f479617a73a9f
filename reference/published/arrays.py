"""Stokes drag of regular arrays: F the mean pressure gradient times the cell, U the superficial velocity."""

import math

from reference.published.cell import equal_sides, refuse_outside
from reference.published.table import Table, read_table
from reference.published.value import Published
from reference.stokes.square_array import square_array

SAME_FRACTION = 1e-4  # relative: a scene gives its radius in some six digits


def _row(table: Table, fraction: float) -> Published | None:
    for row in table.rows:
        if math.isclose(float(row["fraction"]), fraction, rel_tol=SAME_FRACTION):
            return Published(float(row["drag"]), float(row["uncertainty"]), table.source)
    return None


def square_stokes(fraction: float) -> Published:
    """F / (mu U) of a square array of cylinders: the table of Sangani and Acrivos; between its rows its like, computed.

    The Stokes flow that fills the gaps meets all rows of the table but the one at 0.3, which is 0.02 % high.
    """
    table = read_table("sangani_acrivos_1982_square")
    refuse_outside("solids fraction", fraction, 0.05 * (1 - SAME_FRACTION), 0.5 * (1 + SAME_FRACTION), table.source)
    row = _row(table, fraction)
    if row:
        return row
    found = square_array(fraction)
    how = "Stokes flow by eigenfunctions and collocation (reference/stokes/square_array.py), between rows of "
    return Published(found.drag, found.drag * max(found.change, 1e-8), how + table.source)


def cubic_series(fraction: float) -> Published:
    """F / (6 pi mu R U) of a simple cubic array of spheres by the series of Sangani and Acrivos, up to 0.22.

    Its truncation is 2e-7 at 0.1, 9e-5 at 0.2 and 3e-3 at 0.3 of the value.
    """
    table = read_table("sangani_acrivos_1982_cubic")
    refuse_outside("solids fraction", fraction, 0.0, 0.22, table.source)
    chi = (6 * fraction / math.pi) ** (1 / 3)
    value = sum(factor * chi**s for s, factor in enumerate(table.column("coefficient")))
    return Published(value, value * (1e-6 + 1e-4 * (fraction / 0.2) ** 8.7), table.source)


def cubic_stokes(fraction: float) -> Published:
    """F / (6 pi mu R U) of a simple cubic array: a row of Zick and Homsy above 0.13, else the series up to 0.22."""
    rows = read_table("zick_homsy_1982")
    row = _row(rows, fraction)
    if row and fraction > 0.13:
        return row
    return cubic_series(fraction)


def hasimoto(fraction: float) -> Published:
    """F / (6 pi mu R U) of a simple cubic array in the dilute limit; the next term is about 2 phi^(8/3)."""
    source = "Hasimoto, J. Fluid Mech. 5, 1959, 317-328: 1 / (1 - 1.7601 phi^(1/3) + phi - 1.5593 phi^2)"
    refuse_outside("solids fraction", fraction, 0.0, 0.06, source)
    value = 1 / (1 - 1.7601 * fraction ** (1 / 3) + fraction - 1.5593 * fraction**2)
    return Published(value, 4 * value**2 * fraction ** (8 / 3), source)


def square_array_stokes(scene: dict) -> Published:
    return square_stokes(equal_sides(scene, 2).fraction)


def simple_cubic_stokes(scene: dict) -> Published:
    return cubic_stokes(equal_sides(scene, 3).fraction)


def simple_cubic_hasimoto(scene: dict) -> Published:
    return hasimoto(equal_sides(scene, 3).fraction)
