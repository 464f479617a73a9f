"""What is made for the peers and read from them; the peers themselves are not run here."""

import math
from pathlib import Path

import numpy as np
import pytest

from bench.codes import MAPPM, overrides_of
from reference.lammps import program
from reference.lammps.__main__ import main
from reference.lammps.sph import PEER as LAMMPS
from reference.lammps.sph import rest_density
from reference.liggghts.sph import PEER as LIGGGHTS
from reference.periodic_fluid import ABC, VORTICES, WAVE, Fluid, energies_of, loop_seconds, velocity_of
from reference.scripted import Failed
from reference.sph_peer import energies_script, state_script, timed_script
from verification.codes.mappm import Options
from verification.protocol.quantity import read_result

LOG = """LAMMPS (22 Jul 2025 - Update 4)
Loop time of 1e-07 on 1 procs for 0 steps with 4096 atoms
   Step         KinEng
         0   0.25
        10   2.4e-1
        20  -nan
Loop time of 0.5 on 1 procs for 20 steps with 4096 atoms
        20 neighbours
"""


def at(formula: str, x: float, y: float, z: float) -> float:
    return eval(formula, {"PI": math.pi, "sin": math.sin, "cos": math.cos, "sqrt": math.sqrt, "x": x, "y": y, "z": z})


@pytest.mark.parametrize("dimension, flow", [(2, WAVE), (3, WAVE), (2, VORTICES), (3, ABC)])
def test_flows_are_free_of_divergence_and_their_largest_velocity_is_one(dimension: int, flow: str) -> None:
    formulas = velocity_of(Fluid(dimension, 8, 1, flow=flow))
    places = np.array(np.meshgrid(*[np.arange(8) + 0.0] * 3)).reshape(3, -1).T
    speeds = [math.hypot(*(at(formula, *place) for formula in formulas)) for place in places]
    assert max(speeds) == pytest.approx(1, abs=1e-12)
    for place in places[::7]:
        steps = 1e-6 * np.eye(3)
        slopes = [at(f, *(place + d)) - at(f, *(place - d)) for f, d in zip(formulas, steps, strict=False)]
        assert sum(slopes) == pytest.approx(0, abs=1e-12)


def test_the_exact_decay_is_that_of_the_wave_number() -> None:
    """nu k^2, twice that for vortices of two equal wave numbers."""
    fluid = Fluid(2, 32, 1, viscosity=0.01)
    nu, k = fluid.dynamic_viscosity, 2 * math.pi / 32
    assert fluid.decay / fluid.time_unit == pytest.approx(nu * k**2)
    assert Fluid(2, 32, 1, flow=VORTICES, viscosity=0.01).decay == pytest.approx(2 * fluid.decay)


def test_the_table_is_read_and_a_run_that_blew_up_shows() -> None:
    rows = energies_of(LOG)
    assert rows[:2] == [(0, 0.25), (10, 0.24)]
    assert rows[2][0] == 20 and math.isnan(rows[2][1]) and len(rows) == 3


def test_the_time_is_that_of_the_last_run_and_of_all_particles() -> None:
    assert loop_seconds(LOG, Fluid(2, 64, 20)) == 0.5
    with pytest.raises(ValueError, match="no loop time for 100 particles"):
        loop_seconds(LOG, Fluid(2, 10, 20))


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_rest_density_of_lammps_is_near_the_true_one(dimension: int) -> None:
    """The sum of a normalised kernel over a lattice of masses 1 and spacing 1."""
    assert rest_density(Fluid(dimension, 10, 1)) == pytest.approx(1, abs=0.01)


@pytest.mark.parametrize("peer", [LAMMPS, LIGGGHTS])
def test_all_scripts_of_a_peer_carry_the_same_fluid(peer) -> None:
    fluid = Fluid(2, 32, 40, step=0.5, flow=VORTICES, viscosity=0.01, disorder=0.005)
    common = peer.fluid_script(fluid, 0.3)
    assert f"timestep {0.5 * fluid.smoothing_length / 20!r}\n" in common
    assert "displace_atoms all random 0.005 0.005 0.0 " in common
    for script in (state_script(peer, fluid, 0.3), timed_script(peer, fluid, 0.3), energies_script(peer, fluid, 10)):
        assert script.startswith(common) and script.endswith("run 40\n")
    assert "displace" not in peer.fluid_script(Fluid(2, 32, 40), 0.3)


def test_mappm_gets_the_same_fluid_and_the_step_in_seconds() -> None:
    fluid = Fluid(2, 32, 40, step=0.5, flow=VORTICES, viscosity=0.01, disorder=0.005)
    box, table, times, _ = overrides_of(fluid)
    assert box == "box.size=[32.0, 32.0]"
    assert f"viscosity={fluid.dynamic_viscosity!r}" in table and "vortices={amplitude=1.0}" in table
    assert "disorder={amplitude=0.005, seed=1}" in table
    assert times == f"run={{step={0.5 * fluid.smoothing_length / 20!r}, steps=40}}"
    assert MAPPM.more == () and Options(overrides=overrides_of(fluid)).overrides


def test_lammps_that_is_not_installed_is_missing_and_no_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(program, "PEERS", tmp_path)
    assert main(["sph", "--out", str(tmp_path)]) == 0
    result = read_result(tmp_path)
    assert result.missing == program.MISSING
    assert not result.quantities


def test_a_failure_of_lammps_is_told_in_its_words(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "lib" / "python3.11" / "site-packages" / "lammps" / "lmp"
    file.parent.mkdir(parents=True)
    file.write_text("#!/bin/sh\necho \"$LD_LIBRARY_PATH\" >told\necho 'ERROR: Lost atoms: original 4 current 3'\n")
    file.chmod(0o755)
    monkeypatch.setattr(program, "PEERS", tmp_path)
    with pytest.raises(Failed, match="Lost atoms"):
        program.run_script("run 0\n", tmp_path / "run")
    assert (tmp_path / "run" / "told").read_text().strip() == str(tmp_path / "lib")


def test_bad_input_is_one_line_that_names_it(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    assert main(["sph", "--side", "4", "--out", str(tmp_path)]) == 2
    message = capsys.readouterr().err
    assert "--side 4" in message and message.count("\n") == 1
