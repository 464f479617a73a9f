"""The SPH styles of LIGGGHTS on a periodic fluid: a peer for speed, and no reference, as it does not repeat itself.

A lattice of particles in a box that is periodic along all axes carries a shear wave; weakly compressible SPH with
artificial viscosity (Monaghan 1992), Wendland's kernel, 39 neighbours in the plane and 77 in space. Figures that do not
depend on the physics should be the same on one rank and on two, and with a thin and a thick list of neighbours: how far
they are not is measured.
"""

from pathlib import Path

from reference.liggghts.program import CODE, SCRIPT, run_script
from reference.periodic_fluid import Fluid, box_of, start_of
from reference.sph_peer import Peer, add_options, fluid_of, peer_result
from verification.protocol.quantity import Result

__all__ = ["PEER", "Fluid", "add_options", "fluid_of", "run"]

SKINS = (0.3, 0.6)  # in spacings
# Monaghan's artificial viscosity acts like nu = alpha c h / 8 in the plane and / 10 in space, here between particles that come
# nearer, half of the pairs.
ALPHA = {2: 16, 3: 20}  # times nu / (c h)
OBJECTION = "its SPH styles give other figures on two ranks than on one, and with another skin of the neighbour lists"


def fluid_script(fluid: Fluid, skin: float) -> str:
    """All but what is printed and written, and the run."""
    h, c = fluid.smoothing_length, fluid.sound_speed
    kernel = "wendland2d" if fluid.dimension == 2 else "wendland"
    return f"""units lj
atom_style sph
atom_modify map array
dimension {fluid.dimension}
boundary p p p
newton off
communicate single vel yes
{box_of(fluid)}
set group all meso_rho 1.0
neighbor {skin!r} bin
neigh_modify delay 0 every 1 check yes
fix sl all property/global sl peratomtype {h!r}
fix sound all property/global speedOfSound peratomtype {c!r}
fix alpha all property/global artViscAlpha peratomtype {ALPHA[fluid.dimension] * fluid.viscosity!r}
fix beta all property/global artViscBeta peratomtype 0.0
fix eta all property/global artViscEta scalar 0.01
pair_style sph/artVisc/tensCorr {kernel} {h!r} artVisc
pair_coeff * *
fix density all sph/density/continuity sphkernel {kernel}
fix pressure all sph/pressure Tait {c**2 / 7!r} 1.0 7.
{start_of(fluid)}
fix motion all nve/sph
timestep {fluid.step * fluid.time_unit!r}
"""


PEER = Peer(CODE, SCRIPT, SKINS, fluid_script, run_script, "format", OBJECTION)


def run(fluid: Fluid, folder: Path, command: str) -> Result:
    """One rank, two ranks, and one rank with another skin. Throws Failed."""
    return peer_result(PEER, fluid, folder, command)
