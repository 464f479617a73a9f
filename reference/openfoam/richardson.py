"""Value and uncertainty from levels of refinement: Richardson (1911), Roache (1994), Celik et al. (2008)."""

import math
from dataclasses import dataclass

SCHEME_ORDER = 2.0
NEAR = 0.4  # an observed order this close to that of the scheme is trusted
ORDERS = (0.5, 8.0)  # searched for an observed one
SAFETY_TRUSTED, SAFETY = 1.25, 3.0


@dataclass(frozen=True)
class Extrapolated:
    """The value at size 0, half the grid convergence index of the finest level as a standard uncertainty, absolute."""

    value: float
    uncertainty: float
    order: float | None  # observed; None with fewer than three levels, or where the changes do not shrink steadily
    note: str


def observed_order(sizes: tuple[float, float, float], values: tuple[float, float, float]) -> float | None:
    """p in f = f0 + C h^p through three levels, from coarse to fine. None where there is none in ORDERS."""
    first, second = values[0] - values[1], values[1] - values[2]
    if first * second <= 0:
        return None

    def excess(p: float) -> float:
        change = (sizes[0] ** p - sizes[1] ** p) / (sizes[1] ** p - sizes[2] ** p)
        return change - first / second

    low, high = ORDERS
    if excess(low) * excess(high) > 0:
        return None
    for _ in range(60):
        middle = (low + high) / 2
        if excess(low) * excess(middle) <= 0:
            high = middle
        else:
            low = middle
    return (low + high) / 2


def _index(sizes, values, order: float, safety: float) -> float:
    """Grid convergence index of the finest level, absolute."""
    return safety * abs(values[-1] - values[-2]) / ((sizes[-2] / sizes[-1]) ** order - 1)


def _even_fit(sizes: tuple[float, float, float], values: tuple[float, float, float]) -> float:
    """The value at 0 of the polynomial in h^2 of degree 2 through three levels: errors go as h^2, h^4."""
    squares = [size**2 for size in sizes]
    total = 0.0
    for i, value in enumerate(values):
        others = [square for j, square in enumerate(squares) if j != i]
        total += value * math.prod(other / (other - squares[i]) for other in others)
    return total


def extrapolate(sizes: list[float], values: list[float], similar: bool = True) -> Extrapolated:
    """From coarse to fine; at least two levels, the finest three count. Throws ValueError on fewer.

    Where the meshes are not `similar`, an observed order near that of the scheme may be chance, and is not trusted.
    """
    if len(values) < 2:
        raise ValueError("an extrapolation needs two levels")
    if len(values) == 2:
        step = _index(sizes, values, SCHEME_ORDER, 1.0) * math.copysign(1, values[-1] - values[-2])
        uncertainty = _index(sizes, values, SCHEME_ORDER, SAFETY) / 2
        note = "Richardson value of two levels with the order 2 of the scheme; half the GCI, safety factor 3."
        return Extrapolated(values[-1] + step, uncertainty, None, note)
    sizes, values = tuple(sizes[-3:]), tuple(values[-3:])
    order = observed_order(sizes, values)
    if order is None:
        spread = max(values) - min(values)
        note = "Value of the finest level, as the levels do not converge steadily; 1.5 times their spread."
        return Extrapolated(values[-1], SAFETY * spread / 2, None, note)
    if similar and abs(order - SCHEME_ORDER) <= NEAR:
        uncertainty = _index(sizes, values, SCHEME_ORDER, SAFETY_TRUSTED) / 2
        note = "Errors in h^2 and h^4 eliminated over three levels; half the GCI of the finest, safety factor 1.25."
        return Extrapolated(_even_fit(sizes, values), uncertainty, order, note)
    used = min(order, SCHEME_ORDER)
    step = _index(sizes, values, used, 1.0) * math.copysign(1, values[-1] - values[-2])
    note = f"Richardson value of the finest two of three levels with order {used:.2f}; half the GCI, safety factor 3."
    return Extrapolated(values[-1] + step, _index(sizes, values, used, SAFETY) / 2, order, note)
