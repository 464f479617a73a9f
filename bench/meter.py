"""What the benchmarks share: rounds of runs in turn, medians, the command line, and figures on their way to the store."""

import argparse
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, TypeVar

from reference.scripted import Failed
from verification.protocol.errors import SolverError, StoreError
from verification.protocol.machine import ROOT
from verification.store.figures import Figures, Setting, words_of
from verification.store.laboratory import Laboratory, made_now
from verification.store.store import Figure, Made

LABORATORY = ROOT / "runs"
AddOptions = Callable[[argparse.ArgumentParser], None]


class Broken(RuntimeError):
    """A measurement that is none."""


@dataclass(frozen=True)
class Speed:
    """Of one run: particle-steps a second of wall time, start and output left out."""

    rate: float
    digest: str = ""
    phases: dict[str, float] | None = None  # wall seconds


Key, Timed = TypeVar("Key"), TypeVar("Timed", bound=Speed)


class Meter:
    """Rounds of runs: each round makes every run once, in turn."""

    def __init__(self, repeats: int, say: Callable[[str], None]):
        self.repeats, self.say = repeats, say

    def rounds(self, name: str, runs: dict[Key, Callable[[], Timed]]) -> dict[Key, list[Timed]]:
        found: dict[Key, list[Timed]] = {key: [] for key in runs}
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


@dataclass(frozen=True)
class Spread:
    """Of the same figure over rounds: its median, the lowest and the highest."""

    value: float
    low: float
    high: float

    def times(self, factor: float) -> "Spread":
        """By a factor above 0."""
        return Spread(factor * self.value, factor * self.low, factor * self.high)


def spread_of(values: Iterable[float]) -> Spread:
    found = list(values)
    return Spread(statistics.median(found), min(found), max(found))


def rate_of(speeds: list[Speed]) -> Spread:
    return spread_of(speed.rate for speed in speeds)


def ratio_of(over: list[Speed], under: list[Speed]) -> Spread:
    """Of the ratios within a round."""
    return spread_of(a.rate / b.rate for a, b in zip(over, under, strict=True))


@dataclass(frozen=True)
class Row:
    """A figure of a benchmark. The unit is empty for pure numbers: ratios, shares and counts."""

    name: str
    value: float
    unit: str
    settings: dict[str, Setting]
    low: float | None = None  # over the rounds; None for what was found once
    high: float | None = None


def row(name: str, value: float | Spread, unit: str = "", **settings: Setting) -> Row:
    if isinstance(value, Spread):
        return Row(name, value.value, unit, settings, value.low, value.high)
    return Row(name, value, unit, settings)


def entered(bench: str, rows: Iterable[Row], made: Made) -> Figures:
    """As the store keeps them."""
    return Figures(bench, [Figure(bench, one.settings, one.name, one.value, made, one.unit, one.low, one.high) for one in rows])


def shown(figures: Figures) -> Iterator[str]:
    """A line a figure: name, settings, value, range over the rounds, unit."""
    for one in figures.rows:
        yield " ".join(filter(None, (one.name, words_of(one.settings), one.words, one.unit)))


@dataclass(frozen=True)
class Printed:
    """A figure of a program of the build, which prints `figure OWNER.NAME VALUE` or `ratio OWNER.NAME VALUE`."""

    owner: tuple[str, ...]  # words between full stops, of fluids without their prefix
    name: str
    value: float


def printed(text: str) -> list[Printed]:
    """All that such a program printed; other lines are left out."""
    found = []
    for line in text.splitlines():
        kind, _, rest = line.partition(" ")
        if kind in ("figure", "ratio"):
            words, value = rest.rsplit(" ", 1)
            *owner, name = (word.removeprefix("fluid_") for word in words.split("."))
            found.append(Printed(tuple(owner), name, float(value)))
    return found


class Measure(Protocol):
    def __call__(self, quick: bool, repeats: int, folder: Path, say: Callable[[str], None],
                 **more: object) -> tuple[list[Row], str]:
        """Figures, and the commit they are of. Throws Broken, SolverError, Failed."""


def at_least(least: int) -> Callable[[str], int]:
    """Reads an integer of the command line."""

    def read(text: str) -> int:
        if not text.isdecimal() or int(text) < least:
            raise argparse.ArgumentTypeError(f"{text}: must be a number of at least {least}")
        return int(text)

    return read


def command_line(name: str, words: str, add_options: AddOptions, rounds: int) -> tuple[argparse.Namespace, str]:
    """Options as they are given or by default, and the command that means the same."""
    parser = argparse.ArgumentParser(prog=f"python3 -m bench.{name}", description=words,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    add_options(parser)
    parser.add_argument("--quick", action="store_true", help="small scenes, which take seconds: to see that all works")
    parser.add_argument("--repeats", type=at_least(1), help=f"rounds, at least 1; default {rounds}, with --quick 1")
    parser.add_argument("--lab", type=Path, metavar="DIR",
                        help="laboratory whose store keeps the figures (default: runs of this checkout; with --quick none)")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder of the runs (default: one that is removed)")
    options = parser.parse_args()
    options.repeats = options.repeats or (1 if options.quick else rounds)
    options.lab = options.lab or (None if options.quick else LABORATORY)
    options.more = {key: value for key, value in vars(options).items() if key not in ("quick", "repeats", "lab", "out")}
    more = "".join(f" --{key} {value}" for key, value in options.more.items())
    return options, f"python3 -m bench.{name}{more}{' --quick' if options.quick else ''} --repeats {options.repeats}"


def run_benchmark(name: str, words: str, measure: Measure, add_options: AddOptions = lambda parser: None, rounds: int = 7) -> int:
    """Reads the command line of `python3 -m bench.NAME`, measures, prints the figures and enters them into the store of the
    laboratory. Options that are added go to `measure` by their names. 1 where a measurement is broken."""
    options, command = command_line(name, words, add_options, rounds)
    with tempfile.TemporaryDirectory() as scratch:
        try:
            store = Laboratory(options.lab).store if options.lab else None
            rows, commit = measure(options.quick, options.repeats, options.out or Path(scratch),
                                   lambda text: print(text, file=sys.stderr, flush=True), **options.more)
            figures = entered(name, rows, made_now(command, commit))
            print("\n".join(shown(figures)), flush=True)
            if store:
                store.enter_figures(figures.rows)
        except (Broken, SolverError, Failed, StoreError) as error:
            print(f"{name}: {error}", file=sys.stderr)
            return 1
    return 0
