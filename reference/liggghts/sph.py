"""The SPH styles of LIGGGHTS on a periodic fluid: a peer for speed, and no reference, as it does not repeat itself.

A lattice of particles in a box that is periodic along all axes carries a shear wave; weakly compressible SPH with
artificial viscosity (Monaghan 1992), Wendland's kernel, 39 neighbours in the plane and 77 in space. Figures that do not
depend on the physics should be the same on one rank and on two, and with a thin and a thick list of neighbours: how far
they are not is measured.
"""

import argparse
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reference.live import Quantity, Result, checksum_of
from reference.liggghts.program import CODE, SCRIPT, run_script

DUMP = "dump.txt"
NEIGHBOURS = {2: 39, 3: 77}
SOUND_SPEED, AMPLITUDE = 20.0, 1.0
SKINS = (0.3, 0.6)  # in spacings
OBJECTION = "its SPH styles give other figures on two ranks than on one, and with another skin of the neighbour lists"


@dataclass(frozen=True)
class Fluid:
    """The spacing of the lattice, the density and the amplitude of the wave are 1."""

    dimension: int
    side: int  # particles along a side of the box
    steps: int

    @property
    def particles(self) -> int:
        return self.side**self.dimension

    @property
    def smoothing_length(self) -> float:
        """Half the range that holds so many neighbours and the particle itself."""
        held = NEIGHBOURS[self.dimension] + 1
        return 0.5 * (math.sqrt(held / math.pi) if self.dimension == 2 else (3 * held / (4 * math.pi)) ** (1 / 3))


def script_of(fluid: Fluid, skin: float) -> str:
    h, side = fluid.smoothing_length, fluid.side
    kernel = "wendland2d" if fluid.dimension == 2 else "wendland"
    depth = "-0.5 0.5" if fluid.dimension == 2 else f"0 {side}"
    return f"""units lj
atom_style sph
atom_modify map array
dimension {fluid.dimension}
boundary p p p
newton off
communicate single vel yes
lattice {"sq" if fluid.dimension == 2 else "sc"} 1.0
region box block 0 {side} 0 {side} {depth} units box
create_box 1 box
create_atoms 1 box
mass 1 1.0
set group all meso_rho 1.0
neighbor {skin!r} bin
neigh_modify delay 0 every 1 check yes
fix sl all property/global sl peratomtype {h!r}
fix sound all property/global speedOfSound peratomtype {SOUND_SPEED!r}
fix alpha all property/global artViscAlpha peratomtype 0.1
fix beta all property/global artViscBeta peratomtype 0.0
fix eta all property/global artViscEta scalar 0.01
pair_style sph/artVisc/tensCorr {kernel} {h!r} artVisc
pair_coeff * *
fix density all sph/density/continuity sphkernel {kernel}
fix pressure all sph/pressure Tait {SOUND_SPEED**2 / 7!r} 1.0 7.
variable wave atom "{AMPLITUDE!r}*sin(2*PI*y/{side})"
velocity all set v_wave 0 0 units box
fix motion all nve/sph
timestep {0.25 * h / SOUND_SPEED!r}
dump end all custom {fluid.steps} {DUMP} id x y z vx vy vz
dump_modify end sort id format "%d %.17g %.17g %.17g %.17g %.17g %.17g"
thermo {fluid.steps}
run {fluid.steps}
"""


def last_state(dump: Path, fluid: Fluid) -> tuple[np.ndarray, np.ndarray]:
    """(position, velocity) of the last snapshot, (n, 3), by the lattice nodes of the first: numbers depend on the ranks."""
    rows, block = dump.read_text().splitlines(), 9 + fluid.particles
    first, last = (np.array([row.split()[1:] for row in rows[start + 9 : start + block]], dtype=float)
                   for start in (0, len(rows) - block))
    nodes = np.round(first[:, :3]).astype(int) % fluid.side
    order = np.lexsort(nodes.T)
    return last[order, :3], last[order, 3:]


def differences(one: tuple[np.ndarray, np.ndarray], other: tuple[np.ndarray, np.ndarray], side: int) -> tuple[float, float]:
    """Largest of the positions, by the nearest image and in spacings, and of the velocities, over the amplitude."""
    apart = one[0] - other[0]
    apart -= side * np.round(apart / side)
    return float(np.max(np.abs(apart))), float(np.max(np.abs(one[1] - other[1]))) / AMPLITUDE


def run(fluid: Fluid, folder: Path, command: str) -> Result:
    """One rank, two ranks, and one rank with another skin. Throws Failed."""

    def once(ranks: int, skin: float) -> tuple[tuple[np.ndarray, np.ndarray], float, str]:
        finished = run_script(script_of(fluid, skin), folder, ranks)
        state = last_state(folder / DUMP, fluid)
        (folder / DUMP).unlink()
        return state, finished.core_seconds, finished.version

    other_skin, _, _ = once(1, SKINS[1])
    two_ranks, _, _ = once(2, SKINS[0])
    plain, seconds, version = once(1, SKINS[0])
    quantities = {"particle_steps_per_core_second": Quantity(fluid.particles * fluid.steps / seconds, 0.0,
                                                             note=f"{fluid.particles} particles, {fluid.steps} steps, one rank")}
    for name, state, how in (("ranks", two_ranks, "two ranks and one"),
                             ("skin", other_skin, f"skins of {SKINS[1]} and {SKINS[0]} spacings")):
        position, velocity = differences(plain, state, fluid.side)
        note = f"largest after {fluid.steps} steps between {how}"
        quantities[f"{name}_position"] = Quantity(position, 0.0, note=f"{note}, in spacings")
        quantities[f"{name}_velocity"] = Quantity(velocity, 0.0, note=f"{note}, over the amplitude of the wave")
    repeats = all(quantities[f"{name}_velocity"].value == 0 for name in ("ranks", "skin"))
    return Result(CODE, version, command, checksum_of([folder / SCRIPT], folder), quantities, "" if repeats else OBJECTION)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--dimension", type=int, default=2, choices=(2, 3), help="default 2")
    parser.add_argument("--side", type=int, default=64, metavar="N", help="particles along a side, at least 10; default 64")
    parser.add_argument("--steps", type=int, default=100, metavar="N", help="default 100")


def fluid_of(options: argparse.Namespace) -> Fluid:
    """Throws ValueError naming option, value and fix."""
    if options.side < 10:
        raise ValueError(f"--side {options.side}: must be at least 10, or the box is too small for the range of the kernel")
    if options.steps < 1:
        raise ValueError(f"--steps {options.steps}: must be at least 1")
    return Fluid(options.dimension, options.side, options.steps)
