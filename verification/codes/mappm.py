"""Runs the two solvers."""

import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

from verification.protocol.errors import SolverError
from verification.protocol.machine import ROOT
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


def run(scene: Path, out: Path, options: Options = DEFAULT) -> Run:
    """Runs a scene to its end. Throws SolverError with the solver's message."""
    process = start(scene, out, options)
    stdout, stderr = process.communicate()
    if process.returncode != 0:
        raise SolverError(f"{' '.join(process.args)}\nended with {process.returncode}\n{stdout[-2000:]}{stderr[-4000:]}")
    return Run(out)
