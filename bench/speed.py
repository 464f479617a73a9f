"""How fast the solver is: beside LIGGGHTS' SPH on the same fluid, on two processes beside one, and from few to many PPs.

    python3 -m bench.speed [--quick] [--repeats N] [--json FILE] [--out DIR]

The fluid is that of the case sph_peer: a lattice with a shear wave, 39 neighbours a particle in the plane and 77 in space,
the same for both codes. MaPPM also runs it without transport velocity, a term that LIGGGHTS' SPH does not have. Runs
alternate, so that what else the machine does meets all of them; a figure is a median, and a ratio the median of ratios within
one round. Prints a line a figure, `ratio NAME VALUE` or `figure NAME VALUE`. Ends with 1 where a measurement is broken (a run
that failed, digests that differ between one process and two), never because the machine is slow, and with 77 where LIGGGHTS is
not installed.
"""

import argparse
import json
import re
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from reference.liggghts import sph
from reference.liggghts.program import CODE, Failed, installed, run_script
from verification.errors import SolverError
from verification.provenance import processor
from verification.runner import cores
from verification.solver import ROOT, Options, Run, run

SCENE = ROOT / "cases" / "sph_peer" / "case.toml"
WITHOUT_TRANSPORT = "fluid.transport=false"
SKIPPED_CODE = 77  # what ctest takes for skipped
PEER_SKIN = sph.SKINS[0]
FLUIDS = {"2d_39": (2, 400), "3d_77": (3, 54)}  # dimension, particles along a side: about 160 000
QUICK_FLUIDS = {"2d_39": (2, 64), "3d_77": (3, 16)}
SIZES = {"1e4": 100, "1e5": 316, "1e6": 1000}  # in the plane: particles along a side
QUICK_SIZES = {"1e3": 32, "1e4": 100}


class Broken(RuntimeError):
    """A measurement that is none."""


@dataclass(frozen=True)
class Speed:
    """Of one run: particle-steps a second of wall time, start and output left out."""

    rate: float
    digest: str = ""
    phases: dict[str, float] | None = None  # wall seconds


def scene_of(dimension: int, sides: tuple[int, ...]) -> tuple[str, ...]:
    """Overrides of sph_peer; sides in particles, an entry an axis."""
    reach = 2.0 * sph.Fluid(dimension, 10, 1).smoothing_length
    return (
        f"box.size=[{', '.join(f'{side}.0' for side in sides)}]",
        f"fluid.rcut={reach!r}",
        "output.sample=1000000",
        "output.snapshot=1000000",
    )


