"""LIGGGHTS (Kloss, Goniva, Hager, Amberger and Pirker 2012) as a program: found on PATH, run in a folder, its figures kept."""

import re
import resource
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

from reference.live import Result

CODE = "LIGGGHTS"
PROGRAM = "liggghts"
SCRIPT = "in.liggghts"
MISSING = "the program liggghts is not on PATH; apt-get install liggghts"


@dataclass(frozen=True)
class Finished:
    version: str
    log: str
    core_seconds: float


class Failed(RuntimeError):
    """LIGGGHTS ended with an error: its own message."""


def installed() -> bool:
    return shutil.which(PROGRAM) is not None


def missing(command: str) -> Result:
    return Result(CODE, command=command, missing=MISSING)


def _children_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run_script(script: str, folder: Path, ranks: int = 1) -> Finished:
    """Writes the script into `folder` and runs it there. Throws Failed."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / SCRIPT).write_text(script)
    launch = ["mpirun", "-np", str(ranks)] if ranks > 1 else []
    before = _children_seconds()
    done = subprocess.run([*launch, PROGRAM, "-in", SCRIPT, "-log", "none"], cwd=folder, text=True,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    seconds = _children_seconds() - before
    error = re.search(r"^ERROR.*", done.stdout, re.MULTILINE)
    if done.returncode != 0 or error:
        raise Failed(error.group(0) if error else f"exit status {done.returncode}: {done.stdout[-300:]}")
    version = re.search(r"Version ([^,]+)", done.stdout)
    return Finished(version.group(1) if version else "", done.stdout, seconds)
