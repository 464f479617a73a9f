"""LAMMPS, LIGGGHTS and PySPH as codes behind the protocol, run live on small flows. Oracles: the exact decay of a shear wave and of
the vortices of Taylor and Green, the parabola between plane walls, the force of Hertz' law in closed form. What is allowed is what was measured, by a third to a half more: at so coarse a spacing
waves decay by 5, 9 and 3 per cent too slowly in LAMMPS, LIGGGHTS and PySPH, vortices by 7, 1 and 5; LIGGGHTS' 1 is of two errors
of opposite sign. The parabola is missed by 19 and 1 per cent of its top."""

import math
from pathlib import Path

import numpy as np
import pytest

from verification.codes.lammps import Lammps
from verification.codes.liggghts import Liggghts
from verification.codes.openfoam import OpenFoam
from verification.codes.pysph import PySph
from verification.measures.observables import viscosity
from verification.protocol.adapter import CANNOT, Adapter, main
from verification.protocol.run import Run

WAVE = """[box]
size = [0.5, 1.0]
[fluid]
density = 2.0
viscosity = 0.02
spacing = 0.0625
rcut = 0.21875
sound_speed = 0.2
wave = { amplitude = 0.01, direction = "x", gradient = "y" }
[run]
duration = 2.9
"""
VORTICES = """[box]
size = [1.0, 1.0]
[fluid]
density = 1.0
viscosity = 0.1
spacing = 0.05
rcut = 0.2
sound_speed = 10.0
disorder = { amplitude = 0.1, seed = 1 }
vortices = { amplitude = 1.0 }
[run]
duration = 0.15
"""
CHANNEL = """[box]
size = [0.75, 1.25]
[fluid]
density = 1.0
viscosity = 0.05
spacing = 0.0625
rcut = 0.21875
sound_speed = 1.0
[[body]]
shape = "wall"
axis = "y"
position = 1.0
thickness = 0.25
[force]
fluid = [0.02, 0.0]
[run]
duration = 12.0
"""
IMPACT = """[box]
size = [0.06, 0.06, 0.06]
[fluid]
particles = false
density = 2800.0
spacing = 0.002
sound_speed = 1000.0
[[body]]
shape = "sphere"
radius = 0.01
density = 2800.0
positions = [[0.0199, 0.03, 0.03], [0.0401, 0.03, 0.03]]
velocity = [-10.0, 0.0, 0.0]
first_velocity = [10.0, 0.0, 0.0]
[contact]
model = "hertz"
young = 48e9
poisson = 0.2
[run]
step = 2e-8
duration = 8e-5
[output]
sample = 1
"""


def name_of(value: Adapter | float) -> str:
    return value.name if isinstance(value, Adapter) else "within"


def left_by(adapter: Adapter, scene: str, folder: Path, *options: str) -> Run:
    if lacking := adapter.missing():
        pytest.skip(lacking)
    file, out = folder / "scene.toml", folder / "out"
    file.write_text(scene)
    assert main(adapter, ["run", "--scene", str(file), "--out", str(out), *options]) == 0
    return Run(out)


@pytest.mark.parametrize("adapter, within", [(Lammps(), 0.06), (Liggghts(), 0.12), (PySph(), 0.035)], ids=name_of)
def test_a_shear_wave_decays_as_the_exact_one(tmp_path: Path, adapter: Adapter, within: float) -> None:
    run = left_by(adapter, WAVE, tmp_path)
    assert viscosity(run).value == pytest.approx(1, abs=within)
    energy = run.series["fluid_energy"]
    assert energy[0] == pytest.approx(2.0 * 0.5 * 0.01**2 / 4)  # density times area times half the mean square


@pytest.mark.parametrize("adapter, within", [(Lammps(), 0.09), (Liggghts(), 0.12), (PySph(), 0.065)], ids=name_of)
def test_vortices_decay_as_the_exact_ones(tmp_path: Path, adapter: Adapter, within: float) -> None:
    assert viscosity(left_by(adapter, VORTICES, tmp_path)).value == pytest.approx(1, abs=within)


