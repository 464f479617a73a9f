"""What the scripts of granular codes have in common: how a scene is handed to them, and how their dumps are read.

Such codes integrate by velocity Verlet, the solver by kick and drift, whose velocities are those of half a step before. The two
give the same positions if the code starts with the velocity half a kick of gravity later, which is done here.
"""

import math
from pathlib import Path

import numpy as np

from reference.contact.motion import IMPACT, REST, Motion, read_motion
from reference.contact.scene import Body, ContactScene, contact_scene
from verification.protocol.quantity import Quantity

DUMP = "dump.txt"
TABLE = "table.csv"
SOLIDS = "solids.csv"  # that table, as the protocol names it
SKIN = 0.02  # of the lists of neighbours, in radii of the smallest body
MOTION = ("x", "y", "z", "vx", "vy", "vz", "omegax", "omegay", "omegaz", "fx", "fy", "fz")  # columns of a dump
COLUMNS = ("position", "velocity", "angular_velocity", "force")
PROBLEMS = {"impact": IMPACT, "rest": REST}  # what is measured


def numbers(*values: float) -> str:
    """Every bit of them."""
    return " ".join(repr(float(value)) for value in values)


def in_space(vector: np.ndarray) -> np.ndarray:
    return np.concatenate([vector, np.zeros(3 - len(vector))])


def kinds_of(bodies: tuple[Body, ...]) -> list[tuple[float, float]]:
    """Distinct (mass, radius)."""
    return sorted({(body.mass, body.radius) for body in bodies})


def skin_of(scene: ContactScene) -> float:
    return SKIN * min(body.radius for body in scene.bodies)


def body_lines(scene: ContactScene, spin: str) -> str:
    """Creates the bodies, a type a kind, and gives them their start; `spin` are the words for it, {} standing for a component."""
    kinds = kinds_of(scene.bodies)
    lines = []
    for n, body in enumerate(scene.bodies, 1):
        kind = kinds.index((body.mass, body.radius)) + 1
        lines.append(f"create_atoms {kind} single {numbers(*in_space(body.position))} units box")
        density = 3 * body.mass / (4 * math.pi * body.radius**3)
        lines.append(f"set atom {n} diameter {numbers(2 * body.radius)} density {numbers(density)}")
    for n, body in enumerate(scene.bodies, 1):
        velocity = in_space(body.velocity + 0.5 * scene.step * scene.gravity)
        turning = body.spin if scene.dimension == 3 else [0.0, 0.0, body.spin[0]]
        lines.append(f"set atom {n} " + " ".join(f"v{axis} {numbers(value)}" for axis, value in zip("xyz", velocity, strict=True)))
        lines.append(f"set atom {n} " + spin.format(*(numbers(value) for value in turning)))
    return "\n".join(lines)


def box_of(scene: ContactScene) -> tuple[str, str]:
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
    return " ".join(boundary), numbers(*corners)


def gravity_line(scene: ContactScene) -> str:
    strength = float(np.linalg.norm(scene.gravity))
    return "" if strength == 0 else f"fix gravity all gravity {numbers(strength)} vector {numbers(*in_space(scene.gravity))}"


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


def problem_of(scene: ContactScene) -> str:
    return "rest" if scene.gravity.any() and scene.faces else "impact"


def read_scene_of(scene: dict, problem: str = "") -> ContactScene:
    """Throws ValueError, also on what is no such problem; without one, any is taken."""
    made = contact_scene(scene)
    if problem == "rest" and not (made.gravity.any() and made.faces):
        raise ValueError("force.solid: nothing comes to rest without gravity and a wall; give both")
    if problem == "impact" and len(made.bodies) > 2:
        raise ValueError(f"body: {len(made.bodies)} of them; an impact is of one with a wall or of two with each other")
    if problem == "impact" and len(made.bodies) == 1 and not made.faces:
        raise ValueError("body: one sphere and no wall; add what it meets")
    return made


def quantities_of(motion: Motion, problem: str, note: str) -> dict[str, Quantity]:
    found = {name: measure(motion) for name, measure in PROBLEMS[problem].items()}
    return {name: Quantity(value, 0.0, note=note) for name, value in found.items() if math.isfinite(value)}


def read_dump(folder: Path, scene: ContactScene) -> Motion:
    """Of the DUMP in the folder, which becomes the TABLE there."""
    write_table(folder / DUMP, folder / TABLE, scene)
    (folder / DUMP).unlink()
    return read_motion(folder / TABLE, scene)
