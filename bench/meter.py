"""What the benchmarks share: rounds of runs in turn, medians, the command line, and the table of figures."""

import argparse
import json
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Protocol

from reference.scripted import Failed
from verification.protocol.errors import SolverError
from verification.protocol.machine import cores, processor


class Broken(RuntimeError):
    """A measurement that is none."""


@dataclass(frozen=True)
class Speed:
    """Of one run: particle-steps a second of wall time, start and output left out."""

    rate: float
    digest: str = ""
    phases: dict[str, float] | None = None  # wall seconds


class Meter:
    """Rounds of runs: each round makes every run once, in turn."""

    def __init__(self, repeats: int, say: Callable[[str], None]):
        self.repeats, self.say = repeats, say

    def rounds(self, name: str, runs: dict[str, Callable[[], Speed]]) -> dict[str, list[Speed]]:
        found: dict[str, list[Speed]] = {key: [] for key in runs}
        started = time.monotonic()
        for done in range(self.repeats):
            for key, once in runs.items():
                found[key].append(once())
            left = (time.monotonic() - started) * (self.repeats - done - 1) / (done + 1)
            self.say(f"{name}: round {done + 1} of {self.repeats}, {left:.0f} s left")
        for key, speeds in found.items():
            if len({speed.digest for speed in speeds}) > 1:
                raise Broken(f"{name}, {key}: rounds end with different digests")
        return found


def median_rate(speeds: list[Speed]) -> float:
    return statistics.median(speed.rate for speed in speeds)


def median_ratio(over: list[Speed], under: list[Speed]) -> float:
    return statistics.median(a.rate / b.rate for a, b in zip(over, under, strict=True))


class Measure(Protocol):
    def __call__(self, quick: bool, repeats: int, folder: Path, say: Callable[[str], None],
                 **more: object) -> tuple[dict[str, float], str]:
        """Figures by "ratio NAME" or "figure NAME", and the commit they are of. Throws Broken, SolverError, Failed."""


def keep(figures: dict[str, float], command: str, commit: str, file: Path | None) -> None:
    """Prints a line a figure; writes them to the file, if there is one, with where they come from."""
    for name, value in figures.items():
        print(f"{name} {value:.4g}")
    if file is None:
        return
    table = {"date": f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC", "command": command, "commit": commit,
             "host": f"{processor()}, {cores()} cores", "figures": figures}
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(table, indent=1) + "\n")


def run_benchmark(name: str, words: str, measure: Measure,
                  add_options: Callable[[argparse.ArgumentParser], None] = lambda parser: None, rounds: int = 7) -> int:
    """Reads the command line of `python3 -m bench.NAME`, measures, prints and keeps the figures. Options that are added go to
    `measure` by their names. 1 where a measurement is broken."""
    parser = argparse.ArgumentParser(prog=f"python3 -m bench.{name}", description=words,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="small scenes, which take seconds: to see that all works")
    parser.add_argument("--repeats", type=int, help=f"rounds, at least 1; default {rounds}, with --quick 1")
    parser.add_argument("--json", type=Path, help="also keep the figures in this file")
    parser.add_argument("--out", type=Path, help="folder of the runs (default: one that is removed)")
    add_options(parser)
    options = parser.parse_args()
    more = {key: value for key, value in vars(options).items() if key not in ("quick", "repeats", "json", "out")}
    repeats = options.repeats if options.repeats is not None else (1 if options.quick else rounds)
    if repeats < 1:
        parser.error(f"--repeats {repeats}: must be at least 1")
    with tempfile.TemporaryDirectory() as scratch:
        try:
            figures, commit = measure(options.quick, repeats, options.out or Path(scratch),
                                      lambda text: print(text, file=sys.stderr, flush=True), **more)
        except (Broken, SolverError, Failed) as error:
            print(f"{name}: {error}", file=sys.stderr)
            return 1
    added = "".join(f" --{key} {value}" for key, value in more.items())
    command = f"python3 -m bench.{name}{added}" + (" --quick" if options.quick else "")
    keep(figures, f"{command} --repeats {repeats}", commit, options.json)
    return 0