@pytest.mark.parametrize("adapter, within", [(Lammps(), 0.25), (PySph(), 0.015)], ids=name_of)
def test_flow_between_walls_is_the_parabola(tmp_path: Path, adapter: Adapter, within: float) -> None:
    run = left_by(adapter, CHANNEL, tmp_path)
    fluid = run.fluid()
    y, largest = fluid["points"][:, 1], 0.02 / (8 * 0.05)
    assert len(y) == 12 * 16 and y.min() > 0 and y.max() < 1
    assert math.sqrt(np.mean((fluid["velocity"][:, 0] / largest - 4 * y * (1 - y)) ** 2)) < within


@pytest.mark.parametrize("adapter, within", [(Lammps(), 0.35), (PySph(), 0.05)], ids=name_of)
def test_a_moving_wall_carries_the_fluid(tmp_path: Path, adapter: Adapter, within: float) -> None:
    """Into a fluid at rest, by t: U sqrt(4 nu t / pi) on either side, until both layers meet. Measured: 26 and 2 per cent less."""
    moving = 'thickness = 0.25\nmotion = "moving"\nvelocity = [0.04, 0.0]'
    scene = CHANNEL.replace("thickness = 0.25", moving).replace("0.02, 0.0", "0.0, 0.0").replace("12.0", "0.4")
    run = left_by(adapter, scene, tmp_path)
    assert run.series["fluid_velocity_x"][-1] == pytest.approx(2 * 0.04 * math.sqrt(4 * 0.05 * 0.4 / math.pi), rel=within)


def test_liggghts_leaves_solids_and_the_force_of_hertz(tmp_path: Path) -> None:
    run = left_by(Liggghts(), IMPACT, tmp_path)
    assert run.record["quantities"]["contact_force"]["value"] == pytest.approx(10696.89, rel=1e-4)
    assert (run.folder / "solids.csv").read_text().startswith("step,time,id,position_x")


def test_liggghts_as_a_reference_carries_quantities_and_table(tmp_path: Path) -> None:
    given = [f"--option={pair}" for pair in ("problem=fall", "gamma=0.5", "force=2", "mass=3", "duration=30")]
    record = left_by(Liggghts(), CHANNEL, tmp_path, *given).record
    assert record["quantities"]["final_velocity"]["value"] == pytest.approx(4 * -math.expm1(-5), rel=1e-3)
    assert len(record["quantities"]["final_velocity"]["levels"]) == 2
    assert (tmp_path / "out" / record["table"]).exists() and len(record["inputs"]) == 64


def test_openfoam_as_a_reference_leaves_the_drag_and_a_snapshot(tmp_path: Path) -> None:
    scene = """[box]
size = [1.0, 1.0]
[fluid]
density = 1.0
viscosity = 1.0
spacing = 0.1
reference_velocity = 0.01
[[body]]
shape = "disc"
radius = 0.178412
motion = "fixed"
position = [0.5, 0.5]
[force]
fluid = [1.0, 0.0]
"""
    run = left_by(OpenFoam(), scene, tmp_path, "--option", "problem=drag", "--option", "levels=8,16")
    assert run.record["quantities"]["drag"]["value"] == pytest.approx(24.831675, rel=0.01)  # solids fraction 0.1, Stokes flow
    assert len(run.fluid()["points"]) > 100


def test_what_openfoam_cannot_run_is_told(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    if lacking := OpenFoam().missing():
        pytest.skip(lacking)
    free = '[[body]]\nshape = "disc"\nradius = 0.1\ndensity = 2.0\nposition = [0.5, 0.5]\n'
    (tmp_path / "scene.toml").write_text(VORTICES + free)
    assert main(OpenFoam(), ["run", "--scene", str(tmp_path / "scene.toml"), "--out", str(tmp_path / "out")]) == CANNOT
    assert "lacks free-body" in capsys.readouterr().err
