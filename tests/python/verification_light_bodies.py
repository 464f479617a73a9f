"""Free bodies lighter than the fluid that they drag along. Oracle: what rests is not thrown to and fro.

A disc or a sphere of radius 4 dx in a fluid with disorder, which gives it a push. Beyond the last stable step it is
thrown farther in each step.
"""

import re
from pathlib import Path

import numpy as np
import pytest

from verification.codes.mappm import Options, run
from verification.protocol.errors import SolverError

REACH, RADIUS = 3.0, 4.0  # dx
DENSITIES = (1.0, 0.1, 0.01, 0.001)  # of the body over that of the fluid


def scene(folder: Path, dimension: int, density: float, viscosity: float, rotates: bool) -> Path:
    """viscosity: nu / (c h)."""
    side = 20.0 if dimension == 2 else 14.0
    path = folder / "scene.toml"
    path.write_text(f"""
        name = "light"
        units = "dimensionless"
        box.size = {[side] * dimension}
        [fluid]
        density = 1.0
        spacing = 1.0
        rcut = {REACH}
        sound_speed = 1.0
        viscosity = {viscosity * REACH / 2!r}
        disorder = {{ amplitude = 0.2, seed = 1 }}
        [[body]]
        shape = "{'disc' if dimension == 2 else 'sphere'}"
        radius = {RADIUS}
        position = {[side / 2] * dimension}
        density = {density}
        rotates = {str(rotates).lower()}
        [run]
        steps = 400
        [output]
        sample = 5
    """)
    return path


def assert_calm(folder: Path, *of: float) -> None:
    finished = run(scene(folder, *of), folder / "out", Options())
    energy = np.array(finished.series["solid_energy"]) + np.array(finished.series["spin_energy"])
    quarter = len(energy) // 4
    assert energy[-quarter:].max() < 3 * energy[:quarter].max()


@pytest.mark.parametrize("viscosity", [0.02, 0.5])
@pytest.mark.parametrize("density", DENSITIES)
def test_a_light_disc_that_does_not_turn_is_calm(tmp_path: Path, density: float, viscosity: float) -> None:
    assert_calm(tmp_path, 2, density, viscosity, False)


def test_a_light_sphere_that_does_not_turn_is_calm(tmp_path: Path) -> None:
    assert_calm(tmp_path, 3, 0.01, 0.5, False)


@pytest.mark.parametrize("density", DENSITIES)
def test_a_light_disc_is_calm_where_viscosity_is_low(tmp_path: Path, density: float) -> None:
    assert_calm(tmp_path, 2, density, 0.02, True)


@pytest.mark.parametrize(("dimension", "density"), [(2, 0.1), (2, 0.01), (2, 0.001), (3, 0.01)])
def test_a_light_body_is_calm_where_viscosity_is_high(tmp_path: Path, dimension: int, density: float) -> None:
    assert_calm(tmp_path, dimension, density, 0.5, True)


@pytest.mark.parametrize("density", DENSITIES)
def test_a_step_beyond_the_last_is_refused(tmp_path: Path, density: float) -> None:
    """Without rotation: 2 M / (A a mu / h), or what waves allow."""
    with pytest.raises(SolverError, match="the last that") as caught:
        run(scene(tmp_path, 2, density, 0.5, False), tmp_path / "out", Options(overrides=("run.step=50.0",)))
    last = float(re.search(r"longer than (\S+), the last", str(caught.value))[1])
    measured = 2 * (density * RADIUS / 2) / 1.49  # at R / dx of 4 and 8: 1.46 to 1.53
    assert last < 1.2 * measured
    assert last > 0.8 * min(measured, 0.37 * REACH / 2)
