"""Meshes, cases and scenes of reference/openfoam, without OpenFOAM. Oracles: geometry, made-up signals."""

import json
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from reference.openfoam.__main__ import main
from reference.openfoam.blocks import BODY, BlockMesh, block_mesh_dict, box_mesh, disc_mesh, sphere_mesh
from reference.openfoam.cell import cell_of, read_cell
from reference.openfoam.plane_mesh import geometry
from reference.openfoam.read import gradients, latest, scalars, vectors
from reference.openfoam.shift import clear_cuts
from reference.openfoam.store import FOLDER, disagreement, find_stored, read_stored
from reference.openfoam.transient import analyse, transient_for

# Of a block, seen from outside.
SIDES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
MESHES = [disc_mesh(0.2, 16), sphere_mesh(0.2, 6), box_mesh(4)]
SCENE = """[box]
size = [2.0, 2.0]
[fluid]
density = 2.0
viscosity = 0.5
reference_velocity = 3.0
[[body]]
shape = "disc"
radius = 0.4
motion = "fixed"
position = [0.3, 1.7]
[force]
fluid = [0.0, -5.0]
"""


def faces_of(mesh: BlockMesh) -> list[tuple[int, ...]]:
    return [tuple(block[i] for i in side) for block in mesh.blocks for side in SIDES]


def volume_of(mesh: BlockMesh) -> float:
    """Of the blocks with straight edges, by the divergence theorem over their faces cut into triangles."""
    total = 0.0
    for face in faces_of(mesh):
        a, b, c, d = (mesh.vertices[i] for i in face)
        total += (a @ np.cross(b, c) + a @ np.cross(c, d)) / 6
    return total


@pytest.mark.parametrize("mesh", MESHES)
def test_each_side_of_a_block_is_shared_by_two_or_on_one_patch(mesh: BlockMesh) -> None:
    times = Counter(frozenset(face) for face in faces_of(mesh))
    on_patches = Counter(frozenset(face) for patch in mesh.patches.values() for face in patch.faces)
    assert set(on_patches.values()) == {1}
    assert {face for face, count in times.items() if count == 1} == set(on_patches)
    assert set(times.values()) <= {1, 2}


@pytest.mark.parametrize("mesh", MESHES)
def test_blocks_are_right_handed(mesh: BlockMesh) -> None:
    for block in mesh.blocks:
        origin, x, y, z = (mesh.vertices[block[i]] for i in (0, 1, 3, 4))
        assert np.dot(np.cross(x - origin, y - origin), z - origin) > 0


@pytest.mark.parametrize("mesh", MESHES)
def test_periodic_sides_are_one_side_apart(mesh: BlockMesh) -> None:
    for axis, name in enumerate("xyz"):
        if f"{name}_low" not in mesh.patches:
            continue
        low, high = mesh.patches[f"{name}_low"], mesh.patches[f"{name}_high"]
        assert (low.neighbour, high.neighbour) == (f"{name}_high", f"{name}_low")
        ends = [{tuple(mesh.vertices[i]) for i in patch.faces[0]} for patch in (low, high)]
        assert {tuple(np.array(point) + np.eye(3)[axis]) for point in ends[0]} == ends[1]


def test_the_blocks_around_a_disc_leave_out_its_area() -> None:
    radius = 0.2
    chords = volume_of(disc_mesh(radius, 16))  # the square on the four corners is left out
    segments = (np.pi - 2) * radius**2
    assert chords - segments == pytest.approx(1 - np.pi * radius**2, rel=1e-12)


def test_the_blocks_around_a_sphere_leave_out_the_cube_in_it() -> None:
    radius = 0.2
    assert volume_of(sphere_mesh(radius, 6)) == pytest.approx(1 - (2 * radius / np.sqrt(3)) ** 3, rel=1e-12)


@pytest.mark.parametrize("mesh", MESHES[:2])
def test_arcs_run_over_the_surface(mesh: BlockMesh) -> None:
    plane = 2 if mesh.sphere == 0 else 3
    assert len(mesh.arcs) == (8 if plane == 2 else 12)
    for i, j, middle in mesh.arcs:
        for point in (mesh.vertices[i], mesh.vertices[j], np.array(middle)):
            assert np.linalg.norm(point[:plane]) == pytest.approx(0.2, rel=1e-12)
        between = np.array(middle)[:plane]
        assert np.linalg.norm(between - mesh.vertices[i][:plane]) == pytest.approx(
            np.linalg.norm(between - mesh.vertices[j][:plane])
        )


def test_cells_at_the_disc_are_as_wide_as_high_at_every_level() -> None:
    """Of the first of n cells that grow by a constant factor along a radius in the middle of a block."""
    for n in (16, 64):
        mesh = disc_mesh(0.1784, n)
        count = mesh.cells[0]
        first = (0.5 - 0.1784) / sum(mesh.growth ** (i / (count - 1)) for i in range(count))
        assert first == pytest.approx(np.pi * 0.1784 / 2 / n, rel=0.35)


