"""python3 -m tests.robustness.study: kills a study at random moments and resumes it, and compares its store with that of one which
was left alone."""

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from verification.protocol.machine import ROOT
from verification.store.laboratory import Laboratory
from verification.store.store import Store

STUDY = "shear_wave.resolution"
SHARE = 0.6  # of the time that the study takes when left alone: the longest that it has before a kill
MOST = 100  # kills
TIMES = ("made", "machine", "source", "command", "core_seconds", "setup_core_seconds", "wall_seconds", "peak_memory", "record")


def start(folder: Path, name: str) -> subprocess.Popen:
    return subprocess.Popen([sys.executable, "-m", "verification", "study", name, "--lab", str(folder)], cwd=ROOT,
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)


def what_counts(store: Store) -> list[str]:
    """Rows without what differs from run to run: times, dates, and records but for their digests."""
    found = []
    for table, row in store.tables():
        if table == "costs":
            continue
        kept = {name: value for name, value in row.items() if name not in TIMES}
        if table == "runs":
            kept["digest"] = store.run(row["key"]).record["digest"]
        found.append(f"{table} {sorted(kept.items())}")
    return sorted(found)


def left_alone(folder: Path, name: str) -> float:
    """Seconds that the study takes."""
    began = time.monotonic()
    if start(folder, name).wait() != 0:
        raise RuntimeError("the study does not come to its end when left alone")
    return time.monotonic() - began


def killed_and_resumed(folder: Path, name: str, seed: int, seconds: float, say) -> int:
    """Number of kills until the study came to its end."""
    chance, kills = random.Random(seed), 0
    while True:
        process = start(folder, name)
        try:
            status = process.wait(chance.uniform(0.0, SHARE * seconds) if kills < MOST else None)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            kills += 1
            say(f"kill {kills}: {len(Laboratory(folder).store.runs())} runs in the store")
            continue
        if status != 0:
            raise RuntimeError(f"the study ended with {status} after {kills} kills")
        return kills


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m tests.robustness.study", description=__doc__)
    parser.add_argument("--seed", type=int, default=round(time.time()), help="of the moments (default: the time)")
    parser.add_argument("--study", default=STUDY)
    chosen = parser.parse_args()
    print(f"seed {chosen.seed}")
    with tempfile.TemporaryDirectory() as scratch:
        alone, resumed = Path(scratch) / "alone", Path(scratch) / "resumed"
        seconds = left_alone(alone, chosen.study)
        kills = killed_and_resumed(resumed, chosen.study, chosen.seed, seconds, print)
        expected, found = what_counts(Laboratory(alone).store), what_counts(Laboratory(resumed).store)
        left = [path.name for path in (resumed / "runs").glob("*.part")]
    print(f"{kills} kills; {len(found)} rows, {'the same' if found == expected else 'NOT the same'}; left over: {left or 'nothing'}")
    return 0 if found == expected and kills > 0 and not left else 1


if __name__ == "__main__":
    sys.exit(main())
