"""The equivalence matrix of a case: one scene run in every way that must give the same bits.

    [case.equivalence]
    steps = 1000        # of each run
    every = 50          # steps between comparisons of digests
    variants = ["serial", "P=2", "domains 2x2", ...]

A variant is made of these words, in any order; it runs on as many ranks as its words imply, or else on one, or, to have
a border at all, on two with `rebalance` and `build`.

    serial             the serial reference, alone or with `all-pairs` (its search without cells) and `build`
    P=3                ranks of the parallel solver, by default slabs along the longest side
    domains 2x2        grid of domains along x, y (and z)
    threads 2          of each rank
    rebalance 100      steps between moves of the borders to the particle load
    build clang        programs of that preset
    isa avx2           instruction set of a build that holds several: `build portable isa avx2`
    restart 2->3       half of the steps on 2 ranks, the rest on 3, from a checkpoint; stands alone

The first variant is what the others are held against.
"""

import math
import re
import shutil
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from verification.codes.mappm import INSTRUCTION_SETS, Options, best_instruction_set, program, run
from verification.protocol.errors import SolverError, refuse
from verification.protocol.machine import ROOT, cores
from verification.protocol.series import Table, first_difference

UNCHANGED, CHANGED = "UNCHANGED", "CHANGED"
WORDS = "serial, all-pairs, P=N, domains AxB, threads N, rebalance N, build PRESET, isa SET, restart A->B"


@dataclass(frozen=True)
class Variant:
    label: str
    options: Options
    resumed_on: int | None = None  # ranks of the second half of a restarted run

    @property
    def alone(self) -> bool:
        """Runs on one core."""
        return max(self.options.ranks, self.resumed_on or 1) * (self.options.threads or 1) <= 1


@dataclass(frozen=True)
class Equivalence:
    steps: int
    every: int
    variants: tuple[Variant, ...]


@dataclass(frozen=True)
class Row:
    """One variant: its digest at the end, or why it was skipped; the first sample that differs from the first variant."""

    variant: str
    digest: str = ""
    skipped: str = ""
    difference: int | None = None  # step
    samples: int = 0

    @property
    def equal(self) -> bool:
        return not self.skipped and self.difference is None

    @property
    def line(self) -> str:
        if self.skipped:
            return f"{self.variant:26} skipped: {self.skipped}"
        verdict = f"equal at all {self.samples} samples" if self.equal else f"differs from step {self.difference} on"
        return f"{self.variant:26} {self.digest}  {verdict}"


@dataclass(frozen=True)
class Matrix:
    rows: tuple[Row, ...]

    @property
    def equal(self) -> bool:
        """No variant that was run differs; at least two were run. One that was skipped says so in its row."""
        compared = [row for row in self.rows if not row.skipped]
        return len(compared) > 1 and all(row.equal for row in compared)

    @property
    def verdict(self) -> str:
        skipped = sum(bool(row.skipped) for row in self.rows)
        text = f"{UNCHANGED if self.equal else CHANGED}: {len(self.rows) - skipped} variants"
        return f"{text}, {skipped} skipped" if skipped else text

    @property
    def lines(self) -> list[str]:
        return [*(row.line for row in self.rows), self.verdict]


def _variant(label: str, where: str, key: str) -> Variant:
    words, given = label.split(), {}
    wrong = partial(refuse, where, key, label)

    def number(text: str) -> int:
        if not re.fullmatch(r"[1-9][0-9]{0,5}", text):
            wrong(f"{text!r} is no positive number")
        return int(text)

    while words:
        word = words.pop(0)
        name = "P" if word.startswith("P=") else word
        if name in given:
            wrong(f"{name} stands twice; remove one")
        if name in ("serial", "all-pairs"):
            given[name] = ""
        elif name == "P":
            given[name] = word[2:]
        elif name in ("domains", "threads", "rebalance", "build", "isa", "restart") and words:
            given[name] = words.pop(0)
        else:
            wrong(f"{word!r} is unknown or lacks its value; words are {WORDS}")
    if not given:
        wrong(f"is empty; words are {WORDS}")

    if "restart" in given:
        ranks = re.fullmatch(r"(\d+)->(\d+)", given["restart"])
        if len(given) > 1 or not ranks:
            wrong("restart stands alone, as in 'restart 2->3'")
        return Variant(label, Options(ranks=number(ranks[1])), resumed_on=number(ranks[2]))
    build = ROOT / "build" / given["build"] if "build" in given else None
    if "serial" in given:
        if not given.keys() <= {"serial", "all-pairs", "build"}:
            wrong("the serial reference goes with all-pairs and build only")
        return Variant(label, Options(ranks=0, neighbours="all-pairs" if "all-pairs" in given else None, build=build))
    if "all-pairs" in given:
        wrong("all-pairs is a search of the serial reference; write 'serial all-pairs'")
    isa = given.get("isa")
    if isa is not None and (isa not in INSTRUCTION_SETS or build is None):
        wrong(f"isa is one of {', '.join(INSTRUCTION_SETS)}, and goes with a build, as in 'build portable isa plain'")
    domains = given.get("domains")
    if domains is not None and not re.fullmatch(r"[1-9]\d*(x[1-9]\d*){1,2}", domains):
        wrong(f"{domains!r} is no grid; write domains along each axis, as in 2x2")
    implied = math.prod(map(int, domains.split("x"))) if domains else 2 if {"rebalance", "build"} & given.keys() else 1
    ranks = number(given["P"]) if "P" in given else implied
    if domains and ranks != implied:
        wrong(f"{domains} are {implied} domains, not {ranks}; write P={implied} or leave P out")
    optional = {key: number(given[key]) for key in ("threads", "rebalance") if key in given}
    return Variant(label, Options(ranks=ranks, domains=domains, build=build, isa=isa, **optional))


