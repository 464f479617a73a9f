"""How fast the solver is: beside the SPH of LIGGGHTS and of LAMMPS on the same fluid, on two processes, and from few to many PPs.

    python3 -m bench.speed [--quick] [--repeats N] [--lab DIR] [--out DIR]

The fluid is that of the case sph_peer with nu = .01 c h: a lattice with a shear wave, c = 20 U, 39 neighbours a particle in the
plane and 77 in space, the same for all codes. A code that takes longer steps needs fewer of them. So each goes at its own largest
useful step, which is found first (bench/largest_step.py), and what counts is flow time a core-second: the step in h/c times
particle-steps a second and core; h is half the range of the pair law. MaPPM also runs without transport velocity, a term
that the others do not have. These run with the skin of their lists of neighbours that is quickest at their step. Runs
alternate, so that what else the machine does meets all of them; a figure is a median with its range over rounds, a ratio
that of ratios within one round. Prints a line a figure: name, settings, value, range, unit. Ends with 1 where a measurement is broken (a run
that failed, digests that differ between one process and two), never because the machine is slow, and with 77 where LIGGGHTS or
LAMMPS is not installed: its rows are SKIPPED.
"""

import sys
from collections.abc import Callable
from pathlib import Path

from bench.codes import MAPPM, WITHOUT_TRANSPORT, Code, own_speed, peers
from bench.largest_step import VISCOSITY, Found, largest_step
from bench.meter import Broken, Meter, Row, Speed, rate_of, ratio_of, row, run_benchmark, spread_of
from reference.periodic_fluid import Fluid
from verification.protocol.run import Run

SKIPPED_CODE = 77  # what ctest takes for skipped
PROCESSES = (1, 2)
PEER_SHARE = 2 / 3  # of the steps of MaPPM, which is quicker
FLUIDS = {"2d_39": (2, 400), "3d_77": (3, 54)}  # dimension, particles along a side: about 160 000
QUICK_FLUIDS = {"2d_39": (2, 64), "3d_77": (3, 16)}
SIZES, QUICK_SIZES = (100, 316, 1000), (32, 100)  # in the plane: particles along a side


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


def step_rows(fluid: str, code: Code, found: Found) -> list[Row]:
    """The decays are those at small steps, over the exact ones: all codes must have about the same flow."""
    decays = zip(("wave", "vortices"), found.rates, strict=True)
    return [row("largest_step", found.step, "h/c", fluid=fluid, code=code.name),
            *(row("decay_over_exact", rate, fluid=fluid, code=code.name, flow=flow) for flow, rate in decays)]


def rate_rows(fluid: str, code: Code, step: float, speeds: dict[int, list[Speed]]) -> list[Row]:
    """speeds: by the number of processes."""
    rows = []
    for ranks, found in speeds.items():
        rate = rate_of(found)
        rows += [row("particle_steps_per_s", rate, "1/s", fluid=fluid, code=code.name, ranks=ranks),
                 row("flow_time_per_core_s", rate.times(step / ranks), "h/c/s", fluid=fluid, code=code.name, ranks=ranks)]
    return rows


def ratio_rows(fluid: str, code: Code, peer: Code, steps: dict[Code, float], found: dict[tuple[Code, int], list[Speed]]) -> list[Row]:
    """In particle-steps a second and in flow time a core-second."""
    rows = []
    for ranks in PROCESSES:
        settings = {"fluid": fluid, "code": code.name, "peer": peer.name, "ranks": ranks}
        ratio = ratio_of(found[code, ranks], found[peer, ranks])
        rows += [row("rate_over_peer", ratio, **settings),
                 row("flow_time_over_peer", ratio.times(steps[code] / steps[peer]), **settings)]
    return rows


def share_rows(fluid: str, speeds: list[Speed]) -> list[Row]:
    """Of the phases of a step."""
    phases = [speed.phases for speed in speeds]
    return [row("share", spread_of(seconds[phase] / sum(seconds.values()) for seconds in phases),
                fluid=fluid, code=MAPPM.name, ranks=1, phase=phase) for phase in phases[0]]


def of_fluid(name: str, dimension: int, side: int, meter: Meter, quick: bool, folder: Path) -> list[Row]:
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
    rows: list[Row] = []
    for code in codes:
        rows += step_rows(name, code, largest[code])
        rows += rate_rows(name, code, steps[code], {ranks: found[code, ranks] for ranks in PROCESSES})
    for code in own:
        for peer in others:
            rows += ratio_rows(name, code, peer, steps, found)
    rows.append(row("two_processes_over_one", ratio_of(found[MAPPM, 2], found[MAPPM, 1]), fluid=name, code=MAPPM.name))
    return rows + share_rows(name, found[MAPPM, 1])


def against_peers(meter: Meter, quick: bool, folder: Path) -> list[Row]:
    rows: list[Row] = []
    for name, (dimension, side) in (QUICK_FLUIDS if quick else FLUIDS).items():
        rows += of_fluid(name, dimension, side, meter, quick, folder)
    return rows


def over_sizes(meter: Meter, quick: bool, folder: Path) -> list[Row]:
    """Cost of a particle on one process over the number of particles, and weak scaling: twice the fluid on two."""
    sides = QUICK_SIZES if quick else SIZES
    runs: dict[tuple[int, int], Callable[[], Speed]] = {}
    for side in sides:
        steps = steps_for(side * side, quick)
        for ranks in PROCESSES:
            overrides = scene_of(2, (side * ranks, side))
            runs[side, ranks] = lambda o=overrides, s=steps, r=ranks: own_speed(o, s, r, folder)
    found = meter.rounds("sizes", runs)
    rows = []
    for side in sides:
        weak = ratio_of(found[side, 2], found[side, 1]).times(0.5)
        rows += [row("particle_steps_per_s", rate_of(found[side, 1]), "1/s", particles=side * side, code=MAPPM.name, ranks=1),
                 row("weak_efficiency", weak, particles=side * side, code=MAPPM.name, ranks=2)]
    rates = [rate_of(found[side, 1]).value for side in sides]
    return [*rows, row("cost_dearest_over_cheapest", max(rates) / min(rates), code=MAPPM.name, ranks=1)]


def measure(quick: bool, repeats: int, folder: Path, say: Callable[[str], None]) -> tuple[list[Row], str]:
    """Figures, and the commit they are of. Throws Broken, SolverError, Failed."""
    meter = Meter(repeats, say)
    rows = against_peers(meter, quick, folder) + over_sizes(meter, quick, folder)
    return rows, Run(folder / "mappm").record["commit"]


def main() -> int:
    code = run_benchmark("speed", __doc__, measure, rounds=5)
    for words in peers()[1]:
        print(f"rows SKIPPED: {words}", file=sys.stderr)
    return SKIPPED_CODE if code == 0 and peers()[1] else code


if __name__ == "__main__":
    sys.exit(main())
