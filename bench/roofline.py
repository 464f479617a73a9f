"""How near the pair pass is to what the machine can do: bounds from counted operations beside the time it takes.

    python3 -m bench.roofline [--quick] [--repeats N] [--json FILE]

Each round measures what a core can do at most (bench-machine_limits) and, at once, what the pass takes
(bench-pair_census) on a disordered fluid with 39 neighbours a particle in the plane and 77 in space. The census counts
candidates, blocks and lanes in the very lists of the pass, and the operations of a block in the law itself. Sorting and
the search for lists come once in a stay, some steps in which the PPs keep their order; all else in each step. A figure is
the median over the rounds, a ratio that of the ratios within a round; times are those that the thread computed.
Instructions a pair are counted under callgrind in the build of the preset avx2 (valgrind knows no AVX-512) and are the
same every time; without either they are left out. A line a figure, `ratio NAME VALUE` or `figure NAME VALUE`. Ends
with 1 where a measurement is broken, never because the machine is slow.
"""

import argparse
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from bench.meter import Broken, keep
from verification.codes.mappm import build_folder, program
from verification.protocol.errors import SolverError
from verification.protocol.machine import commit

FLUIDS = ("fluid_2d_39", "fluid_3d_77")
SIDES, QUICK_SIDES, COUNTED_SIDES = (320, 48), (64, 16), (128, 24)  # particles along a side, in the plane and in space
ROUNDS_A_CALL = 5  # of the census, whose fluid takes longer to make than to measure
PARTS = ("sort", "search", "lay_out", "distances", "whole_pass")  # of the census
NANO = 1e9

Figures = dict[str, float]


def figures_of(printed: str) -> Figures:
    """By "ratio NAME" or "figure NAME"."""
    lines = (line.rsplit(" ", 1) for line in printed.splitlines() if line.startswith(("figure ", "ratio ")))
    return {name: float(value) for name, value in lines}


def _printed(command: list[str]) -> str:
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise Broken(f"{' '.join(command)} ended with {done.returncode}: {done.stderr.strip()[-300:]}")
    return done.stdout


def census(build: Path, sides: tuple[int, int], rounds: int) -> list[str]:
    return [str(program("bench-pair_census", build)), *map(str, sides), str(rounds)]


def apart(taken: Figures) -> Figures:
    """What the parts of the census take, each less what it holds of another; sorting and search come before the pass."""
    return {
        "sort": taken["sort"],
        "search": taken["search"],
        "lay_out": taken["lay_out"],
        "distances": taken["distances"],
        "pairs": taken["whole_pass"] - taken["lay_out"] - taken["distances"],
        "pass": taken["whole_pass"],
    }


class Costs:
    """Of a fluid in one round: what its blocks ask a pair within the cutoff, and what the machine gives."""

    def __init__(self, figures: Figures, fluid: str):
        self.machine, self.own = ({name.partition(f" {owner}.")[2]: value for name, value in figures.items()
                                   if f" {owner}." in name} for owner in ("machine", fluid))
        self.lanes = self.machine["lanes"]

    def a_pair(self, count: str) -> float:
        """Registers of this kind, in distances and pairs of all blocks in the lists."""
        blocks = self.own["blocks_per_particle"] / self.own["pairs_per_particle"]
        return blocks * (self.own[f"block_distances.{count}"] + self.own[f"block_pairs.{count}"])

    @property
    def operations(self) -> float:
        """In floating point, a pair, those on idle lanes included."""
        return self.lanes * sum(self.a_pair(count) for count in ("multiplications", "additions", "roots"))

    def _bytes(self, *counts: str) -> float:
        return 8 * self.lanes * sum(self.a_pair(count) for count in counts)

    def bounds(self) -> Figures:
        """ns a pair that the pass cannot go below."""
        machine, memory = self.machine, self.own["bytes_per_particle_memory"] / self.own["pairs_per_particle"]
        multiplied, added = (self.lanes * self.a_pair(count) for count in ("multiplications", "additions"))
        return {
            "multiplications": NANO * multiplied / machine["multiplications_per_s"],
            "additions": NANO * added / machine["additions_per_s"],
            "both": NANO * (multiplied + added) / machine["multiplications_and_additions_per_s"],
            "roots": NANO * self.lanes * self.a_pair("roots") / machine["roots_per_s"],
            "integers": NANO * self.lanes * self.a_pair("integers") / machine["integer_additions_per_s"],
            "loads": NANO * self._bytes("loads") / machine["l1_load_bytes_per_s"],
            "stores": NANO * self._bytes("stores") / machine["l1_store_bytes_per_s"],
            "memory": NANO * memory / machine["memory_triad_bytes_per_s"],
        }

    def full_lanes(self) -> float:
        """ns a pair were there no candidate but the pairs, on full lanes: the highest bound of arithmetic."""
        kinds = ("multiplications", "additions", "roots")
        machine, own = self.machine, {kind: self.own[f"block_pairs.{kind}"] for kind in kinds}
        both = (own["multiplications"] + own["additions"]) / machine["multiplications_and_additions_per_s"]
        return NANO * max(both, *(count / machine[f"{kind}_per_s"] for kind, count in own.items()))

    def times(self) -> Figures:
        """ns a pair, measured."""
        return apart({part: self.own[f"ns_per_pair_{part}"] for part in PARTS})

    def derived(self, fluid: str) -> Figures:
        times, bounds = self.times(), self.bounds()
        highest, memory = max(bounds.values()), self.own["bytes_per_particle_memory"] / self.own["pairs_per_particle"]
        figures = {f"figure {fluid}.ns_per_pair_{part}": value for part, value in times.items()}
        figures |= {f"figure {fluid}.bound_ns_per_pair_{name}": value for name, value in bounds.items()}
        figures |= {
            f"figure {fluid}.bound_ns_per_pair_full_lanes": self.full_lanes(),
            f"figure {fluid}.operations_per_pair": self.operations,
            f"figure {fluid}.operations_per_s": self.operations / times["pass"] * NANO,
            f"figure {fluid}.operations_per_byte_memory": self.operations / memory,
            f"figure {fluid}.operations_per_byte_l1": self.operations / self._bytes("loads", "stores"),
            f"ratio {fluid}.pass_over_bound": times["pass"] / highest,
            f"ratio {fluid}.distances_and_pairs_over_bound": (times["distances"] + times["pairs"]) / highest,
            f"ratio {fluid}.bound_over_full_lanes": highest / self.full_lanes(),
        }
        return figures


