"""Flows of a scene by the SPH styles of LAMMPS: periodic ones, and those between plane walls of particles.

The styles are those of sph.py: the density summed at every step under `sph/taitwater/morris`. Particles of a wall keep the
velocity of their wall, at rest or along itself: forces on them are set to zero, so that `fix sph` moves them with it.
"""

from pathlib import Path

import numpy as np

from reference.lammps.program import run_script
from reference.lammps.sph import lattice_density
from reference.particles import Particles, ParticleScene, Plan
from reference.scripted import Finished

DATA, DUMP = "particles.data", "dump.txt"
SKIN = 0.3  # of the lists of neighbours, in spacings
COLUMNS = "x y z vx vy vz"
LOWEST = 0.9  # rest density over that of the lattice


def _in_space(values: np.ndarray) -> np.ndarray:
    return np.column_stack([values, np.zeros((len(values), 3 - values.shape[1]))])


def write_data(file: Path, scene: ParticleScene, particles: Particles, density: float) -> None:
    """The particles as read_data wants them: the fluid is of type 1, walls of type 2."""
    corners = [(0.0, side) for side in scene.size] + [(-0.5 * scene.spacing, 0.5 * scene.spacing)] * (3 - scene.dimension)
    points, velocity = _in_space(particles.points), _in_space(particles.velocity)
    lines = ["particles", "", f"{len(points)} atoms", "2 atom types"]
    lines += [f"{float(low)!r} {float(high)!r} {axis}lo {axis}hi" for axis, (low, high) in zip("xyz", corners, strict=True)]
    lines += ["", "Masses", "", f"1 {scene.mass!r}", f"2 {scene.mass!r}", "", "Atoms # sph", ""]
    kinds = np.where(particles.fluid, 1, 2)
    lines += [f"{n} {kind} {density!r} 0.0 1.0 {x!r} {y!r} {z!r}" for n, (kind, (x, y, z)) in
              enumerate(zip(kinds.tolist(), points.tolist(), strict=True), 1)]
    lines += ["", "Velocities", "", *(f"{n} {u!r} {v!r} {w!r}" for n, (u, v, w) in enumerate(velocity.tolist(), 1))]
    file.write_text("\n".join(lines) + "\n")


def script_of(scene: ParticleScene, particles: Particles, plan: Plan, density: float, rest: float) -> str:
    """Reads DATA, writes DUMP; `rest` is the density at which the pressure is 0."""
    force = " ".join(repr(float(value)) for value in _in_space(scene.mass * scene.gravity[None, :])[0])
    driven = f"fix force fluid addforce {force}" if scene.gravity.any() else ""
    held = "" if particles.fluid.all() else "fix hold wall setforce 0.0 0.0 0.0"
    return f"""units lj
atom_style sph
dimension {scene.dimension}
boundary p p p
newton on
comm_modify vel yes
read_data {DATA}
group fluid type 1
group wall type 2
neighbor {SKIN * scene.spacing!r} bin
neigh_modify delay 0 every 1 check yes
pair_style hybrid/overlay sph/rhosum 1 sph/taitwater/morris
pair_coeff * * sph/rhosum {scene.reach!r}
pair_coeff * * sph/taitwater/morris {rest!r} {scene.sound_speed!r} {scene.viscosity!r} {scene.reach!r}
{driven}
{held}
fix motion all sph
timestep {plan.step!r}
run 0
dump frames all custom {plan.every} {DUMP} {COLUMNS}
dump_modify frames sort id format line "%.9g %.9g %.9g %.9g %.9g %.9g"
thermo {plan.steps}
run {plan.steps}
"""


def rest_density(scene: ParticleScene, density: float, background: float) -> float:
    """At which Tait's law gives 0 where the lattice, of that density, has the pressure `background`."""
    return density * max(1 - background / (scene.density * scene.sound_speed**2), LOWEST)


def run(scene: ParticleScene, particles: Particles, plan: Plan, background: float, folder: Path, ranks: int) -> Finished:
    """Leaves DUMP in the folder. Throws Failed."""
    density = lattice_density(scene.cell, scene.reach, scene.mass)
    rest = rest_density(scene, density, background)
    write_data(folder / DATA, scene, particles, density)
    return run_script(script_of(scene, particles, plan, density, rest), folder, ranks)
