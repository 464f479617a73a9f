"""LIGGGHTS (Kloss, Goniva, Hager, Amberger and Pirker 2012) as a program: found on PATH, run in a folder, its figures kept."""

import shutil
from pathlib import Path

from reference.scripted import Failed, Finished, package_version, run_in
from verification.protocol.quantity import Result

__all__ = ["Failed", "Finished", "installed", "missing", "run_script"]

CODE = "LIGGGHTS"
PROGRAM = "liggghts"
SCRIPT = "in.liggghts"
MISSING = "the program liggghts is not on PATH; apt-get install liggghts"


def installed() -> bool:
    return shutil.which(PROGRAM) is not None


def version() -> str:
    """Of Debian's package; empty where the program came otherwise."""
    return package_version("liggghts")


def missing(command: str) -> Result:
    return Result(CODE, command=command, missing=MISSING)


def run_script(script: str, folder: Path, ranks: int = 1) -> Finished:
    """Writes the script into `folder` and runs it there. Throws Failed."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / SCRIPT).write_text(script)
    launch = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
    return run_in(folder, [*launch, PROGRAM, "-in", SCRIPT, "-log", "none"], r"Version ([^,]+)")
