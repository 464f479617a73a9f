"""What a step costs, taken apart, and what it would cost on processes that this machine does not have.

    python3 -m bench.cost_model [--quick] [--repeats N] [--lab DIR] [--out DIR]

The step of a process that owns n PPs, and sends b bytes in m messages, is taken to last

    t = w n + g b + a m + s b

w and g, the work for a PP and for the ghosts behind a byte, are fitted to runs on two processes whose domains have small margins and
large ones; a and s, a message and a byte on its way, are those of exchanges without work (bench-parallel_exchange). Waiting for a
slower process is in none of them: measured above predicted is what imbalance and other load add. The model is printed beside the
runs it was fitted to and others, and then applied to the paper's system (cases/gas_solid_paper) on up to 1024 processes in the
best grid of domains. Ends with 1 where a measurement is broken, never because the machine is slow.
"""

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bench.meter import Broken, Row, printed, row, run_benchmark
from bench.scaling import Point, Runner, doubled, median_of, require_one_digest
from bench.speed import scene_of
from verification.codes.mappm import MPI_ENVIRONMENT, Options, program
from verification.protocol.run import Run
from verification.store.figures import Setting

PAPER_BOX, PAPER_DENSITY = (177.0, 2816.0), 12.83  # rcut; PPs to the square of rcut
PAPER_PROCESSES = (1, 4, 16, 64, 256, 1024)
MARGIN = 1.1  # rcut, of ghosts: the skin of the lists is in it
NARROWEST = 9.0  # rcut, of a domain of the paper's system: its discs are as wide
LAYOUTS = {"narrow": ((1000, 100), "2x1"), "wide": ((1000, 100), "1x2"), "thin": ((2000, 24), "1x2")}
QUICK_LAYOUTS = {"narrow": ((200, 40), "2x1"), "wide": ((200, 40), "1x2"), "thin": ((400, 16), "1x2")}


@dataclass(frozen=True)
class CostModel:
    """Seconds: of a PP, of the work for a byte of ghosts, of a message, of a byte on its way."""

    particle: float
    ghost_byte: float
    message: float
    sent_byte: float

    def seconds(self, particles: float, messages: float, sent: float) -> float:
        return self.particle * particles + (self.ghost_byte + self.sent_byte) * sent + self.message * messages


def fit_work(points: list[Point]) -> tuple[float, float]:
    """(of a PP, of a byte of ghosts), s, by least squares of relative residuals."""
    work = np.array([point.work for point in points])
    rows = np.array([[point.particles / point.processes, point.bytes] for point in points]) / work[:, None]
    (particle, ghost_byte), *_ = np.linalg.lstsq(rows, np.ones(len(points)), rcond=None)
    return float(particle), float(ghost_byte)


def cost_of_messages() -> tuple[float, float]:
    """(of a message, of a byte), s."""
    done = subprocess.run(["mpirun", "-np", "2", str(program("bench-parallel_exchange"))], env=os.environ | MPI_ENVIRONMENT,
                          capture_output=True, text=True)
    found = {one.name: one.value for one in printed(done.stdout)}
    if done.returncode != 0 or len(found) != 2:
        raise Broken(f"bench-parallel_exchange ended with {done.returncode}: {done.stderr[-500:]}")
    return 1e-6 * found["microseconds"], 1e-9 * found["nanoseconds_per_byte"]


def margin_of(box: tuple[float, float], grid: tuple[int, int]) -> float:
    """Area of the margins of one domain of a periodic grid, rcut = 1: what it receives, and what it sends."""
    sides = [length / count for length, count in zip(box, grid, strict=True)]
    wide = [side + (2.0 * MARGIN if count > 1 else 0.0) for side, count in zip(sides, grid, strict=True)]
    return wide[0] * wide[1] - sides[0] * sides[1]


def neighbours_of(grid: tuple[int, int]) -> int:
    """Other domains that touch one, on a periodic grid."""
    return int(np.prod([min(count, 3) for count in grid])) - 1


