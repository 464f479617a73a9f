"""LAMMPS as a code: its SPH styles on periodic flows and on flows between plane walls, its granular styles on solids that touch.

Solids, in a scene with fluid.particles = false: the scene's step and start, and its contact law as near as the styles come to it
(reference/lammps/contacts.py); leaves solids.csv, and the measures of an impact, or of what comes to rest, as quantities.

Of the fluid, what differs from the solver: the density is summed at every step with the kernel (1 - q^2)^4, forces have Lucy's kernel, both of
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

from reference.contact import granular
from reference.lammps import contacts, flows
from reference.lammps.program import MISSING, SCRIPT, installed, version
from reference.particles import fastest_of, largest_step, leave_frames, particles_of, plan_of, read_particle_scene
from reference.scripted import Failed as FailedScript
from reference.scripted import frames_of
from verification.protocol.adapter import Adapter, BadInput, Cannot, Failed, Left, Task, main
from verification.protocol.capability import CONTACT, FLUID, FREE_BODY, SPACE, WALLS
from verification.protocol.quantity import checksum_of

BACKGROUND = 2.0


def background_of(task: Task) -> float:
    """Throws BadInput."""
    text = task.option("background", str(BACKGROUND))
    try:
        return float(text)
    except ValueError:
        raise BadInput(f"--option background={text}: write a number") from None


def solids(task: Task) -> Left:
    """Throws Cannot on what the contact law, the shapes or the styles do not know, or FailedScript."""
    try:
        scene = granular.read_scene_of(task.scene)
    except ValueError as error:
        raise Cannot(str(error)) from None
    motion = contacts.run(scene, task.out)
    (task.out / granular.TABLE).rename(task.out / granular.SOLIDS)
    quantities = granular.quantities_of(motion, granular.problem_of(scene), "same start and step")
    return Left(quantities, more={"inputs": checksum_of([task.out / SCRIPT], task.out), "step": scene.step, "steps": scene.steps})


def fluid(task: Task) -> Left:
    """Throws BadInput, Cannot or FailedScript."""
    began = time.process_time()
    scene = read_particle_scene(task.scene)
    particles = particles_of(scene)
    fastest = fastest_of(scene, particles)
    plan = plan_of(scene, largest_step(scene, 0.5 * scene.reach, fastest), task.steps)
    background = background_of(task) * scene.density * fastest**2
    with tempfile.TemporaryDirectory(prefix="lammps_") as name:
        folder = Path(name)
        flows.run(scene, particles, plan, background, folder, task.cores)
        frames = frames_of(folder / flows.DUMP, len(particles.points), scene.dimension, plan.step)
        leave_frames(task.out, scene, particles, frames)
        checksum = checksum_of([folder / SCRIPT, folder / flows.DATA], folder)
    return Left(setup_core_seconds=time.process_time() - began, more={"inputs": checksum, "step": plan.step, "steps": plan.steps})


class Lammps(Adapter):
    name, title = "lammps", "LAMMPS"
    capabilities = frozenset({FLUID, SPACE, WALLS, FREE_BODY, CONTACT})

    def version(self) -> str:
        return version()

    def missing(self) -> str:
        return "" if installed() else MISSING

    def run(self, task: Task) -> Left:
        try:
            return fluid(task) if task.scene["fluid"].get("particles", True) else solids(task)
        except FailedScript as error:
            raise Failed(f"LAMMPS failed: {error}") from None


if __name__ == "__main__":
    sys.exit(main(Lammps()))
