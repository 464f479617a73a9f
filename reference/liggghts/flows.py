"""Periodic flows of a scene by the SPH styles of LIGGGHTS, which have artificial viscosity alone (see sph.py)."""

from pathlib import Path

from reference.liggghts.program import run_script
from reference.liggghts.sph import ALPHA
from reference.particles import Particles, ParticleScene, Plan
from reference.scripted import Finished

DUMP = "dump.txt"
SKIN = 0.3  # of the lists of neighbours, in spacings
START = "start.in"  # the particles, as commands
COLUMNS = "x y z vx vy vz"


def start_script(particles: Particles) -> str:
    """Creates the particles one by one and gives each its velocity."""
    dimension = particles.points.shape[1]
    zeros = [0.0] * (3 - dimension)
    lines = []
    for point in particles.points.tolist():
        x, y, z = point + zeros
        lines.append(f"create_atoms 1 single {x!r} {y!r} {z!r} units box")
    for n, velocity in enumerate(particles.velocity.tolist(), 1):
        lines.append(f"set atom {n} " + " ".join(f"v{axis} {value!r}" for axis, value in zip("xyz", velocity, strict=False)))
    return "\n".join(lines) + "\n"


def script_of(scene: ParticleScene, plan: Plan, background: float) -> str:
    """Reads START, writes DUMP. `background`: pressure at the density of the scene."""
    h, c, dimension = 0.5 * scene.reach, scene.sound_speed, scene.dimension
    kernel = "wendland2d" if dimension == 2 else "wendland"
    deep = f"{-0.5 * scene.spacing!r} {0.5 * scene.spacing!r}"
    corners = [f"0 {float(side)!r}" for side in scene.size] + [deep] * (3 - dimension)
    alpha = ALPHA[dimension] * scene.kinematic_viscosity / (c * h)
    rest = scene.density * (1 - background / (scene.density * c**2))
    return f"""units lj
atom_style sph
atom_modify map array
dimension {dimension}
boundary p p p
newton off
communicate single vel yes
region box block {" ".join(corners)} units box
create_box 1 box
include {START}
mass 1 {scene.mass!r}
set group all meso_rho {scene.density!r}
neighbor {SKIN * scene.spacing!r} bin
neigh_modify delay 0 every 1 check yes
fix sl all property/global sl peratomtype {h!r}
fix sound all property/global speedOfSound peratomtype {c!r}
fix alpha all property/global artViscAlpha peratomtype {alpha!r}
fix beta all property/global artViscBeta peratomtype 0.0
fix eta all property/global artViscEta scalar {0.01 * h**2!r}
pair_style sph/artVisc/tensCorr {kernel} {h!r} artVisc
pair_coeff * *
fix density all sph/density/continuity sphkernel {kernel}
fix pressure all sph/pressure Tait {rest * c**2 / 7!r} {rest!r} 7.
fix motion all nve/sph
timestep {plan.step!r}
dump frames all custom {plan.every} {DUMP} {COLUMNS}
dump_modify frames sort id format "{" ".join(["%.9g"] * 6)}"
thermo {plan.steps}
run {plan.steps}
"""


def run(scene: ParticleScene, particles: Particles, plan: Plan, background: float, folder: Path) -> Finished:
    """Leaves DUMP in the folder. One rank: on two these styles give other figures. Throws Failed."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / START).write_text(start_script(particles))
    return run_script(script_of(scene, plan, background), folder)
