"""Measures of the cases with walls and contacts. Oracles: exact fields written here, with a known error added."""

from pathlib import Path

import numpy as np
import pytest
from support import measure_module as module
from synthetic import Fields, Snapshot, scattered, synthetic_run

from verification.measures.fits import values_at

TIME = np.linspace(0.0, 20.0, 401)


def along_x(points: np.ndarray, u: np.ndarray) -> np.ndarray:
    return np.column_stack([u, np.zeros(len(points))])


def test_a_quadratic_field_is_fitted_exactly_inside_and_beside_a_wall() -> None:
    points = scattered(1600, (1.0, 1.0))
    x, y = points.T
    at = np.array([[0.5, 0.5], [0.5, 0.99], [0.01, 0.3], [0.0, 0.0]])
    exact = 1.0 + 2.0 * at[:, 0] - at[:, 1] + 3.0 * at[:, 0] * at[:, 1] - 2.0 * at[:, 1] ** 2 + at[:, 0] ** 2
    found = values_at(points, 1.0 + 2.0 * x - y + 3.0 * x * y - 2.0 * y**2 + x**2, at, 0.1)
    assert found == pytest.approx(exact, abs=1e-12)


def test_the_fit_of_a_cubic_field_errs_with_the_third_power_of_the_radius() -> None:
    points, at = scattered(250_000, (1.0, 1.0)), np.array([[0.5, 0.999]])
    errors = [abs(values_at(points, points[:, 1] ** 3, at, radius)[0] - 0.999**3) for radius in (0.1, 0.05)]
    assert errors[0] / errors[1] == pytest.approx(8.0, rel=0.15)  # one-sided: nothing cancels


def test_a_fit_with_too_few_points_is_refused() -> None:
    with pytest.raises(ValueError, match="take a larger radius"):
        values_at(scattered(100, (1.0, 1.0)), np.zeros(100), np.array([[0.5, 0.5]]), 0.05)


POISEUILLE = """
[box]
size = [0.75, 1.25]
[fluid]
density = 1.0
viscosity = 0.05
[[body]]
shape = "wall"
axis = "y"
position = 1.0
thickness = 0.25
[force]
fluid = [0.02, 0.0]
"""


@pytest.mark.parametrize(("short", "accepted"), [(0.0, True), (0.3, False)])
def test_the_parabola_has_no_error_and_two_per_cent_more_are_seen(tmp_path: Path, short: float, accepted: bool) -> None:
    points = scattered(3000, (0.75, 1.0))
    y = points[:, 1]
    mean = 0.0333 * (1 - short * np.exp(-TIME / 15.0))
    for factor, error in ((1.0, 0.0), (1.02, 0.02 * np.sqrt(8 / 15))):  # rms of 4 y (1 - y) is sqrt(8/15)
        velocity = along_x(points, factor * 0.02 * y * (1 - y) / 0.1)
        fields = Fields(POISEUILLE, {"time": TIME, "fluid_velocity_x": mean},
                        snapshots=(Snapshot(20.0, points, velocity),))
        found = module("poiseuille").poiseuille(synthetic_run(tmp_path / str(factor), fields))
        assert found.value == pytest.approx(error, abs=2e-4)  # of 3000 places at random
        assert (found.objection == "") == accepted


COUETTE = """
[fluid]
density = 2.0
viscosity = 1.0
[[body]]
position = 1.0
velocity = [0.5, 0.0]
"""


def test_the_series_of_the_start_up_solves_its_equation() -> None:
    start_up, y, step = module("couette_start").start_up, np.linspace(0, 1, 401), 1e-5
    inner = slice(1, -1)
    for time in (0.05, 0.3):
        in_time = (start_up(y, time + step) - start_up(y, time - step)) / (2 * step)
        bent = np.diff(start_up(y, time), 2) * 400**2
        assert in_time[inner] == pytest.approx(bent, abs=2e-3)  # second differences: h^2 / 12 of the fourth derivative
        assert start_up(np.array([0.0, 1.0]), time) == pytest.approx([0.0, 1.0], abs=1e-12)
    assert np.abs(start_up(y[:380], 0.001)).max() < 0.3  # at first the fluid is at rest
    assert start_up(y, 5.0) == pytest.approx(y, abs=1e-12)


def test_a_profile_is_compared_at_the_time_it_has(tmp_path: Path) -> None:
    couette, points = module("couette_start"), scattered(3000, (0.75, 1.0))
    times = (0.0, 0.052, 0.104, 0.296, 2.0)  # H^2 / nu, whose unit is 2 here
    taken = tuple(Snapshot(2 * t, points, along_x(points, 0.5 * couette.start_up(points[:, 1], t))) for t in times[1:])
    run = synthetic_run(tmp_path, Fields(COUETTE, snapshots=(Snapshot(0.0, points, 0 * points), *taken)))
    measures = couette.MEASURES.observables
    for name in ("error_at_005", "error_at_01", "error_at_03"):
        assert measures[name](run).value < 1e-12
        assert measures[name](run).objection == ""
    assert "no snapshot near 1.0" in measures["error_at_1"](run).objection


