"""Contact scenes as numbers, what motions are measured by, and the equation of the overlap; no program is run."""

import copy
import math
from pathlib import Path

import numpy as np
import pytest

from reference.contact import granular
from reference.contact.collision import collision_of, hertz, linear
from reference.contact.motion import IMPACT, Motion, centre, fall_time, read_motion
from reference.contact.scene import contact_scene
from reference.liggghts import impact, sph
from reference.liggghts.__main__ import main
from reference.sph_peer import differences, last_state

SCENE = {
    "box": {"size": [4.0, 4.0, 8.0]},
    "fluid": {"particles": False},
    "body": [
        {"shape": "wall", "position": 0.0, "thickness": 1.0},
        {"shape": "sphere", "radius": "500 mm", "density": 2.0, "positions": [[2.0, 2.0, 1.6]], "velocity": [1.0, 0.0, -2.0]},
    ],
    "contact": {"model": "hertz", "young": "1 MPa", "poisson": 0.25, "restitution": 0.5, "friction": 0.3},
    "run": {"step": "1 ms", "duration": 0.1},
}


def changed(*path_and_value) -> dict:
    scene = copy.deepcopy(SCENE)
    *way, last, value = path_and_value
    table = scene
    for key in way:
        table = table.setdefault(key, {}) if isinstance(table, dict) else table[key]
    table[last] = value
    return scene


def motion(**parts) -> Motion:
    """Of the one sphere of SCENE that comes down, touches at t = 1 and is gone at t = 3."""
    time = np.arange(5.0)
    position = np.zeros((5, 1, 3))
    position[:, 0, 2] = [2.0, 1.5, 1.4, 1.5, 2.0]
    velocity = np.tile([1.0, 0.0, -2.0], (5, 1, 1))
    velocity[-1] = [0.4, 0.0, 1.0]
    spin = np.zeros((5, 1, 3))
    spin[-1] = [0.0, 3.0, 0.0]
    values = {"position": position, "velocity": velocity, "spin": spin, "force": None} | parts
    return Motion(contact_scene(SCENE), time, **values)


def test_a_scene_in_numbers() -> None:
    made = contact_scene(SCENE)
    assert made.bodies[0].radius == 0.5 and made.bodies[0].mass == pytest.approx(2 * math.pi / 6)
    assert [(face.axis, face.place, face.sign) for face in made.faces] == [(2, 1.0, 1), (2, 8.0, -1)]
    assert made.law.young == 1e6 and made.steps == 100 and made.step == 1e-3


@pytest.mark.parametrize(
    "scene, named",
    [
        (changed("fluid", "particles", True), "fluid.particles"),
        (changed("body", 1, "motion", "fixed"), "body.1.motion"),
        (changed("body", 1, "contact_radius", 0.4), "body.1.contact_radius"),
        (changed("body", 0, "velocity", None), ""),
        (changed("body", 1, "shape", "disc"), "body.1.shape"),
        (changed("contact", "model", "none"), "contact.model"),
        (changed("run", "relax", 5), "run.relax"),
        (changed("run", {"steps": 5}), "run.step"),
        (changed("force", {"solid": "balance"}), "force.solid"),
        (changed("contact", {"model": "hertz"}), "young"),
    ],
)
def test_what_is_not_supported_is_named(scene: dict, named: str) -> None:
    if not named:
        contact_scene(scene)  # a wall at rest may say so
        return
    with pytest.raises(ValueError, match=named.replace(".", r"\.")):
        contact_scene(scene)


def test_liggghts_takes_no_plane_friction_and_no_crowd() -> None:
    plane = changed("box", "size", [4.0, 8.0])
    plane["body"][0]["axis"] = "y"
    plane["body"][1] |= {"shape": "disc", "positions": [[2.0, 1.6]], "velocity": [1.0, -2.0]}
    with pytest.raises(ValueError, match=r"contact\.friction"):
        impact.read_scene_of(plane, "impact")
    with pytest.raises(ValueError, match="3 of them"):
        impact.read_scene_of(changed("body", 1, "positions", [[1.0, 1.0, 2.0], [1.0, 1.0, 4.0], [1.0, 1.0, 6.0]]), "impact")
    with pytest.raises(ValueError, match="nothing comes to rest"):
        impact.read_scene_of(SCENE, "rest")
    with pytest.raises(ValueError, match=r"contact\.restitution"):
        impact.read_scene_of(changed("contact", "restitution", 0.01), "impact")