def steps_for(particles: int, quick: bool) -> int:
    """A second or more on one core, and enough steps to leave the lattice and to make lists of neighbours some ten times."""
    return 10 if quick else max(80, min(1600, 16_000_000 // particles))


def own_speed(overrides: tuple[str, ...], steps: int, ranks: int, folder: Path) -> Speed:
    finished: Run = run(SCENE, folder / "mappm", Options(ranks=ranks, steps=steps, overrides=overrides))
    record = finished.record
    phases = {name: seconds for name, seconds in record["wall_seconds"].items() if name not in ("output", "steps")}
    return Speed(record["particle_steps_per_second"], record["digest"], phases)


def peer_speed(fluid: sph.Fluid, ranks: int, folder: Path) -> Speed:
    script = "\n".join(line for line in sph.script_of(fluid, PEER_SKIN).splitlines() if not line.startswith("dump"))
    finished = run_script(script + "\n", folder / "liggghts", ranks)
    loop = re.search(r"Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", finished.log)
    if not loop or int(loop[3]) != fluid.particles:
        raise Broken(f"LIGGGHTS printed no loop time for {fluid.particles} particles: {finished.log[-300:]}")
    return Speed(fluid.particles * fluid.steps / float(loop[1]))


class Meter:
    """Rounds of runs: each round makes every run once, in turn."""

    def __init__(self, repeats: int, say: Callable[[str], None]):
        self.repeats, self.say = repeats, say

    def rounds(self, name: str, runs: dict[str, Callable[[], Speed]]) -> dict[str, list[Speed]]:
        found: dict[str, list[Speed]] = {key: [] for key in runs}
        started = time.monotonic()
        for done in range(self.repeats):
            for key, once in runs.items():
                found[key].append(once())
            left = (time.monotonic() - started) * (self.repeats - done - 1) / (done + 1)
            self.say(f"{name}: round {done + 1} of {self.repeats}, {left:.0f} s left")
        for key, speeds in found.items():
            if len({speed.digest for speed in speeds}) > 1:
                raise Broken(f"{name}, {key}: rounds end with different digests")
        return found


def median_rate(speeds: list[Speed]) -> float:
    return statistics.median(speed.rate for speed in speeds)


def median_ratio(over: list[Speed], under: list[Speed]) -> float:
    return statistics.median(a.rate / b.rate for a, b in zip(over, under, strict=True))


def against_peer(meter: Meter, quick: bool, folder: Path, with_peer: bool) -> dict[str, float]:
    figures = {}
    for name, (dimension, side) in (QUICK_FLUIDS if quick else FLUIDS).items():
        fluid = sph.Fluid(dimension, side, steps_for(side**dimension, quick))
        overrides = scene_of(dimension, (side,) * dimension)
        runs: dict[str, Callable[[], Speed]] = {}
        for ranks in (1, 2):
            for code, more in (("own", ()), ("plain", (WITHOUT_TRANSPORT,))):
                runs[f"{code}_{ranks}"] = lambda ranks=ranks, o=overrides + more, f=fluid: own_speed(o, f.steps, ranks, folder)
            if with_peer:
                runs[f"peer_{ranks}"] = lambda ranks=ranks, f=fluid: peer_speed(f, ranks, folder)
        found = meter.rounds(f"fluid {name}", runs)
        for code in ("own", "plain"):
            if found[f"{code}_1"][0].digest != found[f"{code}_2"][0].digest:
                raise Broken(f"fluid {name}: the digest on two processes is not that on one")
        for ranks in (1, 2):
            own, plain = found[f"own_{ranks}"], found[f"plain_{ranks}"]
            figures[f"figure fluid_{name}.particle_steps_per_s_{ranks}"] = median_rate(own)
            figures[f"figure fluid_{name}.without_transport_particle_steps_per_s_{ranks}"] = median_rate(plain)
            if with_peer:
                peer = found[f"peer_{ranks}"]
                figures[f"figure fluid_{name}.liggghts_particle_steps_per_s_{ranks}"] = median_rate(peer)
                figures[f"ratio fluid_{name}.over_liggghts_{ranks}"] = median_ratio(own, peer)
                figures[f"ratio fluid_{name}.without_transport_over_liggghts_{ranks}"] = median_ratio(plain, peer)
        figures[f"ratio fluid_{name}.two_processes_over_one"] = median_ratio(found["own_2"], found["own_1"])
        phases = [speed.phases for speed in found["own_1"]]
        for phase in phases[0]:
            shares = [seconds[phase] / sum(seconds.values()) for seconds in phases]
            figures[f"ratio fluid_{name}.share_{phase}"] = statistics.median(shares)
    return figures


def over_sizes(meter: Meter, quick: bool, folder: Path) -> dict[str, float]:
    """Cost of a particle on one process over the number of particles, and weak scaling: twice the fluid on two."""
    sizes = QUICK_SIZES if quick else SIZES
    runs = {}
    for name, side in sizes.items():
        steps = steps_for(side * side, quick)
        for ranks in (1, 2):
            overrides = scene_of(2, (side * ranks, side))
            runs[f"{name}_{ranks}"] = lambda o=overrides, s=steps, r=ranks: own_speed(o, s, r, folder)
    found = meter.rounds("sizes", runs)
    figures = {}
    for name in sizes:
        figures[f"figure size_{name}.particle_steps_per_s"] = median_rate(found[f"{name}_1"])
        figures[f"ratio size_{name}.weak_efficiency_2"] = median_ratio(found[f"{name}_2"], found[f"{name}_1"]) / 2
    rates = [median_rate(found[f"{name}_1"]) for name in sizes]
    figures["ratio sizes.cost_dearest_over_cheapest"] = max(rates) / min(rates)
    return figures


def measure(quick: bool, repeats: int, folder: Path, say: Callable[[str], None]) -> tuple[dict[str, float], str]:
    """Figures by "ratio NAME" or "figure NAME", and where they come from. Throws Broken, SolverError, Failed."""
    meter = Meter(repeats, say)
    figures = against_peer(meter, quick, folder, installed()) | over_sizes(meter, quick, folder)
    return figures, Run(folder / "mappm").record["commit"]


Measure = Callable[[bool, int, Path, Callable[[str], None]], tuple[dict[str, float], str]]


def keep(figures: dict[str, float], command: str, commit: str, file: Path | None) -> None:
    """Prints a line a figure; writes them to the file, if there is one, with where they come from."""
    for name, value in figures.items():
        print(f"{name} {value:.4g}")
    if file is None:
        return
    table = {"date": f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC", "command": command, "commit": commit,
             "host": f"{processor()}, {cores()} cores", "figures": figures}
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(table, indent=1) + "\n")


def run_benchmark(name: str, words: str, measure: Measure) -> int:
    """Reads the command line of `python3 -m bench.NAME`, measures, prints and keeps the figures. 1 where a measurement is broken."""
    parser = argparse.ArgumentParser(prog=f"python3 -m bench.{name}", description=words,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="small scenes, which take seconds: to see that all works")
    parser.add_argument("--repeats", type=int, help="rounds, at least 1; default 7, with --quick 1")
    parser.add_argument("--json", type=Path, help="also keep the figures in this file")
    parser.add_argument("--out", type=Path, help="folder of the runs (default: one that is removed)")
    options = parser.parse_args()
    repeats = options.repeats if options.repeats is not None else (1 if options.quick else 7)
    if repeats < 1:
        parser.error(f"--repeats {repeats}: must be at least 1")
    with tempfile.TemporaryDirectory() as scratch:
        try:
            figures, commit = measure(options.quick, repeats, options.out or Path(scratch),
                                      lambda text: print(text, file=sys.stderr, flush=True))
        except (Broken, SolverError, Failed) as error:
            print(f"{name}: {error}", file=sys.stderr)
            return 1
    command = f"python3 -m bench.{name}" + (" --quick" if options.quick else "")
    keep(figures, f"{command} --repeats {repeats}", commit, options.json)
    return 0


def main() -> int:
    code = run_benchmark("speed", __doc__, measure)
    if code == 0 and not installed():
        print(f"{CODE} is not installed: no ratio to it. apt-get install liggghts", file=sys.stderr)
        return SKIPPED_CODE
    return code


if __name__ == "__main__":
    sys.exit(main())
