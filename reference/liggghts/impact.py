"""Bodies that meet each other and walls, of the scene that the solver gets: same law, same step, same start.

LIGGGHTS integrates by velocity Verlet, the solver by kick and drift, whose velocities are those of half a step before.
The two give the same positions if LIGGGHTS starts with the velocity half a kick of gravity later, which is done here.
Discs are computed as spheres of the same mass that move in a plane; their moment of inertia is 2/5 m R^2, not 1/2 m R^2,
so scenes in the plane are accepted without friction only.

LIGGGHTS forgets the tangential spring of two spheres that have parted only when it builds its lists of neighbours anew:
those that meet again before go on with the old one. With a thin skin lists are built often, and this is rare.
"""

import argparse
import math
from pathlib import Path

import numpy as np

from reference.contact.motion import IMPACT, REST, Motion, read_motion
from reference.contact.scene import Body, ContactScene, contact_scene
from reference.liggghts.program import CODE, SCRIPT, run_script
from verification.protocol.quantity import Quantity, Result, checksum_of

DUMP = "dump.txt"
TABLE = "table.csv"
SKIN = 0.02  # of the lists of neighbours, in radii of the smallest body
LOWEST_RESTITUTION = 0.05  # LIGGGHTS takes no lower one
MOTION = ("x", "y", "z", "vx", "vy", "vz", "omegax", "omegay", "omegaz", "fx", "fy", "fz")
COLUMNS = ("position", "velocity", "angular_velocity", "force")


def _numbers(*values: float) -> str:
    """Every bit of them."""
    return " ".join(repr(float(value)) for value in values)


def _matrix(entries: list[list[float]]) -> str:
    return f"{len(entries)} " + _numbers(*(entry for row in entries for entry in row))


def kinds_of(bodies: tuple[Body, ...]) -> list[tuple[float, float]]:
    """Distinct (mass, radius): each is a type of atom, as LIGGGHTS has dashpots by type."""
    return sorted({(body.mass, body.radius) for body in bodies})


def damping_constant(restitution: float, mass: float, stiffness: float) -> float:
    """Of a linear dashpot that leaves `restitution` of the speed of an effective mass on a spring."""
    log = math.log(restitution)
    return -2 * log / math.hypot(math.pi, log) * math.sqrt(mass * stiffness)


def law_of(scene: ContactScene) -> tuple[str, str, str]:
    """(properties, model, its settings, which stand last in a command): of each pair of types, the last of which is the wall."""
    law, masses = scene.law, [mass for mass, _ in kinds_of(scene.bodies)] + [math.inf]
    types = len(masses)

    def pairs(value: float) -> list[list[float]]:
        return [[value] * types for _ in masses]

    properties = [f"fix friction all property/global coefficientFriction peratomtypepair {_matrix(pairs(law.friction))}"]
    if law.model == "hertz":
        for name, value in (("youngsModulus", law.young), ("poissonsRatio", law.poisson)):
            properties.append(f"fix {name} all property/global {name} peratomtype {_numbers(*[value] * types)}")
        properties.append(f"fix restitution all property/global coefficientRestitution peratomtypepair {_matrix(pairs(law.restitution))}")
        return "\n".join(properties), "model hertz tangential history", ""
    effective = [[1 / max(1 / a + 1 / b, 1e-300) for b in masses] for a in masses]
    effective[-1][-1] = effective[0][0]  # walls do not meet
    dashpots = [[damping_constant(law.restitution, mass, law.stiffness) for mass in row] for row in effective]
    for name, values in (("kn", pairs(law.stiffness)), ("kt", pairs(law.stiffness)), ("gamman_abs", dashpots), ("gammat_abs", dashpots)):
        properties.append(f"fix {name} all property/global {name} peratomtypepair {_matrix(values)}")
    return "\n".join(properties), "model hooke/stiffness tangential history", "absolute_damping on"


def _in_space(vector: np.ndarray) -> np.ndarray:
    return np.concatenate([vector, np.zeros(3 - len(vector))])


def _body_lines(scene: ContactScene) -> str:
    kinds = kinds_of(scene.bodies)
    lines = []
    for n, body in enumerate(scene.bodies, 1):
        kind = kinds.index((body.mass, body.radius)) + 1
        lines.append(f"create_atoms {kind} single {_numbers(*_in_space(body.position))} units box")
        density = 3 * body.mass / (4 * math.pi * body.radius**3)
        lines.append(f"set atom {n} diameter {_numbers(2 * body.radius)} density {_numbers(density)}")
    for n, body in enumerate(scene.bodies, 1):
        velocity = _in_space(body.velocity + 0.5 * scene.step * scene.gravity)
        turning = body.spin if scene.dimension == 3 else [0.0, 0.0, body.spin[0]]
        for name, values in (("v", velocity), ("omega", turning)):
            lines.append(f"set atom {n} " + " ".join(f"{name}{axis} {_numbers(value)}" for axis, value in zip("xyz", values, strict=False)))
    return "\n".join(lines)


