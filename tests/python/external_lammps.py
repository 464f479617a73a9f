"""LAMMPS, run live: that the fluid it runs is the one it is compared on, and that it repeats itself."""

from dataclasses import replace
from pathlib import Path

import pytest

from bench.codes import Other
from bench.largest_step import flows_of, trial_of
from reference.lammps.__main__ import main
from reference.lammps.program import MISSING, installed
from reference.lammps.sph import PEER
from reference.periodic_fluid import Fluid
from reference.scripted import Failed
from verification.protocol.quantity import read_result

pytestmark = pytest.mark.skipif(not installed(), reason=MISSING)


@pytest.mark.parametrize("dimension, side", [(2, 32), (3, 12)])
def test_it_gives_the_same_on_two_ranks_and_with_another_skin_but_for_rounding(tmp_path: Path, dimension: int, side: int) -> None:
    assert main(["sph", "--dimension", str(dimension), "--side", str(side), "--steps", "50", "--out", str(tmp_path)]) == 0
    result = read_result(tmp_path)
    assert result.version.startswith("22 Jul 2025") and not result.objection
    for name in ("ranks_velocity", "skin_velocity"):
        assert result.quantities[name].value < 1e-10
    assert result.quantities["particle_steps_per_core_second"].value > 0


@pytest.mark.parametrize("dimension, side", [(2, 24), (3, 12)])
def test_its_flows_decay_as_the_exact_ones(tmp_path: Path, dimension: int, side: int) -> None:
    """Within the error of so coarse a lattice; a wrong unit of the viscosity, of the step or of the range is far beyond."""
    for fluid, end in flows_of(dimension, side):
        assert trial_of(Other("lammps", PEER), fluid, end, tmp_path)(0.5) == pytest.approx(1, abs=0.1)


def test_a_step_beyond_its_limit_fails(tmp_path: Path) -> None:
    wave = replace(flows_of(2, 16)[0][0], step=3.0, steps=100)
    with pytest.raises(Failed, match="Lost atoms|Non-numeric"):
        Other("lammps", PEER).energies(wave, 1, tmp_path)


def test_the_speed_is_that_of_the_quickest_skin(tmp_path: Path) -> None:
    code, fluid = Other("lammps", PEER), Fluid(2, 32, 40, step=1.0, viscosity=0.01)
    assert code.speed(fluid, 1, tmp_path).rate > 0 and code.speed(fluid, 2, tmp_path).rate > 0
    assert f"neighbor {code.skins[fluid]!r} bin" in (tmp_path / "lammps" / "in.lammps").read_text()
