"""The published tables of the cavity. Oracles: a spectral solution, a second table, conservation of mass, smoothness."""

import numpy as np
import pytest

from reference.cavity import chebyshev, interpolate, solve
from reference.published.cavity import CentreLine, centre_line
from verification.suite.manifest import find_case


@pytest.fixture(scope="module")
def spectral():
    return solve((100.0,), 20)


def test_derivative_and_interpolation_are_exact_for_polynomials() -> None:
    nodes, derivative = chebyshev(8)
    assert derivative @ nodes**5 == pytest.approx(5 * nodes**4, abs=1e-12)
    at = np.array([0.0, 0.123, nodes[3], 1.0])
    assert interpolate(nodes, nodes**5, at) == pytest.approx(at**5, abs=1e-13)


def test_the_spectral_solution_meets_its_equations(spectral) -> None:
    nodes, derivative = chebyshev(20)
    assert spectral.correction < 1e-10
    divergence = derivative @ spectral.u + spectral.v @ derivative.T
    assert np.abs(divergence).max() < 1e-8  # a stream function; rounding times the derivatives
    assert spectral.u[1:-1, -1] == pytest.approx(1.0, abs=1e-9)
    assert spectral.u[1:-1, 0] == pytest.approx(0.0, abs=1e-9)


def test_more_points_change_the_extremes_of_the_cases_by_less_than_their_uncertainty(spectral) -> None:
    # The manifest of the case has -0.21404, 0.17957, -0.25381; the corners leave a few 1e-5.
    line = np.linspace(0, 1, 2001)
    coarse = solve((100.0,), 16)
    for solution, within in ((coarse, 2e-4), (spectral, 5e-5)):
        assert solution.u_on_vertical(line).min() == pytest.approx(-0.21404, abs=within)
        assert solution.v_on_horizontal(line).max() == pytest.approx(0.17957, abs=within)
        assert solution.v_on_horizontal(line).min() == pytest.approx(-0.25381, abs=within)


def inner_differences(of: dict[str, np.ndarray], reynolds: int) -> np.ndarray:
    """Of Ghia's velocities between the walls from others at the same places."""
    return np.concatenate([(centre_line(component, reynolds).velocity - of[component])[1:-1] for component in "uv"])


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def test_ghia_at_re_100_is_as_uncertain_as_its_table_says(spectral) -> None:
    # What their mesh left, one-signed and smooth over neighbouring points.
    found = {"u": spectral.u_on_vertical(centre_line("u", 100).position), "v": spectral.v_on_horizontal(centre_line("v", 100).position)}
    apart = inner_differences(found, 100)
    assert rms(apart) == pytest.approx(0.0040, abs=5e-5) and np.abs(apart).max() == pytest.approx(0.0093, abs=1e-4)
    for case in ("cavity", "cavity_re1000"):
        stated = {one.name: one.uncertainty for one in find_case(case).observables if one.name.endswith("from_ghia")}
        rms_of, largest_of = (0.0040, 0.0093) if case == "cavity" else (0.0075, 0.0185)
        assert stated == {"rms_from_ghia": rms_of, "largest_from_ghia": largest_of}


def test_ghia_at_re_1000_is_as_uncertain_as_its_table_says() -> None:
    apart = inner_differences({component: centre_line(component, 1000, "botella_1998").velocity for component in "uv"}, 1000)
    assert rms(apart) == pytest.approx(0.0075, abs=1e-4) and np.abs(apart).max() == pytest.approx(0.0185, abs=1e-4)


def test_one_value_of_ghia_at_re_100_is_off_the_curve(spectral) -> None:
    # u(0.0703) = -0.04775 stands in every copy. It is 0.0011 too low, its neighbours are within 0.0001.
    table = centre_line("u", 100)
    error = table.velocity - spectral.u_on_vertical(table.position)
    assert table.position[3] == 0.0703
    assert error[3] == pytest.approx(-0.0011, abs=1e-4)
    assert np.abs(error[[1, 2, 4]]).max() < 2e-4


def test_botella_and_peyret_lie_by_the_extremes_they_name() -> None:
    # u = -0.3885698 at 0.1717, v = 0.3769447 at 0.1578 and -0.5270771 at 0.9092, beside nodes of the tables.
    u, v = centre_line("u", 1000, "botella_1998"), centre_line("v", 1000, "botella_1998")
    assert u.velocity.min() == pytest.approx(-0.3885698, abs=2e-6)
    assert v.velocity.max() == pytest.approx(0.3769447, abs=5e-5)
    assert v.velocity.min() == pytest.approx(-0.5270771, abs=1e-3)


def integral(line: CentreLine) -> float:
    """Of the cubic through each two points with the slopes of the parabola through three."""
    x, f = line.position, line.velocity
    h = np.diff(x)
    secant = np.diff(f) / h
    slope = np.empty_like(f)
    slope[1:-1] = (h[1:] * secant[:-1] + h[:-1] * secant[1:]) / (h[1:] + h[:-1])
    slope[0], slope[-1] = 2 * secant[0] - slope[1], 2 * secant[-1] - slope[-2]
    return float(np.sum(0.5 * h * (f[1:] + f[:-1]) + h**2 / 12 * (slope[:-1] - slope[1:])))


TABLES = [("u", 100, "ghia_1982"), ("v", 100, "ghia_1982"), ("u", 1000, "ghia_1982"), ("v", 1000, "ghia_1982"),
          ("u", 1000, "botella_1998"), ("v", 1000, "botella_1998")]


@pytest.mark.parametrize(("component", "reynolds", "source"), TABLES)
def test_as_much_flows_one_way_as_the_other(component: str, reynolds: int, source: str) -> None:
    line = centre_line(component, reynolds, source)
    assert abs(integral(line)) < 0.008  # seventeen points, up to 0.27 apart, of a curve of size 0.5
    assert line.velocity[0] == 0.0
    assert line.velocity[-1] == (1.0 if component == "u" else 0.0)
    assert (np.diff(line.position) > 0).all()
