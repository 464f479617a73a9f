"""Extrapolation over levels, on sequences whose limit and order are known."""

import pytest

from reference.openfoam.richardson import extrapolate, observed_order


def sequence(sizes: list[float], order: float, coefficient: float = 3.0) -> list[float]:
    return [10 + coefficient * size**order for size in sizes]


@pytest.mark.parametrize("sizes", [(1, 0.5, 0.25), (1 / 6, 1 / 8, 1 / 12), (1 / 8, 1 / 12, 1 / 18)])
@pytest.mark.parametrize("order", [0.7, 1.0, 2.0, 3.1])
def test_the_order_is_found_for_any_ratios(sizes: tuple[float, ...], order: float) -> None:
    assert observed_order(sizes, tuple(sequence(sizes, order))) == pytest.approx(order, abs=1e-6)


def test_second_order_errors_are_eliminated() -> None:
    sizes = [1 / 8, 1 / 12, 1 / 18]
    values = [10 - 4 * size**2 + 30 * size**4 for size in sizes]
    found = extrapolate(sizes, values)
    assert found.value == pytest.approx(10, rel=1e-12)
    # Half of 1.25 |f3 - f2| / (1.5^2 - 1), worked by hand.
    assert found.uncertainty == pytest.approx(0.5 * 1.25 * (values[2] - values[1]) / 1.25)


def test_an_order_that_is_not_that_of_the_scheme_is_not_trusted() -> None:
    sizes = [1, 0.5, 0.25]
    values = sequence(sizes, 1.0)
    found = extrapolate(sizes, values)
    assert found.value == pytest.approx(10, rel=1e-6) and found.order == pytest.approx(1.0, abs=1e-6)
    assert found.uncertainty == pytest.approx(0.5 * 3 * (values[1] - values[2]) / (2 - 1), rel=1e-5)
    steep = extrapolate(sizes, sequence(sizes, 4.0))
    assert "order 2.00" in steep.note  # an order above that of the scheme is chance


def test_meshes_that_are_not_similar_keep_the_larger_safety() -> None:
    sizes = [1, 0.5, 0.25]
    values = sequence(sizes, 2.0)
    assert extrapolate(sizes, values, similar=False).uncertainty == pytest.approx(
        2.4 * extrapolate(sizes, values).uncertainty, rel=1e-6
    )


def test_two_levels_take_the_order_of_the_scheme_and_say_so() -> None:
    found = extrapolate([1, 0.5], sequence([1, 0.5], 2.0))
    assert found.value == pytest.approx(10) and found.order is None and "two levels" in found.note
    assert found.uncertainty == pytest.approx(0.5 * 3 * 2.25 / 3)


@pytest.mark.parametrize("values", [[1.0, 2.0, 1.5], [1.0, 1.1, 2.0], [1.0, 1.0, 1.0]])
def test_levels_that_do_not_converge_give_their_spread(values: list[float]) -> None:
    found = extrapolate([1, 0.5, 0.25], values)
    assert found.order is None and found.value == values[-1]
    assert found.uncertainty == pytest.approx(1.5 * (max(values) - min(values)))


def test_one_level_is_refused() -> None:
    with pytest.raises(ValueError):
        extrapolate([1], [2.0])
