"""LAMMPS as a code: its SPH styles on periodic flows and on flows between plane walls.

What differs from the solver: the density is summed at every step with the kernel (1 - q^2)^4, forces have Lucy's kernel, both of
the range `fluid.rcut`; pressure by Tait's law with exponent 7, about a density just below that of the lattice: the fluid starts
with a background pressure of twice rho U^2, U the fastest motion, or particles would clump where the pressure is negative;
friction of Morris, Fox and Zhu (1997), with the scene's dynamic viscosity; no particle is shifted. Particles of walls have the
velocity of their wall, not one extrapolated through it, and their density by the same sum. Time advances by velocity Verlet,
with a step that is safe by sound, friction and force. The cost is that of LAMMPS; what this adapter does itself is set-up.

    python3 -m verification.codes.lammps run --scene FILE --out DIR [--cores N] [--steps N] [--option background=B]

background: pressure of the lattice at the start in units of rho U^2, by default 2.
"""

import sys
import tempfile
import time
from pathlib import Path

from reference.lammps import flows
from reference.lammps.program import MISSING, SCRIPT, installed, version
from reference.particles import fastest_of, largest_step, leave_frames, particles_of, plan_of, read_particle_scene
from reference.scripted import Failed as FailedScript
from reference.scripted import frames_of
from verification.protocol.adapter import Adapter, BadInput, Failed, Left, Task, main
from verification.protocol.capability import FLUID, SPACE, WALLS
from verification.protocol.quantity import checksum_of

BACKGROUND = 2.0


def background_of(task: Task) -> float:
    """Throws BadInput."""
    text = task.option("background", str(BACKGROUND))
    try:
        return float(text)
    except ValueError:
        raise BadInput(f"--option background={text}: write a number") from None


class Lammps(Adapter):
    name = "lammps"
    capabilities = frozenset({FLUID, SPACE, WALLS})

    def version(self) -> str:
        return version()

    def missing(self) -> str:
        return "" if installed() else MISSING

    def run(self, task: Task) -> Left:
        began = time.process_time()
        scene = read_particle_scene(task.scene)
        particles = particles_of(scene)
        fastest = fastest_of(scene, particles)
        plan = plan_of(scene, largest_step(scene, 0.5 * scene.reach, fastest), task.steps)
        background = background_of(task) * scene.density * fastest**2
        with tempfile.TemporaryDirectory(prefix="lammps_") as name:
            folder = Path(name)
            try:
                flows.run(scene, particles, plan, background, folder, task.cores)
            except FailedScript as error:
                raise Failed(f"LAMMPS failed: {error}") from None
            frames = frames_of(folder / flows.DUMP, len(particles.points), scene.dimension, plan.step)
            leave_frames(task.out, scene, particles, frames)
            checksum = checksum_of([folder / SCRIPT, folder / flows.DATA], folder)
        more = {"inputs": checksum, "step": plan.step, "steps": plan.steps}
        return Left(setup_core_seconds=time.process_time() - began, more=more)


if __name__ == "__main__":
    sys.exit(main(Lammps()))
