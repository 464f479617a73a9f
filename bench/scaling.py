"""How the solver scales over processes: the same fluid on more of them, more fluid on more of them, what they send each other.

    python3 -m bench.scaling [--quick] [--processes N] [--repeats N] [--lab DIR] [--out DIR]

The fluids are those of bench.speed. Every run of a fluid must end with the digest of one process, be it on 2 or on 64: 64 are run
on the cores there are, with discs across their borders too, for the sake of the exchange and not of the time. The last
run of all is the paper's system at full size, 5.56 million PPs and 1024 discs. Prints a line a figure: name, settings, value, unit; efficiencies are ratios of runs within
one round. Ends with 1 where a measurement is broken, never because the machine is slow.
"""

import argparse
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from bench.codes import SCENE
from bench.meter import Broken, Row, Spread, at_least, row, run_benchmark, spread_of
from bench.speed import scene_of
from verification.codes.mappm import Options, run
from verification.protocol.machine import ROOT, cores
from verification.protocol.run import Run
from verification.store.figures import Setting

PAPER = ROOT / "cases" / "gas_solid_paper" / "case.toml"
NO_PHASES = ("output", "steps")  # of the seconds in run.json
MANY = 64  # processes, on however few cores
STRONG = {"2d": (1000, 1000), "3d": (80, 80, 80)}  # particles along the sides
QUICK_STRONG = {"2d": (100, 100), "3d": (18, 18, 18)}
WEAK, QUICK_WEAK = 316, 50  # in the plane: particles along the side of one process' square


@dataclass(frozen=True)
class Point:
    """Of one run, per step: seconds by phase on the slowest process, and what the busiest one sent."""

    name: str
    processes: int
    particles: int
    phases: dict[str, float]
    messages: float
    bytes: float
    digest: str

    @property
    def seconds(self) -> float:
        return self.phases["steps"]

    @property
    def work(self) -> float:
        return sum(seconds for name, seconds in self.phases.items() if name not in ("exchange", "copies", "output", "steps"))


def point_of(name: str, finished: Run) -> Point:
    record = finished.record
    steps = record["steps"] - record["first_step"]
    phases = {phase: seconds / steps for phase, seconds in record["wall_seconds"].items()}
    sent = record["exchange"]
    return Point(name, record["ranks"], record["particles"], phases, sent["messages_per_step"], sent["bytes_per_step"],
                 record["digest"])


