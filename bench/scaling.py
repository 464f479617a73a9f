"""How the solver scales over processes: the same fluid on more of them, more fluid on more of them, what they send each other.

    python3 -m bench.scaling [--quick] [--processes N] [--repeats N] [--json FILE] [--out DIR]

The fluids are those of bench.speed. Every run of a fluid must end with the digest of one process, be it on 2 or on 64: 64 are run
on the cores there are, with discs across their borders too, for the sake of the exchange and not of the time. The last run of all is the paper's system at full size,
5.56 million PPs and 1024 discs. Prints a line a figure, `ratio NAME VALUE` or `figure NAME VALUE`; efficiencies are ratios of
runs within one round. Ends with 1 where a measurement is broken, never because the machine is slow.
"""

import argparse
import statistics
import sys
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from bench.codes import SCENE
from bench.meter import Broken, keep
from bench.speed import scene_of
from verification.codes.mappm import Options, run
from verification.protocol.errors import SolverError
from verification.protocol.machine import ROOT, cores
from verification.protocol.run import Run

PAPER = ROOT / "cases" / "gas_solid_paper" / "case.toml"
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


class Lab:
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


def efficiency(found: dict[int, list[Point]], processes: int) -> float:
    """Median over the rounds of the rate of a process against that of one alone."""
    return statistics.median(
        one.seconds / one.particles * some.particles / some.seconds / processes
        for one, some in zip(found[1], found[processes], strict=True)
    )


def figures_of(name: str, found: dict[int, list[Point]]) -> dict[str, float]:
    figures = {}
    for processes, points in found.items():
        point = median_of(points)
        label = f"{name}.{processes}"
        figures[f"figure {label}.particle_steps_per_s"] = point.particles / point.seconds
        if processes > 1:
            figures[f"ratio {label}.efficiency"] = efficiency(found, processes)
            figures[f"figure {label}.messages_per_step"] = point.messages
            figures[f"figure {label}.bytes_per_step"] = point.bytes
        for phase, seconds in point.phases.items():
            if phase not in ("output", "steps"):
                figures[f"figure {label}.microseconds_{phase}"] = 1e6 * seconds
    return figures


def measure(lab: Lab, processes: int, quick: bool) -> dict[str, float]:
    counts = doubled(processes)
    figures: dict[str, float] = {}
    for name, sides in (QUICK_STRONG if quick else STRONG).items():
        steps = 10 if quick else {"2d": 20, "3d": 12}[name]
        found = lab.rounds(f"strong {name}", {
            count: lambda n=name, s=sides, k=steps, c=count: lab.once(f"strong {n}", s, k, Options(ranks=c)) for count in counts
        })
        require_one_digest(point for points in found.values() for point in points)
        figures |= figures_of(f"strong_{name}", found)
    side = QUICK_WEAK if quick else WEAK
    found = lab.rounds("weak 2d", {
        count: lambda c=count: lab.once("weak 2d", (side * c, side), 10 if quick else 150, Options(ranks=c)) for count in counts
    })
    return figures | figures_of("weak_2d", found)


def many_processes(lab: Lab, quick: bool) -> dict[str, float]:
    """Digests on 64 processes are those of one: of a fluid in slabs and in squares, and of discs that lie across borders."""
    sides, steps = ((6 * MANY, 32), 4) if quick else ((16 * MANY, 256), 20)
    layouts = [Options(ranks=1), Options(ranks=MANY, domains=f"{MANY}x1")] + ([] if quick else [Options(ranks=MANY, domains="16x4")])
    fluid = [lab.once("fluid", sides, steps, options) for options in layouts]
    require_one_digest(fluid)
    discs = []
    for ranks in (1, MANY):
        options = Options(ranks=ranks, steps=steps, overrides=(f"box.size=[22.0, {10.0 * MANY}]", f"body.0.array.count=[1, {MANY // 2}]",
                                                               "run.relax=0", "output.sample=1000000", "output.snapshot=1000000"))
        discs.append(point_of("discs", run(PAPER, lab.folder / "discs", options)))
    require_one_digest(discs)
    lab.say(f"{MANY} processes: digests {fluid[0].digest} of a fluid, {discs[0].digest} of discs in it, those of one")
    return {"figure many.processes": MANY, "figure many.runs_of_equal_digest": len(fluid) + len(discs)}


def full_size(lab: Lab, processes: int, steps: int) -> dict[str, float]:
    """The paper's system: rate, and that its momentum is that of the forces to the last bit."""
    finished = run(PAPER, lab.folder / "full_size", Options(ranks=processes, steps=steps, overrides=("output.snapshot=1000000",)))
    record, ledger = finished.record, finished.record["momentum"]
    for start, end, impulse in zip(ledger["start"], ledger["end"], ledger["impulse"], strict=True):
        if int(end) - int(start) != int(impulse):
            raise Broken(f"full size: momentum grew by {int(end) - int(start)} quanta, forces gave {impulse}")
    point = point_of("full size", finished)
    shares = {phase: seconds / point.seconds for phase, seconds in point.phases.items()}
    return {
        "figure full_size.particles": record["particles"],
        "figure full_size.solids": record["solids"],
        "figure full_size.processes": processes,
        "figure full_size.steps": steps,
        "figure full_size.particle_steps_per_s": record["particle_steps_per_second"],
        "figure full_size.messages_per_step": point.messages,
        "figure full_size.bytes_per_step": point.bytes,
    } | {f"ratio full_size.share_{phase}": share for phase, share in shares.items() if phase not in ("output", "steps")}


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m bench.scaling", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="small fluids, which take seconds: to see that all works")
    parser.add_argument("--processes", type=int, default=cores(),
                        help="the most, at least 2; default: the cores there are")
    parser.add_argument("--repeats", type=int, help="rounds, at least 1; default 5, with --quick 1")
    parser.add_argument("--json", type=Path, help="also keep the figures in this file")
    parser.add_argument("--out", type=Path, help="folder of the runs (default: one that is removed)")
    options = parser.parse_args()
    repeats = options.repeats if options.repeats is not None else (1 if options.quick else 5)
    if repeats < 1 or options.processes < 2:
        parser.error(f"--repeats {repeats} --processes {options.processes}: must be at least 1 and 2")
    with tempfile.TemporaryDirectory() as scratch:
        lab = Lab(options.out or Path(scratch), repeats, lambda text: print(text, file=sys.stderr, flush=True))
        try:
            figures = measure(lab, options.processes, options.quick) | many_processes(lab, options.quick)
            if not options.quick:
                figures |= full_size(lab, options.processes, 100)
            commit = Run(lab.folder / "fluid").record["commit"]
        except (Broken, SolverError) as error:
            print(f"scaling: {error}", file=sys.stderr)
            return 1
    command = "python3 -m bench.scaling" + (" --quick" if options.quick else "")
    keep(figures, f"{command} --processes {options.processes} --repeats {repeats}", commit, options.json)
    return 0


if __name__ == "__main__":
    sys.exit(main())
