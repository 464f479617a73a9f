"""A solid whose periodic images are in reach of its FPs. Oracle: the same lattice of discs with a box of 2 x 2 cells.

There each disc is a solid of its own, and sees the others as such.
"""

from pathlib import Path

import numpy as np
import pytest

from verification.codes.mappm import Options, run
from verification.protocol.run import Run

CELL = (18.0, 12.0)  # two processes share it along x
RADIUS = (80 / np.pi) ** 0.5  # of an area of 80 PPs, whole shells of the lattice; 1.9 dx lie between images along y
# dx = 1, c = 1. Viscosity and force make a flow of .01 c about.
SCENE = """
    name = "own_image"
    units = "dimensionless"
    box.size = {sides}
    [fluid]
    density = 1.0
    spacing = 1.0
    rcut = 3.0
    sound_speed = 1.0
    viscosity = 0.2
    [[body]]
    shape = "disc"
    radius = {radius!r}
    motion = "{motion}"
    positions = {centres}
    density = 2.0
    rotates = false
    [force]
    fluid = [2e-3, 5e-4]
    {balance}
    [contact]
    model = "none"
    [run]
    steps = {steps}
    [output]
    sample = 10
"""


def finished(folder: Path, cells: int, options: Options, motion: str = "fixed", steps: int = 100) -> Run:
    scene = folder / f"{cells}.toml"
    balance = 'solid = "balance"' if motion == "free" else ""
    sides = [cells * side for side in CELL]
    centres = [[(i + 0.5) * CELL[0], (j + 0.5) * CELL[1]] for j in range(cells) for i in range(cells)]
    scene.write_text(SCENE.format(sides=sides, radius=float(RADIUS), motion=motion, centres=centres, steps=steps,
                                  balance=balance))
    return run(scene, folder / f"out{cells}", options)


def columns(of: Run) -> np.ndarray:
    """Mean velocity of the fluid and drag on a disc, a row a sample."""
    names = ("fluid_velocity_x", "fluid_velocity_y", "drag_x", "drag_y")
    return np.array([of.series[name] for name in names]).T[1:]


@pytest.mark.parametrize("motion", ["fixed", "free"])
@pytest.mark.parametrize("ranks", [0, 1, 2])
def test_a_body_and_its_images_are_a_lattice_of_bodies(tmp_path: Path, ranks: int, motion: str) -> None:
    options = Options(ranks=ranks, domains="2x1" if ranks == 2 else None)
    one, four = (finished(tmp_path, cells, options, motion) for cells in (1, 2))
    assert four.record["frozen_particles"] == 4 * one.record["frozen_particles"]
    assert four.series["fluid_particles"][0] == 4 * one.series["fluid_particles"][0]
    a, b = columns(one), columns(four)
    off = np.abs(a - b).max(axis=0) / np.abs(a).max(axis=0)
    print(f"off by {off}")
    assert off.max() < 1e-9


def test_their_mean_flow_stays_the_same(tmp_path: Path) -> None:
    """When rounding has grown the PPs go other ways."""
    one, four = (finished(tmp_path, cells, Options(), steps=12000) for cells in (1, 2))
    a, b = (columns(of)[300:].mean(axis=0) for of in (one, four))
    print(f"mean velocity and drag {a} alone, {b} of four")
    assert a == pytest.approx(b, rel=5e-3)
