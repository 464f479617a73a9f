"""Viscosity from the decay of a shear wave. Oracle: the exact solution exp(-2 nu k^2 t) of the kinetic energy."""

from pathlib import Path

import pytest

from support import assert_correct, judged


@pytest.mark.parametrize("direction", [("x", "y"), ("y", "x")])
def test_viscosity_in_the_plane(tmp_path: Path, direction: tuple[str, str]) -> None:
    flow, gradient = direction
    overrides = (f"fluid.wave.direction={flow}", f"fluid.wave.gradient={gradient}")
    _, outcomes = judged("shear_wave", tmp_path, *overrides)
    assert_correct(outcomes["viscosity"], goal=0.01)


def test_viscosity_in_space(tmp_path: Path) -> None:
    # The same wave on 48 nodes across; 12 along the others, above the two cutoffs that a box needs.
    overrides = ("box.size=[0.25,1.0,0.25]", "fluid.spacing=0.0208333333", "fluid.rcut=0.0625")
    _, outcomes = judged("shear_wave", tmp_path, *overrides)
    assert_correct(outcomes["viscosity"], goal=0.01)


def test_viscosity_of_the_plain_method(tmp_path: Path) -> None:
    _, outcomes = judged("shear_wave", tmp_path, "fluid.method=classic")
    assert_correct(outcomes["viscosity"], goal=0.01)