def one_round(sides: tuple[int, int]) -> Figures:
    build = build_folder()
    figures = figures_of(_printed([str(program("bench-machine_limits", build))]))
    figures |= figures_of(_printed(census(build, sides, ROUNDS_A_CALL)))
    measured = {name: value for name, value in figures.items() if "ns_per_pair_" not in name}
    for fluid in FLUIDS:
        measured |= Costs(figures, fluid).derived(fluid)
    return measured


def instructions(say: Callable[[str], None]) -> Figures:
    """A pair, part by part; of a small fluid, lanes of four. Nothing where valgrind or the build is missing."""
    build = build_folder().parent / "avx2"
    if not shutil.which("valgrind"):
        say("no instructions are counted: apt-get install valgrind")
        return {}
    if not (build / "bin" / "bench-pair_census").exists():
        say("no instructions are counted: cmake --preset avx2; cmake --build --preset avx2 --target bench-pair_census")
        return {}
    with tempfile.TemporaryDirectory() as scratch:
        kept = Path(scratch) / "callgrind.out"
        counted_run = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={kept}", *census(build, COUNTED_SIDES, 0)]
        figures = figures_of(_printed(counted_run))
        table = _printed(["callgrind_annotate", "--inclusive=yes", "--threshold=100", str(kept)])
    found = {}
    for fluid, dimension in zip(FLUIDS, (2, 3), strict=True):
        counted = {}
        for part in PARTS:
            line = re.search(rf"^ *([\d,]+) .*Parts<{dimension}>::{part}\(\)", table, re.MULTILINE)
            if not line:
                raise Broken(f"callgrind saw nothing of {part} in {fluid}")
            counted[part] = int(line[1].replace(",", "")) / figures[f"figure {fluid}.pairs"]
        found |= {f"figure {fluid}.instructions_per_pair_{part}": value for part, value in apart(counted).items()}
    return found


def measure(quick: bool, repeats: int, say: Callable[[str], None]) -> Figures:
    """Throws Broken, SolverError."""
    rounds = []
    for done in range(repeats):
        rounds.append(one_round(QUICK_SIDES if quick else SIDES))
        say(f"round {done + 1} of {repeats}")
    figures = {name: statistics.median(found[name] for found in rounds) for name in rounds[0]}
    for fluid in FLUIDS:
        if figures[f"figure {fluid}.pairs"] != rounds[-1][f"figure {fluid}.pairs"]:
            raise Broken(f"{fluid}: rounds count different pairs")
    return figures | instructions(say)


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m bench.roofline", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="small fluids, which take seconds: to see that all works")
    parser.add_argument("--repeats", type=int, help="rounds, at least 1; default 7, with --quick 1")
    parser.add_argument("--json", type=Path, help="also keep the figures in this file")
    options = parser.parse_args()
    repeats = options.repeats if options.repeats is not None else (1 if options.quick else 7)
    if repeats < 1:
        parser.error(f"--repeats {repeats}: must be at least 1")
    try:
        figures = measure(options.quick, repeats, lambda text: print(text, file=sys.stderr, flush=True))
    except (Broken, SolverError) as error:
        print(f"roofline: {error}", file=sys.stderr)
        return 1
    command = "python3 -m bench.roofline" + (" --quick" if options.quick else "") + f" --repeats {repeats}"
    keep(figures, command, commit(), options.json)
    return 0


if __name__ == "__main__":
    sys.exit(main())
