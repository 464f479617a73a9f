"""The laboratory's command line: cases, codes, the store, the report. See README.md of this folder."""

import argparse
import os
import signal
import sys
import tempfile
import textwrap
from pathlib import Path

from verification.protocol.errors import Beyond, CaseError, SolverError, StoreError
from verification.protocol.machine import ROOT, cores

SKIPPED_CODE = 77  # what ctest takes for skipped
LABORATORY = ROOT / "runs"
TIERS = ("quick", "full")


def list_cases(for_ctest: bool) -> int:
    """For people, or a line a test: name, core-seconds, processors, and its labels."""
    from verification.suite.manifest import all_cases

    if not for_ctest:
        for case in all_cases():
            print(f"{case.name:28} {case.tier:6} {case.cost:6g} s  {textwrap.shorten(case.purpose, 90, placeholder=' ...')}")
        return 0
    families: dict[str, list] = {}
    for case in all_cases():
        if case.judged and case.tier == "quick" and (case.observables or case.equivalence):
            families.setdefault(case.family, []).append(case)
    for family, points in families.items():
        processors = 2 if any(case.equivalence for case in points) else 1
        labels = ["verification", *(["external"] if points[0].live else [])]
        print(f"{family} {sum(case.cost for case in points):g} {processors} {','.join(labels)}")
    return 0


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _run_alone(laboratory, case, code, arguments: argparse.Namespace) -> None:
    """A case that judges nothing: runs its scene."""
    from verification.store.laboratory import Request
    from verification.suite.parameters import scene_of

    scene = scene_of(case, case.base + tuple(arguments.set))
    stored = laboratory.obtain(Request(code, scene, case.name, cores=arguments.ranks), arguments.anew, folder_too=True)
    where = "" if arguments.scratch else f". Series in {laboratory.run_folder(stored.key)}/series.csv"
    print(f"{case.name}: ran to its end; its manifest names no observable{where}")


def run_named(arguments: argparse.Namespace) -> int:
    """In the laboratory named, or in one that starts empty and is removed."""
    if not arguments.scratch:
        return _run_in(arguments.lab, arguments)
    with tempfile.TemporaryDirectory() as folder:
        return _run_in(Path(folder), arguments)


def _run_in(folder: Path, arguments: argparse.Namespace) -> int:
    """The case, or all its points of the tier.

    Returns 0, 1 where something does not hold and is not explained, else 77 where something was skipped.
    """
    from verification.codes.code import find_code
    from verification.store.laboratory import Laboratory
    from verification.suite.ability import able
    from verification.suite.manifest import find_cases
    from verification.suite.result import Way, run_case, run_with

    for name in ("jobs", "ranks"):
        if getattr(arguments, name) < 1:
            raise CaseError(f"--{name} {getattr(arguments, name)}: must be at least 1")
    found = []
    for name in arguments.case:
        points = find_cases(name)
        found += [case for case in points if len(points) == 1 or arguments.tier == "full" or case.tier == "quick"]
    code, laboratory = find_code(arguments.code), Laboratory(folder)
    if code.missing:
        print(f"SKIPPED: {code.missing}")
        return SKIPPED_CODE
    way = Way(arguments.ranks, arguments.jobs, arguments.anew)
    passes, skipped = True, False
    for case in found:
        before = f"{case.name}: " if len(found) > 1 else ""
        try:
            asked = able(case, code)
            if not case.judged:
                _run_alone(laboratory, asked, code, arguments)
                continue
            if arguments.set:
                result = run_with(laboratory, asked, tuple(arguments.set), code, way)
            else:
                result = run_case(laboratory, asked, arguments.tier, code, way, _say)
        except Beyond as error:
            print(f"{before}SKIPPED: {error}")
            skipped = True
            continue
        passes, skipped = passes and result.passes, skipped or bool(result.skipped)
        print("\n".join(before + line for line in result.lines), flush=True)
    return 1 if not passes else SKIPPED_CODE if skipped else 0


def show_scene(name: str, sets: list[str]) -> int:
    from verification.protocol.toml_text import scene_text
    from verification.suite.manifest import find_case
    from verification.suite.parameters import scene_of

    case = find_case(name)
    print(scene_text(scene_of(case, (*case.base, *sets))), end="")
    return 0


def compare_bits(scene: Path, ranks: list[int], steps: int | None, every: int | None, build: Path | None) -> int:
    """The serial reference and `ranks` of the parallel solver, these from the folder `build` where it is given."""
    from verification.bits.compare import compare, explain
    from verification.codes.mappm import Options

    overrides = () if every is None else (f"output.sample={every}",)
    variants = [Options(ranks=count, steps=steps, overrides=overrides, build=build if count else None) for count in [0, *ranks]]
    with tempfile.TemporaryDirectory() as folder:
        comparison = compare(scene, Path(folder), variants)
        print("\n".join(comparison.lines), flush=True)
        if not comparison.equal:
            print("\n".join(explain(scene, Path(folder), comparison).lines))
    return 0 if comparison.equal else 1