def predicted(model: CostModel, bytes_per_ghost: float, grid: tuple[int, int]) -> float:
    """Seconds of a step of the paper's system on a grid of domains; solids are taken for fluid."""
    particles = PAPER_BOX[0] * PAPER_BOX[1] * PAPER_DENSITY / (grid[0] * grid[1])
    sent = margin_of(PAPER_BOX, grid) * PAPER_DENSITY * bytes_per_ghost
    return model.seconds(particles, 2.0 * neighbours_of(grid), sent)  # a message for the halo and one for the loads of copies


def best_grid(model: CostModel, bytes_per_ghost: float, processes: int) -> tuple[int, int]:
    grids = [(columns, processes // columns) for columns in doubled(processes)]
    fitting = [grid for grid in grids if all(n == 1 or side / n >= NARROWEST for side, n in zip(PAPER_BOX, grid, strict=True))]
    return min(fitting, key=lambda grid: predicted(model, bytes_per_ghost, grid))


def model_rows(model: CostModel, bytes_per_ghost: float) -> list[Row]:
    return [
        row("nanoseconds_per_particle", 1e9 * model.particle, "ns"),
        row("nanoseconds_per_ghost", 1e9 * model.ghost_byte * bytes_per_ghost, "ns"),
        row("microseconds_per_message", 1e6 * model.message, "us"),
        row("nanoseconds_per_byte", 1e9 * model.sent_byte, "ns"),
        row("bytes_per_ghost", bytes_per_ghost, "B"),
    ]


def layout_rows(model: CostModel, points: dict[str, Point]) -> list[Row]:
    rows = []
    for name, point in points.items():
        seconds = model.seconds(point.particles / point.processes, point.messages, point.bytes)
        rows += [row("microseconds_per_step", 1e6 * point.seconds, "us", layout=name),
                 row("measured_over_predicted", point.seconds / seconds, layout=name)]
    return rows


def paper_rows(model: CostModel, bytes_per_ghost: float) -> list[Row]:
    """Of the paper's system, on processes that may not be there."""
    alone, rows = predicted(model, bytes_per_ghost, (1, 1)), []
    for processes in PAPER_PROCESSES:
        grid = best_grid(model, bytes_per_ghost, processes)
        seconds = predicted(model, bytes_per_ghost, grid)
        here: dict[str, Setting] = {"system": "paper", "ranks": processes}
        rows += [row("domains_along_x", grid[0], **here), row("microseconds_per_step", 1e6 * seconds, "us", **here),
                 row("efficiency", alone / seconds / processes, **here)]
    return rows


def measure(quick: bool, repeats: int, folder: Path, say: Callable[[str], None]) -> tuple[list[Row], str]:
    """Figures, and the commit they are of. Throws Broken, SolverError."""
    runner = Runner(folder, repeats, say)
    layouts = QUICK_LAYOUTS if quick else LAYOUTS
    found: dict[str, list[Point]] = {name: [] for name in layouts}
    for done in range(repeats):
        for name, (sides, domains) in layouts.items():
            found[name].append(runner.once(name, sides, 10 if quick else 60, Options(ranks=2, domains=domains)))
        say(f"round {done + 1} of {repeats}")
    require_one_digest([*found["narrow"], *found["wide"]])
    points = {name: median_of(rounds) for name, rounds in found.items()}
    model = CostModel(*fit_work(list(points.values())), *cost_of_messages())
    cutoff = float(scene_of(2, (1, 1))[1].partition("=")[2])
    bytes_per_ghost = points["wide"].bytes / (2.0 * MARGIN * cutoff * layouts["wide"][0][0])  # spacing 1, two margins
    rows = model_rows(model, bytes_per_ghost) + layout_rows(model, points) + paper_rows(model, bytes_per_ghost)
    return rows, Run(folder / "fluid").record["commit"]


def main() -> int:
    return run_benchmark("cost_model", __doc__, measure)


if __name__ == "__main__":
    sys.exit(main())
