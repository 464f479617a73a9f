"""Exact flows and what is measured of them. Oracles: calculus by differences, and fields written here."""

import math
from pathlib import Path

import h5py
import numpy as np
import pytest

from verification.measures import flows
from verification.measures.fits import damped_oscillation
from verification.measures.flows import Flow, read_flow
from verification.measures.observables import viscosity
from verification.protocol.run import Run
from verification.suite.manifest import find_case
from verification.suite.runner import measures_of

PLANE, SPACE = [1.0, 1.0], [1.0, 1.0, 1.0]
WAVE = {"wave": {"amplitude": 0.5, "direction": "z", "gradient": "x", "mode": 3}}


@pytest.mark.parametrize(
    ("table", "size"),
    [(WAVE, [1.0, 0.25, 0.25]), ({"vortices": {"amplitude": 0.5}}, PLANE), ({"vortices": {"amplitude": 0.5}}, SPACE),
     ({"abc": {"amplitude": 0.5, "mode": 2}}, SPACE)],
    ids=["wave", "vortices-plane", "vortices-space", "abc"],
)
def test_a_flow_is_solenoidal_and_an_eigenfunction_of_the_laplacian(table: dict, size: list[float]) -> None:
    flow, h = read_flow(table, size), 1e-3
    points = np.zeros((50, 3))
    points[:, : len(size)] = np.random.default_rng(1).uniform(size=(50, len(size)))
    laplacian, divergence = np.zeros((50, 3)), np.zeros(50)
    for axis in range(len(size)):
        beyond, before = flow.shape(points + h * np.eye(3)[axis]), flow.shape(points - h * np.eye(3)[axis])
        laplacian += (beyond - 2 * flow.shape(points) + before) / h**2
        divergence += (beyond - before)[:, axis] / (2 * h)
    assert np.abs(divergence).max() < 1e-10  # differences of sines of one wave number cancel as the derivatives do
    # The error of the second difference is k^2 h^2 / 12, at most 3e-5 for mode 3.
    assert laplacian == pytest.approx(-flow.eigenvalue * flow.shape(points), rel=1e-4, abs=1e-4)


def test_vorticity_of_the_abc_flow_is_parallel_to_it() -> None:
    flow, h = read_flow({"abc": {"amplitude": 1.0}}, SPACE), 1e-4
    points = np.random.default_rng(2).uniform(size=(20, 3))
    x, y, z = ((flow.shape(points + h * e) - flow.shape(points - h * e)) / (2 * h) for e in np.eye(3))  # du/dx ...
    curl = np.column_stack([y[:, 2] - z[:, 1], z[:, 0] - x[:, 2], x[:, 1] - y[:, 0]])
    assert curl == pytest.approx(2 * math.pi * flow.shape(points), rel=1e-5, abs=1e-5)




def written(folder: Path, scene: dict, times: np.ndarray, velocity) -> Run:
    """velocity(points, t) of 400 points, the same at all times."""
    (folder / "snapshots").mkdir()
    size = scene["box"]["size"]
    points = np.zeros((400, 3))
    points[:, : len(size)] = np.random.default_rng(3).uniform(size=(400, len(size))) * size
    for i, time in enumerate(times):
        with h5py.File(folder / f"snapshots/fluid_{i:09}.vtkhdf", "w") as file:
            group = file.create_group("VTKHDF")
            group["Points"] = points
            group["PointData/velocity"] = velocity(points, time)
            group["PointData/kind"] = np.zeros(400, dtype=np.uint8)
            group["FieldData/TimeValue"] = np.array([time])
    run = Run(folder)
    run.__dict__["scene"] = scene  # what the cached property would have read
    return run


def scene_of(table: dict, size: list[float], **fluid) -> dict:
    return {"box": {"size": size}, "fluid": {"density": 2.0, "viscosity": 0.02, "sound_speed": 10.0} | table | fluid}


