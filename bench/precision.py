"""What single precision of pairs gains and loses, and what exact sums cost.

    python3 -m bench.precision [--quick] [--repeats N] [--lab DIR] [--out DIR]

Speed: steps of the fluids of bench.speed in both precisions, in turn; a ratio is the median of the ratios within a round.
Accuracy: cases with a known answer, at their levels, in both: how far single precision is from double, beside how far double
precision is from the answer. Exactness: the pair pass with floating-point sums against that with exact ones, where the build of the
preset `floating-sums` is there (bench-pair_numbers; no run can select it). Prints a line a figure: name,
settings, value, unit. Ends with 1 where a measurement is broken, never because the machine is slow.
"""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from bench.codes import own_speed
from bench.meter import Broken, Meter, Row, Speed, printed, rate_of, ratio_of, row, run_benchmark
from bench.speed import FLUIDS, QUICK_FLUIDS, scene_of, steps_for
from verification.codes.code import find_code
from verification.codes.mappm import Options, run
from verification.protocol.machine import ROOT
from verification.protocol.run import Run
from verification.suite.case import Case
from verification.suite.manifest import find_case
from verification.suite.parameters import overrides_of
from verification.suite.references import resolved
from verification.suite.runner import measured

SINGLE = 'fluid.precision="single"'
FLOATING_SUMS = ROOT / "build" / "floating-sums" / "bin" / "bench-pair_numbers"
CASES = ("shear_wave", "poiseuille", "taylor_green")  # with an exact answer, judged in the quick tier


def of_speed(meter: Meter, quick: bool, folder: Path) -> list[Row]:
    rows = []
    for name, (dimension, side) in (QUICK_FLUIDS if quick else FLUIDS).items():
        overrides, steps = scene_of(dimension, (side,) * dimension), steps_for(side**dimension, quick)
        runs: dict[str, Callable[[], Speed]] = {
            "double": lambda o=overrides, s=steps: own_speed(o, s, 1, folder),
            "single": lambda o=overrides, s=steps: own_speed((*o, SINGLE), s, 1, folder),
            "single_2": lambda o=overrides, s=steps: own_speed((*o, SINGLE), s, 2, folder),
        }
        found = meter.rounds(f"fluid {name}", runs)
        if found["single"][0].digest != found["single_2"][0].digest:
            raise Broken(f"fluid {name}, single precision: the digest on two processes is not that on one")
        rows += [row("particle_steps_per_s", rate_of(found[precision]), "1/s", fluid=name, precision=precision, ranks=1)
                 for precision in ("double", "single")]
        rows.append(row("single_over_double", ratio_of(found["single"], found["double"]), fluid=name, ranks=1))
    return rows


def of_accuracy(case: Case, levels: int, folder: Path) -> list[Row]:
    """At each of the coarsest levels, in units of the answer."""
    rows, code = [], find_code("mappm")
    observable = resolved(case, None).observables[0]
    for place, level in enumerate(case.levels_of("quick")[:levels]):
        values = {}
        for precision, more in (("double", ()), ("single", (SINGLE,))):
            options = Options(overrides=overrides_of(case, level.overrides) + more)
            finished = run(case.file, folder / case.name / f"{place}_{precision}", options)
            values[precision] = measured(case, finished, code, with_charts=False).values[observable.name].value
        here, scale = {"case": case.name, "level": place}, abs(observable.reference) or 1.0
        rows += [row("spacing", float(finished.scene["fluid"]["spacing"]), **here),
                 row("double_off_the_answer", abs(values["double"] - observable.reference) / scale, **here),
                 row("single_off_double", abs(values["single"] - values["double"]) / scale, **here)]
    return rows


def of_exactness() -> list[Row]:
    """Of the pair pass alone; nothing where that build is missing."""
    if not FLOATING_SUMS.exists():
        return []
    done = subprocess.run([str(FLOATING_SUMS)], capture_output=True, text=True)
    found = printed(done.stdout)
    if done.returncode or not found:
        raise Broken(f"{FLOATING_SUMS} ended with {done.returncode}: {done.stderr[-300:]}")
    return [row(one.name, one.value, fluid=one.owner[-1], part="pass") for one in found]


def measure(quick: bool, repeats: int, folder: Path, say: Callable[[str], None]) -> tuple[list[Row], str]:
    """Figures, and the commit they are of. Throws Broken, SolverError."""
    rows = of_speed(Meter(repeats, say), quick, folder)
    for name in CASES[:1] if quick else CASES:
        say(f"accuracy: {name}")
        rows += of_accuracy(find_case(name), 1 if quick else 3, folder)
    exactness = of_exactness()
    if not exactness:
        say("what exactness costs: left out; cmake --preset floating-sums && cmake --build --preset floating-sums")
    return rows + exactness, Run(folder / "mappm").record["commit"]


def main() -> int:
    return run_benchmark("precision", __doc__, measure)


if __name__ == "__main__":
    sys.exit(main())
