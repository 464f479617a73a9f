"""MaPPM: runs its two programs, and is the adapter of the parallel one.

    python3 -m verification.codes.mappm describe | run --scene FILE --out DIR ...
"""

import json
import os
import re
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from verification.protocol.adapter import BAD_INPUT, Adapter, BadInput, Failed, Left, Task, core_seconds_of_children, main
from verification.protocol.capability import CAPABILITIES
from verification.protocol.errors import SolverError
from verification.protocol.machine import ROOT

if TYPE_CHECKING:
    from verification.protocol.run import Run

# Open MPI as root, and with more ranks than cores; threads that wait give way to other ranks.
MPI_ENVIRONMENT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_hwloc_base_binding_policy": "none",
    "OMP_WAIT_POLICY": "passive",
}


def build_folder() -> Path:
    """Where the programs are: MAPPM_BUILD, or the preset `fast` of this tree."""
    return Path(os.environ.get("MAPPM_BUILD", ROOT / "build" / "fast"))


def program(name: str, build: Path | None = None) -> Path:
    path = (build or build_folder()) / "bin" / name
    if not path.exists():
        raise SolverError(f"{path} is missing; build it first: ./check, or cmake --workflow --preset fast")
    return path


INSTRUCTION_SETS = ("plain", "avx2", "avx512")  # each holds those before it


def best_instruction_set(build: Path | None = None) -> str:
    """The one that mappm chooses on this processor."""
    said = subprocess.run([program("mappm", build), "--version"], capture_output=True, text=True, check=True).stdout
    return said.split()[-1]


@dataclass(frozen=True)
class Options:
    """How to run one scene. ranks = 0 is the serial reference; more than one rank goes through mpirun."""

    ranks: int = 1
    steps: int | None = None
    overrides: tuple[str, ...] = ()
    domains: str | None = None
    threads: int | None = None
    rebalance: int | None = None
    faces: bool = False  # write faces.csv; of the parallel solver
    trace: str | None = None  # "ID@STEP": write trace.csv
    resume: Path | None = None
    overwrite: bool = True  # what an earlier run left in the folder, unless this one resumes it
    neighbours: str | None = None  # search of the reference: "cells" or "all-pairs"
    build: Path | None = None
    isa: str | None = None  # instruction set of a portable build; by default the best of the processor

    @property
    def label(self) -> str:
        parts = [f"P={self.ranks}" if self.ranks else "serial reference"]
        if self.neighbours:
            parts.append(self.neighbours)
        if self.domains:
            parts.append(f"domains {self.domains}")
        if self.threads:
            parts.append(f"{self.threads} threads a rank")
        if self.rebalance:
            parts.append(f"rebalanced every {self.rebalance} steps")
        if self.resume:
            parts.append("resumed")
        if self.build:
            parts.append(f"build {self.build.name}")
        if self.isa:
            parts.append(f"isa {self.isa}")
        return ", ".join(parts)

    def command(self, scene: Path, out: Path) -> list[str]:
        line = [str(program("mappm" if self.ranks else "mappm-reference", self.build)), "run", str(scene)]
        if self.ranks > 1:
            line = ["mpirun", "-np", str(self.ranks), *line]
        line += ["--out", str(out)]
        for flag, value in (
            ("--steps", self.steps),
            ("--domains", self.domains),
            ("--threads", self.threads),
            ("--rebalance", self.rebalance),
            ("--trace", self.trace),
            ("--resume", self.resume),
            ("--neighbours", self.neighbours),
            ("--isa", self.isa),
        ):
            if value is not None:
                line += [flag, str(value)]
        if self.faces:
            line.append("--faces")
        if self.overwrite and self.resume is None:
            line.append("--overwrite")
        for override in self.overrides:
            line += ["--set", override]
        return line


DEFAULT = Options()


