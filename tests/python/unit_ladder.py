"""What levels show, and how far the finest may be from the limit. Oracles: sequences whose limit and order are known, the figures of
Eca and Hoekstra's procedure worked by hand, tables of Student's t."""

import math

import numpy as np
import pytest

from verification.suite.ladder import (
    CONVERGING,
    DIVERGING,
    NOISE_LIMITED,
    NOT_CONVERGING,
    converge,
    error_order,
    estimate,
    extrapolated,
    observed_order,
    order_text,
)
from verification.suite.student import coverage_of, factor_of

H = [0.4, 0.2, 0.1]
MANY = [0.8, 0.4, 0.2, 0.1]


def power_series(h: list[float], limit: float = 50.0, factor: float = 3.0, order: float = 2.0) -> list[float]:
    return [limit + factor * value**order for value in h]


@pytest.mark.parametrize("h", [H, [0.3, 0.2, 0.1], [0.2, 0.15, 0.1]])
@pytest.mark.parametrize("order", [0.2, 1.0, 2.0, 3.0, -1.0])
def test_the_order_of_a_power_law_is_found_for_any_ratio(h: list[float], order: float) -> None:
    values = power_series(h, order=order)
    assert observed_order(h, values) == pytest.approx(order, rel=1e-6)
    assert error_order(h, [value - 50.0 for value in values]) == pytest.approx(order, rel=1e-9)


@pytest.mark.parametrize("h", [H, MANY])
@pytest.mark.parametrize("order", [0.6, 1.0, 1.5, 2.0])
def test_a_power_law_is_bounded_by_the_factor_of_safety_and_leads_to_its_limit(h: list[float], order: float) -> None:
    values = power_series(h, order=order)
    found = estimate(h, values)
    assert found.bound == pytest.approx(1.25 * (values[-1] - 50.0), rel=1e-4)
    assert found.limit == pytest.approx(50.0, rel=1e-6) and found.order == pytest.approx(order, rel=1e-4)


@pytest.mark.parametrize("h", [H, MANY])
def test_no_estimate_takes_an_order_above_that_of_the_method(h: list[float]) -> None:
    """Of order 4 the true error is 3e-4. Clamped at 2 it may be a third of the last change, thrice for safety."""
    values = power_series(h, order=4.0)
    found = estimate(h, values)
    assert found.order == pytest.approx(4.0, rel=1e-3) and math.isnan(found.limit)
    assert found.bound > 10 * (values[-1] - 50.0)
    assert order_text(found.order) == "above 2.5"


def test_three_levels_beyond_the_order_of_the_method() -> None:
    values = power_series(H, order=4.0)
    assert estimate(H, values).bound == pytest.approx((values[0] - values[1]) / 4)  # r^2 - 1 = 3, and a quarter of the change before


@pytest.mark.parametrize("values", [[2.0, 1.0, 1.0], [2.0, 1.0, 1.0 - 1e-9], [1.457, -0.0532, -0.0539]])
def test_a_last_change_that_is_small_by_chance_bounds_nothing(values: list[float]) -> None:
    assert estimate(H, values).bound >= 0.25


@pytest.mark.parametrize("levels", [3, 4, 5, 7])
def test_the_bound_holds_the_limit_of_noise(levels: int) -> None:
    """Of scatter about 0, on levels twice as fine each: in 85 of 100 at least, for a bound of 95 that knows nothing of noise."""
    draws = np.random.default_rng(3).normal(size=(120, levels))
    h = [0.5**k for k in range(levels)]
    held = [abs(row[-1]) <= estimate(h, list(row)).bound for row in draws]
    assert np.mean(held) > 0.85


def test_levels_that_swing_have_no_order_no_limit_and_a_wide_bound() -> None:
    found = estimate(H, [50.3, 49.9, 50.1])
    assert math.isnan(found.order) and math.isnan(found.limit)
    assert found.bound == pytest.approx(3.0 * 0.4)  # thrice what they span
    assert order_text(found.order) == "none"


def test_two_levels_give_a_bound_of_first_order() -> None:
    found = estimate([0.2, 0.1], [50.2, 50.1])
    assert found.bound == pytest.approx(0.3) and math.isnan(found.limit)