def median_of(points: list[Point]) -> Point:
    """The one of the median time."""
    return sorted(points, key=lambda point: point.seconds)[len(points) // 2]


def doubled(most: int) -> list[int]:
    """1, 2, 4, ... up to `most`."""
    return [1 << power for power in range(most.bit_length()) if 1 << power <= most]


class Runner:
    def __init__(self, folder: Path, repeats: int, say: Callable[[str], None]):
        self.folder, self.repeats, self.say = folder, repeats, say

    def once(self, name: str, sides: tuple[int, ...], steps: int, options: Options) -> Point:
        chosen = Options(ranks=options.ranks, domains=options.domains, steps=steps, overrides=scene_of(len(sides), sides))
        return point_of(name, run(SCENE, self.folder / "fluid", chosen))

    def rounds(self, name: str, runs: dict[int, Callable[[], Point]]) -> dict[int, list[Point]]:
        """Each round makes every run once, in turn. By the number of processes."""
        found: dict[int, list[Point]] = {processes: [] for processes in runs}
        for done in range(self.repeats):
            for processes, once in runs.items():
                found[processes].append(once())
            self.say(f"{name}: round {done + 1} of {self.repeats}")
        return found


def require_one_digest(points: Iterable[Point]) -> None:
    by_digest = {point.digest: point for point in points}
    if len(by_digest) > 1:
        raise Broken(f"digests differ: {', '.join(f'{p.name} on {p.processes}: {d}' for d, p in by_digest.items())}")


def efficiency(found: dict[int, list[Point]], processes: int) -> Spread:
    """Median over the rounds of the rate of a process against that of one alone."""
    return spread_of(
        one.seconds / one.particles * some.particles / some.seconds / processes
        for one, some in zip(found[1], found[processes], strict=True)
    )


def rows_of(found: dict[int, list[Point]], **settings: Setting) -> list[Row]:
    """Per step, by the number of processes; times and messages of the slowest process."""
    rows = []
    for processes, points in found.items():
        point, here = median_of(points), settings | {"ranks": processes}
        rows.append(row("particle_steps_per_s", spread_of(one.particles / one.seconds for one in points), "1/s", **here))
        if processes > 1:
            rows += [row("efficiency", efficiency(found, processes), **here), *message_rows(point, here)]
        rows += [row("microseconds_per_step", 1e6 * seconds, "us", **here, phase=phase)
                 for phase, seconds in point.phases.items() if phase not in NO_PHASES]
    return rows


def message_rows(point: Point, settings: dict[str, Setting]) -> list[Row]:
    return [row("messages_per_step", point.messages, **settings), row("bytes_per_step", point.bytes, "B", **settings)]


def over_processes(runner: Runner, processes: int, quick: bool) -> list[Row]:
    """The same fluid on more of them, and more fluid on more of them."""
    counts, rows = doubled(processes), []
    for name, sides in (QUICK_STRONG if quick else STRONG).items():
        steps = 10 if quick else {"2d": 20, "3d": 12}[name]
        found = runner.rounds(f"strong {name}", {
            count: lambda n=name, s=sides, k=steps, c=count: runner.once(f"strong {n}", s, k, Options(ranks=c)) for count in counts
        })
        require_one_digest(point for points in found.values() for point in points)
        rows += rows_of(found, scaling="strong", fluid=name)
    side = QUICK_WEAK if quick else WEAK
    found = runner.rounds("weak 2d", {
        count: lambda c=count: runner.once("weak 2d", (side * c, side), 10 if quick else 150, Options(ranks=c)) for count in counts
    })
    return rows + rows_of(found, scaling="weak", fluid="2d")


def many_processes(runner: Runner, quick: bool) -> list[Row]:
    """Digests on 64 processes are those of one: of a fluid in slabs and in squares, and of discs that lie across borders."""
    sides, steps = ((6 * MANY, 32), 4) if quick else ((16 * MANY, 256), 20)
    layouts = [Options(ranks=1), Options(ranks=MANY, domains=f"{MANY}x1")] + ([] if quick else [Options(ranks=MANY, domains="16x4")])
    fluid = [runner.once("fluid", sides, steps, options) for options in layouts]
    require_one_digest(fluid)
    discs = []
    for ranks in (1, MANY):
        options = Options(ranks=ranks, steps=steps, overrides=(f"box.size=[22.0, {10.0 * MANY}]", f"body.0.array.count=[1, {MANY // 2}]",
                                                               "run.relax=0", "output.sample=1000000", "output.snapshot=1000000"))
        discs.append(point_of("discs", run(PAPER, runner.folder / "discs", options)))
    require_one_digest(discs)
    runner.say(f"{MANY} processes: digests {fluid[0].digest} of a fluid, {discs[0].digest} of discs in it, those of one")
    return [row("runs_of_equal_digest", len(fluid) + len(discs), ranks=MANY)]


def full_size(runner: Runner, processes: int, steps: int) -> list[Row]:
    """The paper's system: rate, and that its momentum is that of the forces to the last bit."""
    finished = run(PAPER, runner.folder / "full_size", Options(ranks=processes, steps=steps, overrides=("output.snapshot=1000000",)))
    record, ledger = finished.record, finished.record["momentum"]
    for start, end, impulse in zip(ledger["start"], ledger["end"], ledger["impulse"], strict=True):
        if int(end) - int(start) != int(impulse):
            raise Broken(f"full size: momentum grew by {int(end) - int(start)} quanta, forces gave {impulse}")
    point = point_of("full size", finished)
    here: dict[str, Setting] = {"system": "paper", "ranks": processes}
    return [
        row("particles", record["particles"], **here),
        row("solids", record["solids"], **here),
        row("steps", steps, **here),
        row("particle_steps_per_s", record["particle_steps_per_second"], "1/s", **here),
        *message_rows(point, here),
        *(row("share", seconds / point.seconds, **here, phase=phase)
          for phase, seconds in point.phases.items() if phase not in NO_PHASES),
    ]


def measure(quick: bool, repeats: int, folder: Path, say: Callable[[str], None], processes: int) -> tuple[list[Row], str]:
    """Figures, and the commit they are of. Throws Broken, SolverError."""
    runner = Runner(folder, repeats, say)
    rows = over_processes(runner, processes, quick) + many_processes(runner, quick)
    if not quick:
        rows += full_size(runner, processes, 100)
    return rows, Run(folder / "fluid").record["commit"]


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--processes", type=at_least(2), default=max(2, cores()), metavar="N",
                        help="the most, at least 2; default: the cores there are")


def main() -> int:
    return run_benchmark("scaling", __doc__, measure, add_options, rounds=5)


if __name__ == "__main__":
    sys.exit(main())
