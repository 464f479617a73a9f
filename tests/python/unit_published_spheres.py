"""Published figures of spheres: falling, alone, in random arrays, in contact. Oracles: theory, a second source."""

import math

import numpy as np
import pytest

from reference.published import look_up
from reference.published.contact import READING, chung_ooi
from reference.published.impacts import UNCERTAINTY, angles_of, kharaz
from reference.published.random_arrays import koch_hill
from reference.published.sphere import spread
from reference.published.table import read_table
from reference.published.ten_cate import (
    DIAMETER,
    END,
    SPHERE_DENSITY,
    START,
    gap_of,
    input_uncertainty,
    time_of_fall,
    velocity_in_wide_fluid,
)
from reference.published.ten_cate import READING as READING_OF_GAP


def sphere_scene(**fluid: float) -> dict:
    body = {"shape": "sphere", "radius": "7.5 mm", "position": [0.05, 0.05, 0.1]}
    return {"box": {"size": [0.11, 0.11, 0.17]}, "body": [body, {"shape": "wall"}], "fluid": fluid}


def test_ten_cate_s_numbers_follow_from_each_other() -> None:
    # Printed digits: u to 1e-3, Re to 0.1, St to 0.01 of numbers that follow from densities, viscosity and Abraham's
    # law.
    for row in read_table("ten_cate_2002").rows:
        density, viscosity = float(row["density"]), float(row["viscosity"])
        velocity = velocity_in_wide_fluid(density, viscosity)
        reynolds = velocity * DIAMETER * density / viscosity
        assert velocity == pytest.approx(float(row["u_infinity"]), abs=5.1e-4)
        assert reynolds == pytest.approx(float(row["reynolds"]), abs=0.06)
        assert reynolds * SPHERE_DENSITY / (9 * density) == pytest.approx(float(row["stokes"]), abs=0.006)


def test_ten_cate_s_experiment_lies_by_their_computation() -> None:
    table = read_table("ten_cate_2002")
    measured, computed = np.array(table.column("ratio")), np.array(table.column("lattice_boltzmann"))
    assert np.abs(measured - computed)[1:].max() < 0.01
    assert abs(measured - computed)[0] < 0.06  # E1, where their lattice is coarse for the viscosity


def test_ten_cate_by_density_and_viscosity() -> None:
    found = look_up("ten_cate_u_max", sphere_scene(density=960.0, viscosity=0.058))
    assert found.value == pytest.approx(0.955 * 0.128, abs=5e-4)  # u is printed to 1e-3
    assert found.uncertainty == pytest.approx(0.128 * 1e-3 / math.sqrt(12), rel=0.01)  # the ratio likewise
    assert found.source.startswith("E4 of ten Cate")
    with pytest.raises(ValueError, match="960 and 0.06: no experiment"):
        look_up("ten_cate_u_max", sphere_scene(density=960.0, viscosity=0.06))


def test_the_uncertainty_of_ten_cate_s_inputs_by_stokes_law() -> None:
    # u ~ (rho_p - rho_f) / mu: 1 % of the viscosity, and the rounding of both densities to 1 of 150 and of mu to 1 of 373.
    # Abraham's drag of E1 rises somewhat faster than the velocity, so the answer is somewhat smaller.
    stokes = math.hypot(math.sqrt(2 / 12) / 150, math.hypot(1 / 373 / math.sqrt(12), 0.01))
    assert 0.75 * stokes < input_uncertainty("970", "0.373") < stokes


def test_the_fall_of_e1_was_read_evenly() -> None:
    scene = sphere_scene(density=970.0, viscosity=0.373)
    time, gap, _ = gap_of(scene)
    steady = (gap < 7.3) & (gap > 2.2)
    about = gap[steady] - np.polyval(np.polyfit(time[steady], gap[steady], 2), time[steady])
    assert about.std(ddof=3) == pytest.approx(READING_OF_GAP, rel=0.2)
    found = look_up("ten_cate_fall", scene)
    # The mean velocity is below the largest, and not by more than the bottom and the start explain.
    mean = (START - END) * DIAMETER / found.value
    assert 0.9 < mean / look_up("ten_cate_u_max", scene).value < 1.0
    assert found.uncertainty < 0.01 * found.value
    with pytest.raises(ValueError, match="E4: no reading of its fall"):
        look_up("ten_cate_fall", sphere_scene(density=960.0, viscosity=0.058))


def test_the_time_of_a_steady_fall() -> None:
    time = np.linspace(0.0, 4.0, 401)
    assert time_of_fall(time, 8.0 - 2.5 * time) == pytest.approx((START - END) / 2.5, rel=1e-12)


def test_correlations_for_one_sphere_tend_to_stokes_and_oseen() -> None:
    # Proudman and Pearson 1957: 1 + 3/16 Re + 9/160 Re^2 ln(Re / 2). Abraham's law is of boundary layers: 11 % high at
    # 0.01.
    for re in (0.02, 0.1):
        exact = 1 + 3 / 16 * re + 9 / 160 * re**2 * math.log(re / 2)
        values = spread(re)
        assert values["Clift, Grace and Weber 1978"] == pytest.approx(exact, rel=0.01)
        assert all(exact * 0.99 < value < exact * 1.1 for value in values.values())


def test_correlations_for_one_sphere_agree_within_what_is_said_of_them() -> None:
    for re in (1.0, 10.0, 50.0, 200.0):
        values = np.array(list(spread(re).values()))
        assert np.ptp(values) / values.mean() < 0.09
    # Le Clair, Hamielec and Pruppacher 1970, computed: C_D 27.3 at 1, 4.32 at 10, 1.085 at 100.
    for re, computed in ((1.0, 27.3), (10.0, 4.32), (100.0, 1.085)):
        found = look_up("isolated_sphere", sphere_scene(density=1.0, viscosity=0.015 / re, reference_velocity=1.0))
        assert abs(found.value - computed * re / 24) < 2 * found.uncertainty