def test_numbers_of_cells_are_those_of_the_recipe() -> None:
    assert [disc_mesh(0.2, n).number_of_cells for n in (16, 32, 64)] == [768, 3072, 12288]
    assert [sphere_mesh(0.2, n).number_of_cells for n in (6, 8, 12, 18)] == [7776, 18432, 62208, 209952]


def test_the_dictionary_names_neighbours_and_the_surface() -> None:
    text = block_mesh_dict(sphere_mesh(0.2, 6))
    assert "x_low { type cyclic; neighbourPatch x_high;" in text
    assert text.count(f") {BODY}\n") == 6 and "searchableSphere" in text
    assert "project" not in block_mesh_dict(disc_mesh(0.2, 16))


def scene_file(folder: Path, text: str = SCENE) -> Path:
    file = folder / "scene.toml"
    file.write_text(text)
    return file


def test_a_scene_is_made_dimensionless(tmp_path: Path) -> None:
    cell = read_cell(scene_file(tmp_path), [])
    assert (cell.dimension, cell.side, cell.speed) == (2, 2.0, 3.0)
    assert cell.radius == pytest.approx(0.2)
    assert cell.reynolds == pytest.approx(2 * 2.0 * 0.4 * 3.0 / 0.5)
    assert cell.viscosity == pytest.approx(0.5 / 2.0 / (3.0 * 2.0))  # kinematic, over speed and side
    assert cell.direction == (0.0, -1.0)
    assert cell.positions == ((0.15, 0.85),)


def test_units_of_a_scene_do_not_matter(tmp_path: Path) -> None:
    mapped = SCENE.replace("[2.0, 2.0]", '["2 mm", "2 mm"]').replace("0.4", '"400 um"').replace("3.0", '"3 mm/s"') \
        .replace("density = 2.0", "density = 2e6").replace("[0.3, 1.7]", '["0.3 mm", "1.7 mm"]')
    mapped = mapped.replace('"3 mm/s"', "0.003")
    plain = read_cell(scene_file(tmp_path), [])
    found = read_cell(scene_file(tmp_path, mapped), [])
    assert found.radius == pytest.approx(plain.radius) and found.reynolds == pytest.approx(plain.reynolds)
    assert found.positions[0] == pytest.approx(plain.positions[0])


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("box.size=[2.0,1.0]", ["box.size", "equal sides"]),
        ("body.0.shape=sphere", ["body.0.shape", '"disc"']),
        ("body.0.motion=free", ["body.0.motion", '"fixed"']),
        ("body.0.radius=-1.0", ["body.0.radius", "above 0"]),
        ("body.0.radius=1.2", ["body.0.radius", "enlarge the box"]),
        ("fluid.viscosity=thick", ["fluid.viscosity", "quantity"]),
        ("force.fluid=[0.0,0.0]", ["force.fluid", "direction"]),
        ("force.fluid=[1.0]", ["force.fluid", "2 components"]),
        ("body.0.positions=[[0.5,0.5],[1.0,0.5]]", ["body.0.positions", "overlap"]),
        ("body.0.positions=[[0.5,0.5],[1.5,0.5]]", ["body.0.positions", "`bodies`"]),
        ("body.7.radius=1.0", ["body.7.radius", "no such key"]),
    ],
)
def test_bad_scenes_are_named(tmp_path: Path, capsys: pytest.CaptureFixture, override: str, words: list[str]) -> None:
    file = scene_file(tmp_path)
    assert main(["drag", "--scene", str(file), "--out", str(tmp_path), "--levels", "8,16", "--set", override]) == 2
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    for word in (str(file), *words):
        assert word in message


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--levels", "8"], ["--levels 8", "name two"]),
        (["--levels", "8,10"], ["--levels 10", "multiple of 4"]),
        (["--levels", "8,16", "--stored"], ["--stored", "nothing for a solids fraction"]),
        (["--levels", "8,16", "--stored", "nowhere.json"], ["nowhere.json", "no such file"]),
        (["--levels", "8,16", "--transient", "--end", "-1"], ["--end", "above 0"]),
        (["--levels", "8,x"], ["--levels 8,x", "whole numbers"]),
        (["--levels", "8,16", "--jobs", "0"], ["--jobs 0", "1"]),
    ],
)
def test_bad_options_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture, options: list[str], words: list[str]
) -> None:
    assert main(["drag", "--scene", str(scene_file(tmp_path)), "--out", str(tmp_path), *options]) == 2
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    for word in words:
        assert word in message


