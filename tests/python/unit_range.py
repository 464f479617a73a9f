"""A value that leaves its range ends a run with exit code 3, and the message says which."""

from pathlib import Path

import pytest

from verification.codes.mappm import Options, run
from verification.protocol.errors import SolverError


@pytest.mark.parametrize("ranks", [0, 1])
def test_a_fluid_that_collapses_is_named(tmp_path: Path, ranks: int) -> None:
    """A force towards one plane: at rest ln(rho / rho_0) would be about 2 A / (k c^2) = 30 there."""
    scene = tmp_path / "scene.toml"
    scene.write_text("""
        name = "torn"
        units = "dimensionless"
        box.size = [24.0, 7.0]
        [fluid]
        density = 1.0
        spacing = 1.0
        rcut = 3.0
        sound_speed = 1.0
        viscosity = 0.5
        method = "classic"
        [force]
        wave = { amplitude = 4.0, direction = "x", gradient = "x" }
        [run]
        step = 0.1
        steps = 400
    """)
    with pytest.raises(SolverError, match=r"ended with 3[\s\S]*density 1[0-9.]+ times rest, outside 0\.1 to 10"):
        run(scene, tmp_path / "out", Options(ranks=ranks))
