"""Peers as codes, where they are not installed; and the particles that they start from. Nothing of them is run here."""

import json
from pathlib import Path

import numpy as np
import pytest

from reference import scripted
from reference.lammps import program as lammps_program
from reference.lammps.sph import lattice_density
from reference.particles import FRAMES, largest_step, particles_of, plan_of, read_particle_scene
from verification.codes.lammps import Lammps
from verification.codes.liggghts import Liggghts
from verification.codes.openfoam import OpenFoam
from verification.codes.pysph import PySph
from verification.protocol.adapter import BAD_INPUT, CANNOT, Adapter, BadInput, Cannot, main
from verification.protocol.toml_text import scene_text

LINES = {"lammps": "./setup --peers", "pysph": "./setup --peers", "liggghts": "apt-get install liggghts",
         "openfoam": "apt-get install openfoam"}
CHANNEL = {"box": {"size": [0.5, 1.25]}, "run": {"duration": 2.0}, "force": {"fluid": [0.1, 0.0]},
           "fluid": {"density": 2.0, "viscosity": 0.1, "spacing": 0.125, "rcut": 0.25, "sound_speed": 1.0,
                     "disorder": {"amplitude": 0.2, "seed": 3}},
           "body": [{"shape": "wall", "axis": "y", "position": 1.0, "thickness": 0.25, "motion": "moving", "velocity": [0.5, 0.0]}]}


@pytest.fixture
def nothing_installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    for module in (scripted, lammps_program):
        monkeypatch.setattr(module, "PEERS", tmp_path)


@pytest.mark.parametrize("adapter", [Lammps(), Liggghts(), OpenFoam(), PySph()], ids=lambda adapter: adapter.name)
def test_a_code_that_is_not_installed_names_the_line_that_installs_it(
    adapter: Adapter, nothing_installed: None, tmp_path: Path, capsys: pytest.CaptureFixture
) -> None:
    assert main(adapter, ["describe"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["missing"].endswith(LINES[adapter.name]) and found["version"] == ""
    (tmp_path / "scene.toml").write_text(scene_text(CHANNEL))
    assert main(adapter, ["run", "--scene", str(tmp_path / "scene.toml"), "--out", str(tmp_path / "out")]) == CANNOT
    assert capsys.readouterr().err.strip().endswith(LINES[adapter.name])


def test_particles_lie_in_the_middle_of_cells_and_walls_move() -> None:
    scene = read_particle_scene(CHANNEL)
    particles = particles_of(scene)
    assert len(particles.points) == 4 * 10 and scene.mass == pytest.approx(2.0 * 0.125**2)
    wall = particles.points[~particles.fluid]
    assert sorted(set(wall[:, 1])) == pytest.approx([1.0625, 1.1875]) and len(wall) == 8
    assert np.all(particles.velocity[~particles.fluid] == [0.5, 0.0]) and np.all(particles.velocity[particles.fluid] == 0)


def test_disorder_leaves_those_next_to_a_wall_on_the_lattice() -> None:
    points = particles_of(read_particle_scene(CHANNEL)).points
    off = np.abs((points / 0.125 - 0.5) - np.round(points / 0.125 - 0.5)).max(axis=1) > 1e-9
    rows = np.round(points[:, 1] / 0.125 - 0.5)
    assert set(rows[off]) == {1, 2, 3, 4, 5, 6}  # rows 0 and 7 touch the wall, 8 and 9 are the wall
    assert np.abs(points / 0.125 - 0.5 - np.round(points / 0.125 - 0.5)).max() <= 0.2 + 1e-9


def test_a_run_ends_where_the_scene_does_and_holds_the_limit() -> None:
    scene = read_particle_scene(CHANNEL)
    limit = largest_step(scene, 0.125, 0.5)
    assert limit == pytest.approx(min(0.25 * 0.125 / 1.5, 0.125 * 0.125**2 / 0.05))
    plan = plan_of(scene, limit, None)
    assert plan.step * plan.steps == pytest.approx(2.0) and plan.step <= limit and plan.steps == FRAMES * plan.every
    assert plan_of(scene, limit, 3).steps == 3


def test_what_such_codes_do_not_have_is_refused() -> None:
    with pytest.raises(Cannot, match="shape disc"):
        read_particle_scene(CHANNEL | {"body": [{"shape": "disc"}]})
    with pytest.raises(Cannot, match="force.wave"):
        read_particle_scene(CHANNEL | {"force": {"wave": {}}})
    with pytest.raises(BadInput, match="fluid.sound_speed is missing"):
        read_particle_scene(CHANNEL | {"fluid": {key: value for key, value in CHANNEL["fluid"].items() if key != "sound_speed"}})


def test_the_sum_over_a_lattice_by_hand() -> None:
    """Reach 1.2: the particle itself and four neighbours, (1 - 1/1.44)^4 each, with 5 / pi over the reach squared."""
    assert lattice_density([1.0, 1.0], 1.2, 3.0) == pytest.approx(3.0 * 5 / np.pi / 1.44 * (1 + 4 * (1 - 1 / 1.44) ** 4))


def test_options_of_a_reference_are_checked_by_its_program(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    if lacking := Liggghts().missing():
        pytest.skip(lacking)
    (tmp_path / "scene.toml").write_text(scene_text(CHANNEL))
    given = ["run", "--scene", str(tmp_path / "scene.toml"), "--out", str(tmp_path / "out")]
    assert main(Liggghts(), [*given, "--option", "problem=fall", "--option", "gamma=much"]) == BAD_INPUT
    assert "argument --gamma: invalid float value" in capsys.readouterr().err
    assert main(Liggghts(), [*given, "--option", "problem=melt"]) == BAD_INPUT
    assert "take one of impact, rest, fall, sph" in capsys.readouterr().err