def test_bodies_that_no_cut_passes_are_named(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    file = scene_file(tmp_path)
    places = "body.0.positions=[[0.4,0.5],[1.0,1.4],[1.6,0.5]]"
    sets = ["--set", places, "--set", "body.0.radius=0.39"]  # at 0.4 they would touch
    assert main(["bodies", "--scene", str(file), "--out", str(tmp_path), "--levels", "16,32", *sets]) == 2
    assert capsys.readouterr().err.startswith(f"{file}: body.0.positions: every cut")


def test_a_scene_that_is_not_there_is_named(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    assert main(["drag", "--scene", "no.toml", "--out", str(tmp_path), "--levels", "8,16"]) == 2
    assert capsys.readouterr().err == "no.toml: no such file; give a scene\n"


def test_cuts_pass_between_bodies() -> None:
    rng = np.random.default_rng(3)
    radius, found = 0.05, 0
    for _ in range(20):
        positions = rng.uniform(0, 1, (4, 2))
        shift, clearance = clear_cuts(positions, radius)
        moved = (positions + shift) % 1.0
        assert min(moved.min(), 1 - moved.max()) - radius == pytest.approx(clearance)
        found += clearance > 0
    assert found > 10


def test_the_input_of_gmsh_keeps_discs_apart() -> None:
    text = geometry(np.array([[0.3, 0.3], [0.7, 0.7]]), 0.1, 8)
    assert text.count("Circle(") == 8 and "Plane Surface(1) = {1, 10, 20};" in text
    assert 'Physical Surface("raw_body") = {' + ", ".join(f"out[{i}]" for i in range(6, 14)) + "};" in text


def test_a_period_and_a_mean_are_found_in_a_signal() -> None:
    time = np.linspace(0, 40, 8001)
    drag = 30 + 5 * np.exp(-time) + 2 * np.sin(4 * np.pi * time / 1.3)
    found = analyse(time, drag, 10 * np.sin(2 * np.pi * time / 1.3) + 0.4)
    assert found.period == pytest.approx(1.3, rel=1e-4)
    assert found.drag == pytest.approx(30, rel=1e-4)


def test_an_oscillation_that_dies_out_is_no_period() -> None:
    time = np.linspace(0, 40, 8001)
    found = analyse(time, np.full(8001, 30.0), np.exp(-time / 3) * np.sin(2 * np.pi * time))
    assert found.period is None and found.drag == 30.0 and found.drag_uncertainty == 0.0
    drifting = analyse(time, 30 + 0.1 * time, np.zeros(8001))
    assert drifting.drag_uncertainty == pytest.approx(0.5, rel=1e-2)


def test_the_time_step_obeys_both_limits() -> None:
    slow, fast = cell_of(2, 0.1, 1.0), cell_of(2, 0.1, 100.0)
    width = np.pi * slow.radius / 32
    assert transient_for(slow, 16, 10).step == pytest.approx(width**2 / slow.viscosity)
    assert transient_for(fast, 16, 10).step == pytest.approx(0.4 * width)


def test_logs_and_fields_are_read(tmp_path: Path) -> None:
    line = "Pressure gradient source: uncorrected Ubar = 1, pressure gradient = {}\n"
    steps = (f"Time = {i}\n" + line.format(0) + line.format(i * 2.5) for i in (1, 2))
    (tmp_path / "log.simpleFoam").write_text("".join(steps))
    assert gradients(tmp_path, "simpleFoam").tolist() == [2.5, 5.0]
    for name in ("0", "2", "10", "constant"):
        (tmp_path / name).mkdir()
    assert latest(tmp_path).name == "10"
    (tmp_path / "U").write_text("internalField nonuniform List<vector> \n2\n(\n(1 2 3)\n(4 5e-1 -6)\n)\n;\nboundary\n")
    assert vectors(tmp_path / "U").tolist() == [[1, 2, 3], [4, 0.5, -6]]


def test_scalars_are_read_as_openfoam_writes_them(tmp_path: Path) -> None:
    (tmp_path / "V").write_text("dimensions [0 3 0 0 0 0 0];\n\ninternalField   nonuniform List<scalar>\n3\n(\n1\n2.5e-1\n3\n)\n;\n\nboundaryField\n{\n}\n")
    assert scalars(tmp_path / "V").tolist() == [1, 0.25, 3]
    (tmp_path / "V").write_text("internalField   uniform 0.125;\n")
    assert scalars(tmp_path / "V", 2).tolist() == [0.125, 0.125]


STORED = sorted(FOLDER.glob("*.json"))


def test_there_are_stored_results() -> None:
    assert len(STORED) >= 13


@pytest.mark.parametrize("file", STORED, ids=lambda file: file.stem)
def test_a_stored_result_is_found_by_its_cell_alone(file: Path) -> None:
    stored = read_stored(file)
    cell = cell_of(stored.dimension, stored.solid, stored.reynolds)
    assert find_stored(cell, stored.transient, None) == stored
    assert not stored.fits(cell_of(stored.dimension, stored.solid * 1.0001, stored.reynolds), stored.transient)
    assert not stored.fits(cell_of(stored.dimension, stored.solid, stored.reynolds * 1.01 + 0.1), stored.transient)
    assert not stored.fits(cell, not stored.transient)
    assert [level.n for level in stored.levels] == sorted({level.n for level in stored.levels})
    assert stored.version and "reference.openfoam store" in stored.command
    assert all(len(level.checksum) == 64 for level in stored.levels)


def test_a_level_that_moved_is_told() -> None:
    stored = next(read_stored(file) for file in STORED if not json.loads(file.read_text())["transient"])
    level = stored.levels[0]
    assert disagreement(stored, level.n, level.value * (1 + 0.9e-4)) == ""
    assert f"N {level.n}" in disagreement(stored, level.n, level.value * (1 + 1.1e-4))
    assert disagreement(stored, 999, 0.0) == ""
