"""Measures of released bodies. Oracles: the equation of motion, Galilean invariance, limits of history."""

from pathlib import Path

import numpy as np
import pytest
from synthetic import Fields, synthetic_run

from cases.falling_disc import measure
from cases.falling_disc.measure import Law, Release
from cases.falling_sphere.measure import added_mass, drag_of, with_history
from cases.falling_sphere.measure import virtual_mass as dragged
from reference.stokes.history import History
from reference.stokes.square_array import square_array
from reference.stokes.unsteady_array import impedance, virtual_mass
from verification.measures.measures import Values
from verification.protocol.run import Run

SCENE = """
[box]
size = [{side}]
[fluid]
density = 1.0
viscosity = 10.0
[[body]]
radius = 1.0
density = {density}
motion = "{motion}"
[force]
fluid = [8.0]
[run]
relax = {relax}
"""
SPHERE = Release(3, 4.03, 0.064, 1.0, 1.0, 10.0, 2.0, 8.09)


def run_of(folder: Path, *, motion: str = "free", drift: float = 0.0, relax: int = 0) -> Run:
    """A disc at its terminal slip 1.1 for the whole run; the fluid has 1.3 times the energy of its mean,
    seen from the disc."""
    scene = SCENE.format(side="5.6, 5.6", density=100.0, motion=motion, relax=relax)
    release = measure.release_of(synthetic_run(folder / "bare", Fields(scene)))
    mean, excess = 1.1, 0.3  # <u^2> = (1 + excess) <u>^2, seen from the body
    steps = np.arange(0.0, 101.0)
    energy = 0.5 * release.fluid_mass * ((1 + excess) * mean**2 + 2 * mean * drift + drift**2)
    held = {"slip_x": -mean, "solid_velocity_x": drift, "fluid_velocity_x": mean + drift, "fluid_energy": energy}
    series = {"step": steps, "time": 0.01 * steps} | {name: np.full(101, value) for name, value in held.items()}
    return synthetic_run(folder / "run", Fields(scene, series))


def test_the_law_meets_the_equation_of_motion() -> None:
    law, time = Law(400.0, 10.0), np.linspace(0, 0.3, 301)
    slip = law.slip(SPHERE, time)
    change = np.gradient(slip, time, edge_order=2)
    assert (SPHERE.reduced_mass + 10.0) * change + 400.0 * slip == pytest.approx(SPHERE.force, rel=2e-4)


@pytest.mark.parametrize("drift", [0.0, -0.4])
def test_the_mass_dragged_along_is_the_same_for_a_body_that_drifts(tmp_path: Path, drift: float) -> None:
    run = run_of(tmp_path, drift=drift)
    assert dragged(run) == pytest.approx(0.3 * measure.release_of(run).fluid_mass)


def test_time_counts_from_the_release(tmp_path: Path) -> None:
    time, slip = measure.slip(run_of(tmp_path, relax=20))
    assert (time[0], len(slip)) == (pytest.approx(0.0), 81)
    assert time[-1] == pytest.approx(0.8)


def test_liggghts_is_given_the_law_of_stokes_flow_whatever_was_measured(tmp_path: Path) -> None:
    runs = [run_of(tmp_path / name, drift=drift) for name, drift in (("one", -0.4), ("other", 0.3))]
    kept = [Values(run.scene, {name: figure(run) for name, figure in measure.MEASURES.figures.items()}) for run in runs]
    release = measure.release_of(runs[0])
    law = measure.stokes_law(release)
    expected = {"gamma": law.drag, "force": release.force, "mass": release.reduced_mass + law.virtual_mass}
    for one in kept:
        found = measure.MEASURES.reference_options([one])
        assert {name: float(text) for name, text in found.items()} == pytest.approx(expected)