DISC = """
[[body]]
position = [0.5, 0.5]
[[body]]
position = 1.0
velocity = [0.75, 0.0]
[[body]]
position = 1.2
velocity = [-0.75, 0.0]
"""


def test_the_spin_is_that_of_the_second_half_over_the_shear_rate(tmp_path: Path) -> None:
    noise = 0.01 * np.random.default_rng(1).standard_normal(len(TIME))
    solids = {"time": TIME, "angular_velocity": -1.5 * (0.46 + noise - 0.3 * np.exp(-TIME / 0.5)),
              "position_y": np.full(len(TIME), 0.5)}
    found = module("disc_in_couette").spin(synthetic_run(tmp_path / "middle", Fields(DISC, solids=solids)))
    assert found.value == pytest.approx(0.46, abs=0.003)  # 200 values with a scatter of 0.01
    assert 0.0002 < found.uncertainty < 0.002  # 0.01 / sqrt(200) = 0.0007
    assert found.objection == ""
    away = solids | {"position_y": np.linspace(0.5, 0.45, len(TIME))}
    assert "left the middle" in module("disc_in_couette").spin(
        synthetic_run(tmp_path / "away", Fields(DISC, solids=away))).objection


CAVITY = """
[fluid]
density = 1.0
viscosity = 0.01
spacing = 0.025
[[body]]
velocity = [1.0, 0.0]
"""


def test_extremes_on_the_centre_lines(tmp_path: Path) -> None:
    # u = sin(3 pi y / 2) has its lowest value -1 at the lid; v = sin(2 pi x) goes from 1 to -1.
    cavity, points = module("cavity"), scattered(1600, (1.0, 1.0))
    velocity = np.column_stack([-np.sin(np.pi * points[:, 1]), 0.5 * np.sin(2 * np.pi * points[:, 0])])
    snapshots = tuple(Snapshot(float(t), points, velocity) for t in range(0, 21, 1))
    settled = {"time": TIME, "fluid_energy": 1.0 - np.exp(-TIME)}
    run = synthetic_run(tmp_path / "a", Fields(CAVITY, settled, snapshots=snapshots))
    for measure, exact in ((cavity.lowest_u, -1.0), (cavity.highest_v, 0.5), (cavity.lowest_v, -0.5)):
        assert measure(run).value == pytest.approx(exact, rel=0.005)  # a cubic is left over by the fit
        assert measure(run).objection == ""
    assert cavity.rms_from_ghia(run).value > 0.1
    rising = {"time": TIME, "fluid_energy": 1.0 + 0.1 * TIME}
    unsettled = synthetic_run(tmp_path / "b", Fields(CAVITY, rising, snapshots=snapshots[-2:]))
    assert "kinetic energy" in cavity.lowest_u(unsettled).objection
    assert "late snapshots; write more" in cavity.lowest_u(unsettled).objection


IMPACT = """
[contact]
young = "48 GPa"
poisson = 0.2
[[body]]
radius = "10 mm"
density = "2800 kg/m3"
velocity = ["10 m/s", "0 m/s", "0 m/s"]
[[body]]
velocity = ["-10 m/s", "0 m/s", "0 m/s"]
"""


def test_force_and_time_of_an_exact_impact(tmp_path: Path) -> None:
    # Oracle: Hertz' closed form, 2.9432752 d / V; the history is a quadrature of the energy equation.
    impact = module("two_spheres_impact")
    bare = synthetic_run(tmp_path / "bare", Fields(IMPACT))
    mass, stiffness, speed = impact.hertz(bare)
    largest = (5 * mass * speed**2 / (4 * stiffness)) ** 0.4
    time, force = impact.hertz_history(bare)
    assert time[-1] == pytest.approx(2.9432752 * largest / speed, rel=1e-6)
    assert force.max() == pytest.approx(stiffness * largest**1.5, rel=1e-12)
    sampled = np.arange(0, 80e-6, 20e-9)
    impulse = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(time))])
    velocity = 10.0 - np.interp(sampled, 10.003e-6 + time, impulse, left=0.0, right=impulse[-1]) / (2 * mass)
    solids = {"time": sampled, "id": 0 * sampled, "velocity_x": velocity}
    run = synthetic_run(tmp_path / "run", Fields(IMPACT, solids=solids))
    assert impact.contact_force(run).value == pytest.approx(force.max(), rel=1e-6)
    assert impact.contact_time(run).value == pytest.approx(time[-1], rel=1e-4)