def test_slow_levels_are_not_trusted() -> None:
    values = power_series(H, order=0.2)
    found = estimate(H, values)
    assert math.isnan(found.limit) and found.bound == pytest.approx(3 * (values[0] - values[2]))


def test_four_scattered_levels_are_fitted_and_their_scatter_counts() -> None:
    """Scatter of 0.1 on differences of 0.04: the deviation of the fit exceeds the range of the data, and so does the bound."""
    values = [50.11, 49.93, 50.08, 49.96]
    found = estimate(MANY, values)
    assert found.bound > np.ptp(values) and math.isnan(found.limit)


def test_noise_on_a_second_order_sequence_widens_the_bound() -> None:
    clean = power_series(MANY)
    noisy = [value + shift for value, shift in zip(clean, (0.0, 0.02, -0.02, 0.01), strict=True)]
    assert estimate(MANY, noisy).bound > estimate(MANY, clean).bound
    assert abs(noisy[-1] - 50.0) < estimate(MANY, noisy).bound


def test_a_level_that_is_no_number_shows_nothing() -> None:
    values = [50.3, math.nan, 50.1]
    assert math.isnan(error_order(H, values)) and math.isnan(observed_order(H, values))
    assert math.isnan(extrapolated(H, values).value) and math.isnan(estimate(H, values).bound)
    assert converge(H, values, 50.0, 0.0).state == NOT_CONVERGING


def test_levels_that_are_equal_bound_nothing() -> None:
    assert estimate(H, [1.0, 1.0, 1.0]).bound == 0.0 and estimate(MANY, [1.0] * 4).bound == 0.0


# What they show.


def state(values: list[float], reference: float = 50.0, h: list[float] = H, **more) -> str:
    return converge(h, values, reference, **({"uncertainty": 0.0} | more)).state


@pytest.mark.parametrize("h", [H, MANY])
def test_a_second_order_sequence_converges(h: list[float]) -> None:
    assert state(power_series(h), h=h) == CONVERGING
    assert state(power_series(h), 48.0, h=h, uncertainty=3.0, allowed=3.0) == CONVERGING  # to its own limit


def test_the_referee_s_lag_diverges() -> None:
    """0.24, 0.97, 2.25 % from its reference with each refinement: never "not monotonic"."""
    lag = [0.317 * (1 + error) for error in (0.0024, 0.0097, 0.0225)]
    assert state(lag, 0.317, [0.3, 0.2, 0.15], uncertainty=0.002, allowed=0.002) == DIVERGING
    assert converge([0.3, 0.2, 0.15], lag, 0.317, 0.002).order < 0


def test_differences_that_grow_diverge_wherever_the_reference_is() -> None:
    assert state([50.1, 50.2, 50.5], 50.0) == DIVERGING
    assert state([50.1, 49.8, 50.9], 50.0, uncertainty=0.2) == DIVERGING  # in ever wider swings
    assert state([50.1, 49.8, 50.9, 48.0], 49.9, MANY) == DIVERGING


def test_what_leaves_its_reference_by_less_than_is_explained_does_not_diverge() -> None:
    """It converges to a limit 0.4 beside the reference, which the sound speed, say, explains."""
    values = [50.1, 50.3, 50.35]
    assert state(values, 50.0, uncertainty=0.1, allowed=0.1) == DIVERGING
    assert state(values, 50.0, uncertainty=0.5, allowed=0.5) == CONVERGING


@pytest.mark.parametrize("uncertainty", [0.0, 0.0002, 0.5])
def test_what_comes_nearer_with_every_level_does_not_diverge(uncertainty: float) -> None:
    """A disc that falls 2.02, 1.47 and 0.88 % too fast: its differences grow for the step in h, and it tends to the reference."""
    falling = [1.0202, 1.01465, 1.0088]
    found = state(falling, 1.0, [1 / 4, 1 / 6, 1 / 8], uncertainty=uncertainty)
    assert found == (CONVERGING if uncertainty < 0.001 else NOT_CONVERGING)  # a reference that is not sharp tells no order


