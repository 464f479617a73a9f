"""python3 -m tests.mutation: plants every fault of mutants/, one at a time, and sees it caught.

Exit code 0: all caught; 1: one survived, or a detector fails without a fault; 2: the manifest or the build is at fault.
"""

import argparse
import fcntl
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.mutation.detectors import Detector, Result, run_detector
from tests.mutation.manifest import ROOT, ManifestError, Mutant, read_manifests
from tests.mutation.tree import BUILD, FOLDER, BuildError, build_tree, write_planted, write_tree
from verification.bits.compare import compare
from verification.codes.mappm import Options
from verification.protocol.errors import SolverError

PUBLISHED = ROOT / "reports" / "published" / "mutation.json"
LONGEST = 300.0  # seconds that a detector may take without a fault


@dataclass(frozen=True)
class Outcome:
    mutant: Mutant
    detector: str  # the first that caught it; empty: none
    message: str
    seconds: float

    @property
    def caught(self) -> bool:
        return bool(self.detector)


class Remaining:
    """One line a finished part, with the time that the others may take."""

    def __init__(self, title: str, count: int):
        self.title, self.count, self.done, self.began = title, count, 0, time.monotonic()

    def note(self, text: str) -> None:
        self.done += 1
        left = int((time.monotonic() - self.began) / self.done * (self.count - self.done))
        clock = f"{left // 60}:{left % 60:02} left" if left else "done"
        print(f"{self.title} {self.done}/{self.count}, {clock}: {text}", file=sys.stderr, flush=True)


def assert_sleeping_faults_change_no_bit() -> None:
    """The copy with all faults asleep gives the digests of the ordinary build; else it would prove nothing."""
    for scene in ("crossing_2d", "crossing_3d"):
        variants = [Options(ranks=2, steps=60), Options(ranks=2, steps=60, build=BUILD),
                    Options(ranks=0, steps=60, build=BUILD)]
        with tempfile.TemporaryDirectory() as folder:
            file = ROOT / "cases" / scene / "case.toml"
            comparison = compare(file, Path(folder), variants)
        if not comparison.equal:
            raise BuildError("the build with sleeping faults differs:\n" + "\n".join(comparison.lines))


def baseline(texts: list[str], jobs: int) -> dict[str, Result]:
    """Every detector without a fault."""
    progress = Remaining("without a fault", len(texts))
    results = {}
    with ThreadPoolExecutor(jobs) as pool:
        futures = {pool.submit(run_detector, Detector(text), None, ROOT, LONGEST): text for text in texts}
        for future in as_completed(futures):
            text = futures[future]
            results[text] = future.result()
            progress.note(f"{text}: " + ("passes" if results[text].passed else f"FAILS: {results[text].message}"))
    return results


def hunt(mutant: Mutant, alone: dict[str, Result]) -> Outcome:
    """Its detectors in their order, until one catches it. One that fails without a fault is none."""
    tree = ROOT if mutant.is_compiled else write_planted(mutant)
    number = mutant.number if mutant.is_compiled else None
    seconds, messages = 0.0, []
    for text in mutant.caught_by:
        if not alone[text].passed:
            messages.append(f"{text}: fails without a fault: {alone[text].message}")
            continue
        timeout = max(60.0, 10 * alone[text].seconds)
        result = run_detector(Detector(text), number, tree, timeout, mutant.hang)
        seconds += result.seconds
        if result.failed:
            return Outcome(mutant, text, result.message, seconds)
        messages.append(f"{text}: " + (result.message if result.trouble else "passed"))
    return Outcome(mutant, "", "; ".join(messages), seconds)


def hunt_all(mutants: list[Mutant], alone: dict[str, Result], jobs: int) -> list[Outcome]:
    progress = Remaining("faults", len(mutants))
    outcomes = {}
    with ThreadPoolExecutor(jobs) as pool:
        futures = [pool.submit(hunt, mutant, alone) for mutant in mutants]
        for future in as_completed(futures):
            outcome = future.result()
            outcomes[outcome.mutant.id] = outcome
            how = f"caught by {outcome.detector}" if outcome.caught else "SURVIVED"
            progress.note(f"{outcome.mutant.id}: {how}")
    return [outcomes[mutant.id] for mutant in mutants]