def test_a_body_that_falls_as_the_exact_flow_has_ratios_of_one(tmp_path: Path) -> None:
    heavy = Release(2, 5.604991216397929, 0.1, 1.0, 1.0, 10.0, 100.0, 7.90416764300288)
    time = np.linspace(0.0, 1.4, 1401)
    w = np.concatenate([[0.0], measure.stokes_flow(heavy, tuple(time[1::100]))])
    series = {"step": np.arange(len(w)) * 1.0, "time": np.concatenate([[0.0], time[1::100]]), "slip_x": -w}
    scene = SCENE.format(side="5.604991216397929, 5.604991216397929", density=100.0, motion="free", relax=0).replace(
        "fluid = [8.0]", "fluid = [7.90416764300288]")
    run = synthetic_run(tmp_path, Fields(scene, series))
    assert measure.terminal_over_exact(run).value == pytest.approx(1.0, abs=2e-3)
    limit = heavy.force / measure.stokes_law(heavy).drag
    at = measure.stokes_relaxation(measure.release_of(run))
    assert measure.stokes_flow(heavy, (at,))[0] / limit == pytest.approx(1 - np.exp(-1), abs=1e-5)


def test_the_drag_on_a_sphere_is_that_of_the_array() -> None:
    """Of Zick and Homsy, 2.810 at this fraction, times (1 - phi)^2 for the slip between fluid and sphere."""
    assert drag_of(SPHERE) == pytest.approx(6 * np.pi * 10.0 * 2.810 * (1 - 0.064) ** 2, rel=1e-3)


def test_masses_of_the_two_body_problem() -> None:
    solid = SPHERE.ratio * SPHERE.displaced
    assert SPHERE.displaced == pytest.approx(4 / 3 * np.pi, rel=1e-3)
    assert SPHERE.fluid_mass + SPHERE.displaced == pytest.approx(4.03**3)
    assert 1 / SPHERE.reduced_mass == pytest.approx(1 / solid + 1 / SPHERE.fluid_mass)


def test_the_law_of_stokes_flow_is_the_late_part_of_the_unsteady_flow() -> None:
    heavy = Release(2, 5.604991216, 0.1, 1.0, 1.0, 10.0, 100.0, 7.904167)
    times = (0.6, 0.9, 1.4)
    law = measure.stokes_law(heavy).slip(heavy, np.array(times))
    assert measure.stokes_flow(heavy, times) == pytest.approx(law, rel=0.01)


def test_history_begins_with_added_mass_and_ends_in_the_drag_law() -> None:
    law = Law(467.0, 10.0)
    early, late = with_history(SPHERE, law, np.array([1e-6, 5.0]))
    assert early == pytest.approx(SPHERE.force * 1e-6 / (SPHERE.reduced_mass + added_mass(SPHERE)), rel=0.05)
    assert late == pytest.approx(SPHERE.force / law.drag, rel=1e-4)


def test_in_a_wide_fluid_the_added_mass_is_half_of_the_fluid_displaced() -> None:
    wide = Release(3, 100.0, 4.18879e-6, 1.0, 1.0, 10.0, 2.0, 8.09)
    assert added_mass(wide) == pytest.approx(0.5 * wide.displaced, rel=1e-4)


@pytest.mark.parametrize("fraction", [0.03, 0.1])
def test_basset_s_history_with_an_end_meets_the_unsteady_stokes_flow_in_the_plane(fraction: float) -> None:
    # The same form for discs: the fluid slips past with 2 w sin(theta), so its boundary layer takes 4 pi sqrt(rho mu s)
    # R, and the added mass is phi (1 - phi). Units of the cell.
    drag, layer = (1 - fraction) ** 2 * square_array(fraction).drag, 4 * np.pi * np.sqrt(fraction / np.pi)
    history = History(drag, fraction * (1 - fraction), layer, virtual_mass(fraction))
    for s in (1.0, 10.0, 100.0, 1000.0, 10000.0):
        assert history.impedance(s) == pytest.approx(impedance(fraction, s).real, rel=0.02)
