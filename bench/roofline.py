"""How near the pair pass is to what the machine can do: bounds from counted operations beside the time it takes.

    python3 -m bench.roofline [--quick] [--repeats N] [--lab DIR]

Each round measures what a core can do at most (bench-machine_limits) and, at once, what the pass takes
(bench-pair_census) on a disordered fluid with 39 neighbours a particle in the plane and 77 in space. The census counts
candidates, blocks and lanes in the very lists of the pass, and the operations of a block in the law itself. Sorting and
the search for lists come once in a stay, some steps in which the PPs keep their order; all else in each step. A figure is
the median over the rounds, a ratio that of the ratios within a round; times are those that the thread computed.
Instructions a pair are counted under callgrind in the build of the preset avx2 (valgrind knows no AVX-512) and are the
same every time; without either they are left out. A line a figure: name, settings, value, unit. Ends
with 1 where a measurement is broken, never because the machine is slow.
"""

import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from bench.meter import Broken, Printed, Row, printed, row, run_benchmark, spread_of
from verification.codes.mappm import build_folder, program
from verification.protocol.machine import commit
from verification.store.figures import words_of

FLUIDS = ("2d_39", "3d_77")
SIDES, QUICK_SIDES, COUNTED_SIDES = (320, 48), (64, 16), (128, 24)  # particles along a side, in the plane and in space
ROUNDS_A_CALL = 5  # of the census, whose fluid takes longer to make than to measure
PARTS = ("sort", "search", "lay_out", "distances", "whole_pass")  # of the census
BLOCKS = ("distances", "pairs")  # parts whose work it counts
NANO = 1e9

Named = dict[str, float]  # by the names that the programs print


def _output_of(command: list[str]) -> str:
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise Broken(f"{' '.join(command)} ended with {done.returncode}: {done.stderr.strip()[-300:]}")
    return done.stdout


def census(build: Path, sides: tuple[int, int], rounds: int) -> list[str]:
    return [str(program("bench-pair_census", build)), *map(str, sides), str(rounds)]


def apart(taken: Named) -> Named:
    """What the parts of the census take, each less what it holds of another; sorting and search come before the pass."""
    return {
        "sort": taken["sort"],
        "search": taken["search"],
        "lay_out": taken["lay_out"],
        "distances": taken["distances"],
        "pairs": taken["whole_pass"] - taken["lay_out"] - taken["distances"],
        "pass": taken["whole_pass"],
    }


@dataclass(frozen=True)
class Costs:
    """Of a fluid in one round: what its blocks ask a pair within the cutoff, and what the machine gives."""

    machine: Named
    own: Named
    blocks: dict[str, Named]  # of each part of the pass: registers of each kind in a block

    @property
    def lanes(self) -> float:
        return self.machine["lanes"]

    def a_pair(self, count: str) -> float:
        """Registers of this kind, in distances and pairs of all blocks in the lists."""
        blocks = self.own["blocks_per_particle"] / self.own["pairs_per_particle"]
        return blocks * (self.blocks["distances"][count] + self.blocks["pairs"][count])

    @property
    def operations(self) -> float:
        """In floating point, a pair, those on idle lanes included."""
        return self.lanes * sum(self.a_pair(count) for count in ("multiplications", "additions", "roots"))

    def _bytes(self, *counts: str) -> float:
        return 8 * self.lanes * sum(self.a_pair(count) for count in counts)

    def bounds(self) -> Named:
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
        machine, own = self.machine, {kind: self.blocks["pairs"][kind] for kind in kinds}
        both = (own["multiplications"] + own["additions"]) / machine["multiplications_and_additions_per_s"]
        return NANO * max(both, *(count / machine[f"{kind}_per_s"] for kind, count in own.items()))

    def times(self) -> Named:
        """ns a pair, measured."""
        return apart({part: self.own[f"ns_per_pair_{part}"] for part in PARTS})

    def counted_rows(self, fluid: str) -> list[Row]:
        """As the census prints them, but for times."""
        timed = {f"ns_per_pair_{part}" for part in PARTS}
        rows = [row(name, value, unit_of(name), fluid=fluid) for name, value in self.own.items() if name not in timed]
        return rows + [row("registers_per_block", count, fluid=fluid, part=part, kind=kind)
                       for part, counts in self.blocks.items() for kind, count in counts.items()]

    def derived_rows(self, fluid: str) -> list[Row]:
        times, bounds = self.times(), self.bounds()
        highest, memory = max(bounds.values()), self.own["bytes_per_particle_memory"] / self.own["pairs_per_particle"]
        limits = bounds | {"full_lanes": self.full_lanes()}
        return [
            *(row("ns_per_pair", value, "ns", fluid=fluid, part=part) for part, value in times.items()),
            *(row("bound_ns_per_pair", value, "ns", fluid=fluid, limit=limit) for limit, value in limits.items()),
            row("operations_per_pair", self.operations, fluid=fluid),
            row("operations_per_s", self.operations / times["pass"] * NANO, "1/s", fluid=fluid),
            row("operations_per_byte_memory", self.operations / memory, "1/B", fluid=fluid),
            row("operations_per_byte_l1", self.operations / self._bytes("loads", "stores"), "1/B", fluid=fluid),
            row("pass_over_bound", times["pass"] / highest, fluid=fluid),
            row("distances_and_pairs_over_bound", (times["distances"] + times["pairs"]) / highest, fluid=fluid),
            row("bound_over_full_lanes", highest / self.full_lanes(), fluid=fluid),
        ]


