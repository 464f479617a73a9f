"""What a sequence of levels shows: whether it converges, to what, and how far the finest level may be from there.

Levels run from coarse to fine; h is what is refined, the spacing or the step. The method is of second order, FORMAL: no estimate
takes a higher one, and an observed order far above it only says that the levels are not yet where theory holds.

Eca and Hoekstra, J. Comput. Phys. 262, 2014, 104-130, over four levels or more; their limits on the order and their factors also
over three, whose order is that of Celik, Ghia, Roache, Freitas, Coleman and Raad, J. Fluids Eng. 130, 2008, 078001; over two,
Roache, J. Fluids Eng. 116, 1994, 405-413.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

FORMAL = 2.0
LOWEST_ORDER, HIGHEST_ORDER = 0.5, 2.1  # an observed order is trusted between these
BAND = (0.5, 2.5)  # where the observed order must lie if a manifest says nothing narrower, and may not be declared beyond
SAFETY, SAFETY_WITHOUT_ORDER = 1.25, 3.0
CONVERGING, NOISE_LIMITED, DIVERGING, NOT_CONVERGING = "CONVERGING", "NOISE-LIMITED", "DIVERGING", "NOT CONVERGING"


@dataclass(frozen=True)
class Estimate:
    """Of one observable over its levels."""

    bound: float  # 95 %, of the error of the finest level, absolute
    order: float = math.nan  # observed, not clamped; NaN where there is none
    limit: float = math.nan  # at h = 0; NaN where the order is not to be trusted
    how: str = ""


def is_trusted(order: float) -> bool:
    return LOWEST_ORDER <= order <= HIGHEST_ORDER


def order_text(order: float) -> str:
    """For people, who are shown no order that nobody believes."""
    if math.isnan(order):
        return "none"
    if order < 0:
        return "below 0"
    return f"above {BAND[1]:g}" if order > BAND[1] else f"{order:.2f}"


def observed_order(h: Sequence[float], values: Sequence[float]) -> float:
    """Of the three finest levels: p with values = limit + a h^p, below 0 where the differences grow. NaN where the values swing, or
    do not change."""
    coarse, medium, fine = values[-3:]
    r21, r32 = h[-2] / h[-1], h[-3] / h[-2]
    e21, e32 = medium - fine, coarse - medium
    if not math.isfinite(e21 * e32) or e21 == 0.0 or e32 / e21 <= 0.0:
        return math.nan  # also where the first two are equal

    def excess(order: float) -> float:
        """Grows with the order from below 0 to above it."""
        if abs(order) < 1e-9:
            return math.log(r32) / math.log(r21) - e32 / e21
        return r21**order * (r32**order - 1) / (r21**order - 1) - e32 / e21

    low, high = -50.0, 50.0
    if excess(low) > 0 or excess(high) < 0:
        return low if excess(low) > 0 else high
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) < 0 else (low, middle)
    return 0.5 * (low + high)


def error_order(h: Sequence[float], errors: Sequence[float]) -> float:
    """Slope of log |error| over log h, by least squares over all levels: the order where the exact value is known. NaN where an
    error is no number, or where errors have both signs and fall through 0."""
    if not all(map(math.isfinite, errors)):
        return math.nan
    if min(abs(error) for error in errors) == 0.0:
        return math.inf
    if min(errors) < 0 < max(errors):
        return math.nan
    slope, _ = np.polyfit(np.log(h), np.log(np.abs(errors)), 1)
    return float(slope)


# Least squares.


@dataclass(frozen=True)
class Fit:
    """values = limit + sum of a_k h^k over the powers."""

    limit: float
    deviation: float  # standard, of the values from the fit
    correction: float  # value of the fit on the finest level, less the limit
    powers: tuple[float, ...]
    error: float  # standard, of the limit


def fitted(h: np.ndarray, values: np.ndarray, powers: tuple[float, ...], weighted: bool = False, free: int | None = None) -> Fit:
    """`free` is the number of what is fitted, where that is more than the factors. Weights go with 1 / h."""
    weight = (1 / h) / np.sum(1 / h) * len(h) if weighted else np.ones_like(h)
    basis = np.column_stack([np.ones_like(h), *(h**power for power in powers)])
    root = np.sqrt(weight)[:, None]
    factors, *_ = np.linalg.lstsq(root * basis, root[:, 0] * values, rcond=None)
    left = values - basis @ factors
    variance = float(np.sum(weight * left**2)) / max(1, len(h) - (free or basis.shape[1]))
    covariance = variance * np.linalg.pinv((root * basis).T @ (root * basis))
    return Fit(float(factors[0]), math.sqrt(variance), float(basis[-1] @ factors - factors[0]), powers, math.sqrt(max(0.0, covariance[0, 0])))


def _best(fits: list[Fit]) -> Fit:
    return min(fits, key=lambda fit: fit.deviation)


def _power_law(h: np.ndarray, values: np.ndarray, weighted: bool) -> Fit:
    """limit + a h^p with the p of the least deviation."""
    def deviation(order: float) -> float:
        return fitted(h, values, (order,), weighted, 3).deviation

    orders = np.linspace(-2.0, 8.0, 201)
    orders = orders[np.abs(orders) > 1e-6]
    at = int(np.argmin([deviation(order) for order in orders]))
    low, high = orders[max(0, at - 1)], orders[min(len(orders) - 1, at + 1)]
    golden = (math.sqrt(5) - 1) / 2
    for _ in range(60):
        left, right = high - golden * (high - low), low + golden * (high - low)
        low, high = (low, right) if deviation(left) < deviation(right) else (left, high)
    return fitted(h, values, (0.5 * (low + high),), weighted, 3)


def _least_squares(h: np.ndarray, values: np.ndarray) -> Estimate:
    """Four levels or more."""
    laws = [_power_law(h, values, weighted) for weighted in (False, True)]
    free = _best([law for law in laws if law.powers[0] > 0] or laws)
    order = free.powers[0]
    chosen = free
    if order > FORMAL:
        chosen = _best([fitted(h, values, powers, weighted) for powers in ((1.0,), (2.0,)) for weighted in (False, True)])
    elif order < LOWEST_ORDER:
        chosen = _best([fitted(h, values, powers, weighted) for powers in ((1.0,), (2.0,), (1.0, 2.0)) for weighted in (False, True)])
    range_of_data = float(np.ptp(values)) / (len(h) - 1)
    trusted = is_trusted(order)
    safety = SAFETY if trusted and chosen.deviation < range_of_data else SAFETY_WITHOUT_ORDER
    off = abs(float(values[-1]) - chosen.limit - chosen.correction)
    if chosen.deviation < range_of_data or range_of_data == 0.0:
        bound = safety * abs(chosen.correction) + chosen.deviation + off
    else:
        bound = safety * chosen.deviation / range_of_data * (abs(chosen.correction) + chosen.deviation + off)
    return Estimate(bound, order, chosen.limit if trusted else math.nan, "least squares")


def estimate(h: Sequence[float], values: Sequence[float]) -> Estimate:
    """At least two levels."""
    if not all(map(math.isfinite, values)):
        return Estimate(math.nan, how="no number on a level")
    ratio, change = h[-2] / h[-1], values[-1] - values[-2]
    if len(values) < 3:
        return Estimate(SAFETY_WITHOUT_ORDER * abs(change) / (ratio - 1), how="two levels")
    if max(values) == min(values):
        return Estimate(0.0, math.nan, values[-1], "no change over the levels")
    if len(values) > 3:
        return _least_squares(np.array(h, dtype=float), np.array(values, dtype=float))
    order = observed_order(h, values)
    if is_trusted(order):
        step = change / (ratio ** min(order, FORMAL) - 1)
        return Estimate(SAFETY * abs(step), order, values[-1] + step, "three levels")
    if order > HIGHEST_ORDER:  # the last change may be small by chance: at least what second order makes of the one before
        expected = (values[-2] - values[-3]) * (h[-2] ** FORMAL - h[-1] ** FORMAL) / (h[-3] ** FORMAL - h[-2] ** FORMAL)
        change = max(abs(change), abs(expected))
        return Estimate(SAFETY_WITHOUT_ORDER * change / (ratio**FORMAL - 1), order, how="three levels")
    return Estimate(SAFETY_WITHOUT_ORDER * max(max(values) - min(values), abs(change) / (ratio - 1)), order, how="three levels")


# What the levels show.


ROUNDING = 1e-12  # of a value


def _grows(h: Sequence[float], values: Sequence[float], floor: float) -> bool:
    """Each difference, for its step in h, is larger than the one before, by more than the floor."""
    changes = np.diff(values)
    if np.max(np.abs(changes)) <= floor:
        return False
    for k in range(2, len(values)):
        before, now = changes[k - 2], changes[k - 1]
        wider = before * now <= 0 and abs(now) > abs(before) + floor  # in swings, or after none
        if not (wider or observed_order(h[: k + 1], values[: k + 1]) <= 0):
            return False
    return True


def _approaches(errors: Sequence[float]) -> bool:
    """Each level is nearer to the reference: whatever its differences do, such a sequence does not diverge."""
    return bool(np.all(np.diff(np.abs(errors)) < 0))


def _leaves(errors: Sequence[float], limit: float, allowed: float) -> bool:
    """Each level is farther from the reference, in all by more than what is not refined allows, and so is the error of the limit,
    where there is one."""
    away = np.abs(errors)
    return bool(np.all(np.diff(away) > 0)) and away[-1] - away[0] > allowed and not abs(limit) <= allowed


@dataclass(frozen=True)
class Convergence:
    """What the levels show, one of the four words above, and the estimate of their error."""

    state: str  # empty below three levels
    order: float  # of the errors where the reference is sharp and they have one sign, else of the differences of levels
    estimate: Estimate


SHARP = 0.1  # errors tell an order where what is uncertain about their reference is below this share of the smallest


def converge(h: Sequence[float], values: Sequence[float], reference: float, uncertainty: float, noise: float = 0.0,
             allowed: float = 0.0, band: tuple[float, float] = BAND) -> Convergence:
    """At least two levels. `uncertainty` is that of the reference; `noise` is by how much two of equal levels may differ, from several
    starts; `allowed` is how far from the reference a limit may be by all that is not refined: the reference itself, the step, the
    sound speed. All 95 %, absolute."""
    found = estimate(h, values)
    if len(values) < 3:
        return Convergence("", math.nan, found)
    errors = [value - reference for value in values]
    if not all(map(math.isfinite, errors)):
        return Convergence(NOT_CONVERGING, math.nan, found)
    if not any(errors):
        return Convergence(CONVERGING, math.nan, found)
    through_zero = min(errors) < 0 < max(errors)  # then their size tells no order
    sharp = uncertainty <= SHARP * min(map(abs, errors)) and not through_zero
    order = error_order(h, errors) if sharp else found.order
    floor, changes = max(noise, uncertainty, ROUNDING * max(map(abs, values))), np.abs(np.diff(values))
    leaves = _leaves(errors, found.limit - reference, max(floor, allowed))
    if leaves or (_grows(h, values, floor) and not _approaches(errors)):
        return Convergence(DIVERGING, order, found)
    if noise > 0 and np.max(changes) <= noise:
        return Convergence(NOISE_LIMITED, order, found)
    falls = not sharp or abs(errors[-1]) < abs(errors[-2])
    if band[0] <= order <= band[1] and falls:
        return Convergence(CONVERGING, order, found)
    if noise > 0 and changes[-1] <= noise:
        return Convergence(NOISE_LIMITED, order, found)
    return Convergence(NOT_CONVERGING, order, found)


@dataclass(frozen=True)
class Extrapolated:
    """Value at h = 0 with its standard uncertainty, absolute, and in words how it was made."""

    value: float
    uncertainty: float
    how: str


def extrapolated(h: Sequence[float], values: Sequence[float]) -> Extrapolated:
    """At least three levels. The limit of the estimate where its order can be trusted; else, as scattered levels have none,
    a + b h or a + b h^2, whichever fits all of them better. NaN where a value is no number."""
    if not all(map(math.isfinite, values)):
        return Extrapolated(math.nan, 0.0, "no number on a level")
    found = estimate(h, values)
    if is_trusted(found.order):
        correction = abs(found.limit - values[-1])
        second = values[-1] + (values[-1] - values[-2]) / ((h[-2] / h[-1]) ** FORMAL - 1)
        spread = max((SAFETY - 1) * correction, abs(found.limit - second))
        return Extrapolated(found.limit, spread / 2, f"{found.how}, order {found.order:.2f}")
    fits = {order: fitted(np.array(h), np.array(values), (float(order),)) for order in (1, 2)}
    best = min(fits, key=lambda order: fits[order].error)
    return Extrapolated(fits[best].limit, math.hypot(fits[best].error, (fits[best].limit - fits[3 - best].limit) / 2),
                        f"least squares, order {best}")
