"""The spectral solution behind taylor_green_3d. Oracles: exact decays, its own refinement, the file that is stored."""

import hashlib
import importlib.util
import re

import numpy as np
import pytest

from verification.protocol.machine import ROOT
from verification.suite.manifest import find_case

spec = importlib.util.spec_from_file_location("taylor_green", ROOT / "reference/spectral/taylor_green.py")
spectral = importlib.util.module_from_spec(spec)
spec.loader.exec_module(spectral)

TIMES = np.linspace(0.0, 3.0, 7)
STORED = ROOT / "cases/taylor_green_3d/reference.csv"


def test_vortices_without_depth_decay_exactly() -> None:
    found = spectral.decay(spectral.vortices(12, plane=True), 10.0, TIMES, 4)
    assert found == pytest.approx(np.exp(-4 * TIMES / 10), rel=1e-12)


def test_slow_vortices_decay_as_the_linear_equation_says() -> None:
    # Convection changes the energy by a term of order Re^2 at a fixed nu t: here 1e-4 of what it is at Re 10.
    found = spectral.decay(spectral.vortices(12), 0.1, TIMES / 100, 4)
    assert found == pytest.approx(np.exp(-6 * TIMES / 100 / 0.1), rel=1e-4)


def test_without_friction_energy_is_conserved_while_it_cascades() -> None:
    found = spectral.decay(spectral.vortices(24), 1e9, np.linspace(0.0, 1.0, 3), 20)
    assert found == pytest.approx(1.0, abs=1e-6)  # until the smallest waves kept are reached


def test_the_stored_file_is_what_the_program_makes_at_half_the_resolution() -> None:
    time, energy = np.loadtxt(STORED, delimiter=",", skiprows=3).T
    found = spectral.decay(spectral.vortices(16), 10.0, time, 4)
    assert found == pytest.approx(energy, abs=1e-6)  # 16 points a side are good to 1e-7
    assert (np.diff(energy) < 0).all()


def test_the_stored_file_is_whole_and_belongs_to_the_scene() -> None:
    command, checksum, _, *rows = STORED.read_text().splitlines(keepends=True)
    assert hashlib.sha256("".join(rows).encode()).hexdigest() == checksum.split()[-1]
    scene = find_case("taylor_green_3d").scene
    fluid = scene["fluid"]
    k = 2 * np.pi / scene["box"]["size"][0]
    reynolds = fluid["vortices"]["amplitude"] * fluid["density"] / (fluid["viscosity"] * k)
    assert float(re.search(r"--reynolds (\S+)", command)[1]) == pytest.approx(reynolds, rel=1e-6)
