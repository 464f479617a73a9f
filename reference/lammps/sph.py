"""The SPH styles of LAMMPS on the periodic fluid, a peer for speed: `sph/rhosum` at every step under `sph/taitwater/morris`.

LAMMPS can also carry the density along by its rate of change, which saves the sum. But then the pressure of a step is that of half
a step before, sound grows, and the fluid of bench.speed stands no step beyond some .05 h/c; with the density summed it stands
thirty times that for twice the time of a step. One who wants flow time runs the sum.

The sum has the kernel (1 - q^2)^4 and the forces Lucy's, both of range 2 h. The reference density of Tait's law is the sum on the
lattice, so that the fluid starts without pressure. `fix sph` hands the velocities that the forces see across borders one
set-up late, so a run of no steps comes first: else the first step is wrong near borders, and another one on two ranks.
"""

import itertools
import math
from collections.abc import Sequence
from pathlib import Path

from reference.lammps.program import CODE, SCRIPT, run_script
from reference.periodic_fluid import Fluid, box_of, start_of
from reference.sph_peer import Peer, add_options, fluid_of, peer_result
from verification.protocol.quantity import Result

__all__ = ["PEER", "add_options", "fluid_of", "run"]

SKINS = (0.3, 0.6)  # in spacings
OBJECTION = "its SPH styles give other figures on two ranks than on one, or with another skin of the neighbour lists"


def lattice_density(cell: Sequence[float], reach: float, mass: float) -> float:
    """The sum over a lattice of cells (D) of one particle each."""
    dimension = len(cell)
    norm = 5 / math.pi if dimension == 2 else 3465 / (512 * math.pi)
    nodes = (range(-math.ceil(reach / side), math.ceil(reach / side) + 1) for side in cell)
    total = sum(max(0.0, 1 - sum((n * side) ** 2 for n, side in zip(node, cell, strict=True)) / reach**2) ** 4
                for node in itertools.product(*nodes))
    return float(mass * norm / reach**dimension * total)


def rest_density(fluid: Fluid) -> float:
    """The sum over the lattice of masses 1."""
    return lattice_density([1.0] * fluid.dimension, fluid.reach, 1.0)


def fluid_script(fluid: Fluid, skin: float) -> str:
    """All but what is printed and written, and the run."""
    density, reach = rest_density(fluid), fluid.reach
    return f"""units lj
atom_style sph
dimension {fluid.dimension}
boundary p p p
newton on
comm_modify vel yes
{box_of(fluid)}
set group all sph/rho {density!r}
neighbor {skin!r} bin
neigh_modify delay 0 every 1 check yes
pair_style hybrid/overlay sph/rhosum 1 sph/taitwater/morris
pair_coeff * * sph/rhosum {reach!r}
pair_coeff * * sph/taitwater/morris {density!r} {fluid.sound_speed!r} {fluid.dynamic_viscosity!r} {reach!r}
{start_of(fluid)}
fix motion all sph
timestep {fluid.step * fluid.time_unit!r}
run 0
"""


PEER = Peer(CODE, SCRIPT, SKINS, fluid_script, run_script, "format line", OBJECTION)


def run(fluid: Fluid, folder: Path, command: str) -> Result:
    """One rank, two ranks, and one rank with another skin. Throws Failed."""
    return peer_result(PEER, fluid, folder, command)
