"""Fits of a time series: what it tends to, how it decays, how it oscillates."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Limit:
    """What a relaxing series tends to: `value` by extrapolation, `last` the mean of its last tenth, `noise` the standard
    deviation of the residuals, `error` the standard error of their mean, from the scatter of eight stretches of them."""

    value: float
    last: float
    noise: float
    error: float
    tau: float

    @property
    def gap(self) -> float:
        """Relative distance of the extrapolation from the end of the series."""
        return abs(self.value - self.last) / abs(self.value)


STRETCHES = 8


def relaxed(time: np.ndarray, values: np.ndarray, tau: float) -> Limit:
    """Fits a + b exp(-t / tau) with the given tau to the second half of a series. Throws ValueError where that is short."""
    half = time >= 0.5 * (time[0] + time[-1])
    t, y = time[half] - time[half][0], values[half]
    if len(t) < STRETCHES:
        raise ValueError(f"{len(t)} samples in the second half of the run; sample more often or run longer")
    basis = np.column_stack([np.ones_like(t), np.exp(-t / tau)])
    coefficients, *_ = np.linalg.lstsq(basis, y, rcond=None)
    rest = y - basis @ coefficients
    error = np.std([part.mean() for part in np.array_split(rest, STRETCHES)], ddof=2) / np.sqrt(STRETCHES)
    last = float(np.mean(y[-max(1, len(values) // 10) :]))
    return Limit(float(coefficients[0]), last, float(np.std(rest)), float(error), tau)


def extrapolate(time: np.ndarray, values: np.ndarray, longest: float = np.inf) -> Limit:
    """Fits a + b exp(-t / tau) to the second half of a series; tau is searched from a thirtieth of the half to its length,
    or to `longest`, where the flow is known to relax no more slowly.

    A tau beyond the length of the data is not determined by them, which shows as a gap between value and last.
    """
    half = 0.5 * (time[-1] - time[0])
    slowest = min(max(longest, half / 30), half)
    return min((relaxed(time, values, tau) for tau in np.geomspace(half / 30, slowest, 60)), key=lambda fit: fit.noise)


def decay_rate(time: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """(rate, its standard error) of a positive series that falls as exp(-rate t)."""
    coefficients, covariance = np.polyfit(time, np.log(values), 1, cov=True)
    return float(-coefficients[0]), float(np.sqrt(covariance[0, 0]))


def minima(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Times of the minima of an oscillating series, each from the parabola through its lowest three samples."""
    lowest = 1 + np.flatnonzero((values[1:-1] < values[:-2]) & (values[1:-1] <= values[2:]))
    left, here, right = values[lowest - 1], values[lowest], values[lowest + 1]
    shift = 0.5 * (left - right) / (left - 2 * here + right)
    return time[lowest] + shift * (time[1] - time[0])


@dataclass(frozen=True)
class Oscillation:
    """exp(-damping t) (a cos(frequency t) + b sin(frequency t)), with the standard errors of the first two."""

    frequency: float
    damping: float
    frequency_error: float
    damping_error: float


def damped_oscillation(time: np.ndarray, values: np.ndarray) -> Oscillation | None:
    """Least squares by Gauss and Newton from the zero crossings; None with fewer than three, or without convergence."""
    crossings = np.flatnonzero(values[1:] * values[:-1] < 0)
    if len(crossings) < 3:
        return None
    frequency, damping = np.pi * (len(crossings) - 1) / (time[crossings[-1]] - time[crossings[0]]), 0.0
    bound = 1.0 / (time[1] - time[0])  # beyond it the samples could not show the oscillation
    for _ in range(100):
        decay = np.exp(-damping * time)
        basis = np.column_stack([decay * np.cos(frequency * time), decay * np.sin(frequency * time)])
        (a, b), *_ = np.linalg.lstsq(basis, values, rcond=None)
        model = basis @ [a, b]
        slopes = np.column_stack([time * (basis @ [b, -a]), -time * model, basis])
        change, *_ = np.linalg.lstsq(slopes, values - model, rcond=None)
        frequency, damping = frequency + change[0], damping + change[1]
        if not max(abs(frequency), abs(damping)) < bound:
            return None
        if np.abs(change[:2]).max() < 1e-12 * frequency:
            break
    else:
        return None
    variance = np.sum((values - model) ** 2) / max(1, len(time) - 4)
    errors = np.sqrt(variance * np.diag(np.linalg.inv(slopes.T @ slopes)))
    return Oscillation(float(frequency), float(damping), float(errors[0]), float(errors[1]))


def values_at(points: np.ndarray, values: np.ndarray, at: np.ndarray, radius: float) -> np.ndarray:
    """A field known at scattered `points` (n, 2), fitted at each of `at` (m, 2) by a quadratic to the points nearer than
    `radius`, by least squares with the weight (1 - (r / radius)^2)^2. Exact for a quadratic field, one-sided beside walls.

    Throws ValueError where fewer than eight points are that near: a quadratic has six coefficients.
    """
    found = np.empty(len(at))
    for i, place in enumerate(at):
        offset = (points - place) / radius
        square = np.sum(offset**2, axis=1)
        near = square < 1.0
        if np.count_nonzero(near) < 8:
            raise ValueError(f"{np.count_nonzero(near)} points within {radius:g} of {place}; take a larger radius")
        x, y = offset[near].T
        basis = np.column_stack([np.ones_like(x), x, y, x**2, x * y, y**2])
        weight = 1.0 - square[near]  # the root of that of the squares
        found[i] = np.linalg.lstsq(basis * weight[:, None], values[near] * weight, rcond=None)[0][0]
    return found