def table(outcomes: list[Outcome]) -> str:
    """Survivors first."""
    lines = []
    for outcome in sorted(outcomes, key=lambda outcome: outcome.caught):
        verdict = "caught" if outcome.caught else "SURVIVED"
        lines.append(f"{verdict:8} {outcome.mutant.group:12} {outcome.mutant.id:40} {outcome.seconds:6.1f} s  "
                     f"{outcome.detector or outcome.message}")
    caught = sum(outcome.caught for outcome in outcomes)
    return "\n".join([*lines, f"{caught} of {len(outcomes)} planted faults caught"])


def record(outcomes: list[Outcome]) -> dict:
    commit = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty", "--abbrev=12"],
                            capture_output=True, text=True)
    rows = [{"id": o.mutant.id, "group": o.mutant.group, "what": o.mutant.what, "file": o.mutant.file,
             "caught": o.caught, "detector": o.detector, "message": o.message, "seconds": round(o.seconds, 2)}
            for o in outcomes]
    command = " ".join(["python3 -m tests.mutation", *sys.argv[1:]])
    return {"commit": commit.stdout.strip() or "unknown", "command": command,
            "date": time.strftime("%Y-%m-%dT%H:%M:%S%z"), "number": len(rows),
            "caught": sum(row["caught"] for row in rows), "mutants": rows}


def chosen(mutants: list[Mutant], quick: bool, names: list[str]) -> list[Mutant]:
    unknown = set(names) - {mutant.id for mutant in mutants}
    if unknown:
        raise ManifestError(f"--only {', '.join(sorted(unknown))}: no such fault; see tests/mutation/mutants")
    picked = [mutant for mutant in mutants if (mutant.quick or not quick) and (mutant.id in names or not names)]
    if not picked:
        raise ManifestError("no fault is chosen")
    return picked


@contextmanager
def only_run() -> Iterator[None]:
    """Waits until no other run of this program works on the copy of the sources."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    with (FOLDER / "lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print("waiting for another run to end", file=sys.stderr, flush=True)
            fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def write_whole_tree(everything: list[Mutant]) -> dict[str, Detector]:
    """The copy of the sources with all faults; every detector by its text. Throws ManifestError."""
    detectors = {text: Detector(text) for mutant in everything for text in mutant.caught_by}
    for detector in detectors.values():
        detector.check()
    write_tree(everything, {detector.test_file for detector in detectors.values() if detector.test_file}
               | {"tests/mpi/main.cpp"})
    return detectors


def parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python3 -m tests.mutation", description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="only the faults marked quick")
    parser.add_argument("--only", metavar="ID", action="append", default=[], help="only this fault; may be repeated")
    parser.add_argument("--jobs", type=int, default=2, help="detectors and compilers side by side (default 2)")
    parser.add_argument("--out", type=Path, help="JSON file of the results (default reports/published/mutation.json "
                        "for all faults, build/mutation/part.json for some)")
    return parser.parse_args()


def main() -> int:
    arguments = parsed()
    everything = read_manifests()
    mutants = chosen(everything, arguments.quick, arguments.only)
    detectors = write_whole_tree(everything)
    needed = list(dict.fromkeys(text for mutant in mutants for text in mutant.caught_by))
    targets = {"mappm", "mappm-reference"}.union(*(detectors[text].targets for text in needed))
    print(f"building {', '.join(sorted(targets))} with {len(everything)} sleeping faults", file=sys.stderr, flush=True)
    build_tree(sorted(targets), arguments.jobs)
    assert_sleeping_faults_change_no_bit()
    alone = baseline(needed, arguments.jobs)
    useless = [f"{text}: {result.message}" for text, result in alone.items() if not result.passed]
    outcomes = hunt_all(mutants, alone, arguments.jobs)
    print(table(outcomes))
    if useless:
        print("no detectors, as they do not pass without a fault:\n" + "\n".join(useless))
    out = arguments.out or (PUBLISHED if len(mutants) == len(everything) else FOLDER / "part.json")
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(json.dumps(record(outcomes), indent=1) + "\n")
    return 0 if all(outcome.caught for outcome in outcomes) and not useless else 1


if __name__ == "__main__":
    try:
        with only_run():
            sys.exit(main())
    except (ManifestError, BuildError, SolverError) as error:
        print(f"mutation: {error}", file=sys.stderr)
        sys.exit(2)
