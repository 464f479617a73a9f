"""Fields of particles on a grid, and their pictures. Oracles: fields given by formulas, and the colours of written pictures."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from synthetic import Fields, Snapshot, scattered, synthetic_run

from verification.protocol.run import Run
from verification.report.fields import Window, near_middle, on_grid
from verification.report.pictures import flow_of, velocity_field
from verification.report.shapes import balls_of_scene, strips_of, window_of

SIDES = np.array([1.0, 0.5])
SPACING = 1 / 64
WHOLE = Window(np.zeros(2), SIDES)
CAVITY = """
[box]
size = [1.125, 1.25]
[fluid]
spacing = 0.02
[[body]]
shape = "wall"
axis = "y"
position = 1.0
thickness = 0.125
motion = "moving"
velocity = [1.0, 0.0]
[[body]]
shape = "wall"
axis = "y"
position = 1.125
thickness = 0.125
[[body]]
shape = "wall"
axis = "x"
position = 1.0
thickness = 0.125
extent = { axis = "y", from = 0.0, to = 1.0 }
"""
BOX = "[box]\nsize = [1.0, 0.5]\n[fluid]\nspacing = 0.015625\n"


def wave(points: np.ndarray) -> np.ndarray:
    """(n, 1), periodic, 32 spacings long."""
    return np.sin(4 * np.pi * points[:, :1]) + np.cos(4 * np.pi * points[:, 1:])


def field_of(values, points: np.ndarray, window: Window = WHOLE) -> tuple[np.ndarray, np.ndarray]:
    """(on the grid, exact), (rows, columns) each."""
    found = on_grid(points, values(points), window, SPACING)[0]
    x, y = window.nodes(found.shape)
    return found, values(np.column_stack([x.ravel(), y.ravel()])).reshape(found.shape)


def run_of(folder: Path, scene: str, points: np.ndarray, velocity: np.ndarray) -> Run:
    return synthetic_run(folder, Fields(scene, {"time": np.zeros(1), "fluid_velocity_x": np.zeros(1)},
                                        snapshots=(Snapshot(0.0, points, velocity),)))


def test_a_periodic_field_comes_out_of_disordered_particles() -> None:
    found, exact = field_of(wave, scattered(2048, (1.0, 0.5)))
    assert np.isfinite(found).all()
    assert np.sqrt(np.mean((found - exact) ** 2)) < 0.03  # of an amplitude of 1, with 32 spacings a wave
    for here, there in ((found[:, 0], found[:, -1]), (found[0], found[-1])):  # across the border as anywhere else
        assert np.abs(here - there).max() < 0.1


def test_a_field_that_grows_along_a_line_is_reproduced_away_from_the_border() -> None:
    found, exact = field_of(lambda points: points[:, :1] + 2 * points[:, 1:], scattered(2048, (1.0, 0.5)))
    inner = np.s_[20:-20, 20:-20]  # where it jumps from one period to the next lies outside
    assert np.abs(found - exact)[inner].max() < 0.5 * SPACING * np.sqrt(5)  # half a spacing along the gradient


def test_a_constant_is_reproduced_wherever_the_window_begins() -> None:
    for corner in ((0.0, 0.0), (-0.3, 0.2)):
        window = Window(np.array(corner), SIDES)
        found, _ = field_of(lambda points: np.full((len(points), 1), 3.0), scattered(2048, (1.0, 0.5)), window)
        assert found == pytest.approx(np.full(found.shape, 3.0))


def test_a_window_shows_what_lies_there() -> None:
    found, exact = field_of(wave, scattered(2048, (1.0, 0.5)), Window(np.array([-0.3, 0.2]), SIDES))
    assert np.sqrt(np.mean((found - exact) ** 2)) < 0.03


def test_where_no_particle_is_near_nothing_is_known() -> None:
    points = scattered(2048, (1.0, 0.5))
    found, _ = field_of(wave, points[np.abs(points[:, 0] - 0.5) > 0.2])
    columns = found.shape[1]
    assert np.isnan(found[:, columns // 2]).all() and np.isfinite(found[:, columns // 8]).all()


def test_many_particles_are_gathered_on_few_nodes() -> None:
    points = scattered(300_000, (1.0, 0.5))
    found = on_grid(points, wave(points), WHOLE, np.sqrt(0.5 / len(points)))[0]
    assert max(found.shape) <= 720 and np.isfinite(found).all()
    x, y = WHOLE.nodes(found.shape)
    assert np.abs(found - np.sin(4 * np.pi * x) - np.cos(4 * np.pi * y)).max() < 0.01


def test_particles_away_from_the_middle_plane_count_less() -> None:
    weights = near_middle(np.array([0.0, 0.5, -0.5, 1.5, -3.0]), 1.0)
    assert weights[0] == 1 and weights[1] == weights[2] == pytest.approx(8 / 9) and not weights[3:].any()


def test_walls_at_the_end_of_the_box_are_shown_on_both_sides(tmp_path: Path) -> None:
    scene = run_of(tmp_path, CAVITY, scattered(2500, (1.0, 1.0)), np.zeros((2500, 2))).scene
    assert window_of(scene) == pytest.approx([-0.0625, -0.125])
    assert [strip.velocity.any() for strip in strips_of(scene)] == [True, False, False]
    assert window_of({"box": {"size": [1.0, 1.0]}}) == pytest.approx([0.0, 0.0])


def test_distances_to_balls_reach_across_the_border() -> None:
    balls = balls_of_scene({"box": {"size": [2.0, 2.0]}, "body": [{"shape": "disc", "radius": 0.4, "position": [0.1, 1.0]}]})
    found = balls.distance(np.array([0.1, 1.9, 1.1]), np.array([1.0, 1.0, 1.0]))
    assert found == pytest.approx([-0.4, -0.2, 0.6])
    cut = balls_of_scene({"box": {"size": [2.0] * 3}, "body": [{"shape": "sphere", "radius": 0.5, "position": [1.0, 1.0, 1.3]}]})
    assert [radius for _, radius in cut.discs()] == pytest.approx([0.4])


def test_x_is_to_the_right_and_y_upward(tmp_path: Path, drawn: list) -> None:
    """The lid of the cavity is above, and what moves fast is bright there."""
    points = scattered(2500, (1.0, 1.0))
    run = run_of(tmp_path, CAVITY, points, np.column_stack([points[:, 1] ** 3, np.zeros(len(points))]))
    file = tmp_path / "field.png"
    velocity_field(run, file)
    axes = drawn[0].axes[0]
    assert axes.get_xlabel() == "x" and axes.get_ylabel() == "y" and axes.get_aspect() == 1.0
    (words,) = [text for text in axes.texts if "moves" in text.get_text()]
    assert words.get_position() == pytest.approx((0.5, 1.0625)) and words.get_text() == "wall moves at 1 \u2192"
    speed = axes.images[0].get_array()
    rows, columns = speed.shape
    at = [round((y + 0.125) / 1.25 * rows) for y in (0.2, 0.8)]
    assert speed[at[1], columns // 2] > 10 * speed[at[0], columns // 2]
    brightness = np.asarray(Image.open(file).convert("L"), dtype=float)
    high, wide = brightness.shape
    column = np.median(brightness[:, int(0.3 * wide) : int(0.5 * wide)], axis=1)
    assert column[int(0.2 * high)] > column[int(0.7 * high)] + 30  # of 255


def test_a_stream_is_taken_off_where_nothing_holds_the_frame(tmp_path: Path) -> None:
    points = scattered(2048, (1.0, 0.5))
    swirl = np.column_stack([np.sin(4 * np.pi * points[:, 1]), np.zeros(len(points))])
    swirl -= swirl.mean(axis=0)
    still, streaming = (flow_of(run_of(tmp_path / f"{stream}", BOX, points, swirl + [stream, 0.0])) for stream in (0, 5))
    assert not still.relative and streaming.relative
    assert streaming.speed == pytest.approx(still.speed, abs=1e-6)
    held = flow_of(run_of(tmp_path / "held", CAVITY, scattered(2500, (1.0, 1.0)), np.ones((2500, 2))))
    assert not held.relative


def test_a_fluid_at_rest_is_said_to_be(tmp_path: Path, drawn: list) -> None:
    points = scattered(2048, (1.0, 0.5))
    velocity_field(run_of(tmp_path, BOX, points, np.zeros_like(points)), tmp_path / "rest.png")
    axes = drawn[0].axes[0]
    assert "at rest" in axes.texts[0].get_text() and not axes.images
    assert (tmp_path / "rest.png").stat().st_size > 1000


def test_a_wall_that_is_limited_along_two_axes_is_as_long_as_they_say() -> None:
    """Of a tank in space, whose walls end at each other; a wall whose second limit misses the middle plane is not seen."""
    wall = {"shape": "wall", "axis": "y", "position": 0.8, "thickness": 0.2}
    limits = [{"axis": "x", "from": 0.0, "to": 0.5}, {"axis": "z", "from": 0.0, "to": 0.7}]
    (strip,) = strips_of({"box": {"size": [1.0, 1.0, 1.0]}, "body": [wall | {"extent": limits}]})
    assert (*strip.low, *strip.high) == pytest.approx((0.0, 0.8, 0.5, 1.0))
    above = [limits[0], {"axis": "z", "from": 0.6, "to": 0.7}]
    assert strips_of({"box": {"size": [1.0, 1.0, 1.0]}, "body": [wall | {"extent": above}]}) == []
