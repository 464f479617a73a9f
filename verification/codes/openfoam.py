"""OpenFOAM as a code: as a reference, the drag on bodies held in a periodic cell; as a subject, flows between walls.

    python3 -m verification.codes.openfoam run --scene FILE --out DIR --option problem=drag|bodies --option levels=16,32
        [--option stored=[FILE]] [--option transient=] [--option end=T]

The problems and options are those of python3 -m reference.openfoam. Meshes follow the surface; the level, not the scene, says how
fine they are. Without `problem` the scene itself is run on a mesh as wide as its spacing: flows over time by reference/openfoam/flows.py,
one body by the steady solver, which states its drag.
"""

import shlex
import sys

from reference.openfoam import __main__ as program
from reference.openfoam.cell import read_cell
from reference.openfoam.drag import drag_at
from reference.openfoam.errors import InputError
from reference.openfoam.flows import subject
from reference.openfoam.run import FailedRun, missing_of
from reference.roles import PROBLEM, arguments_of, left_of, parsed
from reference.scripted import package_version
from verification.protocol.adapter import Adapter, BadInput, Cannot, Failed, Left, Task, main
from verification.protocol.capability import FIXED_BODY, FLUID, FORCE_ON_BODY, MOVING_BODY, SPACE, WALLS
from verification.protocol.quantity import read_result

RUN = {"drag": program.run_drag, "bodies": program.run_bodies}


def reference(task: Task) -> Left:
    """Throws BadInput, Cannot or Failed."""
    problem = task.option(PROBLEM)
    if problem not in RUN:
        raise BadInput(f"--option {PROBLEM}={problem}: unknown; take {' or '.join(RUN)}")
    given = arguments_of(task)
    chosen = parsed(program.arguments, given)
    try:
        RUN[problem](chosen, shlex.join(["python3", "-m", "reference.openfoam", *given]))
    except InputError as error:
        raise BadInput(str(error)) from None
    except FailedRun as error:
        raise Failed(str(error)) from None
    return left_of(read_result(task.out), task.out)


def drag(task: Task) -> Left:
    """On one body that is held, or driven, in a periodic cell, at the resolution of the scene. Throws Cannot and Failed."""
    try:
        return left_of(drag_at(read_cell(task.file, []), float(task.scene["fluid"]["spacing"]), task.out), task.out)
    except InputError as error:
        shapes = ", ".join(body["shape"] for body in task.scene["body"])
        raise Cannot(f"flow around bodies ({shapes}): {error}") from None
    except FailedRun as error:
        raise Failed(str(error)) from None


def as_it_stands(task: Task) -> Left:
    """Throws BadInput, Cannot or Failed."""
    has_bodies = any(body["shape"] != "wall" for body in task.scene.get("body", []))
    return drag(task) if has_bodies else subject(task)


class OpenFoam(Adapter):
    name, title = "openfoam", "OpenFOAM"
    capabilities = frozenset({FLUID, SPACE, WALLS, FIXED_BODY, MOVING_BODY, FORCE_ON_BODY})

    def version(self) -> str:
        return package_version("openfoam")

    def missing(self) -> str:
        return missing_of(("blockMesh", "checkMesh", "simpleFoam", "pimpleFoam", "postProcess"))

    def run(self, task: Task) -> Left:
        return reference(task) if PROBLEM in task.options else as_it_stands(task)


if __name__ == "__main__":
    sys.exit(main(OpenFoam()))
