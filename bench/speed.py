"""How fast the solver is: beside the SPH of LIGGGHTS and of LAMMPS on the same fluid, on two processes, and from few to many PPs.

    python3 -m bench.speed [--quick] [--repeats N] [--json FILE] [--out DIR]

The fluid is that of the case sph_peer with nu = .01 c h: a lattice with a shear wave, c = 20 U, 39 neighbours a particle in the
plane and 77 in space, the same for all codes. A code that takes longer steps needs fewer of them. So each goes at its own largest
useful step, which is found first (bench/largest_step.py), and what counts is flow time a core-second: the step in h/c times
particle-steps a second and core; h is half the range of the pair law. MaPPM also runs without transport velocity, a term
that the others do not have. These run with the skin of their lists of neighbours that is quickest at their step. Runs
alternate, so that what else the machine does meets all of them; a figure is a median, and a ratio the median of ratios within
one round. Prints a line a figure, `ratio NAME VALUE` or `figure NAME VALUE`. Ends with 1 where a measurement is broken (a run
that failed, digests that differ between one process and two), never because the machine is slow, and with 77 where LIGGGHTS or
LAMMPS is not installed: its rows are SKIPPED.
"""

import statistics
import sys
from collections.abc import Callable
from pathlib import Path

from bench.codes import MAPPM, WITHOUT_TRANSPORT, Code, own_speed, peers
from bench.largest_step import VISCOSITY, Found, largest_step
from bench.meter import Broken, Meter, Speed, median_rate, median_ratio, run_benchmark
from reference.periodic_fluid import Fluid
from verification.protocol.run import Run

SKIPPED_CODE = 77  # what ctest takes for skipped
PROCESSES = (1, 2)
PEER_SHARE = 2 / 3  # of the steps of MaPPM, which is quicker
FLUIDS = {"2d_39": (2, 400), "3d_77": (3, 54)}  # dimension, particles along a side: about 160 000
QUICK_FLUIDS = {"2d_39": (2, 64), "3d_77": (3, 16)}
SIZES = {"1e4": 100, "1e5": 316, "1e6": 1000}  # in the plane: particles along a side
QUICK_SIZES = {"1e3": 32, "1e4": 100}


def scene_of(dimension: int, sides: tuple[int, ...]) -> tuple[str, ...]:
    """Overrides of sph_peer; sides in particles, an entry an axis."""
    reach = 2.0 * Fluid(dimension, 10, 1).smoothing_length
    return (
        f"box.size=[{', '.join(f'{side}.0' for side in sides)}]",
        f"fluid.rcut={reach!r}",
        "output.sample=1000000",
        "output.snapshot=1000000",
    )


def steps_for(particles: int, quick: bool) -> int:
    """A second or more on one core, and enough steps to leave the lattice and to make lists of neighbours some ten times."""
    return 10 if quick else max(80, min(1600, 16_000_000 // particles))


def prefix_of(code: Code) -> str:
    """Before the names of its figures."""
    return "" if code is MAPPM else f"{code.name}_"


def step_figures(name: str, code: Code, found: Found) -> dict[str, float]:
    """The decays are those at small steps, over the exact ones: all codes must have about the same flow."""
    prefix = f"fluid_{name}.{prefix_of(code)}"
    figures = {f"figure {prefix}largest_step": found.step}
    return figures | {f"ratio {prefix}{flow}_decay_over_exact": rate
                      for flow, rate in zip(("wave", "vortices"), found.rates, strict=True)}


def rate_figures(name: str, code: Code, step: float, speeds: dict[int, list[Speed]]) -> dict[str, float]:
    """speeds: by the number of processes."""
    prefix, figures = f"fluid_{name}.{prefix_of(code)}", {}
    for ranks, found in speeds.items():
        rate = median_rate(found)
        figures[f"figure {prefix}particle_steps_per_s_{ranks}"] = rate
        figures[f"figure {prefix}flow_time_per_core_s_{ranks}"] = step * rate / ranks
    return figures


def ratio_figures(name: str, code: Code, peer: Code, steps: dict[Code, float],
                  found: dict[tuple[Code, int], list[Speed]]) -> dict[str, float]:
    """In particle-steps a second and in flow time a core-second."""
    prefix, figures = f"fluid_{name}.{prefix_of(code)}", {}
    for ranks in PROCESSES:
        ratio = median_ratio(found[code, ranks], found[peer, ranks])
        figures[f"ratio {prefix}over_{peer.name}_{ranks}"] = ratio
        figures[f"ratio {prefix}flow_time_over_{peer.name}_{ranks}"] = ratio * steps[code] / steps[peer]
    return figures


def share_figures(name: str, speeds: list[Speed]) -> dict[str, float]:
    """Of the phases of a step."""
    phases = [speed.phases for speed in speeds]
    return {f"ratio fluid_{name}.share_{phase}": statistics.median(seconds[phase] / sum(seconds.values()) for seconds in phases)
            for phase in phases[0]}


def of_fluid(name: str, dimension: int, side: int, meter: Meter, quick: bool, folder: Path) -> dict[str, float]:
    own, others = [MAPPM, WITHOUT_TRANSPORT], peers()[0]
    codes: list[Code] = [*own, *others]
    largest = {code: largest_step(code, dimension, quick, folder, meter.say) for code in codes}
    steps = {code: found.step for code, found in largest.items()}
    runs: dict[tuple[Code, int], Callable[[], Speed]] = {}
    most = steps_for(side**dimension, quick)
    for ranks in PROCESSES:
        for code in codes:
            fluid = Fluid(dimension, side, most if code in own else round(most * PEER_SHARE), steps[code], viscosity=VISCOSITY)
            runs[code, ranks] = lambda c=code, f=fluid, r=ranks: c.speed(f, r, folder)
    found = meter.rounds(f"fluid {name}", runs)
    if any(found[code, 1][0].digest != found[code, 2][0].digest for code in own):
        raise Broken(f"fluid {name}: the digest on two processes is not that on one")
    figures: dict[str, float] = {}
    for code in codes:
        figures |= step_figures(name, code, largest[code])
        figures |= rate_figures(name, code, steps[code], {ranks: found[code, ranks] for ranks in PROCESSES})
    for code in own:
        for peer in others:
            figures |= ratio_figures(name, code, peer, steps, found)
    figures[f"ratio fluid_{name}.two_processes_over_one"] = median_ratio(found[MAPPM, 2], found[MAPPM, 1])
    return figures | share_figures(name, found[MAPPM, 1])


def against_peers(meter: Meter, quick: bool, folder: Path) -> dict[str, float]:
    figures: dict[str, float] = {}
    for name, (dimension, side) in (QUICK_FLUIDS if quick else FLUIDS).items():
        figures |= of_fluid(name, dimension, side, meter, quick, folder)
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
    figures = against_peers(meter, quick, folder) | over_sizes(meter, quick, folder)
    return figures, Run(folder / "mappm").record["commit"]


def main() -> int:
    code = run_benchmark("speed", __doc__, measure, rounds=5)
    for words in peers()[1]:
        print(f"rows SKIPPED: {words}", file=sys.stderr)
    return SKIPPED_CODE if code == 0 and peers()[1] else code


if __name__ == "__main__":
    sys.exit(main())