def list_codes() -> int:
    """Each with its version, what it can do, or what is missing."""
    from verification.codes.code import all_codes, find_code

    for name in all_codes():
        code = find_code(name)
        print(f"{code.name:18} {code.version or '-':14} {code.missing or ', '.join(sorted(code.capabilities))}")
    return 0


def use_store(arguments: argparse.Namespace) -> int:
    from verification.store.commands import export_store, import_store, list_runs, prune, show
    from verification.store.laboratory import Laboratory

    laboratory = Laboratory(arguments.lab)
    match arguments.what:
        case "list":
            return list_runs(laboratory.store, arguments.code)
        case "show":
            return show(laboratory.store, arguments.key)
        case "export":
            return export_store(laboratory.store, arguments.file)
        case "import":
            return import_store(laboratory.store, arguments.file)
        case "prune":
            return prune(laboratory, arguments.folders)


def report(arguments: argparse.Namespace) -> int:
    """Runs what is missing, then draws what there is. 1 where a run failed, or something does not hold."""
    from verification.store.laboratory import Laboratory
    from verification.suite.tier import make_tier

    laboratory = Laboratory(arguments.lab)
    failures = [] if arguments.only_draw else make_tier(laboratory, arguments.tier)
    print("report: drawing", flush=True)
    from verification.report.report import draw_report  # drawing libraries load slowly

    status = draw_report(laboratory, arguments.tier, arguments.out, arguments.publish)
    for words in failures:
        _say(f"verification: failed: {words}")
    return 1 if failures else status


def study(arguments: argparse.Namespace) -> int:
    """Lists the studies, or runs what is missing of one, prints its table and draws its chart."""
    from verification.studies.precision import lines_of_fronts
    from verification.studies.study import all_studies, find_study, lines_of, read_study, results_of, run_study

    if arguments.name is None:
        for found in map(read_study, all_studies()):
            runs, purpose = len(found.runs), textwrap.shorten(found.purpose, 90, placeholder=" ...")
            print(f"{found.name:28} {runs:4} runs  {purpose}")
        return 0
    from verification.store.laboratory import Laboratory

    found, laboratory = find_study(arguments.name), Laboratory(arguments.lab)
    if not arguments.only_show:
        run_study(laboratory, found, arguments.jobs, _say, arguments.repeats)
    results = results_of(laboratory, found)
    print("\n".join(lines_of(found, results)))
    file = arguments.out / f"{found.name}.svg"
    if found.chart == "precision" and results:
        from verification.report.precision_chart import draw_precision

        print("\n".join(lines_of_fronts(draw_precision(laboratory.store, found, results, file).fronts)))
    elif found.chart == "map" and results:
        from verification.report.map_chart import draw_map

        draw_map(found, results, file)
    if found.chart and results:
        print(f"study: {file} and {file.with_suffix('.csv').name}")
    return 0


def _ranks(text: str) -> list[int]:
    ranks = [int(word) for word in text.split(",")]
    if min(ranks) < 1 or len(set(ranks)) != len(ranks):
        raise ValueError(text)
    return ranks