def test_bad_scenes_are_one_line_with_the_file(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    file = tmp_path / "case.toml"
    file.write_text("[box]\nsize = [1.0, 1.0]\n")
    assert main(["impact", "--scene", str(file), "--out", str(tmp_path)]) == 2
    message = capsys.readouterr().err
    assert str(file) in message and "fluid" in message and message.count("\n") == 1
    assert main(["sph", "--side", "3", "--out", str(tmp_path)]) == 2


def test_the_script_has_law_step_start_and_walls() -> None:
    script = impact.script_of(contact_scene(changed("force", {"solid": [0.0, 0.0, -10.0]})))
    assert "youngsModulus peratomtype 1000000.0 1000000.0" in script
    assert "primitive type 2 zplane 1.0" in script and "primitive type 2 zplane 8.0" in script
    assert "boundary p p f" in script and "timestep 0.001" in script and "run 100" in script
    assert "vx 1.0 vy 0.0 vz -2.005" in script  # half a kick of gravity


def test_linear_dashpots_are_those_of_each_pair() -> None:
    """gamma = sqrt(4 m k / (1 + (pi / ln e)^2)): with a wall the mass is that of the sphere, else half of it."""
    law = {"model": "linear", "stiffness": 50.0, "restitution": 0.5}
    properties, model, _ = impact.law_of(contact_scene(changed("contact", law)))
    mass = 2 * math.pi / 6
    values = [float(x) for x in properties.split("gamman_abs peratomtypepair 2 ")[1].split("\n")[0].split()]
    full = math.sqrt(4 * mass * 50 / (1 + (math.pi / math.log(0.5)) ** 2))
    assert values[1] == pytest.approx(full) and values[0] == pytest.approx(full / math.sqrt(2))
    assert model.startswith("model hooke/stiffness")


def test_a_dump_becomes_a_table(tmp_path: Path) -> None:
    scene = contact_scene(SCENE)
    head = "ITEM: TIMESTEP\n{}\n" + "x\n" * 7
    (tmp_path / "dump").write_text(head.format(0) + "1 1 2 3 4 5 6 7 8 9 10 11 12\n" + head.format(7) + "1 0 0 0 0 0 0 0 0 0 0 0 0\n")
    granular.write_table(tmp_path / "dump", tmp_path / "table", scene)
    made = read_motion(tmp_path / "table", scene)
    assert made.time.tolist() == [0.0, 0.007]
    assert made.position[0, 0].tolist() == [1, 2, 3] and made.velocity[0, 0].tolist() == [4, 5, 6]
    assert made.spin[0, 0].tolist() == [7, 8, 9] and made.force[0, 0].tolist() == [10, 11, 12]


def test_measures_of_an_impact_on_a_wall() -> None:
    found = {name: measure(motion()) for name, measure in IMPACT.items()}
    assert found["restitution"] == 0.5 and found["normal_velocity"] == 1.0
    assert found["tangential_velocity"] == pytest.approx(0.4) and found["tangential_restitution"] == pytest.approx(0.4)
    assert found["spin"] == pytest.approx(3.0)  # rolls along x
    # the surface at the wall: 0.4 - 3 * 0.5 = -1.1 along x, 1 away
    assert found["rebound_angle"] == pytest.approx(math.degrees(math.atan2(-1.1, 1.0)))
    assert found["contact_time"] == pytest.approx(2.0)


def test_no_impact_is_not_a_number() -> None:
    high = np.full((5, 1, 3), 4.0)
    assert math.isnan(IMPACT["contact_time"](motion(position=high)))


def test_the_largest_force_is_of_the_parabola() -> None:
    force = np.zeros((5, 1, 3))
    force[:, 0, 2] = [0.0, 3.0, 3.75, 2.5, 0.0]
    a, b = np.polyfit([1, 2, 3], [3.0, 3.75, 2.5], 2)[:2]
    top = np.polyval(np.polyfit([1, 2, 3], [3.0, 3.75, 2.5], 2), -b / (2 * a))
    assert IMPACT["contact_force"](motion(force=force)) == pytest.approx(top)


def test_half_the_fall() -> None:
    scene = contact_scene(changed("force", {"solid": [0.0, 0.0, -1.0]}))
    fallen = Motion(scene, np.arange(5.0), motion().position, motion().velocity, motion().spin, None)
    fallen.position[:, 0, 2] = [2.0, 1.8, 1.2, 1.0, 1.0]
    assert centre(fallen)[0] == 2.0
    assert fall_time(fallen) == pytest.approx(1.5)


def test_hertz_without_loss_is_the_closed_form() -> None:
    """F = K d^(3/2), t = 2.9432752 d / v, d = (5 m v^2 / (4 K))^(2/5)."""
    overlap = (5 * 2.0 * 9.0 / (4 * 7.0)) ** 0.4
    found = hertz(2.0, 7.0, 1.0, 3.0)
    assert found.force == pytest.approx(7.0 * overlap**1.5, rel=1e-6)
    assert found.time == pytest.approx(2.9432752 * overlap / 3.0, rel=1e-6)


@pytest.mark.parametrize("restitution", [0.2, 0.5, 0.9])
def test_damped_collisions_return_what_they_are_given(restitution: float) -> None:
    """Antypov and Elliott 2011: the loss of the dashpot does not depend on speed, mass or stiffness."""
    assert hertz(2.0, 7.0, restitution, 3.0).restitution == pytest.approx(restitution, rel=1e-5)


@pytest.mark.parametrize("restitution", [0.1, 0.3, 0.9])
def test_the_linear_collision_solves_its_equation(restitution: float) -> None:
    """Against small steps of m d'' = -k d - c d'."""
    mass, stiffness, speed = 2.0, 7.0, 3.0
    damping = impact.damping_constant(restitution, mass, stiffness)
    d, v, t, step, largest = 0.0, speed, 0.0, 1e-5, 0.0
    while d >= 0.0:
        force = stiffness * d + damping * v
        largest = max(largest, force)
        middle = v - 0.5 * step * force / mass
        v -= step * (stiffness * (d + 0.5 * step * v) + damping * middle) / mass
        d, t = d + step * middle, t + step
    exact = linear(mass, stiffness, restitution, speed)
    assert exact.force == pytest.approx(largest, rel=1e-4) and exact.time == pytest.approx(t, rel=1e-4)
    assert -v / speed == pytest.approx(restitution, rel=1e-3)


def test_the_collision_of_a_scene_takes_masses_radii_and_approach() -> None:
    mass, young = 2 * math.pi / 6, 1e6 / (2 * (1 - 0.25**2))
    assert collision_of(contact_scene(SCENE)) == hertz(mass, 4 / 3 * young * math.sqrt(0.5), 0.5, 2.0)


def test_the_range_of_the_kernel_holds_its_neighbours() -> None:
    """39 and the particle itself in the disc of radius 2 h, 77 and itself in the ball."""
    assert math.pi * (2 * sph.Fluid(2, 64, 1).smoothing_length) ** 2 == pytest.approx(40)
    assert 4 / 3 * math.pi * (2 * sph.Fluid(3, 16, 1).smoothing_length) ** 3 == pytest.approx(78)


def test_states_are_compared_by_the_nodes_they_started_from(tmp_path: Path) -> None:
    fluid = sph.Fluid(2, 2, 1)
    block = "x\n" * 9
    nodes = [(0, 0), (1, 0), (0, 1), (1, 1)]

    def dump(order: list[int], move: float) -> Path:
        file = tmp_path / f"dump{order[0]}"
        first = "".join(f"{k + 1} {nodes[n][0]} {nodes[n][1]} 0 0 0 0\n" for k, n in enumerate(order))
        last = "".join(f"{k + 1} {nodes[n][0] + move * n} {nodes[n][1]} 0 {n} 0 0\n" for k, n in enumerate(order))
        file.write_text(block + first + block + last)
        return file

    one = last_state(dump([0, 1, 2, 3], 0.0), fluid)
    same = last_state(dump([3, 1, 0, 2], 0.0), fluid)
    other = last_state(dump([2, 1, 0, 3], 0.1), fluid)
    assert differences(one, same, 2) == (0.0, 0.0)
    assert differences(one, other, 2) == (pytest.approx(0.3), 0.0)
