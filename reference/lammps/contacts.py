"""Bodies that meet each other and walls, by `pair_style granular` and `fix wall/gran` of LAMMPS: same step and start, nearly the same law.

Springs and dashpots are those of the solver: `hertz/material` or `hooke`, damping by the coefficient of restitution, a tangential
spring of 8 G* a (Mindlin) or of the normal stiffness, whose dashpot is x times that along the normal, with x^2 = 2 (1 - nu) /
(2 - nu), the ratio of the two stiffnesses, or x = 1. So impacts along the normal agree with the solver and with LIGGGHTS to the
digits that a step leaves, and oblique ones of two spheres without loss too. Two rules are others:
- friction at a wall has the arm R - d/2 of a contact half way into the overlap d, in the solver R - d, that of the wall's face;
- friction limits the sum of spring and dashpot, in the solver the spring alone, and what the limit cuts off is taken out of the
  spring. Where the dashpot is beyond the limit, as at the first touch of a sphere that slides, that winds the spring up backwards,
  and friction then pushes for a while.
Discs turn as discs.
"""

import math
from pathlib import Path

from reference.contact import granular
from reference.contact.granular import DUMP, MOTION, kinds_of, numbers
from reference.contact.motion import Motion
from reference.contact.scene import ContactScene, Law
from reference.lammps.program import run_script


def law_of(law: Law) -> str:
    """The words after `pair_coeff * *`."""
    if law.model == "linear":
        return (f"hooke {numbers(law.stiffness, law.restitution)} tangential linear_history "
                f"{numbers(law.stiffness, 1.0, law.friction)} damping coeff_restitution")
    shear = 2 * law.young / ((2 - law.poisson) * (1 + law.poisson))  # 8 G*
    share = math.sqrt(2 * (1 - law.poisson) / (2 - law.poisson))
    return (f"hertz/material {numbers(law.young, law.restitution, law.poisson)} tangential mindlin "
            f"{numbers(shear, share, law.friction)} damping coeff_restitution")


def script_of(scene: ContactScene) -> str:
    law = law_of(scene.law)
    boundary, corners = granular.box_of(scene)
    walls = "\n".join(f"fix wall{n} all wall/gran granular {law} {'xyz'[face.axis]}plane "
                      + (f"{numbers(face.place)} NULL" if face.sign > 0 else f"NULL {numbers(face.place)}")
                      for n, face in enumerate(scene.faces))
    columns = " ".join(["%d"] + ["%.17g"] * len(MOTION))
    return f"""units lj
atom_style sphere
atom_modify map array
dimension {scene.dimension}
boundary {boundary}
newton off
comm_modify vel yes
region box block {corners} units box
create_box {len(kinds_of(scene.bodies))} box
{granular.body_lines(scene, 'omega {} {} {}')}
neighbor {numbers(granular.skin_of(scene))} bin
neigh_modify delay 0 every 1 check yes
pair_style granular
pair_coeff * * {law}
timestep {scene.step!r}
fix motion all nve/sphere{" disc" if scene.dimension == 2 else ""}
{granular.gravity_line(scene)}
{walls}
{"fix plane all enforce2d" if scene.dimension == 2 else ""}
dump motion all custom {scene.sample} {DUMP} id {" ".join(MOTION)}
dump_modify motion sort id format line "{columns}"
thermo {scene.steps}
run {scene.steps}
"""


def run(scene: ContactScene, folder: Path) -> Motion:
    """Leaves the table of the motion in the folder. Throws Failed."""
    run_script(script_of(scene), folder)
    return granular.read_dump(folder, scene)
