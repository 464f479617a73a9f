"""PySPH as a code: its transport-velocity scheme (Adami, Hu and Adams 2013) on periodic flows and on flows between plane walls.

What differs from the solver: the quintic spline with h a third of `fluid.rcut`, so of the same range; the density is summed at
every step; pressure is c^2 (rho - rho0), the background pressure that moves the particles rho0 c^2, as in the examples of PySPH;
velocities of walls are extrapolated from the fluid, as by Adami, Hu and Adams (2012). Particles of walls stay where they are,
also of a wall that moves along itself. The step is 0.25 h / (c + U), or 0.125 h^2 / nu, or 0.25 sqrt(h / g). One thread.
PySPH compiles its loops before a run, which takes some 15 core-seconds the first time; that is set-up, as is what this adapter
does itself.

    python3 -m verification.codes.pysph run --scene FILE --out DIR [--steps N]
"""

import sys
import tempfile
import time
from pathlib import Path

from reference.particles import fastest_of, largest_step, leave_frames, particles_of, plan_of, read_particle_scene
from reference.pysph import program
from reference.scripted import Failed as FailedDriver
from verification.protocol.adapter import Adapter, Failed, Left, Task, main
from verification.protocol.capability import FLUID, SPACE, WALLS


class PySph(Adapter):
    name, title = "pysph", "PySPH"
    capabilities = frozenset({FLUID, SPACE, WALLS})

    def version(self) -> str:
        return program.version()

    def missing(self) -> str:
        return "" if program.version() else program.MISSING

    def run(self, task: Task) -> Left:
        began = time.process_time()
        scene = read_particle_scene(task.scene)
        particles = particles_of(scene)
        plan = plan_of(scene, largest_step(scene, scene.reach / program.RANGE, fastest_of(scene, particles)), task.steps)
        with tempfile.TemporaryDirectory(prefix="pysph_") as name:
            folder = Path(name)
            program.write_input(folder / program.INPUT, scene, particles, plan)
            try:
                found = program.run(folder)
            except FailedDriver as error:
                raise Failed(f"PySPH failed: {error}") from None
        leave_frames(task.out, scene, particles, zip(found["time"], found["points"], found["velocity"], strict=True))
        setup = float(found["setup_seconds"]) + time.process_time() - began
        return Left(setup_core_seconds=setup, more={"step": plan.step, "steps": plan.steps})


if __name__ == "__main__":
    sys.exit(main(PySph()))
