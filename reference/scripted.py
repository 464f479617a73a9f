"""Programs that read a script, such as LIGGGHTS and LAMMPS: run in a folder, their words and figures kept."""

import os
import re
import shutil
import subprocess
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from verification.protocol.adapter import core_seconds_of_children

PEERS = Path(__file__).resolve().parents[1] / ".venv-peers"  # an environment of their own, by ./setup --peers
HEADER = 9  # lines of a frame of a dump before its particles


@dataclass(frozen=True)
class Finished:
    version: str
    log: str
    core_seconds: float


class Failed(RuntimeError):
    """The program ended with an error: its own message."""


def peer_version(name: str) -> str:
    """Of a package in the environment of the peers, such as 2025.7.22.4.0; empty where it is not installed."""
    found = next(PEERS.glob(f"lib/python3*/site-packages/{name}-*.dist-info"), None)
    return found.name.removeprefix(f"{name}-").removesuffix(".dist-info") if found else ""


def package_version(name: str) -> str:
    """Of a package of Debian; empty where it is not installed as one."""
    if not shutil.which("dpkg-query"):
        return ""
    done = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", name], capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else ""


def run_in(folder: Path, command: list[str], version: str, environment: Mapping[str, str] = {}) -> Finished:
    """Runs the command in `folder`; the first group of the pattern `version` in its output is the version. Throws Failed."""
    before = core_seconds_of_children()
    done = subprocess.run(command, cwd=folder, text=True, env=os.environ | environment, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    seconds = core_seconds_of_children() - before
    error = re.search(r"^ERROR.*", done.stdout, re.MULTILINE)
    if done.returncode != 0 or error:
        raise Failed(error.group(0) if error else f"exit status {done.returncode}: {done.stdout[-300:]}")
    found = re.search(version, done.stdout)
    return Finished(found.group(1) if found else "", done.stdout, seconds)


def frames_of(dump: Path, count: int, dimension: int, step: float) -> Iterator[tuple[float, np.ndarray, np.ndarray]]:
    """(time, points (n, D), velocity (n, D)) of every frame of a dump whose columns are x y z vx vy vz."""
    with dump.open() as file:
        while header := [file.readline() for _ in range(HEADER)]:
            if not header[-1]:
                return
            rows = np.loadtxt(file, max_rows=count, ndmin=2)
            yield int(header[1]) * step, rows[:, :dimension], rows[:, 3 : 3 + dimension]
