"""What must stay at rest, and what a boost must not change. Oracle: symmetry."""

from pathlib import Path

import numpy as np
from support import assert_holds, judged

from verification.codes.mappm import Options, run
from verification.protocol.machine import ROOT
from verification.protocol.run import Run


def test_a_lattice_of_powers_of_two_stays_exactly_at_rest(tmp_path: Path) -> None:
    finished, outcomes = judged("rest", tmp_path)
    assert_holds(outcomes["largest_velocity"], goal=0.0)
    assert finished.series["fluid_energy"][-1] == 0.0


def test_any_other_lattice_stays_at_rest_to_rounding(tmp_path: Path) -> None:
    # 30 nodes a side: positions are rounded to 2^-52 of the box, so sums over neighbours cancel to that only. 1e-12 c is
    # the bound asked of the solver; the velocity quantum is 4e-15 c.
    _, outcomes = judged("rest", tmp_path, "fluid.spacing=0.0333333333333", "fluid.rcut=0.11")
    assert 0.0 <= outcomes["largest_velocity"].measured.value < 1e-12


def relative_velocities(finished: Run) -> tuple[np.ndarray, np.ndarray]:
    """Of PPs and of solids to the mean of the PPs, in the order of their ids."""
    fluid, solids = finished.fluid(), finished.solids()
    fluid_order, solid_order = np.argsort(fluid["id"]), np.argsort(solids["id"])
    mean = fluid["velocity"].mean(axis=0)
    return fluid["velocity"][fluid_order] - mean, solids["velocity"][solid_order] - mean


def test_a_boost_changes_relative_motion_by_rounding_only(tmp_path: Path) -> None:
    common = ("body.0.angular_velocity=0.4", "force.fluid=[-0.002,-0.01]")
    resting = ("fluid.velocity=[0,0]", "body.0.velocity=[0,0]", "body.1.velocity=[0,0]", *common)
    boosted = ("fluid.velocity=[0.05,0.07]", "body.0.velocity=[0.05,0.07]", "body.1.velocity=[0.05,0.07]", *common)
    runs = [
        run(ROOT / "cases" / "crossing_2d" / "case.toml", tmp_path / str(i), Options(steps=100, overrides=overrides))
        for i, overrides in enumerate((resting, boosted))
    ]
    for a, b in zip(*(relative_velocities(finished) for finished in runs), strict=True):
        # Rounding starts at 4e-15 c (the velocity quantum) and, the particles being disordered, grows with the steps;
        # what a wrong frame does is of the size of the boost, 0.05 c, times a step.
        assert np.abs(a - b).max() < 1e-10
        assert np.abs(a).max() > 1e-3  # there is motion to compare
