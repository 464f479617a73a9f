"""OpenFOAM, run live on scenes as they stand. Oracles: exact solutions, and what second order makes of half the spacing."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from reference.exact_flows import exact_flow
from reference.openfoam.run import missing_of
from verification.codes.openfoam import OpenFoam
from verification.protocol.adapter import CANNOT, main
from verification.protocol.check import check_run
from verification.protocol.run import Run, read_time
from verification.protocol.scene import read_scene
from verification.protocol.toml_text import scene_text

lacking = missing_of(("blockMesh", "pimpleFoam"))
pytestmark = pytest.mark.skipif(bool(lacking), reason=lacking)
ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "verification" / "codes" / "scenes"


def scene_of(name: str, spacing: float, *sets: str) -> dict:
    return read_scene(SCENES / f"{name}.toml", [f"fluid.spacing={spacing}", *sets])


def run_scene(folder: Path, scene: dict, *options: str) -> Run:
    file, out = folder / "scene.toml", folder / "out"
    shutil.rmtree(out, ignore_errors=True)
    file.write_text(scene_text(scene))
    assert main(OpenFoam(), ["run", "--scene", str(file), "--out", str(out), *options]) == 0
    check_run(out, OpenFoam.capabilities)
    return Run(out)


def error_of(run: Run, which: int = -1) -> float:
    """Root-mean-square error of the velocity of a snapshot over that of the exact one."""
    fluid, time = run.fluid(which), read_time(run.snapshots()[which])
    exact = exact_flow(run.scene).velocity(fluid["points"], time)
    return float(np.linalg.norm(fluid["velocity"] - exact) / np.linalg.norm(exact))


# The bounds are about one and a half times the errors that were found.
def test_a_shear_wave_decays_with_second_order(tmp_path: Path) -> None:
    narrow = "box.size=[0.25, 1.0]"
    coarse, fine = (error_of(run_scene(tmp_path, scene_of("shear_wave", 1 / n, narrow))) for n in (16, 32))
    assert fine < 0.005 and 3.4 < coarse / fine < 4.6  # 4 for second order


def test_vortices_in_the_plane_decay(tmp_path: Path) -> None:
    coarse, fine = (error_of(run_scene(tmp_path, scene_of("taylor_green", 1 / n))) for n in (16, 32))
    assert fine < 0.006 and coarse / fine > 3.2


def test_a_force_drives_the_parabola(tmp_path: Path) -> None:
    """Settled, its error is g h^2 / (8 nu) in every cell: that of the velocity half a cell off the wall."""
    settled = "box.size=[0.25, 1.25]", "run.duration=20.0"
    coarse, fine = (error_of(run_scene(tmp_path, scene_of("poiseuille", 1 / n, *settled))) for n in (8, 16))
    assert fine == pytest.approx(1 / 16**2 * np.sqrt(15 / 8), rel=0.02)
    assert 3.6 < coarse / fine < 4.4


def test_a_wall_that_starts_to_move_drags_the_fluid(tmp_path: Path) -> None:
    short = ["fluid.spacing=0.0625", "box.size=[0.25, 1.5]", "run.duration=0.3"]
    scene = read_scene(ROOT / "cases/couette_start/case.toml", short)
    assert error_of(run_scene(tmp_path, scene), 7) < 5.5e-3  # nu t / H^2 = 0.0525


def test_a_mean_stream_carries_the_flow(tmp_path: Path) -> None:
    run = run_scene(tmp_path, scene_of("taylor_green", 1 / 16, "fluid.velocity=[1.0, 0.5]"))
    assert error_of(run) < 0.009
    for axis, mean in (("x", 1.0), ("y", 0.5)):
        assert run.series[f"fluid_velocity_{axis}"] == pytest.approx(mean, abs=1e-6)


def test_a_flow_in_space_decays_alike_along_each_axis(tmp_path: Path) -> None:
    """Of Arnold, Beltrami and Childress; a wrong order of the cells would mix the axes."""
    scene = scene_of("taylor_green", 1 / 12, "box.size=[1.0, 1.0, 1.0]")
    scene["fluid"]["abc"] = scene["fluid"].pop("vortices")
    run = run_scene(tmp_path, scene)
    assert error_of(run) < 0.019
    assert error_of(run, 0) == 0


def test_a_cavity_turns(tmp_path: Path) -> None:
    """Coarse, at Re 100: the lowest velocity on the vertical centre line is -0.214 (reference/cavity.py)."""
    scene = read_scene(ROOT / "cases/cavity/case.toml", ["fluid.spacing=0.0625", "run.duration=12.0"])
    fluid = run_scene(tmp_path, scene).fluid()
    points, velocity = fluid["points"], fluid["velocity"]
    assert points.shape == (256, 3) and points[:, :2].min() > 0 and points.max() < 1
    middle = np.abs(points[:, 0] - 0.5) < 0.04
    assert velocity[middle, 0].min() == pytest.approx(-0.214, abs=0.02)
    assert np.abs(velocity[:, 1].mean()) < 1e-3  # what goes up comes down


def test_what_a_run_leaves(tmp_path: Path) -> None:
    run = run_scene(tmp_path, scene_of("shear_wave", 1 / 16))
    cost = run.record["cost"]
    assert cost["core_seconds"] > 0 and cost["setup_core_seconds"] > 0
    assert len(run.snapshots()) == len(run.series["time"]) == 41
    energy = 0.25 * 0.01**2 * 0.5 * np.exp(-2 * 0.01 * (2 * np.pi) ** 2 * run.series["time"])  # of rho U^2 / 4 in 0.5 x 1
    assert run.series["fluid_energy"] == pytest.approx(energy, rel=0.04)
    short = run_scene(tmp_path, scene_of("shear_wave", 1 / 16), "--steps", "2")
    assert short.series["time"][-1] == pytest.approx(2 * run.record["step"])


@pytest.mark.parametrize("body, word", [
    ('shape = "disc"\nradius = 0.125\nposition = [0.25, 0.5]\ndensity = 1.0', "free-body"),
    ('shape = "disc"\nradius = 0.125\nposition = [0.25, 0.5]\nmotion = "fixed"', "disc"),
])
def test_a_scene_with_a_body_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture, body: str, word: str) -> None:
    file = tmp_path / "scene.toml"
    file.write_text((SCENES / "shear_wave.toml").read_text() + f"\n[[body]]\n{body}\n")
    assert main(OpenFoam(), ["run", "--scene", str(file), "--out", str(tmp_path / "out")]) == CANNOT
    assert word in capsys.readouterr().err.splitlines()[-1]
    assert not (tmp_path / "out" / "run.json").exists()
