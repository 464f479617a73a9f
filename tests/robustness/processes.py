"""Finds and kills what a call of mpirun or of a solver has started."""

import os
import signal
import subprocess
import time
from pathlib import Path

GONE_SECONDS = 60.0


def children(of: int) -> list[int]:
    """Processes below one, at any depth."""
    parents: dict[int, list[int]] = {}
    for entry in Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            stat = (entry / "stat").read_text()
        except OSError:  # ended meanwhile
            continue
        parents.setdefault(int(stat.rpartition(")")[2].split()[1]), []).append(int(entry.name))
    found: list[int] = []
    to_visit = [of]
    while to_visit:
        below = parents.get(to_visit.pop(), [])
        found += below
        to_visit += below
    return found


def ranks(of: int) -> list[int]:
    """The solver's processes below mpirun; the process itself where there is no mpirun."""
    found = [pid for pid in children(of) if name(pid) == "mappm"]
    return sorted(found) or [of]


def name(pid: int) -> str:
    try:
        return Path(f"/proc/{pid}/comm").read_text().strip()
    except OSError:
        return ""


def kill(pids: list[int]) -> None:
    for pid in pids:
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass


def _running(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def wait_until_gone(process: subprocess.Popen, pids: list[int]) -> tuple[str, str]:
    """What the call printed, once it and the other processes have ended. Throws TimeoutError where one does not."""
    limit = time.monotonic() + GONE_SECONDS
    try:
        printed = process.communicate(timeout=GONE_SECONDS)
        while any(_running(pid) for pid in pids):
            if time.monotonic() > limit:
                raise TimeoutError(f"processes {[pid for pid in pids if _running(pid)]} outlive the kill")
            time.sleep(0.01)
    except (TimeoutError, subprocess.TimeoutExpired):
        kill([process.pid, *pids])
        raise
    return printed
