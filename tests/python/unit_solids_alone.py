"""Without fluid the keys of [fluid] set units: they neither change the mass of a body nor make the set-up long.

Oracle: the closed form of two balls of radius and distance 1/2, volume 9 pi / 32.
"""

import math
import resource
import signal
import time
from pathlib import Path

import pytest

from verification.codes.mappm import Options, run, start

SCENES = Path(__file__).parent / "scenes"
BOUNCE = SCENES / "bounce.toml"
TWO_BALLS = "body.1.balls=[{centre=[0,0,0], radius=0.5}, {centre=[0.5,0,0], radius=0.5}]"
FLIGHT = (TWO_BALLS, "body.1.position=[2.0,2.0,2.0]", "run.steps=10", "output.sample=10")
RANGE = 3


def ended(scene: Path, folder: Path, options: Options) -> tuple[int, str]:
    process = start(scene, folder, options)
    _, stderr = process.communicate()
    return process.returncode, stderr


def processor_seconds() -> float:
    """Of all processes that were waited for."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


@pytest.mark.parametrize("ranks", [0, 1, 2])
@pytest.mark.parametrize("units", [(), ("fluid.spacing=0.003", "fluid.rcut=0.01"), ("fluid.spacing=1e-4", "fluid.rcut=0.3"),
                                   ("fluid.spacing=0.0851",), ("fluid.sound_speed=0.9",)])
def test_the_units_of_solids_alone_change_neither_mass_nor_time(tmp_path: Path, ranks: int, units: tuple[str, ...]) -> None:
    before = processor_seconds()
    finished = run(BOUNCE, tmp_path, Options(ranks=ranks, overrides=(*FLIGHT, *units)))
    assert processor_seconds() - before < 20  # 285, were a grid of the spacing laid over the body
    energy = float(finished.series["solid_energy"][-1])
    assert energy == pytest.approx(0.5 * 9 * math.pi / 32, rel=1e-7)


def test_a_solid_that_moves_far_in_a_step_names_the_length_that_limits_it(tmp_path: Path) -> None:
    code, stderr = ended(BOUNCE, tmp_path, Options(overrides=("fluid.rcut=0.0015", "run.step=0.001")))
    assert code == RANGE
    assert "rcut/4" in stderr
    assert "lower run.step, or raise fluid.rcut" in stderr


@pytest.mark.parametrize("ranks", [0, 1, 2])
def test_a_signal_ends_a_long_set_up_at_once_and_the_wait_is_explained(tmp_path: Path, ranks: int) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text("""
        name = "packing"
        units = "dimensionless"
        box.size = [1000.0, 1000.0]
        fluid = { particles = false, density = 1.0, spacing = 0.1, sound_speed = 1.0 }
        run = { step = 1.0, steps = 1 }
        [[body]]
        shape = "disc"
        radius = 0.5
        density = 1.0
        random = { count = 655000, seed = 1 }
    """)
    process = start(scene, tmp_path / "out", Options(ranks=ranks))
    said = iter(process.stderr.readline, "")  # MPI may have said something before
    assert any(line == "setting up: reading the scene (5 s)\n" for line in said)
    asked = time.monotonic()
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=60)
    assert time.monotonic() - asked < (1.0 if ranks < 2 else 5.0)  # mpirun takes its time
    assert process.returncode not in (0, None)
    assert not (tmp_path / "out").exists()
