"""What single precision of pairs gains and loses, and what exact sums cost.

    python3 -m bench.precision [--quick] [--repeats N] [--json FILE] [--out DIR]

Speed: steps of the fluids of bench.speed in both precisions, in turn; a ratio is the median of the ratios within a round.
Accuracy: cases with a known answer, at their levels, in both: how far single precision is from double, beside how far double
precision is from the answer. Exactness: the pair pass with floating-point sums against that with exact ones, where the build of the
preset `floating-sums` is there (bench-pair_numbers; no run can select it). Prints a line a figure, `ratio NAME VALUE` or
`figure NAME VALUE`. Ends with 1 where a measurement is broken, never because the machine is slow.
"""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from bench.codes import own_speed
from bench.meter import Broken, Meter, Speed, median_rate, median_ratio, run_benchmark
from bench.speed import FLUIDS, QUICK_FLUIDS, scene_of, steps_for
from verification.codes.mappm import Options, run
from verification.protocol.machine import ROOT
from verification.protocol.run import Run
from verification.suite.case import Case
from verification.suite.judge import measures
from verification.suite.manifest import find_case
from verification.suite.parameters import overrides_of
from verification.suite.references import resolved

SINGLE = 'fluid.precision="single"'
FLOATING_SUMS = ROOT / "build" / "floating-sums" / "bin" / "bench-pair_numbers"
CASES = ("shear_wave", "poiseuille", "taylor_green")  # with an exact answer, judged in the quick tier


def of_speed(meter: Meter, quick: bool, folder: Path) -> dict[str, float]:
    figures = {}
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
        for precision in ("double", "single"):
            figures[f"figure fluid_{name}.particle_steps_per_s_{precision}"] = median_rate(found[precision])
        figures[f"ratio fluid_{name}.single_over_double"] = median_ratio(found["single"], found["double"])
    return figures


def of_accuracy(case: Case, levels: int, folder: Path) -> dict[str, float]:
    """At each of the coarsest levels, in units of the answer."""
    figures = {}
    observable = resolved(case, None).observables[0]
    measured = measures(case)[observable.name]
    for place, level in enumerate(case.levels_of("quick")[:levels]):
        values = {}
        for precision, more in (("double", ()), ("single", (SINGLE,))):
            finished = run(case.file, folder / case.name / f"{place}_{precision}", Options(overrides=overrides_of(case, level.overrides) + more))
            values[precision] = measured(finished).value
        name, scale = f"{case.name}.level_{place}", abs(observable.reference) or 1.0
        figures[f"figure {name}.spacing"] = float(finished.scene["fluid"]["spacing"])
        figures[f"ratio {name}.double_off_the_answer"] = abs(values["double"] - observable.reference) / scale
        figures[f"ratio {name}.single_off_double"] = abs(values["single"] - values["double"]) / scale
    return figures


def of_exactness() -> dict[str, float]:
    if not FLOATING_SUMS.exists():
        return {}
    done = subprocess.run([str(FLOATING_SUMS)], capture_output=True, text=True)
    lines = [line.rsplit(" ", 1) for line in done.stdout.splitlines() if line.startswith("ratio ")]
    if done.returncode or not lines:
        raise Broken(f"{FLOATING_SUMS} ended with {done.returncode}: {done.stderr[-300:]}")
    return {name: float(value) for name, value in lines}


def measure(quick: bool, repeats: int, folder: Path, say: Callable[[str], None]) -> tuple[dict[str, float], str]:
    """Figures by "ratio NAME" or "figure NAME", and the commit they are of. Throws Broken, SolverError."""
    figures = of_speed(Meter(repeats, say), quick, folder)
    for name in CASES[:1] if quick else CASES:
        say(f"accuracy: {name}")
        figures |= of_accuracy(find_case(name), 1 if quick else 3, folder)
    exactness = of_exactness()
    if not exactness:
        say("what exactness costs: left out; cmake --preset floating-sums && cmake --build --preset floating-sums")
    return figures | exactness, Run(folder / "mappm").record["commit"]


def main() -> int:
    return run_benchmark("precision", __doc__, measure)


if __name__ == "__main__":
    sys.exit(main())