def unit_of(name: str) -> str:
    """Of a figure of the census or of the limits of the machine, whose names end with it or begin with bytes."""
    if name.endswith("_per_s"):
        return "B/s" if name.endswith("bytes_per_s") else "1/s"
    return "B" if name.startswith("bytes_") else ""


def costs_of(found: list[Printed]) -> dict[str, Costs]:
    """By the fluid."""

    def named(*owner: str) -> Named:
        return {one.name: one.value for one in found if one.owner == owner}

    return {fluid: Costs(named("machine"), named(fluid), {part: named(fluid, f"block_{part}") for part in BLOCKS}) for fluid in FLUIDS}


def one_round(sides: tuple[int, int]) -> list[Row]:
    build = build_folder()
    limits = printed(_output_of([str(program("bench-machine_limits", build))]))
    fluids = costs_of(limits + printed(_output_of(census(build, sides, ROUNDS_A_CALL))))
    rows = [row(one.name, one.value, unit_of(one.name)) for one in limits]
    for fluid, costs in fluids.items():
        rows += costs.counted_rows(fluid) + costs.derived_rows(fluid)
    return rows


def instructions(say: Callable[[str], None]) -> list[Row]:
    """A pair, part by part; of a small fluid, lanes of four. Nothing where valgrind or the build is missing."""
    build = build_folder().parent / "avx2"
    if not shutil.which("valgrind"):
        say("no instructions are counted: apt-get install valgrind")
        return []
    if not (build / "bin" / "bench-pair_census").exists():
        say("no instructions are counted: cmake --preset avx2; cmake --build --preset avx2 --target bench-pair_census")
        return []
    with tempfile.TemporaryDirectory() as scratch:
        kept = Path(scratch) / "callgrind.out"
        counted_run = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={kept}", *census(build, COUNTED_SIDES, 0)]
        fluids = costs_of(printed(_output_of(counted_run)))
        table = _output_of(["callgrind_annotate", "--inclusive=yes", "--threshold=100", str(kept)])
    rows = []
    for fluid, dimension in zip(FLUIDS, (2, 3), strict=True):
        counted = {}
        for part in PARTS:
            line = re.search(rf"^ *([\d,]+) .*Parts<{dimension}>::{part}\(\)", table, re.MULTILINE)
            if not line:
                raise Broken(f"callgrind saw nothing of {part} in {fluid}")
            counted[part] = int(line[1].replace(",", "")) / fluids[fluid].own["pairs"]
        rows += [row("instructions_per_pair", value, fluid=fluid, part=part) for part, value in apart(counted).items()]
    return rows


def median_rows(rounds: list[list[Row]]) -> list[Row]:
    """Throws Broken where rounds count different pairs."""
    rows = []
    for same in zip(*rounds, strict=True):
        values = [one.value for one in same]
        if same[0].name == "pairs" and len(set(values)) > 1:
            raise Broken(f"{words_of(same[0].settings)}: rounds count different pairs")
        rows.append(row(same[0].name, spread_of(values), same[0].unit, **same[0].settings))
    return rows


def measure(quick: bool, repeats: int, folder: Path, say: Callable[[str], None]) -> tuple[list[Row], str]:
    """Figures, and the commit of these sources. Nothing is left in the folder. Throws Broken, SolverError."""
    rounds = []
    for done in range(repeats):
        rounds.append(one_round(QUICK_SIDES if quick else SIDES))
        say(f"round {done + 1} of {repeats}")
    return median_rows(rounds) + instructions(say), commit()


def main() -> int:
    return run_benchmark("roofline", __doc__, measure)


if __name__ == "__main__":
    sys.exit(main())