def test_noise_can_neither_converge_nor_diverge() -> None:
    assert state([50.1, 49.9, 50.2], 50.0, noise=0.4) == NOISE_LIMITED
    assert state([50.1, 49.9, 50.2], 50.0, noise=0.0) == DIVERGING
    assert state([50.05, 50.06, 50.08], 50.0, noise=0.1, uncertainty=0.1) == NOISE_LIMITED
    assert state([50.05, 50.02, 50.01], 50.0, noise=0.1) == NOISE_LIMITED  # by chance of second order
    assert state([50.05, 50.04, 50.04], 50.0, noise=0.1) == NOISE_LIMITED


@pytest.mark.parametrize(("values", "h"), [([58.0, 51.0, 50.5, 51.0], MANY), ([60.0, 51.0, 50.1, 50.4, 51.5], [1.6, *MANY])])
def test_what_turns_away_again_does_not_converge(values: list[float], h: list[float]) -> None:
    """Though the errors of all levels together fall."""
    assert state(values, 50.0, h) == NOT_CONVERGING


def test_rounding_does_not_diverge() -> None:
    assert state([1.0, 1 + 4e-16, 1 + 1e-15], 1.0) != DIVERGING
    assert state([1 + 1e-9, 1 + 2e-9, 1 + 4.1e-9], 1.0, uncertainty=4e-5, allowed=4e-5) != DIVERGING


def test_what_stands_and_then_leaps_diverges() -> None:
    assert state([50.0, 50.0, 55.0], 50.0) == DIVERGING


def test_a_limit_within_what_is_allowed_is_no_divergence() -> None:
    assert state([50.0, 50.3, 50.375], 49.9, uncertainty=0.2, allowed=0.6) == CONVERGING


@pytest.mark.parametrize("values", [[50.9, 50.85, 50.82], [58.0, 50.4, 50.02]])
def test_too_slow_and_too_fast_is_not_converging(values: list[float]) -> None:
    """Of order 0.1, and faster than the method can be."""
    assert state(values) == NOT_CONVERGING


def test_errors_that_fall_through_zero_are_judged_by_their_differences() -> None:
    assert state([52.0, 50.3, 49.9]) == CONVERGING  # 1.7, then 0.4: order 2.1, to a limit 0.1 below


def test_orders_nobody_believes_are_not_printed() -> None:
    assert [order_text(value) for value in (9.69, 14.76, -0.3, math.nan, 1.9)] == ["above 2.5", "above 2.5", "below 0", "none", "1.90"]


def test_two_levels_show_nothing() -> None:
    assert state([50.2, 50.1], h=[0.2, 0.1]) == ""


# Student's t.


@pytest.mark.parametrize(("freedom", "factor"), [(1, 12.706), (2, 4.303), (3, 3.182), (4, 2.776), (9, 2.262), (10, 2.228), (29, 2.045)])
def test_the_factor_is_that_of_the_tables(freedom: int, factor: float) -> None:
    assert factor_of(freedom) == pytest.approx(factor, abs=5e-4)


def test_few_starts_widen_the_bound_as_far_as_they_count() -> None:
    assert coverage_of([(0.1, None)]) == 2.0 and coverage_of([]) == 2.0
    assert coverage_of([(0.1, 4)]) == pytest.approx(2.776, abs=1e-3)
    assert coverage_of([(0.1, 4), (1.0, None)]) == 2.0  # one that hardly counts
    assert coverage_of([(0.1, 4), (0.1, None)]) == pytest.approx(factor_of(16))  # Welch and Satterthwaite: (2)^2 / (1 / 4)


def test_the_noise_of_starts_is_covered_as_often_as_promised() -> None:
    """Of 20 000 samples of five, 95 of 100 hold the next value within t of their own deviation about the truth."""
    draws = np.random.default_rng(7).normal(size=(20000, 6))
    inside = np.abs(draws[:, 5]) <= factor_of(4) * draws[:, :5].std(axis=1, ddof=1)
    assert inside.mean() == pytest.approx(0.95, abs=0.005)
    assert (np.abs(draws[:, 5]) <= 2 * draws[:, :5].std(axis=1, ddof=1)).mean() < 0.9
