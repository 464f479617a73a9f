"""python3 -m reference.openfoam drag|store: see --help of each."""

import argparse
import shlex
import sys
import tempfile
from datetime import date
from pathlib import Path

from reference.live import write_result
from reference.openfoam.cell import cell_of, read_cell
from reference.openfoam.drag import Options, check_meshes, drag, run_any
from reference.openfoam.errors import InputError
from reference.openfoam.run import FailedRun, missing_of
from reference.openfoam.store import Stored, StoredLevel, find_stored, read_stored, stored_file, write_stored


def numbers(text: str) -> list[int]:
    return [int(part) for part in text.split(",")]


def arguments(given: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python3 -m reference.openfoam")
    problems = parser.add_subparsers(dest="problem", required=True)
    one = problems.add_parser("drag", help="on a fixed disc or sphere in a periodic cell")
    one.add_argument("--scene", type=Path, required=True, metavar="FILE")
    one.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="override a key of the scene")
    one.add_argument("--out", type=Path, required=True, metavar="DIR")
    one.add_argument("--levels", type=numbers, required=True, metavar="N,N", help="cells along a side, half of it in space")
    one.add_argument("--stored", nargs="?", const="", metavar="FILE",
                     help="finer levels from a file, or from the stored one that fits; levels run are compared with it")
    one.add_argument("--jobs", type=int, default=1, metavar="K", help="levels run at a time")
    keep = problems.add_parser("store", help="compute levels and keep them in reference/openfoam/stored")
    keep.add_argument("--dimension", type=int, choices=(2, 3), required=True)
    keep.add_argument("--solid", type=float, required=True, help="solids fraction")
    keep.add_argument("--reynolds", type=float, required=True, help="2 rho R U / mu")
    keep.add_argument("--levels", type=numbers, required=True, metavar="N,N")
    for command in (one, keep):
        command.add_argument("--transient", action="store_true", help="over time: mean drag, and period of a flow that sheds")
        command.add_argument("--end", type=float, default=30.0, metavar="T",
                             help="of a transient run, box sides over superficial velocity; the second half is measured")
    return parser.parse_args(given)


def run_drag(chosen: argparse.Namespace, command: str) -> None:
    cell = read_cell(chosen.scene, chosen.set)
    stored = None
    if chosen.stored is not None:
        stored = find_stored(cell, chosen.transient, Path(chosen.stored) if chosen.stored else None)
    options = Options(chosen.levels, stored, chosen.jobs, chosen.transient, chosen.end, chosen.out, command)
    with tempfile.TemporaryDirectory(prefix="openfoam_") as folder:
        write_result(drag(cell, options, Path(folder)), chosen.out)


def run_store(chosen: argparse.Namespace, command: str) -> None:
    """Adds levels to the file of this cell; those that it has are made again if named."""
    cell = cell_of(chosen.dimension, chosen.solid, chosen.reynolds)
    options = Options(chosen.levels, transient=chosen.transient, end=chosen.end)
    check_meshes(cell, options)
    if missing := missing_of(("blockMesh", "checkMesh", "simpleFoam", "pimpleFoam")):
        raise InputError(missing)
    file = stored_file(cell, chosen.transient)
    levels = {level.n: level for level in read_stored(file).levels} if file.exists() else {}
    for n in sorted(set(chosen.levels)):
        with tempfile.TemporaryDirectory(prefix="openfoam_") as folder:
            run = run_any(Path(folder) / "case", cell, n, options)
        if run.objection:
            raise InputError(f"--reynolds {cell.reynolds:g}, N {n}: {run.objection}")
        levels[n] = StoredLevel(n, float(run.drag), round(run.core_seconds, 1), run.checksum, run.uncertainty, run.period)
        made = tuple(levels[n] for n in sorted(levels))
        write_stored(
            Stored(cell.dimension, cell.solid, cell.reynolds, cell.direction, chosen.transient, run.version, command,
                   date.today().isoformat(), made),
            file,
        )  # after each level, as the finest take long


def main(given: list[str]) -> int:
    chosen = arguments(given)
    command = shlex.join(["python3", "-m", "reference.openfoam", *given])
    try:
        {"drag": run_drag, "store": run_store}[chosen.problem](chosen, command)
    except (InputError, FailedRun) as error:
        print(error, file=sys.stderr)
        return 2 if isinstance(error, InputError) else 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
