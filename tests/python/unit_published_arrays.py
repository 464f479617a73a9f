"""Published drag of arrays. Oracles: a second source for each number, theory of the dilute limit, refusal."""

import math

import numpy as np
import pytest

from reference.published import look_up
from reference.published.arrays import cubic_series, cubic_stokes, hasimoto, square_stokes
from reference.published.table import read_table
from reference.stokes.square_array import square_array


def cell(dimension: int, fraction: float, side: float = 2.0) -> dict:
    radius = side * (math.sqrt(fraction / math.pi) if dimension == 2 else (3 * fraction / (4 * math.pi)) ** (1 / 3))
    body = {"shape": "disc" if dimension == 2 else "sphere", "radius": round(radius, 7), "position": [1.0] * dimension}
    fluid = {"density": 1.0, "viscosity": 2.0, "reference_velocity": 1.0}
    return {"box": {"size": [side] * dimension}, "body": [body], "fluid": fluid}


def test_each_row_for_cylinders_lies_by_a_computed_stokes_flow() -> None:
    table = read_table("sangani_acrivos_1982_square")
    for row in table.rows:
        fraction, drag, uncertainty = (float(row[key]) for key in ("fraction", "drag", "uncertainty"))
        found = square_array(fraction)
        assert found.change < 1e-6
        assert abs(drag - found.drag) < 2 * uncertainty


def test_the_computed_stokes_flow_against_another_computation() -> None:
    # Drag to eight digits by collocation of point forces, an independent program.
    other = {0.05: 15.557822, 0.1: 24.831675, 0.131: 31.589344, 0.2: 51.526949, 0.3: 102.88130, 0.4: 217.89431}
    for fraction, drag in other.items():
        assert square_array(fraction).drag == pytest.approx(drag, rel=5e-8)


def test_the_computed_stokes_flow_in_the_dilute_limit() -> None:
    # Drummond and Tahir 1984: 8 pi / (ln(1/phi) - 1.476 + 2 phi - 1.774 phi^2 + 4.076 phi^3).
    for phi in (0.005, 0.02):
        series = 8 * np.pi / (np.log(1 / phi) - 1.476 + 2 * phi - 1.774 * phi**2 + 4.076 * phi**3)
        assert square_array(phi).drag == pytest.approx(series, rel=3e-4)  # 1.476 has four digits


def test_each_row_for_spheres_lies_by_the_series() -> None:
    table = read_table("zick_homsy_1982")
    for row in table.rows:
        fraction, drag, uncertainty = (float(row[key]) for key in ("fraction", "drag", "uncertainty"))
        if fraction < 0.22:
            series = cubic_series(fraction)
            assert abs(drag - series.value) < 2 * math.hypot(uncertainty, series.uncertainty)


def test_the_series_against_another_computation() -> None:
    for fraction, drag in {0.1: 3.642448, 0.2: 6.775923}.items():
        series = cubic_series(fraction)
        assert abs(series.value - drag) < 2 * series.uncertainty


def test_the_misprinted_coefficient_would_be_seen() -> None:
    # 2.534787 in place of 2.584787: Zick and Homsy tell them apart at 0.125.
    table, rows = read_table("sangani_acrivos_1982_cubic"), read_table("zick_homsy_1982")
    assert table.column("coefficient")[5] == 2.584787
    fraction, drag = rows.column("fraction")[5], rows.column("drag")[5]
    chi = (6 * fraction / math.pi) ** (1 / 3)
    assert abs(cubic_series(fraction).value - 0.05 * chi**5 - drag) > 5 * rows.column("uncertainty")[5]


def test_hasimoto_is_the_dilute_limit_of_the_series() -> None:
    for fraction in (1e-4, 1e-3, 0.01, 0.06):
        dilute = hasimoto(fraction)
        assert abs(dilute.value - cubic_series(fraction).value) < 2 * dilute.uncertainty + 2e-4 * dilute.value


@pytest.mark.parametrize(("drag", "fractions"), [(square_stokes, np.linspace(0.05, 0.5, 46)),
                                                 (cubic_stokes, np.linspace(0.001, 0.22, 45))])  # fmt: skip
def test_more_solids_more_drag(drag, fractions) -> None:
    values = np.array([drag(float(fraction)).value for fraction in fractions])
    assert (np.diff(values) > 0).all()


def test_a_scene_finds_its_row_or_the_value_between() -> None:
    row = look_up("square_array_stokes", cell(2, 0.2))
    assert (row.value, row.uncertainty) == (51.53, 0.003)
    assert "Sangani and Acrivos" in row.source
    assert look_up("square_array_stokes", cell(2, 0.131)).value == pytest.approx(31.589344, rel=1e-6)
    assert look_up("simple_cubic_stokes", cell(3, 0.216)).value == 7.442
    assert look_up("simple_cubic_stokes", cell(3, 0.1)).value == pytest.approx(3.642448, rel=1e-6)
    assert look_up("simple_cubic_hasimoto", cell(3, 0.01)).value == pytest.approx(1.5861, rel=1e-3)


def test_out_of_range_is_refused_with_value_and_range() -> None:
    for name, dimension, fraction in (("square_array_stokes", 2, 0.52), ("square_array_stokes", 2, 0.04),
                                      ("simple_cubic_stokes", 3, 0.3), ("simple_cubic_hasimoto", 3, 0.1)):  # fmt: skip
        with pytest.raises(ValueError, match=rf"{fraction}.*outside .* to "):
            look_up(name, cell(dimension, fraction))
    with pytest.raises(ValueError, match="one disc"):
        look_up("square_array_stokes", cell(3, 0.1))
    stretched = cell(2, 0.1)
    stretched["box"]["size"] = [2.0, 2.5]
    with pytest.raises(ValueError, match="equal sides"):
        look_up("square_array_stokes", stretched)


def test_an_unknown_table_is_refused_with_those_known() -> None:
    with pytest.raises(KeyError, match="simple_cubic_stokes"):
        look_up("nothing", cell(2, 0.1))


def test_a_solids_fraction_beyond_the_collocation_is_refused() -> None:
    with pytest.raises(ValueError, match="0.6"):
        square_array(0.7)
