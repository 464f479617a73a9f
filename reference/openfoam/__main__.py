"""python3 -m reference.openfoam drag|bodies|store: see --help of each."""

import argparse
import shlex
import sys
import tempfile
from datetime import date
from pathlib import Path

from reference.openfoam.bodies import bodies_problem
from reference.openfoam.cell import cell_of, read_cell
from reference.openfoam.drag import drag_problem
from reference.openfoam.errors import InputError
from reference.openfoam.ladder import Options, Problem, check_meshes, solve
from reference.openfoam.run import FailedRun, missing_of
from reference.openfoam.store import Stored, StoredLevel, find_stored, read_stored, stored_file, write_stored
from verification.protocol.quantity import write_result

LEVELS = "plane: cells along a side (drag), along a quarter of a disc (bodies); space: along half an edge of the cell"


def levels_of(text: str) -> list[int]:
    """Throws InputError."""
    try:
        return [int(part) for part in text.split(",")]
    except ValueError:
        raise InputError(f"--levels {text}: write whole numbers with commas between, as 16,32") from None


def options_of(chosen: argparse.Namespace, stored: Stored | None, command: str) -> Options:
    """Throws InputError."""
    if chosen.jobs < 1:
        raise InputError(f"--jobs {chosen.jobs}: must be at least 1")
    return Options(levels_of(chosen.levels), stored, chosen.jobs, chosen.out, command)


def arguments(given: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python3 -m reference.openfoam")
    problems = parser.add_subparsers(dest="problem", required=True)
    one = problems.add_parser("drag", help="on a fixed disc or sphere in a periodic cell")
    several = problems.add_parser("bodies", help="total drag on several fixed discs or spheres")
    for command in (one, several):
        command.add_argument("--scene", type=Path, required=True, metavar="FILE")
        command.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="override a key of it")
        command.add_argument("--out", type=Path, required=True, metavar="DIR")
        command.add_argument("--jobs", type=int, default=1, metavar="K", help="levels run at a time")
    one.add_argument("--stored", nargs="?", const="", metavar="FILE",
                     help="finer levels from a file, or from the stored one that fits; levels run are compared with it")
    keep = problems.add_parser("store", help="compute levels and keep them in reference/openfoam/stored")
    keep.add_argument("--dimension", type=int, choices=(2, 3), required=True)
    keep.add_argument("--solid", type=float, required=True, help="solids fraction")
    keep.add_argument("--reynolds", type=float, required=True, help="2 rho R U / mu")
    for command in (one, several, keep):
        command.add_argument("--levels", required=True, metavar="N,N", help=LEVELS)
    for command in (one, keep):
        command.add_argument("--transient", action="store_true", help="over time: mean drag, and period where it sheds")
        command.add_argument("--end", type=float, default=30.0, metavar="T",
                             help="end of it, box sides over superficial velocity; the second half is measured")
    return parser.parse_args(given)


def end_of(chosen: argparse.Namespace) -> float | None:
    return chosen.end if chosen.transient else None


def run_problem(problem: Problem, options: Options) -> None:
    with tempfile.TemporaryDirectory(prefix="openfoam_") as folder:
        write_result(solve(problem, options, Path(folder)), options.out)


def run_drag(chosen: argparse.Namespace, command: str) -> None:
    problem = drag_problem(read_cell(chosen.scene, chosen.set), end_of(chosen))
    stored = None
    if chosen.stored is not None:
        stored = find_stored(problem.cell, chosen.transient, Path(chosen.stored) if chosen.stored else None)
    run_problem(problem, options_of(chosen, stored, command))


def run_bodies(chosen: argparse.Namespace, command: str) -> None:
    problem = bodies_problem(read_cell(chosen.scene, chosen.set))
    run_problem(problem, options_of(chosen, None, command))


def run_store(chosen: argparse.Namespace, command: str) -> None:
    """Adds levels to the file of this cell; those that it has are made again if named."""
    cell = cell_of(chosen.dimension, chosen.solid, chosen.reynolds)
    problem = drag_problem(cell, end_of(chosen))
    chosen_levels = levels_of(chosen.levels)
    check_meshes(problem, chosen_levels)
    if missing := missing_of(problem.programs, problem.how_to_get):
        raise InputError(missing)
    file = stored_file(cell, chosen.transient)
    levels = {level.n: level for level in read_stored(file).levels} if file.exists() else {}
    for n in sorted(set(chosen_levels)):
        with tempfile.TemporaryDirectory(prefix="openfoam_") as folder:
            run = problem.run(Path(folder) / "case", n)
        if run.objection:
            raise InputError(f"--reynolds {cell.reynolds:g}, N {n}: {run.objection}")
        levels[n] = StoredLevel(n, run.drag, round(run.core_seconds, 1), run.checksum, run.uncertainty, run.period)
        made = tuple(levels[n] for n in sorted(levels))
        stored = Stored(cell.dimension, cell.solid, cell.reynolds, cell.direction, chosen.transient, run.version,
                        command, date.today().isoformat(), made)
        write_stored(stored, file)  # after each level, as the finest take long


def main(given: list[str]) -> int:
    chosen = arguments(given)
    command = shlex.join(["python3", "-m", "reference.openfoam", *given])
    try:
        {"drag": run_drag, "bodies": run_bodies, "store": run_store}[chosen.problem](chosen, command)
    except (InputError, FailedRun) as error:
        print(error, file=sys.stderr)
        return 2 if isinstance(error, InputError) else 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
