"""Are the bits equal? Runs one scene in several ways and compares the digests of every sample; where they differ, finds
the first step, particle, field and pair."""

import csv
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path

from verification.bits.states import Difference, difference, read_state
from verification.codes.mappm import Options, run
from verification.protocol.run import Run
from verification.protocol.series import first_difference


@dataclass(frozen=True)
class VariantRun(Run):
    """A run, and the options that it was made with."""

    options: Options


def run_variant(scene: Path, out: Path, options: Options) -> VariantRun:
    return VariantRun(run(scene, out, options).folder, options)


@dataclass(frozen=True)
class Comparison:
    runs: tuple[VariantRun, ...]
    difference: tuple[int, dict[str, str]] | None

    @property
    def equal(self) -> bool:
        return self.difference is None

    @property
    def lines(self) -> list[str]:
        if self.difference is not None:
            step, digests = self.difference
            return [f"first difference at step {step}:", *(f"  {digest}  {name}" for name, digest in digests.items())]
        series = self.runs[0].series
        names = "; ".join(finished.options.label for finished in self.runs)
        return [f"equal at all {len(series)} samples up to step {int(series['step'][-1])}, "
                f"digest {series['digest'][-1]}: {names}"]

    @property
    def unequal_pair(self) -> tuple[VariantRun, VariantRun]:
        """The first run and the first other one whose digest is not the same where they first differ."""
        digests = self.difference[1]
        first = self.runs[0]
        other = next(r for r in self.runs if digests[r.options.label] != digests[first.options.label])
        return first, other


def compare(scene: Path, out: Path, variants: list[Options]) -> Comparison:
    """Runs every variant in a folder of its own under `out`; their labels must differ."""
    runs = tuple(run_variant(scene, out / str(i), options) for i, options in enumerate(variants))
    return compare_runs(runs)


def compare_runs(runs: tuple[VariantRun, ...]) -> Comparison:
    tables = {finished.options.label: finished.series for finished in runs}
    if len(tables) != len(runs):
        raise ValueError("two runs of a comparison share a label")
    return Comparison(runs, first_difference(tables))


@dataclass(frozen=True)
class PairDifference:
    """One entry of two traces that is not the same: partner ("PP 7", "FP 2:31") and what differs."""

    partner: str
    fields: dict[str, tuple[str, str]]  # integers of the one and the other by field; empty where one has no such pair
    counts: tuple[int, int]  # how often each has it

    @property
    def lacks(self) -> bool:
        return self.counts[0] != self.counts[1]

    def line(self, names: tuple[str, str]) -> str:
        if self.lacks:
            what = f"{self.counts[0]} times | {self.counts[1]} times"
        else:
            what = ", ".join(f"{field} {one} | {other}" for field, (one, other) in self.fields.items())
        return f"{names[0]} | {names[1]}: pair with {self.partner}: {what}"


@dataclass(frozen=True)
class Explanation:
    """Where two variants part: the first step whose states differ, what differs there, and the pairs of the step that led
    to it: those of a PP for which one variant lacks a pair, if one is found, else of the first PP."""

    names: tuple[str, str]
    step: int
    difference: Difference
    particle: int | None = None
    traced: int | None = None
    pairs: tuple[PairDifference, ...] = ()
    at_start: bool = False

    @property
    def lines(self) -> list[str]:
        counts = f"{len(self.difference.particles)} particles, {len(self.difference.solids)} solids differ"
        lines = [f"first divergent step {self.step}: {counts}"]
        if self.particle is not None:
            lines[0] += f"; first PP {self.particle}, fields {', '.join(self.difference.particles[self.particle])}"
        for solid, fields in list(self.difference.solids.items())[:3]:
            lines.append(f"solid {solid}: fields {', '.join(fields)}")
        if not self.difference.any:
            lines.append("two more runs of the variants agree: one of them is not the same from run to run")
        elif self.at_start:
            lines.append("the states differ before the first step: they were built or read differently")
        elif self.particle is not None and self.pairs:
            if self.traced != self.particle:
                lines.append(f"PP {self.traced} lacks pairs; a missing neighbour is missing from densities too, and so shows in other pairs:")
            lines += [pair.line(self.names) for pair in self.pairs]
        elif self.particle is not None:
            lines.append(f"all pairs of PP {self.particle} are equal: the difference arose after they were taken, where "
                         "they were summed or the PP was moved")
        return lines