def read_equivalence(table: dict, where: str) -> Equivalence:
    """The table [case.equivalence]; `where` is its place, "file: case.equivalence". Throws CaseError."""
    if not isinstance(table, dict):
        refuse(where.rpartition(".")[0], where.rpartition(".")[2], table, "must be a table")
    known = ("steps", "every", "variants")
    for key in table:
        if key not in known:
            refuse(where, key, table[key], f"unknown; known are {', '.join(known)}")
    for key in known:
        if key not in table:
            refuse(where, key, None, "missing; add it")
    steps, every, labels = (table[key] for key in known)
    for key, value in (("steps", steps), ("every", every)):
        if not isinstance(value, int) or isinstance(value, bool) or value < 1:
            refuse(where, key, value, "must be a positive whole number of steps")
    if steps % every:
        refuse(where, "every", every, f"must divide steps = {steps}, so that the end is compared")
    if not isinstance(labels, list) or not all(isinstance(label, str) for label in labels) or len(labels) < 2:
        refuse(where, "variants", labels, f"must be a list of at least two texts; words are {WORDS}")
    for index, label in enumerate(labels):
        if label in labels[:index]:
            refuse(where, f"variants[{index}]", label, "stands twice; remove one")
    variants = tuple(_variant(label, where, f"variants[{index}]") for index, label in enumerate(labels))
    if any(variant.resumed_on for variant in variants) and steps < 2:
        refuse(where, "steps", steps, "must be at least 2 for a restart in the middle")
    return Equivalence(steps, every, variants)


def _series(scene: Path, variant: Variant, steps: int, every: int, folder: Path) -> Table:
    options = replace(variant.options, steps=steps, overrides=(f"output.sample={every}",))
    if variant.resumed_on is None:
        return run(scene, folder, options).series
    middle = steps // 2
    run(scene, folder, replace(options, steps=middle, overrides=(*options.overrides, f"output.checkpoint={middle}")))
    (checkpoint,) = (folder / "checkpoints").iterdir()
    return run(scene, folder, replace(options, ranks=variant.resumed_on, resume=checkpoint)).series


def obstacle(variant: Variant) -> str:
    """Why it cannot be run here; empty where it can."""
    name, build, isa = "mappm" if variant.options.ranks else "mappm-reference", variant.options.build, variant.options.isa
    try:
        program(name, build)
    except SolverError:
        if build is None:
            return "the programs are not built; ./check builds them"
        return f"not built; cmake --preset {build.name} && cmake --build --preset {build.name} --target {name}"
    if isa and INSTRUCTION_SETS.index(isa) > INSTRUCTION_SETS.index(best_instruction_set(build)):
        return f"this processor has no {isa}"
    return ""


def _row(variant: Variant, series: Table, reference: Table) -> Row:
    difference = first_difference({"reference": reference, variant.label: series})
    return Row(variant.label, str(series["digest"][-1]), difference=difference and difference[0], samples=len(series))


def run_matrix(scene: Path, equivalence: Equivalence, out: Path, say: Callable[[str], None] = print) -> Matrix:
    """Runs every variant in a folder of its own under `out`, which is emptied before, and says each row as it comes: first those
    of one core, as many at a time as there are cores, then the others one after another.
    A run that fails is a SolverError; a variant whose programs are not built, or not for this processor, is skipped, and
    so not equal."""
    shutil.rmtree(out, ignore_errors=True)
    skipped = [obstacle(variant) for variant in equivalence.variants]
    if skipped[0]:
        raise SolverError(f"{equivalence.variants[0].label}: {skipped[0]}")  # nothing to compare with

    def series_of(index: int) -> Table:
        return _series(scene, equivalence.variants[index], equivalence.steps, equivalence.every, out / str(index))

    with ThreadPoolExecutor(cores()) as pool:  # which ends when all of them have
        alone = {index: pool.submit(series_of, index) for index, variant in enumerate(equivalence.variants)
                 if variant.alone and not skipped[index]}
    rows: list[Row] = []
    reference: Table | None = None
    for index, (variant, why) in enumerate(zip(equivalence.variants, skipped, strict=True)):
        if why:
            rows.append(Row(variant.label, skipped=why))
        else:
            series = alone[index].result() if index in alone else series_of(index)
            reference = series if reference is None else reference
            rows.append(_row(variant, series, reference))
        say(rows[-1].line)
    return Matrix(tuple(rows))
