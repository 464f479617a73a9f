"""The search for the largest useful step, on made-up codes; no code is run here."""

import math

import numpy as np
import pytest

from bench.largest_step import Found, flows_of, largest_useful, left_at_most, rate_of_decay, trial_of
from bench.meter import Broken
from reference.periodic_fluid import Fluid
from reference.scripted import Failed
from verification.protocol.errors import SolverError


def off_beyond(limit: float, by: float = 0.02):
    """A rate of 3 that is off by so much beyond the limit."""
    return lambda step: 3.0 * (1 + by * (step > limit))


@pytest.mark.parametrize("limit", [0.06, 0.11, 0.3, 1.0, 1.9, 3.1])
@pytest.mark.parametrize("resolution", [0.05, 0.2])
def test_the_limit_of_a_code_is_found_within_the_resolution(limit: float, resolution: float) -> None:
    found = largest_useful([off_beyond(limit)], 0.05, 3.2, resolution)
    assert found.step <= limit <= found.step * (1 + resolution)
    assert found.rates == (3.0,)


def test_an_error_of_less_than_a_hundredth_is_useful() -> None:
    assert largest_useful([off_beyond(0.3, 0.009)], 0.05, 3.2, 0.05).step == 3.2
    assert largest_useful([off_beyond(0.3, -0.011)], 0.05, 3.2, 0.05).step <= 0.3


def test_the_nearer_of_two_limits_counts() -> None:
    both = largest_useful([off_beyond(0.9), off_beyond(0.4)], 0.05, 3.2, 0.05)
    assert both == Found(largest_useful([off_beyond(0.4)], 0.05, 3.2, 0.05).step, (3.0, 3.0))


@pytest.mark.parametrize("error", [Failed("Lost atoms"), SolverError("the step is more than 2 times its limit")])
def test_a_run_that_fails_or_is_refused_or_blows_up_is_not_useful(error: Exception) -> None:
    def fails(step: float) -> float:
        if step > 1.0:
            raise error
        return 3.0

    blown_up = largest_useful([lambda step: 3.0 if step <= 1.0 else math.nan], 0.05, 3.2, 0.05)
    assert largest_useful([fails], 0.05, 3.2, 0.05) == blown_up
    assert 0.95 < blown_up.step <= 1.0


def test_a_code_that_fails_at_the_small_step_has_no_largest_one() -> None:
    def fails(step: float) -> float:
        raise Failed("no such pair style")

    with pytest.raises(Failed, match="no such pair style"):
        largest_useful([fails], 0.05, 3.2, 0.05)
    with pytest.raises(Broken, match="a step of 0.05 h/c"):
        largest_useful([lambda step: math.nan], 0.05, 3.2, 0.05)


def test_each_step_is_told_and_what_is_left_shrinks_to_nothing() -> None:
    told: list[tuple[float, bool, int]] = []
    found = largest_useful([off_beyond(0.3)], 0.05, 3.2, 0.05, lambda *words: told.append(words))
    assert [step for step, _, _ in told][:4] == [0.05, 0.1, 0.2, 0.4]
    assert max(step for step, useful, _ in told if useful) == found.step
    bisected = [left for _, _, left in told[3:]]
    assert bisected == sorted(bisected, reverse=True) and bisected[-1] == 0
    assert left_at_most(0.2, 0.4, 0.05) == 4 and left_at_most(0.2, 0.4, 0.2) == 2


def test_the_rate_is_that_of_the_amplitude() -> None:
    """An energy exp(-2 r t) on uneven times, beyond the end too."""
    times = [0.0, 1.0, 3.0, 7.0, 8.0, 11.0]
    assert rate_of_decay(times, [5 * math.exp(-0.2 * time) for time in times], 10.0) == pytest.approx(0.1, rel=1e-12)
    assert math.isnan(rate_of_decay(times, [1.0, 1.0, 1.0, math.nan, 1.0, 1.0], 10.0))
    assert math.isnan(rate_of_decay(times, [1.0, 1.0, 1.0, 0.0, 1.0, 1.0], 10.0))


@pytest.mark.parametrize("dimension, side", [(2, 32), (3, 16)])
@pytest.mark.parametrize("step", [0.05, 0.37, 3.2])
def test_a_code_that_decays_exactly_has_the_rate_one_at_every_step(dimension: int, side: int, step: float) -> None:
    class Exact:
        name = "exact"

        def energies(self, fluid: Fluid, every: int, folder) -> list[tuple[int, float]]:
            assert fluid.steps % every == 0 and fluid.steps * fluid.step >= end
            assert fluid.steps // every <= 129
            return [(k, math.exp(-2 * fluid.decay * k * step)) for k in range(0, fluid.steps + 1, every)]

    for fluid, end in flows_of(dimension, side):
        assert trial_of(Exact(), fluid, end, None)(step) == pytest.approx(1, rel=1e-9)


def test_the_flows_are_inertial_and_slow_beside_sound() -> None:
    for dimension in (2, 3):
        wave, vortices = (fluid for fluid, _ in flows_of(dimension, 32))
        assert (wave.sound_speed, vortices.sound_speed) == (200, 20)
        assert np.all([fluid.dynamic_viscosity / (fluid.sound_speed * fluid.smoothing_length) == pytest.approx(0.01)
                       for fluid in (wave, vortices)])