def test_clift_grace_and_weber_s_pieces_meet() -> None:
    below, above = (spread(re)["Clift, Grace and Weber 1978"] for re in (20.0, 20.001))
    assert below == pytest.approx(above, rel=0.01)


def test_random_arrays_against_van_der_hoef() -> None:
    # Van der Hoef, Beetstra and Kuipers 2005, without the share of the mean pressure: 10 phi / (1 - phi)^2 + (1 -
    # phi)^2 (1 + 1.5 sqrt(phi)).
    for fraction in (0.1, 0.2, 0.3, 0.4, 0.5):
        fluid = 1 - fraction
        other = (10 * fraction / fluid**2 + fluid**2 * (1 + 1.5 * math.sqrt(fraction))) / fluid
        found = koch_hill(fraction, 0.0)
        assert abs(found.value - other) < found.uncertainty


def test_random_arrays_of_a_scene_and_their_range() -> None:
    body = {"shape": "sphere", "radius": 1.0, "random": {"count": 10, "seed": 1}}
    fluid = {"density": 1.0, "viscosity": 0.05, "reference_velocity": 1.0}
    scene = {"box": {"size": [6.0, 6.0, 6.0]}, "body": [body], "fluid": fluid}
    assert look_up("random_spheres", scene).value == koch_hill(10 * 4 / 3 * math.pi / 216, 40.0).value
    scene["body"].append({"shape": "sphere", "radius": 0.5, "position": [0.0, 0.0, 0.0]})
    with pytest.raises(ValueError, match="equal spheres"):
        look_up("random_spheres", scene)
    with pytest.raises(ValueError, match=r"Re = 200: outside"):
        koch_hill(0.2, 200.0)


@pytest.mark.parametrize(("re", "words"), [(0.005, "Re = 0.005: outside 0.01 to 260"), (300.0, "Re = 300: outside")])
def test_one_sphere_out_of_range_is_refused(re: float, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        spread(re)


@pytest.mark.parametrize(
    ("test", "young", "radius"), [(1, 48e9 / (2 * (1 - 0.2**2)), 0.005), (2, 70e9 / (1 - 0.3**2), 0.1)]
)
def test_chung_and_ooi_s_forces_are_hertz_s(test: int, young: float, radius: float) -> None:
    overlap, force = chung_ooi(test, "force")
    hertz = 4 / 3 * young * math.sqrt(radius) * (overlap * 1e-6) ** 1.5 / 1e3
    assert np.abs(force - hertz).max() < 2 * READING * force.max()


def test_chung_and_ooi_s_oblique_impacts_slide_as_coulomb_says() -> None:
    # At 40 degrees and more the sphere slides throughout: an impulse mu (1 + e) m v cos(theta) along the plane.
    friction, restitution, speed, radius = 0.092, 0.98, 3.9, 0.0025
    impulse = friction * (1 + restitution)
    angle, kept = chung_ooi(4, "tangential_restitution")
    slides = angle > 39
    assert kept[slides] == pytest.approx(1 - impulse / np.tan(np.radians(angle[slides])), abs=2 * READING)
    angle, spin = chung_ooi(4, "angular_velocity")
    expected = -2.5 * impulse * speed * np.cos(np.radians(angle)) / radius
    assert np.abs(spin - expected)[slides].max() < 2 * READING * np.abs(spin).max()
    angle, rebound = chung_ooi(4, "rebound_angle")
    contact = (np.tan(np.radians(angle)) - 3.5 * impulse) / restitution
    assert np.abs(rebound - np.degrees(np.arctan(contact)))[slides].max() < 2 * READING * 90


def test_chung_and_ooi_s_other_figures_are_not_there() -> None:
    with pytest.raises(KeyError, match="there are 1 force"):
        chung_ooi(7, "force")


def test_two_readings_of_kharaz_s_figures_agree() -> None:
    for row in read_table("kharaz_2001").rows:
        value, again = float(row["value"]), float(row["value_again"])
        assert abs(float(row["angle"]) - float(row["angle_again"])) < 0.24
        assert abs(value - again) < (0.0014 if row["figure"] == "tangential_restitution" else 1.6)


def test_kharaz_s_spheres_slide_as_coulomb_says() -> None:
    """From 30 degrees on: e_t = 1 - mu (1 + e) / tan(angle), with the friction and the restitution that they measured."""
    for angle in angles_of("tangential_restitution")[4:]:
        slides = 1 - 0.092 * 1.98 / math.tan(math.radians(angle))
        assert kharaz("tangential_restitution", angle).value == pytest.approx(slides, abs=0.015)


def test_kharaz_s_two_figures_differ_by_the_uncertainty_of_the_spin() -> None:
    angles = angles_of("tangential_restitution")
    kept = np.interp(angles_of("spin"), angles, [kharaz("tangential_restitution", angle).value for angle in angles])
    left = [2.5 * (1 - e) * 3.9 * math.sin(math.radians(angle)) / 0.0025 for e, angle in zip(kept, angles_of("spin"), strict=True)]
    apart = np.array([kharaz("spin", angle).value for angle in angles_of("spin")]) - left
    assert np.sqrt(np.mean(apart**2)) == pytest.approx(UNCERTAINTY["spin"], rel=0.15)


def test_an_angle_that_was_not_measured_is_refused() -> None:
    with pytest.raises(ValueError, match="angle of 45 degrees: not measured; there are 1.93, 3.82"):
        kharaz("tangential_restitution", 45.0)
