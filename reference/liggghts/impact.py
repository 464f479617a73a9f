"""Bodies that meet each other and walls, of the scene that the solver gets: same law, same step, same start.

Discs are computed as spheres of the same mass that move in a plane; their moment of inertia is 2/5 m R^2, not 1/2 m R^2,
so scenes in the plane are accepted without friction only.

LIGGGHTS forgets the tangential spring of two spheres that have parted only when it builds its lists of neighbours anew:
those that meet again before go on with the old one. With a thin skin lists are built often, and this is rare.
"""

import argparse
import math
from pathlib import Path

from reference.contact import granular
from reference.contact.granular import DUMP, MOTION, TABLE, kinds_of, numbers
from reference.contact.scene import ContactScene
from reference.liggghts.program import CODE, SCRIPT, run_script
from verification.protocol.quantity import Result, checksum_of

SPIN = "omegax {} omegay {} omegaz {}"
LOWEST_RESTITUTION = 0.05  # LIGGGHTS takes no lower one


def _matrix(entries: list[list[float]]) -> str:
    return f"{len(entries)} " + numbers(*(entry for row in entries for entry in row))


def damping_constant(restitution: float, mass: float, stiffness: float) -> float:
    """Of a linear dashpot that leaves `restitution` of the speed of an effective mass on a spring."""
    log = math.log(restitution)
    return -2 * log / math.hypot(math.pi, log) * math.sqrt(mass * stiffness)


def law_of(scene: ContactScene) -> tuple[str, str, str]:
    """(properties, model, its settings, which stand last in a command): of each pair of types, the last of which is the wall.

    A kind of body is a type, as LIGGGHTS has dashpots by type.
    """
    law, masses = scene.law, [mass for mass, _ in kinds_of(scene.bodies)] + [math.inf]
    types = len(masses)

    def pairs(value: float) -> list[list[float]]:
        return [[value] * types for _ in masses]

    properties = [f"fix friction all property/global coefficientFriction peratomtypepair {_matrix(pairs(law.friction))}"]
    if law.model == "hertz":
        for name, value in (("youngsModulus", law.young), ("poissonsRatio", law.poisson)):
            properties.append(f"fix {name} all property/global {name} peratomtype {numbers(*[value] * types)}")
        properties.append(f"fix restitution all property/global coefficientRestitution peratomtypepair {_matrix(pairs(law.restitution))}")
        return "\n".join(properties), "model hertz tangential history", ""
    effective = [[1 / max(1 / a + 1 / b, 1e-300) for b in masses] for a in masses]
    effective[-1][-1] = effective[0][0]  # walls do not meet
    dashpots = [[damping_constant(law.restitution, mass, law.stiffness) for mass in row] for row in effective]
    for name, values in (("kn", pairs(law.stiffness)), ("kt", pairs(law.stiffness)), ("gamman_abs", dashpots), ("gammat_abs", dashpots)):
        properties.append(f"fix {name} all property/global {name} peratomtypepair {_matrix(values)}")
    return "\n".join(properties), "model hooke/stiffness tangential history", "absolute_damping on"


def script_of(scene: ContactScene) -> str:
    properties, model, settings = law_of(scene)
    boundary, corners = granular.box_of(scene)
    types = len(kinds_of(scene.bodies)) + 1
    walls = "\n".join(f"fix wall{n} all wall/gran {model} primitive type {types} {'xyz'[face.axis]}plane {numbers(face.place)} {settings}"
                      for n, face in enumerate(scene.faces))
    return f"""units lj
atom_style granular
atom_modify map array
boundary {boundary}
newton off
communicate single vel yes
region box block {corners} units box
create_box {types} box
{granular.body_lines(scene, SPIN)}
neighbor {numbers(granular.skin_of(scene))} bin
neigh_modify delay 0 every 1 check yes
{properties}
pair_style gran {model} {settings}
pair_coeff * *
timestep {scene.step!r}
fix motion all nve/sphere
{granular.gravity_line(scene)}
{walls}
dump motion all custom {scene.sample} {DUMP} id {" ".join(MOTION)}
dump_modify motion sort id format "%d {" ".join(["%.17g"] * len(MOTION))}"
thermo {scene.steps}
run {scene.steps}
"""


def read_scene_of(scene: dict, problem: str = "") -> ContactScene:
    """Throws ValueError, also on what LIGGGHTS does not know."""
    made = granular.read_scene_of(scene, problem)
    if made.dimension == 2 and made.law.friction != 0:
        raise ValueError(f"contact.friction = {made.law.friction}: discs turn otherwise than spheres; write 0, or a scene in space")
    if made.law.restitution <= LOWEST_RESTITUTION:
        raise ValueError(f"contact.restitution = {made.law.restitution}: LIGGGHTS takes none below {LOWEST_RESTITUTION}; raise it")
    return made


def run(scene: ContactScene, folder: Path, command: str, problem: str) -> Result:
    """`problem` is one of granular.PROBLEMS. Throws Failed."""
    finished = run_script(script_of(scene), folder)
    quantities = granular.quantities_of(granular.read_dump(folder, scene), problem, "same law, start and step")
    return Result(CODE, finished.version, command, checksum_of([folder / SCRIPT], folder), quantities, table=TABLE)


def add_options(parser: argparse.ArgumentParser) -> None:
    """None: the scene says all."""
