"""Steps beyond the last stable one are refused. Oracle: the first wave that grows, in any direction.

Theory: lattice_theory.py. The solver looks at the symmetric directions of two lattices alone, and cuts what it finds
to two decimals.
"""

import re
from pathlib import Path

import numpy as np
import pytest
from lattice_theory import KERNELS, Lattice, Law, first_instability

from verification.codes.mappm import Options, run
from verification.protocol.errors import SolverError

REACH = 3.0
LATTICES = {2: ("square", "hexagonal"), 3: ("cubic", "face-centred")}


def last_step(folder: Path, dimension: int, viscosity: float, *overrides: str, kernel: str = "wendland-c2") -> float:
    """The last c dt / h that a scene of 12 nodes a side may have, as the refusal of a longer one says."""
    scene = folder / "scene.toml"
    scene.write_text(f"""
        name = "limits"
        units = "dimensionless"
        box.size = {[12.0] * dimension}
        [fluid]
        density = 1.0
        spacing = 1.0
        rcut = {REACH}
        sound_speed = 1.0
        viscosity = {viscosity * REACH / 2!r}
        kernel = "{kernel}"
        [run]
        step = 20.0
        steps = 1
    """)
    with pytest.raises(SolverError, match="the last that") as caught:
        run(scene, folder / "out", Options(ranks=0, overrides=overrides))
    return float(re.search(r"longer than (\S+), the last", str(caught.value))[1]) / (REACH / 2)


def theory(dimension: int, kernel: str, viscosity: float, shift: float = 0.0) -> float:
    lattices = [Lattice(kind, REACH, kernel) for kind in LATTICES[dimension]]
    return first_instability(lattices, Law(1.0, viscosity, shift), 36 if dimension == 2 else 9)


@pytest.mark.parametrize("viscosity", [0.0, 0.01, 0.1, 0.5])
@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_the_last_step_is_that_of_the_first_wave_that_grows(
    tmp_path: Path, dimension: int, kernel: str, viscosity: float
) -> None:
    found = last_step(tmp_path, dimension, viscosity, "fluid.transport=false", kernel=kernel)
    # 0.01 of the cut, and in space what the few wave numbers along each axis pass over.
    assert found == pytest.approx(theory(dimension, kernel, viscosity), abs=0.012 if dimension == 2 else 0.03)


@pytest.mark.parametrize("rate", [0.25, 0.5, 0.9])
@pytest.mark.parametrize("kernel", KERNELS)
def test_the_shift_has_its_share_in_the_last_step(tmp_path: Path, kernel: str, rate: float) -> None:
    found = last_step(tmp_path, 2, 0.01, f"fluid.shift_rate={rate}", kernel=kernel)
    assert found == pytest.approx(theory(2, kernel, 0.01, rate), abs=0.012)


def friction_at_a_wall(kernel: str, largest: float) -> float:
    """Of a PP that touches a plane wall over that in the fluid, where the shortest waves set two PPs against each
    other: a pair of PPs counts twice, one with an FP once. FPs lie at depths of k + 1/2 spacings; their beta is
    1 + depth / distance, the distance being a quarter of a spacing at least."""
    gradient, most = KERNELS[kernel][2], int(REACH) + 1

    def row(height: float) -> float:
        q = np.hypot(height, np.arange(-most, most + 1)) / REACH
        return gradient(q[(q > 0) & (q < 1)]).sum()

    rows = [row(k) for k in range(most)]
    bulk = rows[0] + 2 * sum(rows[1:])
    wall = sum(min(1 + (k + 0.5) / 0.25, largest) * row(k + 0.5) for k in range(most))
    return (sum(rows) + 0.5 * wall) / bulk


def test_beta_at_a_wall_shortens_the_viscous_step(tmp_path: Path) -> None:
    wall = ('body=[{shape="wall",position=0.0,thickness=3.0}]', "fluid.transport=false", "fluid.no_slip=extrapolated")
    for largest in (2.0, 4.0, 8.0):
        found = last_step(tmp_path, 2, 0.5, *wall, f"fluid.largest_no_slip={largest}")
        viscosity = 0.5 * friction_at_a_wall("wendland-c2", largest)
        assert found == pytest.approx(theory(2, "wendland-c2", viscosity), abs=0.012)
    assert found < 0.75 * theory(2, "wendland-c2", 0.5)