def test_viscosity_is_found_in_a_stream_and_under_noise(tmp_path: Path) -> None:
    table = {"vortices": {"amplitude": 0.5}}
    flow, stream = read_flow(table, PLANE), np.array([0.7, -0.4, 0.0])
    noise = np.random.default_rng(4).normal(scale=0.002, size=(400, 3))

    def velocity(points: np.ndarray, time: float) -> np.ndarray:
        decay = np.exp(-1.1 * 0.01 * flow.eigenvalue * time)  # ten per cent above the declared 0.02 / 2.0
        return stream + decay * flow.amplitude * flow.shape(points - stream * time) + noise

    run = written(tmp_path, scene_of(table, PLANE, velocity=[0.7, -0.4]), np.linspace(0.0, 1.5, 16), velocity)
    assert viscosity(run).value == pytest.approx(1.1, abs=2e-3)  # noise of 0.4 % of U, over 400 points


def test_too_few_snapshots_are_no_measurement(tmp_path: Path) -> None:
    table = {"vortices": {"amplitude": 0.5}}
    flow = read_flow(table, PLANE)
    run = written(tmp_path, scene_of(table, PLANE), np.array([0.0, 1.0]), lambda points, time: flow.shape(points))
    assert "fewer than five snapshots" in viscosity(run).objection


def test_field_error_leaves_out_the_sound_of_the_start_only(tmp_path: Path) -> None:
    table = {"vortices": {"amplitude": 1.0}}
    flow = read_flow(table, PLANE)
    rate = 0.01 * flow.eigenvalue
    quarter = np.log(2.0) / rate

    def velocity(points: np.ndarray, time: float) -> np.ndarray:
        sound, other = np.zeros((2, *points.shape))
        sound[:, 0] = 0.1 * np.sin(4 * np.pi * points[:, 0])
        other[:, 0] = 0.01 * np.sin(2 * np.pi * points[:, 1])
        return np.exp(-rate * time) * flow.shape(points) + sound + other

    run = written(tmp_path, scene_of(table, PLANE), np.array([0.0, quarter]), velocity)
    # rms 0.01 / sqrt 2 beside an exact rms of 0.5 / sqrt 2: 2 %, to the sampling error of 400 points.
    assert measures_of(find_case("taylor_green").file.parent)["field_error"](run).value == pytest.approx(0.02, rel=0.15)


def test_a_damped_oscillation_is_found_under_noise() -> None:
    time = np.linspace(0.0, 15.0, 50)
    signal = np.exp(-0.04 * time) * np.cos(1.25 * time + 0.3)
    exact = damped_oscillation(time, signal)
    assert exact.frequency == pytest.approx(1.25, rel=1e-10)
    assert exact.damping == pytest.approx(0.04, rel=1e-8)
    noisy = damped_oscillation(time, signal + np.random.default_rng(5).normal(scale=0.01, size=50))
    assert abs(noisy.frequency - 1.25) < 4 * noisy.frequency_error
    assert abs(noisy.damping - 0.04) < 4 * noisy.damping_error
    assert 1e-5 < noisy.frequency_error < 1e-3
    assert damped_oscillation(time, np.exp(-time)) is None


def test_sound_of_an_exact_wave(tmp_path: Path) -> None:
    table = {"wave": {"amplitude": 1e-3, "direction": "x", "gradient": "x"}}
    flow = read_flow(table, PLANE)
    undamped, damping = 0.99 * 10.0 * 2 * np.pi, 1.2 * 0.5 * 0.01 * flow.eigenvalue
    frequency = math.sqrt(undamped**2 - damping**2)

    def velocity(points: np.ndarray, time: float) -> np.ndarray:
        return np.exp(-damping * time) * np.cos(frequency * time) * flow.amplitude * flow.shape(points)

    run = written(tmp_path, scene_of(table, PLANE), np.linspace(0.0, 0.4, 60), velocity)
    known = measures_of(find_case("sound_wave").file.parent)
    assert known["sound_speed"](run).value == pytest.approx(0.99, rel=1e-6)
    assert known["sound_damping"](run).value == pytest.approx(1.2, rel=1e-4)


def test_the_force_of_the_manufactured_case_balances_friction() -> None:
    scene = find_case("manufactured").scene
    flow: Flow = read_flow(scene["fluid"], scene["box"]["size"])
    held = scene["fluid"]["viscosity"] / scene["fluid"]["density"] * flow.eigenvalue * flow.amplitude
    assert scene["force"]["vortices"]["amplitude"] == pytest.approx(held, rel=1e-12)
    assert flows.read_flow(scene["force"], scene["box"]["size"]).kind == flow.kind
