"""A code that is right: writes the exact solution of a scene, where there is one, as a run.

`--option snapshots=N` leaves that many after the first, by default 40.
"""

import sys
from collections.abc import Iterator

import numpy as np

from reference.exact_flows import Exact, exact_flow
from verification.protocol.adapter import Adapter, BadInput, Cannot, Left, Task, main
from verification.protocol.capability import FLUID, SPACE, WALLS
from verification.protocol.points import write_points
from verification.protocol.scene import in_si

SAMPLES = 5  # rows of the series a snapshot


def lattice(scene: dict) -> tuple[np.ndarray, float]:
    """Centres of the cells of a lattice of the scene's spacing, fitted to the box: (n, 3), and the volume of a cell."""
    size = [in_si(side) for side in scene["box"]["size"]]
    counts = [max(1, round(side / in_si(scene["fluid"]["spacing"]))) for side in size]
    axes = [(np.arange(count) + 0.5) * side / count for side, count in zip(size, counts, strict=True)]
    centres = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(size))
    points = np.zeros((len(centres), 3))
    points[:, : len(size)] = centres
    return points, float(np.prod(size) / len(points))


def times_of(task: Task) -> np.ndarray:
    """Of the rows of the series; each SAMPLES-th has a snapshot. A step is the time between two snapshots."""
    run, count = task.scene.get("run", {}), task.option("snapshots", "40")
    if not count.isdigit() or int(count) < 1:
        raise BadInput(f"--option snapshots={count}: must be a whole number of at least 1")
    if "duration" not in run:
        raise Cannot("run.steps counts the steps of a solver; this code needs run.duration")
    steps = min(int(count), task.steps or int(count))
    return np.linspace(0.0, in_si(run["duration"]) * steps / int(count), SAMPLES * steps + 1)


def rows(flow: Exact, points: np.ndarray, mass: float, times: np.ndarray) -> Iterator[list[float]]:
    """Time, mean velocity and kinetic energy of the fluid, a unit of depth in the plane."""
    for time in times:
        velocity = flow.velocity(points, time)
        yield [time, *velocity.mean(axis=0), 0.5 * mass * np.sum(velocity**2)]


class ExactSolution(Adapter):
    name = "exact"
    capabilities = frozenset({FLUID, SPACE, WALLS})

    def version(self) -> str:
        return "1"

    def run(self, task: Task) -> Left:
        flow, times = exact_flow(task.scene), times_of(task)
        points, cell = lattice(task.scene)
        points = points[flow.holds_fluid(points)]
        series = np.array(list(rows(flow, points, in_si(task.scene["fluid"]["density"]) * cell, times)))
        header = "time,fluid_velocity_x,fluid_velocity_y,fluid_velocity_z,fluid_energy"
        np.savetxt(task.out / "series.csv", series, delimiter=",", header=header, comments="", fmt="%.17g")
        for number, time in enumerate(times[::SAMPLES]):
            write_points(task.out, number, float(time), points, flow.velocity(points, time))
        return Left()


if __name__ == "__main__":
    sys.exit(main(ExactSolution()))
