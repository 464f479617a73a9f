"""How the solver scales over processes: the same fluid on more of them, more fluid on more of them, what they send each other.

    python3 -m bench.scaling [--quick] [--processes N] [--repeats N] [--json FILE] [--out DIR]

The fluids are those of bench.speed. Every run of a fluid must end with the digest of one process, be it on 2 or on 64: 64 are run
on the cores there are, for the sake of the exchange and not of the time. The last run of all is the paper's system at full size,
5.56 million PPs and 1024 discs. Prints a line a figure, `ratio NAME VALUE` or `figure NAME VALUE`; efficiencies are ratios of
runs within one round. Ends with 1 where a measurement is broken, never because the machine is slow.

The cost model takes the step of one process as

    t = w n + k b + a m + s b        n PPs owned, b bytes and m messages sent; w, k: all phases but the exchange, a, s: the exchange

fitted to all runs by least squares without negative terms, and tells the time of the paper's system on up to 1024 processes.
"""

import argparse
import json
import os
import statistics
import sys
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from bench.speed import SCENE, Broken, scene_of
from verification.errors import SolverError
from verification.provenance import processor
from verification.solver import ROOT, Options, Run, run

PAPER = ROOT / "cases" / "gas_solid_paper" / "case.toml"
PAPER_BOX, PAPER_DENSITY = (177.0, 2816.0), 12.83  # rcut; PPs to the square of rcut
PAPER_PROCESSES = (1, 16, 64, 256, 1024)
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
    def exchange(self) -> float:
        return self.phases["exchange"]

    @property
    def work(self) -> float:
        return sum(seconds for name, seconds in self.phases.items() if name not in ("exchange", "output", "steps"))


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


