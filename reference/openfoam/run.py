"""Runs programs of OpenFOAM, and says what each cost."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

from reference.openfoam.soundness import fault_of_openfoam

PROJECT = "/usr/share/openfoam"  # Debian's; the only variable that its programs need
HOW_TO_GET = "apt-get install openfoam"


class FailedRun(Exception):
    """A program that stopped with an error: which, and the end of its log."""


def missing_of(programs: tuple[str, ...], how: str = HOW_TO_GET) -> str:
    """Which of these are not installed, and how to get them, or why OpenFOAM cannot be used; empty if all is well."""
    absent = [program for program in programs if shutil.which(program) is None]
    if absent:
        return f"{', '.join(absent)} not found; {how}"
    return fault_of_openfoam((("WM_PROJECT_DIR", os.environ.get("WM_PROJECT_DIR", PROJECT)),)) if set(programs) - {"gmsh"} else ""


def run(folder: Path, *command: str) -> float:
    """Runs a command in a folder, its output in log.PROGRAM there. Returns its core-seconds. Throws FailedRun."""
    log = folder / f"log.{command[0]}"
    environment = {"WM_PROJECT_DIR": PROJECT} | dict(os.environ) | {"PWD": str(folder)}
    with log.open("w") as output:
        process = subprocess.Popen(command, cwd=folder, env=environment, stdout=output, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        end = " ".join(log.read_text(errors="replace")[-600:].split())
        raise FailedRun(f"{' '.join(command)} in {folder} ended with {process.returncode}: {end}")
    return usage.ru_utime + usage.ru_stime


def say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
