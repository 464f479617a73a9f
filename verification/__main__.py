"""python3 -m verification list | run CASE | scene CASE | report | compare-bits SCENE"""

import argparse
import sys
import tempfile
import textwrap
from pathlib import Path

from verification.bits.compare import compare, explain
from verification.codes.mappm import Options, run
from verification.protocol.errors import CaseError, SolverError
from verification.protocol.machine import ROOT, cores
from verification.protocol.toml_text import scene_text
from verification.report.stored import store
from verification.suite.case import TIERS, Case
from verification.suite.manifest import all_cases, find_case, find_cases
from verification.suite.parameters import overrides_of, scene_of
from verification.suite.result import run_case, run_with

SKIPPED_CODE = 77  # what ctest takes for skipped


def list_cases() -> int:
    for case in all_cases():
        print(f"{case.name:28} {case.tier:6} {case.cost:6g} s  {textwrap.shorten(case.purpose, 90, placeholder=' ...')}")
    return 0


def _run_alone(case: Case, folder: Path, arguments: argparse.Namespace) -> None:
    """A case that judges nothing: runs its scene."""
    overrides = overrides_of(case, case.base + tuple(arguments.set))
    finished = run(case.file, folder / case.name, Options(ranks=arguments.ranks, overrides=overrides))
    print(f"{case.name}: ran to its end; its manifest names no observable. Series in {finished.folder}/series.csv")


def run_named(arguments: argparse.Namespace) -> int:
    """The case, or all its points of the tier. Returns 0, 1 where something does not hold, else 77 where something was skipped."""
    if arguments.set and arguments.store:
        raise CaseError("--store keeps a case as it is declared; leave out --set or --store")
    if arguments.jobs < 1:
        raise CaseError(f"--jobs {arguments.jobs}: must be at least 1")
    found = []
    for name in arguments.case:
        points = find_cases(name)
        found += [case for case in points if len(points) == 1 or arguments.tier == "full" or case.tier == "quick"]
    folder = arguments.out or ROOT / "runs"
    results = []
    for case in found:
        if not case.judged:
            _run_alone(case, folder, arguments)
            continue
        if arguments.set:
            results.append(run_with(case, folder, tuple(arguments.set), arguments.ranks))
        else:
            results.append(run_case(case, arguments.tier, folder, arguments.ranks, arguments.jobs,
                                    say=lambda text: print(text, file=sys.stderr)))
        if arguments.store:
            store(results[-1])
        print("\n".join(f"{case.name}: {line}" if len(found) > 1 else line for line in results[-1].lines), flush=True)
    if not all(result.holds for result in results):
        return 1
    return SKIPPED_CODE if any(result.skipped for result in results) else 0


def show_scene(name: str, sets: list[str]) -> int:
    case = find_case(name)
    print(scene_text(scene_of(case, (*case.base, *sets))), end="")
    return 0


def compare_bits(scene: Path, ranks: list[int], steps: int | None, every: int | None, build: Path | None) -> int:
    """The serial reference and `ranks` of the parallel solver, these from the folder `build` where it is given."""
    overrides = () if every is None else (f"output.sample={every}",)
    variants = [
        Options(ranks=count, steps=steps, overrides=overrides, build=build if count else None) for count in [0, *ranks]
    ]
    with tempfile.TemporaryDirectory() as folder:
        comparison = compare(scene, Path(folder), variants)
        print("\n".join(comparison.lines), flush=True)
        if not comparison.equal:
            print("\n".join(explain(scene, Path(folder), comparison).lines))
    return 0 if comparison.equal else 1


def _ranks(text: str) -> list[int]:
    ranks = [int(word) for word in text.split(",")]
    if min(ranks) < 1 or len(set(ranks)) != len(ranks):
        raise ValueError(text)
    return ranks


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python3 -m verification", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("list", help="the cases, their tier and their cost in core-seconds")

    one = commands.add_parser("run", help="run a case and print a line an observable")
    one.add_argument("case", nargs="+", help="name of a folder of cases/, CASE.POINT for one of its points, or the path of a scene")
    one.add_argument("--set", metavar="KEY=VALUE", action="append", default=[],
                     help="set a parameter of the case or a key of the scene: then it runs alone, without levels, and the goals "
                     "alone decide")
    one.add_argument("--tier", choices=TIERS, default="quick", help="full adds the levels that take long")
    one.add_argument("--out", type=Path, help="folder of the runs (default runs), which come to lie in OUT/CASE")
    one.add_argument("--ranks", type=int, default=1, help="ranks of the parallel solver; 0 is the serial reference")
    one.add_argument("--jobs", type=int, default=cores(), metavar="K", help="runs of a case at a time (default: a core each)")
    one.add_argument("--store", action="store_true", help="keep the results in reports/published/full.json, for the report")

    scene = commands.add_parser("scene", help="print the scene of a case or of one of its points, as mappm run takes it")
    scene.add_argument("case", help="as for run")
    scene.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="a parameter or a key of the scene")

    report = commands.add_parser("report", help="write the report")
    report.add_argument("--tier", choices=TIERS, default="quick")
    report.add_argument("--out", type=Path, default=ROOT / "reports" / "out")
    report.add_argument("--publish", action="store_true", help="also copy page, summary and key figures to reports/published")

    bits = commands.add_parser("compare-bits", help="compare digests of the serial reference and the parallel solver")
    bits.add_argument("scene", type=Path)
    bits.add_argument("--ranks", type=_ranks, default=[1, 2], metavar="1,2,4", help="default 1,2")
    bits.add_argument("--steps", type=int, help="default: those of the scene")
    bits.add_argument("--every", type=int, metavar="K", help="steps between comparisons (default: those of the scene)")
    bits.add_argument("--build", type=Path, metavar="DIR", help="folder whose bin/mappm is compared (default: as for run)")
    return parser


def main() -> int:
    arguments = _parser().parse_args()
    match arguments.command:
        case "list":
            return list_cases()
        case "run":
            return run_named(arguments)
        case "scene":
            return show_scene(arguments.case, arguments.set)
        case "compare-bits":
            return compare_bits(arguments.scene, arguments.ranks, arguments.steps, arguments.every, arguments.build)
        case "report":
            from verification.report.report import write_report  # drawing libraries load slowly

            return write_report(arguments.tier, arguments.out, arguments.publish)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (CaseError, SolverError) as error:
        sys.exit(f"verification: {error}")