def _box(scene: ContactScene) -> tuple[str, str]:
    """(boundaries, corners): open along the normals of walls, which then may lie on the border of the periodic box."""
    closed = {face.axis for face in scene.faces}
    reach = 4 * max(body.radius for body in scene.bodies)
    boundary, corners = [], []
    for axis in range(3):
        if axis >= scene.dimension:
            boundary.append("p")
            corners += [-reach, reach]
        else:
            boundary.append("f" if axis in closed else "p")
            margin = reach if axis in closed else 0.0
            corners += [-margin, float(scene.size[axis]) + margin]
    return " ".join(boundary), _numbers(*corners)


def script_of(scene: ContactScene) -> str:
    properties, model, settings = law_of(scene)
    boundary, corners = _box(scene)
    types = len(kinds_of(scene.bodies)) + 1
    walls = "\n".join(f"fix wall{n} all wall/gran {model} primitive type {types} {'xyz'[face.axis]}plane {_numbers(face.place)} {settings}"
                      for n, face in enumerate(scene.faces))
    strength = float(np.linalg.norm(scene.gravity))
    gravity = "" if strength == 0 else f"fix gravity all gravity {_numbers(strength)} vector {_numbers(*_in_space(scene.gravity))}"
    return f"""units lj
atom_style granular
atom_modify map array
boundary {boundary}
newton off
communicate single vel yes
region box block {corners} units box
create_box {types} box
{_body_lines(scene)}
neighbor {_numbers(SKIN * min(body.radius for body in scene.bodies))} bin
neigh_modify delay 0 every 1 check yes
{properties}
pair_style gran {model} {settings}
pair_coeff * *
timestep {scene.step!r}
fix motion all nve/sphere
{gravity}
{walls}
dump motion all custom {scene.sample} {DUMP} id {" ".join(MOTION)}
dump_modify motion sort id format "%d {" ".join(["%.17g"] * len(MOTION))}"
thermo {scene.steps}
run {scene.steps}
"""


def write_table(dump: Path, table: Path, scene: ContactScene) -> None:
    """The dump as solids.csv has it, with the force on each body."""
    axes = "xyz"[: scene.dimension]
    names = [f"{name}_{axis}" for name in COLUMNS for axis in ("z" if scene.dimension == 2 and name == "angular_velocity" else axes)]
    chosen = [3 * COLUMNS.index(name.rpartition("_")[0]) + "xyz".index(name[-1]) for name in names]
    lines = dump.read_text().splitlines()
    block = 9 + len(scene.bodies)
    with table.open("w") as out:
        out.write(",".join(["step", "time", "id", *names]) + "\n")
        for start in range(0, len(lines), block):
            step = int(lines[start + 1])
            for body, line in enumerate(lines[start + 9 : start + block]):
                values = line.split()[1:]
                out.write(",".join([str(step), repr(step * scene.step), str(body), *(values[k] for k in chosen)]) + "\n")


def read_scene_of(scene: dict, problem: str) -> ContactScene:
    """Throws ValueError, also on what LIGGGHTS does not know."""
    made = contact_scene(scene)
    if problem == "rest" and not (made.gravity.any() and made.faces):
        raise ValueError("force.solid: nothing comes to rest without gravity and a wall; give both")
    if problem == "impact" and len(made.bodies) > 2:
        raise ValueError(f"body: {len(made.bodies)} of them; an impact is of one with a wall or of two with each other")
    if problem == "impact" and len(made.bodies) == 1 and not made.faces:
        raise ValueError("body: one sphere and no wall; add what it meets")
    if made.dimension == 2 and made.law.friction != 0:
        raise ValueError(f"contact.friction = {made.law.friction}: discs turn otherwise than spheres; write 0, or a scene in space")
    if made.law.restitution <= LOWEST_RESTITUTION:
        raise ValueError(f"contact.restitution = {made.law.restitution}: LIGGGHTS takes none below {LOWEST_RESTITUTION}; raise it")
    return made


PROBLEMS = {"impact": IMPACT, "rest": REST}  # what is measured


def quantities_of(motion: Motion, problem: str) -> dict[str, Quantity]:
    found = {name: measure(motion) for name, measure in PROBLEMS[problem].items()}
    return {name: Quantity(value, 0.0, note="same law, start and step") for name, value in found.items() if math.isfinite(value)}


def run(scene: ContactScene, folder: Path, command: str, problem: str) -> Result:
    """`problem` is one of PROBLEMS. Throws Failed."""
    finished = run_script(script_of(scene), folder)
    write_table(folder / DUMP, folder / TABLE, scene)
    (folder / DUMP).unlink()
    quantities = quantities_of(read_motion(folder / TABLE, scene), problem)
    return Result(CODE, finished.version, command, checksum_of([folder / SCRIPT], folder), quantities, table=TABLE)


def add_options(parser: argparse.ArgumentParser) -> None:
    """None: the scene says all."""
