"""What reference/openfoam/flows.py makes of a scene, without OpenFOAM. Oracles: geometry, and the rules of its page."""

import numpy as np
import pytest

from reference.openfoam.blocks import brick_mesh
from reference.openfoam.flow_case import FlowCase, write_flow_case
from reference.openfoam.flows import COURANT, FRICTION, case_of, largest_step
from reference.openfoam.read import vectors
from reference.openfoam.room import Room, room_of
from reference.particles import ParticleScene, read_particle_scene
from verification.protocol.adapter import Cannot
from verification.protocol.scene import set_value


def scene_of(**keys: object) -> ParticleScene:
    """Without a sound speed; further keys as body__0__position."""
    fluid = {"density": 2.0, "viscosity": 0.2, "spacing": 0.125}
    scene = {"box": {"size": [1.25, 1.5]}, "fluid": fluid, "run": {"duration": 1.0}}
    for key, value in keys.items():
        set_value(scene, key.replace("__", "."), value)
    return read_particle_scene(scene, sound=False)


def wall(axis: str, position: float, **more: object) -> dict:
    return {"shape": "wall", "axis": axis, "position": position, "thickness": 0.25} | more


LID = wall("y", 1.0, motion="moving", velocity=[0.5, 0.0])
CAVITY = [LID, wall("y", 1.25), wall("x", 1.0, extent={"axis": "y", "from": 0.0, "to": 1.0})]


def test_without_walls_the_room_is_the_box() -> None:
    room = room_of(scene_of())
    assert room.origin == pytest.approx([0, 0]) and room.size == pytest.approx([1.25, 1.5])
    assert list(room.cells) == [10, 12] and not room.walls


def test_a_channel_may_lie_over_the_end_of_the_box() -> None:
    """Above the wall at 0.5 to 0.75 up to the same wall, one box higher."""
    room = room_of(scene_of(body=[wall("y", 0.5, motion="moving", velocity=[0.5, 0.0])]))
    assert room.origin == pytest.approx([0, 0.75]) and room.size == pytest.approx([1.25, 1.25])
    assert list(room.cells) == [10, 10]
    assert [list(velocity) for velocity in room.walls[1]] == [[0.5, 0], [0.5, 0]]


def test_a_cavity_has_walls_on_all_sides() -> None:
    room = room_of(scene_of(body=CAVITY))
    assert room.origin == pytest.approx([0, 0]) and room.size == pytest.approx([1, 1]) and room.count == 64
    bottom, lid = room.walls[1]
    assert list(bottom) == [0, 0] and list(lid) == [0.5, 0]
    assert set(room.walls) == {0, 1}


def room_in_space(*extents: dict) -> ParticleScene:
    """A closed room of unit sides, whose walls along y are limited as given."""
    sides = [wall("z", 1.0), wall("x", 1.0, extent={"axis": "z", "from": 0.0, "to": 1.0}), wall("y", 1.0, extent=list(extents))]
    return scene_of(box__size=[1.25] * 3, body=sides)


def test_a_wall_may_be_limited_along_two_axes() -> None:
    room = room_of(room_in_space({"axis": "x", "from": 0.0, "to": 1.0}, {"axis": "z", "from": 0.0, "to": 1.0}))
    assert set(room.walls) == {0, 1, 2} and room.size == pytest.approx([1, 1, 1]) and room.count == 512
    with pytest.raises(Cannot, match="ends within the fluid"):
        room_of(room_in_space({"axis": "x", "from": 0.0, "to": 1.0}, {"axis": "z", "from": 0.0, "to": 0.9}))


@pytest.mark.parametrize("extent", [{"axis": "y", "from": 0.0, "to": 0.9}, {"axis": "y", "from": 0.1, "to": 1.0}])
def test_a_side_that_leaves_a_hole_is_refused(extent: dict) -> None:
    with pytest.raises(Cannot, match="ends within the fluid"):
        room_of(scene_of(body=[*CAVITY[:2], wall("x", 1.0, extent=extent)]))


def test_two_channels_are_refused() -> None:
    with pytest.raises(Cannot, match="2 channels"):
        room_of(scene_of(body=[wall("y", 0.0), wall("y", 0.75)]))


def test_sound_is_refused() -> None:
    with pytest.raises(Cannot, match="sound"):
        case_of(scene_of(fluid__wave={"amplitude": 1.0, "direction": "x", "gradient": "x"}), None)


def test_x_runs_first_over_the_cells() -> None:
    room = Room(np.zeros(3), np.array([2.0, 3.0, 4.0]), np.array([2, 3, 4]), {})
    assert room.centres()[:4].tolist() == [[0.5, 0.5, 0.5], [1.5, 0.5, 0.5], [0.5, 1.5, 0.5], [1.5, 1.5, 0.5]]
    assert room.centres()[-1].tolist() == [1.5, 2.5, 3.5]


def test_the_step_is_by_the_speed_or_by_friction() -> None:
    """nu = 0.1, h = 0.125: friction alone gives FRICTION h / (2 nu pi) in a channel of width 1."""
    channel = [LID | {"velocity": [0.1, 0.0]}, wall("y", 1.25)]
    slow = scene_of(body=channel)
    assert largest_step(slow, room_of(slow), np.zeros((1, 2))) == pytest.approx(FRICTION * 0.125 / (0.2 * np.pi))
    fast = scene_of(body=[LID | {"velocity": [50.0, 0.0]}, channel[1]])
    assert largest_step(fast, room_of(fast), np.zeros((1, 2))) == pytest.approx(COURANT * 0.125 / 50)
    driven = scene_of(body=channel, force={"fluid": [100.0, 0.0]})  # to g t = 100, less than g H^2 / (8 nu)
    assert largest_step(driven, room_of(driven), np.zeros((1, 2))) == pytest.approx(COURANT * 0.125 / (0.1 + 100))


def test_steps_meet_the_end_and_forty_times_before() -> None:
    case = case_of(scene_of(fluid__vortices={"amplitude": 1.0}), None)
    assert case.steps == 40 * case.every and case.steps * case.step == pytest.approx(1.0)


def test_a_mesh_between_walls_has_them_on_two_sides() -> None:
    mesh = brick_mesh((2.0, 1.0), (4, 3), {1})
    assert {name: patch.kind for name, patch in mesh.patches.items()} == {
        "x_low": "cyclic", "x_high": "cyclic", "y_low": "wall", "y_high": "wall", "front_and_back": "empty"}
    for name, axis, at in (("x_low", 0, 0.0), ("x_high", 0, 2.0), ("y_low", 1, 0.0), ("y_high", 1, 1.0)):
        assert all(mesh.vertices[i][axis] == at for i in mesh.patches[name].faces[0])
    assert mesh.number_of_cells == 12


def test_a_case_starts_as_the_scene(tmp_path) -> None:
    case: FlowCase = case_of(scene_of(fluid__vortices={"amplitude": 1.0}, force={"fluid": [0.0, 3.0]}), None)
    write_flow_case(tmp_path, case)
    assert vectors(tmp_path / "0/U")[:, :2] == pytest.approx(case.start)
    assert "U ((0 3 0) 0)" in (tmp_path / "constant/fvOptions").read_text()


def test_a_field_that_is_the_same_everywhere_is_read(tmp_path) -> None:
    (tmp_path / "U").write_text("dimensions [0 1 -1 0 0 0 0];\n\ninternalField   uniform (1 2 -3e-2);\n")
    assert vectors(tmp_path / "U", 2).tolist() == [[1, 2, -0.03]] * 2
