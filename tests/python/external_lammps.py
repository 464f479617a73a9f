"""LAMMPS, run live: that the fluid it runs is the one it is compared on, and that it repeats itself."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

from bench.codes import Other
from bench.largest_step import flows_of, trial_of
from reference.contact.collision import collision_of
from reference.contact.motion import contact_force, contact_time, restitution, spin, tangential_velocity
from reference.contact.scene import contact_scene
from reference.lammps import contacts
from reference.lammps.__main__ import main
from reference.lammps.program import MISSING, installed
from reference.lammps.sph import PEER
from reference.liggghts import impact
from reference.liggghts.program import installed as liggghts_is_installed
from reference.periodic_fluid import Fluid
from reference.scripted import Failed
from verification.protocol.quantity import read_result

pytestmark = pytest.mark.skipif(not installed(), reason=MISSING)


@pytest.mark.parametrize("dimension, side", [(2, 32), (3, 12)])
def test_it_gives_the_same_on_two_ranks_and_with_another_skin_but_for_rounding(tmp_path: Path, dimension: int, side: int) -> None:
    assert main(["sph", "--dimension", str(dimension), "--side", str(side), "--steps", "50", "--out", str(tmp_path)]) == 0
    result = read_result(tmp_path)
    assert result.version.startswith("22 Jul 2025") and not result.objection
    for name in ("ranks_velocity", "skin_velocity"):
        assert result.quantities[name].value < 1e-10
    assert result.quantities["particle_steps_per_core_second"].value > 0


@pytest.mark.parametrize("dimension, side", [(2, 24), (3, 12)])
def test_its_flows_decay_as_the_exact_ones(tmp_path: Path, dimension: int, side: int) -> None:
    """Within the error of so coarse a lattice; a wrong unit of the viscosity, of the step or of the range is far beyond."""
    for fluid, end in flows_of(dimension, side):
        assert trial_of(Other("lammps", PEER), fluid, end, tmp_path)(0.5) == pytest.approx(1, abs=0.1)


def test_a_step_beyond_its_limit_fails(tmp_path: Path) -> None:
    wave = replace(flows_of(2, 16)[0][0], step=3.0, steps=100)
    with pytest.raises(Failed, match="Lost atoms|Non-numeric"):
        Other("lammps", PEER).energies(wave, 1, tmp_path)


def test_the_speed_is_that_of_the_quickest_skin(tmp_path: Path) -> None:
    code, fluid = Other("lammps", PEER), Fluid(2, 32, 40, step=1.0, viscosity=0.01)
    assert code.speed(fluid, 1, tmp_path).rate > 0 and code.speed(fluid, 2, tmp_path).rate > 0
    assert f"neighbor {code.skins[fluid]!r} bin" in (tmp_path / "lammps" / "in.lammps").read_text()


def sphere_on_wall(**contact) -> dict:
    """Comes down at 2 with 1 across, at a radius of 1/2."""
    return {
        "box": {"size": [4.0, 4.0, 8.0]},
        "fluid": {"particles": False},
        "body": [{"shape": "wall", "position": 0.0, "thickness": 1.0},
                 {"shape": "sphere", "radius": 0.5, "density": 2.0, "positions": [[2.0, 2.0, 1.5002]], "velocity": [1.0, 0.0, -2.0]}],
        "contact": {"model": "hertz", "young": 1e6, "poisson": 0.25, "restitution": 0.5, "friction": 0.0} | contact,
        "run": {"step": 5e-6, "steps": 8000},
        "output": {"sample": 10},
    }


@pytest.mark.parametrize("law", [{}, {"restitution": 0.9}, {"model": "linear", "stiffness": 1e5, "restitution": 0.3}])
def test_impacts_along_the_normal_follow_the_equation_of_the_overlap(tmp_path: Path, law: dict) -> None:
    scene = contact_scene(sphere_on_wall(**law))
    exact, found = collision_of(scene), contacts.run(scene, tmp_path)
    assert contact_force(found) == pytest.approx(exact.force, rel=5e-3)
    assert contact_time(found) == pytest.approx(exact.time, rel=5e-3)
    assert restitution(found) == pytest.approx(exact.restitution, rel=5e-3)


@pytest.mark.skipif(not liggghts_is_installed(), reason="LIGGGHTS is not installed")
@pytest.mark.parametrize("law", [{"young": 1e9}, {"model": "linear", "stiffness": 1e8}])
def test_two_spheres_meet_at_an_angle_without_loss_as_in_liggghts(tmp_path: Path, law: dict) -> None:
    """Hard ones: their arms of friction differ by a share of the overlap."""
    given = sphere_on_wall(restitution=1.0, friction=0.3, **law)
    ball = given["body"][1] | {"velocity": [0.0, 0.0, 0.0], "positions": [[2.0, 2.0, 2.0]], "radius": 0.4}
    given["body"] = [given["body"][1] | {"positions": [[2.19528, 2.0, 2.87875]], "angular_velocity": [3.0, 0.0, 0.0]}, ball]
    scene = contact_scene(given | {"run": {"step": 2e-7, "steps": 8000}})
    one = contacts.run(scene, tmp_path / "lammps")
    impact.run(scene, tmp_path / "liggghts", "", "impact")
    other = impact.granular.read_motion(tmp_path / "liggghts" / "table.csv", scene)
    assert one.spin[-1] == pytest.approx(other.spin[-1], rel=2e-3, abs=2e-3)
    assert one.velocity[-1] == pytest.approx(other.velocity[-1], rel=2e-3, abs=2e-3)


def test_discs_turn_as_discs(tmp_path: Path) -> None:
    """One that slides through its impact: friction turns it by 2 mu (1 + e) v / R, and slows it by mu (1 + e) v."""
    given = sphere_on_wall(model="linear", stiffness=1e5, restitution=1.0, friction=0.02)
    given["box"]["size"] = [4.0, 8.0]
    given["body"][0]["axis"] = "y"
    given["body"][1] |= {"shape": "disc", "positions": [[2.0, 1.5002]], "velocity": [1.0, -2.0]}
    found = contacts.run(contact_scene(given), tmp_path)
    assert tangential_velocity(found) == pytest.approx(1 - 0.02 * 2 * 2, rel=2e-3)
    assert abs(spin(found)) == pytest.approx(2 * 0.02 * 2 * 2 / 0.5, rel=1e-2)
    assert math.copysign(1, spin(found)) == 1


def test_a_stack_comes_to_rest_on_its_own_weight(tmp_path: Path) -> None:
    """The deepest overlap with the wall carries the weight of both: k d = 2 m g."""
    given = sphere_on_wall(model="linear", stiffness=1e5, restitution=0.3)
    given["body"][1] |= {"positions": [[2.0, 2.0, 1.5], [2.0, 2.0, 2.5]], "velocity": [0.0, 0.0, 0.0]}
    given["force"] = {"solid": [0.0, 0.0, -10.0]}
    scene = contact_scene(given | {"run": {"step": 1e-4, "steps": 20000}})
    found = contacts.run(scene, tmp_path)
    assert contacts.granular.PROBLEMS["rest"]["lowest_overlap"](found) == pytest.approx(2 * scene.bodies[0].mass * 10 / 1e5, rel=1e-3)