def non_negative(rows: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Least squares of two unknowns, neither below 0, of relative residuals. rows (n, 2), values (n,)."""
    rows, values = rows / values[:, None], np.ones(len(values))
    both, *_ = np.linalg.lstsq(rows, values, rcond=None)
    if (both >= 0).all():
        return both
    alone = [np.where(np.arange(2) == k, (rows[:, k] @ values) / (rows[:, k] @ rows[:, k]), 0.0) for k in range(2)]
    return min(alone, key=lambda x: float(np.sum((rows @ x - values) ** 2)))


@dataclass(frozen=True)
class CostModel:
    """Seconds: of a PP, of the work for a byte received, of a message, of a byte on its way. In the plane."""

    particle: float
    work_byte: float
    message: float
    sent_byte: float

    def seconds(self, particles: float, messages: float, sent: float) -> float:
        return self.particle * particles + (self.work_byte + self.sent_byte) * sent + self.message * messages


def fit(points: list[Point]) -> CostModel:
    """From runs on two processes and more."""
    own = np.array([point.particles / point.processes for point in points])
    sent, messages = np.array([point.bytes for point in points]), np.array([point.messages for point in points])
    particle, work_byte = non_negative(np.column_stack([own, sent]), np.array([point.work for point in points]))
    message, sent_byte = non_negative(np.column_stack([messages, sent]), np.array([point.exchange for point in points]))
    return CostModel(float(particle), float(work_byte), float(message), float(sent_byte))


def margin_of(box: tuple[float, float], grid: tuple[int, int]) -> float:
    """Area of the margins of one domain of a periodic grid, rcut = 1: what it receives, and what it sends."""
    sides = [length / count for length, count in zip(box, grid, strict=True)]
    wide = [side + (2.0 if count > 1 else 0.0) for side, count in zip(sides, grid, strict=True)]
    return wide[0] * wide[1] - sides[0] * sides[1]


def predicted(model: CostModel, bytes_per_ghost: float, box: tuple[float, float], density: float, grid: tuple[int, int]) -> float:
    """Seconds of a step on a grid of domains."""
    particles = box[0] * box[1] * density / (grid[0] * grid[1])
    neighbours = sum(min(count - 1, 2) for count in grid) if 1 in grid else 8
    return model.seconds(particles, 2.0 * neighbours, margin_of(box, grid) * density * bytes_per_ghost)


def best_grid(model: CostModel, bytes_per_ghost: float, processes: int) -> tuple[int, int]:
    """Of the paper's system, with domains of at least three cutoffs: a disc of 4.5 has to find its neighbours."""
    grids = [(columns, processes // columns) for columns in doubled(processes)]
    fitting = [grid for grid in grids if all(side / count >= 3.0 for side, count in zip(PAPER_BOX, grid, strict=True))]
    return min(fitting, key=lambda grid: predicted(model, bytes_per_ghost, PAPER_BOX, PAPER_DENSITY, grid))


def modelled(slabs: list[Point], square: dict[int, list[Point]], side: int) -> dict[str, float]:
    """The fitted terms, what they make of the runs they were fitted to, and of the paper's system."""
    model = fit(slabs)
    figures = {
        "figure model.nanoseconds_per_particle": 1e9 * model.particle,
        "figure model.nanoseconds_of_work_per_byte": 1e9 * model.work_byte,
        "figure model.microseconds_per_message": 1e6 * model.message,
        "figure model.nanoseconds_per_byte_sent": 1e9 * model.sent_byte,
    }
    worst = max(abs(model.seconds(p.particles / p.processes, p.messages, p.bytes) / p.seconds - 1) for p in slabs)
    figures["ratio model.largest_misfit"] = worst
    two = median_of(square[2])
    cutoff = float(scene_of(2, (1, 1))[1].partition("=")[2])
    bytes_per_ghost = two.bytes / (2.0 * cutoff * side)  # spacing 1; two margins a slab
    figures["figure model.bytes_per_ghost"] = bytes_per_ghost
    alone = predicted(model, bytes_per_ghost, PAPER_BOX, PAPER_DENSITY, (1, 1))
    for processes in PAPER_PROCESSES[1:]:
        grid = best_grid(model, bytes_per_ghost, processes)
        seconds = predicted(model, bytes_per_ghost, PAPER_BOX, PAPER_DENSITY, grid)
        figures[f"figure model.paper.{processes}.domains_along_x"] = grid[0]
        figures[f"figure model.paper.{processes}.microseconds_per_step"] = 1e6 * seconds
        figures[f"ratio model.paper.{processes}.efficiency"] = alone / seconds / processes
    return figures


def measure(lab: Lab, processes: int, quick: bool) -> dict[str, float]:
    counts = doubled(processes)
    figures: dict[str, float] = {}
    spread: list[Point] = []  # in the plane, on two processes and more
    square: dict[int, list[Point]] = {}
    for name, sides in (QUICK_STRONG if quick else STRONG).items():
        steps = 10 if quick else {"2d": 20, "3d": 12}[name]
        found = lab.rounds(f"strong {name}", {
            count: lambda n=name, s=sides, k=steps, c=count: lab.once(f"strong {n}", s, k, Options(ranks=c)) for count in counts
        })
        require_one_digest(point for points in found.values() for point in points)
        figures |= figures_of(f"strong_{name}", found)
        if name == "2d":
            square = found
            spread += [median_of(points) for count, points in found.items() if count > 1]
    side = QUICK_WEAK if quick else WEAK
    found = lab.rounds("weak 2d", {
        count: lambda c=count: lab.once("weak 2d", (side * c, side), 10 if quick else 150, Options(ranks=c)) for count in counts
    })
    figures |= figures_of("weak_2d", found)
    spread += [median_of(points) for count, points in found.items() if count > 1]
    figures |= modelled(spread, square, (QUICK_STRONG if quick else STRONG)["2d"][1])
    return figures


def many_processes(lab: Lab, quick: bool) -> dict[str, float]:
    """Digests on 64 processes, in slabs and in squares, are that of one."""
    sides, steps = ((6 * MANY, 32), 4) if quick else ((16 * MANY, 256), 20)
    layouts = [Options(ranks=1), Options(ranks=MANY, domains=f"{MANY}x1")] + ([] if quick else [Options(ranks=MANY, domains="16x4")])
    points = [lab.once("many", sides, steps, options) for options in layouts]
    require_one_digest(points)
    lab.say(f"{MANY} processes: digest {points[0].digest}, that of one")
    return {"figure many.processes": MANY, "figure many.layouts_of_equal_digest": len(points)}


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
    parser.add_argument("--processes", type=int, default=len(os.sched_getaffinity(0)),
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
    for name, value in figures.items():
        print(f"{name} {value:.4g}")
    if options.json:
        command = "python3 -m bench.scaling" + (" --quick" if options.quick else "")
        table = {"date": f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC", "commit": commit,
                 "command": f"{command} --processes {options.processes} --repeats {repeats}",
                 "host": f"{processor()}, {len(os.sched_getaffinity(0))} cores", "figures": figures}
        options.json.parent.mkdir(parents=True, exist_ok=True)
        options.json.write_text(json.dumps(table, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
