"""OpenFOAM, run live: what it must meet before it may judge anything."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from reference.openfoam import case_files, store
from reference.openfoam.__main__ import main
from reference.openfoam.bodies import HOW_TO_GET, bodies_problem
from reference.openfoam.cell import Cell, cell_of
from reference.openfoam.drag import drag_problem
from reference.openfoam.read import vectors
from reference.openfoam.run import missing_of, run
from reference.stokes.unsteady_array import virtual_mass
from verification.protocol.quantity import Result, read_result

EXACT = 24.831675  # F / (mu U) at a solids fraction of 0.1, Stokes flow: a collocation solver without a mesh
CELL = cell_of(2, 0.1, 0.1)
SIDE = 3.0
SCENE = f"""[box]
size = [{SIDE}, {SIDE}]
[fluid]
density = 1.0
viscosity = {{viscosity}}
reference_velocity = 2.0
[[body]]
shape = "disc"
radius = {SIDE * CELL.radius:.12g}
motion = "fixed"
position = [0.4, 2.1]
[force]
fluid = [0.0, 1.0]
"""

lacking = missing_of(("simpleFoam",))
pytestmark = pytest.mark.skipif(bool(lacking), reason=lacking)
needs_gmsh = pytest.mark.skipif(bool(missing_of(("gmsh",))), reason=missing_of(("gmsh",), HOW_TO_GET))


def scene_file(folder: Path, reynolds: float = 0.1) -> Path:
    file = folder / "scene.toml"
    file.write_text(SCENE.format(viscosity=f"{2 * SIDE * CELL.radius * 2.0 / reynolds:.12g}"))
    return file


def drag(folder: Path, *options: str, reynolds: float = 0.1) -> Result:
    assert main(["drag", "--scene", str(scene_file(folder, reynolds)), "--out", str(folder / "out"), *options]) == 0
    return read_result(folder / "out")


def errors(folder: Path, cell: Cell, levels: tuple[int, ...]) -> list[float]:
    """Relative, of levels of one disc."""
    problem = drag_problem(cell)
    return [problem.run(folder / f"n_{n}", n).drag / EXACT - 1 for n in levels]


def test_the_energy_of_the_flow_is_that_of_the_exact_one(tmp_path: Path) -> None:
    """Of Stokes flow through the square array, from the derivative of its impedance: no field is integrated there."""
    exact = 1 + virtual_mass(0.1) / (1 - 0.1)
    coarse, fine = (drag_problem(CELL).run(tmp_path / f"n_{n}", n).energy / exact - 1 for n in (8, 16))
    assert abs(fine) < 0.4 * abs(coarse) and abs(fine) < 5e-3
    found = drag(tmp_path, "--levels", "8,16").quantities["energy"]
    assert found.value == pytest.approx(exact, rel=1e-3) and abs(found.value - exact) < 3 * found.uncertainty


def test_stokes_drag_is_of_second_order_and_right(tmp_path: Path) -> None:
    coarse, fine = errors(tmp_path, CELL, (8, 16))
    assert 3.4 < coarse / fine < 4.6  # 4 for second order
    assert abs(fine) < 0.015
    result = drag(tmp_path, "--levels", "8,16")
    assert not result.objection and not result.missing and result.version and len(result.inputs) == 64
    found = result.quantities["drag"]
    assert found.value == pytest.approx(EXACT, rel=2.5e-3)
    assert abs(found.value - EXACT) < 2 * found.uncertainty
    assert all(level.core_seconds > 0 and level.live for level in found.levels)


def test_the_mesh_has_the_volume_of_its_polygon(tmp_path: Path) -> None:
    """A disc of 4 N chords; the shape itself would be 0.9."""
    run_of = drag_problem(CELL).run(tmp_path / "n", 8)
    chords = 4 * 8
    polygon = chords / 2 * CELL.radius**2 * np.sin(2 * np.pi / chords)
    assert f"Total volume = {1 - polygon:.8f}"[:26] in (run_of.folder / "log.checkMesh").read_text()


def test_interpolation_without_correction_is_told_apart(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(case_files, "INTERPOLATION", "linear")
    coarse, fine = errors(tmp_path, CELL, (8, 16))
    assert not 3.4 < coarse / fine < 4.6


def test_a_body_of_another_size_is_told_apart(tmp_path: Path) -> None:
    coarse, fine = errors(tmp_path, replace(CELL, radius=1.02 * CELL.radius), (8, 16))
    assert not 3.4 < coarse / fine < 4.6


def test_the_field_is_that_of_the_scene(tmp_path: Path) -> None:
    drag(tmp_path, "--levels", "8,16")
    field = np.load(tmp_path / "out/field.npz")
    points, velocity = field["points"], field["velocity"]
    assert points.shape == velocity.shape == (768, 2)
    assert points.min() >= 0 and points.max() <= SIDE
    offset = points - [0.4, 2.1]
    distance = np.linalg.norm(offset - SIDE * np.round(offset / SIDE), axis=1)
    assert distance.min() == pytest.approx(SIDE * CELL.radius, rel=0.06) and distance.min() > SIDE * CELL.radius * 0.99
    # Flow along +y, at rest on the surface; across a section beside the body it makes up the superficial velocity of 2.
    assert velocity[:, 1].mean() > 1 and abs(velocity[:, 0].mean()) < 1e-3
    assert np.linalg.norm(velocity[distance < 1.06 * SIDE * CELL.radius], axis=1).max() < 0.5
    far = np.abs(offset[:, 1] - SIDE * np.round(offset[:, 1] / SIDE)) > 0.46 * SIDE
    assert velocity[far, 1].mean() == pytest.approx(2.0, rel=0.05)  # cells differ in size


def test_finer_levels_come_from_the_store_and_agree(tmp_path: Path) -> None:
    result = drag(tmp_path, "--levels", "16", "--stored")
    assert not result.objection
    found = result.quantities["drag"]
    assert [(level.label, level.live) for level in found.levels] == [("N 16", True), ("N 32", False), ("N 64", False)]
    assert found.order == pytest.approx(2, abs=0.1)
    assert found.value == pytest.approx(EXACT, rel=5e-5)


def test_a_store_that_does_not_agree_is_objected_to(tmp_path: Path) -> None:
    file = store.stored_file(CELL)
    data = json.loads(file.read_text())
    data["levels"][0]["value"] *= 1.0003
    other = tmp_path / "other.json"
    other.write_text(json.dumps(data))
    assert "N 16" in drag(tmp_path, "--levels", "16", "--stored", str(other)).objection


def test_a_run_that_has_not_settled_is_objected_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("reference.openfoam.level.steady_for", lambda *_: case_files.Steady(0.9, 1e-8, 12))
    assert "no steady state" in drag(tmp_path, "--levels", "8,16").objection


def test_over_time_the_drag_becomes_the_steady_one(tmp_path: Path) -> None:
    steady = drag(tmp_path, "--levels", "8", "--stored", reynolds=20.0).quantities["drag"]
    result = drag(tmp_path, "--levels", "8,12", "--transient", "--end", "10", reynolds=20.0)
    assert not result.objection and "period" not in result.quantities
    assert result.quantities["drag"].levels[0].value == pytest.approx(
        steady.levels[0].value, rel=1e-2  # what PISO makes of the fluxes depends on the step: 0.5 % at N 8
    )
    time, along, _ = np.loadtxt(tmp_path / "out" / result.table, delimiter=",", skiprows=1).T
    assert time[-1] == pytest.approx(10 * SIDE / 2.0, rel=1e-2)
    assert along[-1] == pytest.approx(result.quantities["drag"].levels[1].value, rel=2e-3)


@needs_gmsh
def test_an_unstructured_mesh_gives_the_same_drag(tmp_path: Path) -> None:
    assert main(["bodies", "--scene", str(scene_file(tmp_path)), "--out", str(tmp_path), "--levels", "16,32"]) == 0
    result = read_result(tmp_path)
    assert not result.objection
    assert result.quantities["total_drag"].value == pytest.approx(EXACT, rel=5e-3)


@needs_gmsh
def test_a_cell_of_four_discs_drags_four_times_one(tmp_path: Path) -> None:
    """2 x 2 cells of an array are the array: F / (mu U) of the larger cell is four times that of one."""
    quarters = tuple((x, y) for x in (0.25, 0.75) for y in (0.25, 0.75))
    four = Cell(2, CELL.radius / 2, 0.1, (1.0, 0.0), positions=quarters)
    found = bodies_problem(four).run(tmp_path / "n", 16)
    assert not found.objection
    assert found.drag == pytest.approx(4 * EXACT, rel=0.03)
    assert np.isfinite(vectors(found.folder / str(max(int(p.name) for p in found.folder.glob("[1-9]*"))) / "U")).all()


CUBIC = 3.642448  # F / (6 pi mu R U) of a simple cubic array at a solids fraction of 0.1, by the same solver


def test_a_sphere_in_stokes_flow_has_its_drag(tmp_path: Path) -> None:
    coarse, fine = (drag_problem(cell_of(3, 0.1, 0.1)).run(tmp_path / f"n_{n}", n) for n in (6, 8))
    assert not coarse.objection and not fine.objection
    assert 1.5 < (CUBIC - coarse.drag) / (CUBIC - fine.drag) < 2.0  # (8 / 6)^2 = 1.78 for second order
    assert fine.drag + (fine.drag - coarse.drag) / (16 / 9 - 1) == pytest.approx(CUBIC, rel=2e-3)


def test_spheres_cut_from_cubes_drag_alike(tmp_path: Path) -> None:
    found = bodies_problem(cell_of(3, 0.1, 0.1)).run(tmp_path / "n", 8)
    assert not found.objection
    assert found.drag == pytest.approx(CUBIC, rel=0.05)


def test_a_program_that_is_missing_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    result = drag(tmp_path, "--levels", "8,16")
    assert "simpleFoam" in result.missing and "apt-get install openfoam" in result.missing and not result.quantities


def test_a_program_that_fails_is_an_objection(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(case_files, "INTERPOLATION", "crooked")
    result = drag(tmp_path, "--levels", "8,16")
    assert "simpleFoam" in result.objection and not result.quantities


def test_core_seconds_are_those_of_the_program(tmp_path: Path) -> None:
    busy = "import time\nwhile time.process_time() < 0.5: pass"
    assert 0.5 <= run(tmp_path, "python3", "-c", busy) < 0.8
    assert run(tmp_path, "sleep", "0.5") < 0.2
