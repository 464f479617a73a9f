"""LIGGGHTS as a code: solids that touch; its SPH styles on periodic flows; and, by a `problem`, a reference.

    python3 -m verification.codes.liggghts run --scene FILE --out DIR
        [--option problem=impact|rest|fall|sph [--option KEY=VALUE]...]

Solids, in a scene with fluid.particles = false: the scene's contact law, step and start; leaves solids.csv, and the measures of
an impact, or of what comes to rest, as quantities.

The fluid is no peer for accuracy. Its only friction is Monaghan's artificial viscosity, between particles that come nearer. Its
alpha is 16 nu / (c h) in the plane and 20 in space, twice what all pairs would need, which is how that style comes nearest to a
viscosity nu; a shear wave then decays some 5 per cent too slowly, vortices some 10 too fast. Wendland's kernel of range
`fluid.rcut`, density by its rate, pressure by Tait's law with exponent 7 about a density just below that of the lattice, for a
background of twice rho U^2. One core always: on two these styles give other figures.
"""

import shlex
import sys
import tempfile
import time
from pathlib import Path

from reference.contact.granular import SOLIDS, problem_of
from reference.liggghts import __main__ as program
from reference.liggghts import flows, impact
from reference.liggghts.program import MISSING, SCRIPT, installed, version
from reference.particles import fastest_of, largest_step, leave_frames, particles_of, plan_of, read_particle_scene
from reference.roles import PROBLEM, arguments_of, left_of, parsed
from reference.scripted import Failed as FailedScript
from reference.scripted import frames_of
from verification.protocol.adapter import Adapter, BadInput, Cannot, Failed, Left, Task, main
from verification.protocol.capability import CONTACT, FLUID, FREE_BODY, SPACE, WALLS
from verification.protocol.quantity import checksum_of

PROBLEMS = ("impact", "rest", "fall", "sph")
BACKGROUND = 2.0  # in rho U^2
SHORTER = 0.2  # than the usual step: the pressure of a step is that of half a step before, and sound grows from some 0.05 h/c on


def reference(task: Task) -> Left:
    """Throws BadInput or FailedScript."""
    if task.option(PROBLEM) not in PROBLEMS:
        raise BadInput(f"--option {PROBLEM}={task.option(PROBLEM)}: unknown; take one of {', '.join(PROBLEMS)}")
    given = arguments_of(task)
    chosen = parsed(program.parser().parse_args, given)
    try:
        result = program.solve(chosen, shlex.join(["python3", "-m", "reference.liggghts", *given]))
    except ValueError as error:
        raise BadInput(str(error)) from None
    return left_of(result, task.out)


def solids(task: Task) -> Left:
    """Throws Cannot on what the contact law, the shapes or the styles do not know, or FailedScript."""
    try:
        scene = impact.read_scene_of(task.scene)
    except ValueError as error:
        raise Cannot(str(error)) from None
    result = impact.run(scene, task.out, "", problem_of(scene))
    (task.out / result.table).rename(task.out / SOLIDS)
    return Left(result.quantities, more={"inputs": result.inputs, "step": scene.step, "steps": scene.steps})


def fluid(task: Task) -> Left:
    """Throws BadInput, Cannot or FailedScript."""
    began = time.process_time()
    scene = read_particle_scene(task.scene)
    if scene.walls or scene.gravity.any():
        raise Cannot("the SPH styles of liggghts are run on periodic flows that nothing drives; leave out walls and force.fluid")
    particles = particles_of(scene)
    fastest = fastest_of(scene, particles)
    plan = plan_of(scene, SHORTER * largest_step(scene, 0.5 * scene.reach, fastest), task.steps)
    with tempfile.TemporaryDirectory(prefix="liggghts_") as name:
        folder = Path(name)
        flows.run(scene, particles, plan, BACKGROUND * scene.density * fastest**2, folder)
        frames = frames_of(folder / flows.DUMP, len(particles.points), scene.dimension, plan.step)
        leave_frames(task.out, scene, particles, frames)
        checksum = checksum_of([folder / SCRIPT, folder / flows.START], folder)
    return Left(setup_core_seconds=time.process_time() - began, more={"inputs": checksum, "step": plan.step, "steps": plan.steps})


class Liggghts(Adapter):
    name, title = "liggghts", "LIGGGHTS"
    capabilities = frozenset({FLUID, SPACE, WALLS, FREE_BODY, CONTACT})

    def version(self) -> str:
        return version()

    def missing(self) -> str:
        return "" if installed() else MISSING

    def run(self, task: Task) -> Left:
        try:
            if PROBLEM in task.options:
                return reference(task)
            return fluid(task) if task.scene["fluid"].get("particles", True) else solids(task)
        except FailedScript as error:
            raise Failed(f"LIGGGHTS failed: {error}") from None


if __name__ == "__main__":
    sys.exit(main(Liggghts()))