def start(scene: Path, out: Path, options: Options) -> subprocess.Popen:
    return subprocess.Popen(
        options.command(scene, out),
        env=os.environ | MPI_ENVIRONMENT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def run(scene: Path, out: Path, options: Options = DEFAULT) -> "Run":
    """Runs a scene to its end. Throws SolverError with the solver's message."""
    from verification.protocol.run import Run  # loads slowly, and the adapter needs none of it

    process = start(scene, out, options)
    stdout, stderr = process.communicate()
    if process.returncode != 0:
        raise SolverError(f"{' '.join(process.args)}\nended with {process.returncode}\n{stdout[-2000:]}{stderr[-4000:]}")
    return Run(out)


class Solver(Adapter):
    """One of the two programs behind the protocol. `allowed` are flags of it that an --option may set, none of which changes a bit; ranks
    are cores over threads."""

    capabilities, title = frozenset(CAPABILITIES), "MaPPM"

    def __init__(self, name: str, allowed: tuple[str, ...], most_cores: int | None = None) -> None:
        self.name, self.allowed, self.most_cores = name, allowed, most_cores
        self.speed_options = allowed

    def missing(self) -> str:
        try:
            program(self.name)
        except SolverError as error:
            return str(error)
        return ""

    def _said(self) -> re.Match:
        """`NAME 1.0.0 (COMMIT), numerics 2, avx512`."""
        said = subprocess.run([program(self.name), "--version"], capture_output=True, text=True, check=True).stdout
        found = re.match(rf"{self.name} (\S+) \(.*\), numerics (\d+)", said)
        if not found:
            raise Failed(f"--version says {said.strip()!r}, which is not understood")
        return found

    def version(self) -> str:
        return self._said()[1]

    def numerics_version(self) -> int:
        return int(self._said()[2])

    def _ranks(self, task: Task) -> int:
        """0 for the serial program. Throws BadInput."""
        if self.most_cores and task.cores > self.most_cores:
            raise BadInput(f"--cores {task.cores}: {self.name} takes {self.most_cores}")
        threads = _whole(task.options, "threads", 1)
        if task.cores % threads:
            raise BadInput(f"--cores {task.cores}: must be a multiple of threads={threads}")
        return 0 if self.name == "mappm-reference" else task.cores // threads

    def _command(self, task: Task) -> list[str]:
        unknown = set(task.options) - set(self.allowed)
        if unknown:
            raise BadInput(f"--option {', '.join(sorted(unknown))}: unknown; known are {', '.join(self.allowed)}")
        line = Options(ranks=self._ranks(task), steps=task.steps, overwrite=False).command(task.file, task.out)
        for key, value in task.options.items():
            line += [f"--{key}", value]
        return line

    def run(self, task: Task) -> Left:
        used = core_seconds_of_children()
        done = subprocess.run(self._command(task), env=os.environ | MPI_ENVIRONMENT, capture_output=True, text=True)
        if done.returncode != 0:
            raise (BadInput if done.returncode == BAD_INPUT else Failed)(_words(done))
        record = json.loads((task.out / "run.json").read_text())
        (task.out / "run.json").unlink()  # until it is whole
        stepping = record["wall_seconds"]["steps"] * task.cores
        setup = max(0.0, core_seconds_of_children() - used - stepping)
        return Left(digest=record["digest"], setup_core_seconds=setup, more=record)


def _words(done: subprocess.CompletedProcess) -> str:
    """The error that the program told, among what mpirun says about it."""
    lines = (done.stderr.strip() or done.stdout.strip() or f"ended with {done.returncode}").splitlines()
    told = [line.removeprefix("error: ") for line in lines if line.startswith("error: ")]
    return (told or [line for line in lines if not line.startswith("Run with --help")] or lines)[-1]


def _whole(options: Mapping[str, str], key: str, default: int) -> int:
    text = options.get(key, str(default))
    if not text.isdigit() or int(text) < 1:
        raise BadInput(f"--option {key}={text}: must be a whole number of at least 1")
    return int(text)


if __name__ == "__main__":
    sys.exit(main(Solver("mappm", ("domains", "threads", "rebalance", "isa"))))
