"""Runs the two solvers and finds what they wrote."""

import json
import os
import subprocess
import tomllib
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import h5py
import numpy as np

from verification.errors import SolverError
from verification.series import Table, read_table

ROOT = Path(__file__).resolve().parent.parent

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


@dataclass(frozen=True)
class Run:
    """What a finished run left in its folder."""

    folder: Path
    options: Options = field(default_factory=Options)

    @cached_property
    def series(self) -> Table:
        return read_table(self.folder / "series.csv")

    @cached_property
    def record(self) -> dict:
        return json.loads((self.folder / "run.json").read_text())

    @cached_property
    def scene(self) -> dict:
        """The scene as it was run, overrides applied."""
        return tomllib.loads(self.record["scene"]["text"])

    def snapshots(self, kind: str = "fluid") -> list[Path]:
        """Files in the order of their steps; kind is "fluid" (PPs and FPs) or "solids" (a point a ball)."""
        return sorted(self.folder.glob(f"snapshots/{kind}_*.vtkhdf"))

    def fluid(self, which: int = -1) -> dict[str, np.ndarray]:
        """The PPs of a snapshot, the last by default: points (n, 3), velocity (n, 3), density ...; scene units."""
        data = read_points(self.snapshots()[which])
        return {name: values[data["kind"] == 0] for name, values in data.items()}

    def solids(self, which: int = -1) -> dict[str, np.ndarray]:
        """The balls of a snapshot, the last by default: points (n, 3), radius (n) ...; scene units."""
        return read_points(self.snapshots("solids")[which])


def read_points(path: Path) -> dict[str, np.ndarray]:
    """Points and point data of a VTKHDF file."""
    with h5py.File(path) as file:
        group = file["VTKHDF"]
        return {"points": group["Points"][:]} | {name: data[:] for name, data in group["PointData"].items()}


def read_time(path: Path) -> float:
    """Of a VTKHDF file, scene units."""
    with h5py.File(path) as file:
        return float(file["VTKHDF/FieldData/TimeValue"][0])


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
    return Run(out, options)
