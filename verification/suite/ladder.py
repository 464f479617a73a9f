"""Grid convergence: observed order, Richardson's value and the grid convergence index.

Celik, Ghia, Roache, Freitas, Coleman and Raad, J. Fluids Eng. 130, 2008, 078001; Roache, J. Fluids Eng. 116, 1994, 405-413.
Eca and Hoekstra, J. Comput. Phys. 262, 2014, 104-130. Levels run from coarse to fine; h is what is refined, the spacing or the step.
"""

import math
from dataclasses import dataclass

import numpy as np

SAFETY, SAFETY_WITHOUT_ORDER = 1.25, 3.0  # Roache's factors, with three levels that converge and without
LOWEST_ORDER, HIGHEST_ORDER = 0.5, 4.0  # an observed order is not trusted beyond these in an estimate of an error


@dataclass(frozen=True)
class Convergence:
    """Of one observable over its levels."""

    order: float  # observed, of the three finest levels; NaN where they do not converge monotonically
    richardson: float  # value extrapolated to h = 0; NaN where the order is
    gci: float  # 95 % bound of the error of the finest level, absolute

    @property
    def monotonic(self) -> bool:
        return not math.isnan(self.order)


def observed_order(h: list[float], values: list[float]) -> float:
    """Of the three finest levels; NaN where the values do not approach a limit monotonically."""
    coarse, medium, fine = values[-3:]
    r21, r32 = h[-2] / h[-1], h[-3] / h[-2]
    e21, e32 = medium - fine, coarse - medium
    if e21 == 0.0 or e32 == 0.0 or e32 / e21 <= 0.0:
        return math.nan
    order = abs(math.log(e32 / e21)) / math.log(r21)
    for _ in range(100):  # fixed point for ratios that differ; exact at once where they are equal
        ratio = (r21**order - 1) / (r32**order - 1) if order > 0 else 1.0
        following = math.log(e32 / e21 * ratio) / math.log(r21)
        if abs(following - order) < 1e-10:
            break
        order = following
    return order if order > 0 else math.nan


def error_order(h: list[float], errors: list[float]) -> float:
    """Slope of log |error| over log h, by least squares over all levels: the order where the exact value is known. NaN where an
    error is no number."""
    if not all(map(math.isfinite, errors)):
        return math.nan
    if min(abs(error) for error in errors) == 0.0:
        return math.inf
    slope, _ = np.polyfit(np.log(h), np.log(np.abs(errors)), 1)
    return float(slope)


def converge(h: list[float], values: list[float]) -> Convergence:
    """At least two levels. Without an observed order the index takes first order and the larger factor of safety."""
    ratio, change = h[-2] / h[-1], abs(values[-2] - values[-1])
    order = observed_order(h, values) if len(values) > 2 else math.nan
    if math.isnan(order):
        return Convergence(order, math.nan, SAFETY_WITHOUT_ORDER * change / (ratio - 1))
    used = min(max(order, LOWEST_ORDER), HIGHEST_ORDER)
    richardson = values[-1] + (values[-1] - values[-2]) / (ratio**order - 1)
    return Convergence(order, richardson, SAFETY * change / (ratio**used - 1))


@dataclass(frozen=True)
class Extrapolated:
    """Value at h = 0 with its standard uncertainty, absolute, and in words how it was made."""

    value: float
    uncertainty: float
    how: str
    used: int  # of the levels, the finest


def _fitted(h: np.ndarray, values: np.ndarray, order: int) -> tuple[float, float]:
    """(a, its standard error) of values = a + b h^order, by least squares."""
    basis = np.column_stack([np.ones_like(h), h**order])
    coefficients, *_ = np.linalg.lstsq(basis, values, rcond=None)
    variance = np.sum((values - basis @ coefficients) ** 2) / (len(h) - 2)
    return float(coefficients[0]), float(np.sqrt(variance * np.linalg.inv(basis.T @ basis)[0, 0]))


def extrapolated(h: list[float], values: list[float]) -> Extrapolated:
    """At least three levels. Richardson's value where they converge with an order that can be trusted; else, as scattered
    levels have none, a + b h or a + b h^2, whichever fits all of them better. NaN where a value is no number."""
    if not all(map(math.isfinite, values)):
        return Extrapolated(math.nan, 0.0, "no number on a level", len(values))
    found = converge(h, values)
    if LOWEST_ORDER <= found.order <= HIGHEST_ORDER:
        correction = abs(found.richardson - values[-1])
        second = values[-1] + (values[-1] - values[-2]) / ((h[-2] / h[-1]) ** 2 - 1)
        spread = max((SAFETY - 1) * correction, abs(found.richardson - second))
        return Extrapolated(found.richardson, spread / 2, f"Richardson, order {found.order:.2f}", 3)
    fits = {order: _fitted(np.array(h), np.array(values), order) for order in (1, 2)}
    best = min(fits, key=lambda order: fits[order][1])
    value, error = fits[best]
    other = fits[3 - best][0]
    return Extrapolated(value, math.hypot(error, (value - other) / 2), f"least squares, order {best}", len(values))
