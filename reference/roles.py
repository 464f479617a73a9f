"""A code in the role of a reference: options of the protocol become those of its program, the result becomes what a run leaves.

    PROGRAM run --scene FILE --out DIR --option problem=P [--option KEY=VALUE]...

calls the problem P with `--KEY VALUE` each; an option without a value, as `transient=`, is a flag.
"""

import contextlib
import io
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import numpy as np

from verification.protocol.adapter import BadInput, Cannot, Left, Task
from verification.protocol.points import write_points
from verification.protocol.quantity import RESULT, Result

PROBLEM = "problem"
Parsed = TypeVar("Parsed")


def arguments_of(task: Task) -> list[str]:
    """The command line of the reference's program."""
    given = [task.option(PROBLEM), "--scene", str(task.file), "--out", str(task.out)]
    for key, value in task.options.items():
        if key != PROBLEM:
            given += [f"--{key}", value] if value else [f"--{key}"]
    return given


def parsed(parse: Callable[[list[str]], Parsed], given: list[str]) -> Parsed:
    """What argparse makes of a command line. Throws BadInput with its words."""
    said = io.StringIO()
    try:
        with contextlib.redirect_stderr(said):
            return parse(given)
    except SystemExit:
        words = said.getvalue().strip().rpartition("error: ")[2]
        raise BadInput(f"--option: {words}; each KEY=VALUE becomes --KEY VALUE") from None


def left_of(result: Result, out: Path) -> Left:
    """Quantities, objection and table; a field, of the finest level, becomes the snapshot. Throws Cannot where it is missing."""
    if result.missing:
        raise Cannot(result.missing)
    if result.field:
        file = out / result.field
        with np.load(file) as field:
            write_points(out, 0, 0.0, field["points"], field["velocity"])
        file.unlink()
    (out / RESULT).unlink(missing_ok=True)
    more = {"inputs": result.inputs, "table": result.table, "program": result.version, "program_command": result.command}
    return Left(quantities=result.quantities, objection=result.objection, more=more)
