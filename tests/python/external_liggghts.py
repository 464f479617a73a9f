"""LIGGGHTS, run live: what it must meet before it may judge anything."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from reference.liggghts.__main__ import main
from reference.liggghts.program import MISSING, installed
from verification.protocol.quantity import Result, read_result

ROOT = Path(__file__).parents[2]

pytestmark = pytest.mark.skipif(not installed(), reason=MISSING)


def run(folder: Path, *arguments: str) -> Result:
    assert main([*arguments, "--out", str(folder)]) == 0
    return read_result(folder)


def test_a_linear_fall_meets_the_exact_motion(tmp_path: Path) -> None:
    """v = vt (1 - exp(-t/tau)), for the sphere of 1 mm and 2500 kg/m3 in a drag of 1.885e-4 kg/s."""
    mass, gamma = 2500 * math.pi / 6 * 1e-9, 1.8849556e-4
    result = run(tmp_path, "fall", "--mass", str(mass), "--gamma", str(gamma), "--force", str(9.81 * mass), "--duration", "0.05")
    time, velocity = np.loadtxt(tmp_path / result.table, delimiter=",", skiprows=1).T
    terminal, tau = 9.81 * mass / gamma, mass / gamma
    assert np.abs(velocity - terminal * (1 - np.exp(-time / tau))).max() < 2.5e-4 * terminal
    assert result.quantities["relaxation_time"].value == pytest.approx(tau, rel=2.5e-4)
    assert not result.objection


def test_a_quadratic_fall_meets_the_exact_motion(tmp_path: Path) -> None:
    """F = G v + B v^2 from rest: v = F tanh(s t) / (s M + G/2 tanh(s t)), s = sqrt(G^2/4 + B F) / M (Riccati)."""
    mass, force, gamma, quadratic = 3.0, 2.0, 0.5, 0.25
    result = run(tmp_path, "fall", "--mass", "3", "--gamma", "0.5", "--quadratic", "0.25", "--force", "2", "--duration", "20")
    time, velocity = np.loadtxt(tmp_path / result.table, delimiter=",", skiprows=1).T
    s = math.sqrt(gamma**2 / 4 + quadratic * force) / mass
    exact = force * np.tanh(s * time) / (s * mass + gamma / 2 * np.tanh(s * time))
    assert np.abs(velocity - exact).max() < 2.5e-4 * exact[-1]


def test_the_result_names_version_command_and_inputs(tmp_path: Path) -> None:
    run(tmp_path, "fall", "--mass", "1", "--gamma", "1", "--force", "1", "--duration", "0.5")
    result = json.loads((tmp_path / "result.json").read_text())
    assert result["version"].startswith("LIGGGHTS-PUBLIC 3.")
    assert "--gamma 1" in result["command"] and len(result["inputs"]) == 64
    assert "relaxation_time" not in result["quantities"]  # the fall ends before


def scene_of(name: str) -> str:
    return str(ROOT / "cases" / name / "case.toml")


@pytest.mark.parametrize("restitution", [0.5, 0.9])
def test_restitution_given_is_measured(tmp_path: Path, restitution: float) -> None:
    result = run(tmp_path, "impact", "--scene", scene_of("impact_normal"), "--set", f"contact.restitution={restitution}",
                 "--set", "run.step=2e-9", "--set", "output.sample=5")
    assert result.quantities["restitution"].value == pytest.approx(restitution, rel=1e-3)


def test_a_sliding_impact_obeys_coulomb(tmp_path: Path) -> None:
    """At 85 degrees the sphere slides throughout: v_t falls by mu (1 + e) v_n, and omega rises by 5/2 of that over R."""
    angle = math.radians(85)
    across, down = 3.9 * math.sin(angle), 3.9 * math.cos(angle)
    result = run(tmp_path, "impact", "--scene", scene_of("impact_oblique"), "--set", f"body.1.velocity=[{across}, 0.0, {-down}]")
    lost = 0.092 * 1.98 * down
    assert result.quantities["tangential_velocity"].value == pytest.approx(across - lost, rel=1e-3)
    assert result.quantities["spin"].value == pytest.approx(2.5 * lost / 0.0025, rel=0.01)


def test_a_stack_rests_on_its_weight(tmp_path: Path) -> None:
    """k d = 5 m g at the wall."""
    result = run(tmp_path, "rest", "--scene", scene_of("resting_stack"))
    assert result.quantities["lowest_overlap"].value == pytest.approx(5 * 4 / 3 * math.pi / 5000, rel=1e-6)


def test_its_sph_does_not_repeat_itself(tmp_path: Path) -> None:
    result = run(tmp_path, "sph", "--side", "24", "--steps", "20")
    assert result.quantities["ranks_velocity"].value > 0 and result.quantities["skin_velocity"].value > 0
    assert result.objection