def _count(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise ValueError(text)
    return int(text)


def _add_lab(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--lab", type=Path, default=LABORATORY, metavar="DIR",
                        help="folder of the store and of the runs (default runs)")


def _add_run(commands) -> None:
    one = commands.add_parser("run", help="run a case and print a line an observable")
    one.add_argument("case", nargs="+",
                     help="name of a folder of cases/, CASE.POINT for one of its points, or the path of a scene")
    one.add_argument("--code", default="mappm", metavar="NAME",
                     help="the code that is judged (default mappm): a name that `codes` lists, or "
                     "the path of an adapter")
    one.add_argument("--set", metavar="KEY=VALUE", action="append", default=[],
                     help="set a parameter of the case or a key of the scene: then it runs alone, without levels, and the goals "
                     "alone decide")
    one.add_argument("--tier", choices=TIERS, default="quick", help="full adds the levels that take long")
    one.add_argument("--ranks", type=int, default=1, help="cores of each run")
    one.add_argument("--jobs", type=int, default=cores(), metavar="K", help="runs of a case at a time (default: a core each)")
    one.add_argument("--anew", action="store_true", help="run also what the store has; its digest must come out again")
    one.add_argument("--scratch", action="store_true", help="in a store of its own, which starts empty and is removed")
    _add_lab(one)


def _add_store(commands) -> None:
    store = commands.add_parser("store", help="what the store holds")
    what = store.add_subparsers(dest="what", required=True)
    listed = what.add_parser("list", help="a line a run")
    listed.add_argument("--code", help="of this code alone")
    what.add_parser("show", help="all about one run").add_argument("key", help="that `list` prints, or its first digits")
    what.add_parser("export", help="write it as text, JSON lines").add_argument("file", type=Path)
    what.add_parser("import", help="enter what an export holds and the store does not").add_argument("file", type=Path)
    pruned = what.add_parser("prune", help="remove runs of other numerics versions than that of the programs")
    pruned.add_argument("--folders", action="store_true",
                        help="remove the folders of all runs, and keep what the store holds of them")
    for parser in what.choices.values():
        _add_lab(parser)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python3 -m verification", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    listed = commands.add_parser("list", help="the cases, their tier and their cost in core-seconds")
    listed.add_argument("--ctest", action="store_true", help="a line a test: name, core-seconds, processors, labels")
    commands.add_parser("codes", help="the codes that can be judged or be references, and what they can do")
    _add_run(commands)

    scene = commands.add_parser("scene", help="print the scene of a case or of one of its points, as mappm run takes it")
    scene.add_argument("case", help="as for run")
    scene.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="a parameter or a key of the scene")

    report = commands.add_parser("report", help="run what is missing of the tier, then draw what the store holds")
    report.add_argument("--tier", choices=TIERS, default="quick")
    report.add_argument("--out", type=Path, default=ROOT / "reports" / "out", metavar="DIR",
                        help="folder of the page (default reports/out)")
    report.add_argument("--publish", action="store_true",
                        help="also copy page, summary and the store as text to reports/published")
    report.add_argument("--only-draw", action="store_true", help="run nothing")
    _add_lab(report)

    many = commands.add_parser("study",
                               help="run what is missing of a study and print its table; without a name, list the studies")
    many.add_argument("name", nargs="?", help="CASE.NAME")
    many.add_argument("--jobs", type=int, default=cores(), metavar="K", help="runs at a time (default: a core each)")
    many.add_argument("--only-show", action="store_true", help="run nothing")
    many.add_argument("--repeats", type=_count, default=1, metavar="K", help="measure the cost of each run K times (default 1)")
    many.add_argument("--out", type=Path, default=ROOT / "reports" / "out" / "charts", metavar="DIR",
                      help="folder of the chart (default reports/out/charts)")
    _add_lab(many)

    bits = commands.add_parser("compare-bits", help="compare digests of the serial reference and the parallel solver")
    bits.add_argument("scene", type=Path)
    bits.add_argument("--ranks", type=_ranks, default=[1, 2], metavar="1,2,4", help="default 1,2")
    bits.add_argument("--steps", type=int, help="default: those of the scene")
    bits.add_argument("--every", type=int, metavar="K", help="steps between comparisons (default: those of the scene)")
    bits.add_argument("--build", type=Path, metavar="DIR", help="folder whose bin/mappm is compared (default: as for run)")

    adapter = commands.add_parser("conform", help="hold the adapter of a code against the protocol")
    adapter.add_argument("adapter", help="a name that `codes` lists, or the path of an executable or of a .py file")
    _add_store(commands)
    return parser


def _called(arguments: argparse.Namespace) -> int:
    match arguments.command:
        case "list":
            return list_cases(arguments.ctest)
        case "codes":
            return list_codes()
        case "run":
            return run_named(arguments)
        case "scene":
            return show_scene(arguments.case, arguments.set)
        case "compare-bits":
            return compare_bits(arguments.scene, arguments.ranks, arguments.steps, arguments.every, arguments.build)
        case "conform":
            from verification.codes.conform import conform

            return conform(arguments.adapter)
        case "store":
            return use_store(arguments)
        case "report":
            return report(arguments)
        case "study":
            return study(arguments)


def _stopped(number: int, frame: object) -> None:
    raise KeyboardInterrupt


def main() -> int:
    signal.signal(signal.SIGTERM, _stopped)
    # Ignored under nohup; else a terminal that closes would leave its runs behind.
    if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
        signal.signal(signal.SIGHUP, _stopped)
    try:
        status = _called(_parser().parse_args())
        sys.stdout.flush()
        return status
    except BrokenPipeError:  # who reads has seen enough, as `head` has
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 141
    except KeyboardInterrupt:
        print("verification: stopped; what was made before is in the store", file=sys.stderr)
        return 130
    except (CaseError, SolverError, StoreError, Beyond) as error:
        print(f"verification: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