def _trace(path: Path) -> dict[str, list[dict[str, str]]]:
    """Rows by partner."""
    rows: dict[str, list[dict[str, str]]] = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            partner = f"{row.pop('kind')} {row.pop('partner')}"
            rows.setdefault(partner, []).append({name: row[name] for name in row if name not in ("step", "particle")})
    return rows


def trace_differences(one: Path, other: Path) -> tuple[PairDifference, ...]:
    """Of two files trace.csv of one particle and step."""
    a, b = _trace(one), _trace(other)
    found = []
    for partner in dict.fromkeys([*a, *b]):
        of_a, of_b = a.get(partner, []), b.get(partner, [])
        if Counter(map(str, of_a)) == Counter(map(str, of_b)):
            continue
        fields = {}
        if of_a and of_b:
            fields = {name: (of_a[0][name], of_b[0][name]) for name in of_a[0] if of_a[0][name] != of_b[0][name]}
        found.append(PairDifference(partner, fields, (len(of_a), len(of_b))))
    return tuple(sorted(found, key=lambda pair: not pair.lacks))


def _rerun(scene: Path, out: Path, pair: tuple[VariantRun, VariantRun], name: str, changes: dict, *overrides: str) -> list[VariantRun]:
    """Both variants from the start: borders of domains depend on where a run began, and a fault may depend on them."""
    runs = []
    for which, finished in zip(("one", "other"), pair, strict=True):
        options = replace(finished.options, **changes, overrides=(*finished.options.overrides, *overrides))
        runs.append(run_variant(scene, out / f"{name}-{which}", options))
    return runs


SUSPECTS = 12


def _suspects(found: Difference) -> list[int]:
    """Some of the PPs that differ, the first among them."""
    ids = [i for i, fields in found.particles.items() if fields != ("existence",)]
    return ids[:: max(1, -(-len(ids) // SUSPECTS))]


def explain(scene: Path, out: Path, comparison: Comparison) -> Explanation:
    """Runs the two variants again, in folders under `out`: to find the step, to keep the states there, and to trace the
    first particle."""
    pair = comparison.unequal_pair
    names = pair[0].options.label, pair[1].options.label
    quiet = ("output.snapshot=0", "output.solids=false")
    runs = _rerun(scene, out, pair, "steps", {"steps": comparison.difference[0]}, "output.sample=1", *quiet)
    first = first_difference(dict(zip(names, (finished.series for finished in runs), strict=True)))
    if first is None:
        return Explanation(names, comparison.difference[0], Difference({}, {}))
    step = first[0]

    # A run has a checkpoint of its last step, but none of step 0: of that, what differs one step on is shown.
    end = max(step, 1)
    keep = (f"output.sample={end}", f"output.checkpoint={end}", *quiet)
    states = [
        read_state(next((finished.folder / "checkpoints").iterdir()))
        for finished in _rerun(scene, out, pair, "states", {"steps": end}, *keep)
    ]
    found = difference(*states)
    particle = next((i for i, fields in found.particles.items() if fields != ("existence",)), None)
    if particle is None or step == 0:
        return Explanation(names, step, found, particle, at_start=step == 0)

    traces: dict[int, tuple[PairDifference, ...]] = {}
    for suspect in _suspects(found):
        traced = {"steps": step, "trace": f"{suspect}@{step - 1}"}
        reruns = _rerun(scene, out, pair, "trace", traced, f"output.sample={step}", *quiet)
        traces[suspect] = trace_differences(*(finished.folder / "trace.csv" for finished in reruns))
        if not traces[suspect] or traces[suspect][0].lacks:  # either the pairs are not to blame, or this is the one
            return Explanation(names, step, found, particle, suspect, traces[suspect])
    return Explanation(names, step, found, particle, particle, traces[particle])
