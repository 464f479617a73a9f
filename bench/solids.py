"""What solids cost: their share of a step, and a step beside one of the same box full of fluid.

    python3 -m bench.solids [--quick] [--repeats N] [--lab DIR] [--out DIR]

The cost of solids is what a fluid has not: placing FPs, their densities and loads, contacts, motion of solids (phase
`solids`), and copies of solids with their messages (phase `copies`). Pairs of PPs and FPs (phase `frozen_pairs`) stand beside
it: without the solid there would be pairs of PPs in their place. Runs alternate; a figure is a median over rounds, and a ratio
the median of ratios within one round. Prints a line a figure: name, settings, value, unit. Ends with 1 where a
measurement is broken (a run that failed, digests that differ between one process and two), never because the machine is slow.
"""

import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from bench.meter import Broken, Meter, Row, Speed, ratio_of, row, run_benchmark, spread_of
from bench.speed import steps_for
from reference.periodic_fluid import Fluid
from verification.codes.mappm import Options, run
from verification.protocol.machine import ROOT
from verification.protocol.run import Run

FLUID = ROOT / "cases" / "sph_peer" / "case.toml"
GAS_SOLID = ROOT / "cases" / "gas_solid_small" / "case.toml"
UNSAMPLED = ("output.sample=1000000", "output.snapshot=1000000")
CONTACT = 'contact={model="linear", stiffness=1000.0, restitution=0.9, friction=0.3}'  # a contact outlasts a run
COST = ("solids", "copies")  # phases


@dataclass(frozen=True)
class Suspension:
    """Solids in a periodic box, as overrides of a case; lengths in spacings unless the case has others."""

    case: Path
    box: tuple[float, ...]
    solids: tuple[str, ...]  # overrides
    fluid_alone: tuple[str, ...] = ()  # overrides with which the case has no solids
    with_fluid: bool = True

    @property
    def overrides(self) -> tuple[str, ...]:
        return (f"box.size={list(self.box)}", *UNSAMPLED)


def in_shear_wave(box: tuple[float, ...], bodies: list[str], with_fluid: bool = True) -> Suspension:
    """In the fluid of the benchmark `speed`."""
    reach = 2.0 * Fluid(len(box), 10, 1).smoothing_length
    alone = "fluid={particles=false, density=1.0, spacing=1.0, sound_speed=20.0}"
    fluid = f"fluid.rcut={reach!r}" if with_fluid else alone
    return Suspension(FLUID, box, (fluid, f"body=[{', '.join(bodies)}]", CONTACT), (fluid,), with_fluid)


def ball(dimension: int, radius: float, places: str, more: str = "") -> str:
    shape = "disc" if dimension == 2 else "sphere"
    return f'{{shape="{shape}", radius={radius!r}, density=10.0, {places}{more}}}'


def array(count: list[int], more: str = "") -> str:
    return f"array={{count={count}{more}}}"


def gas_solid(columns: int, rows: int) -> Suspension:
    """Discs of radius 8, of the paper's fraction and resolution."""
    solids = (f"body.0.array={{count=[{columns}, {rows}]}}",)
    return Suspension(GAS_SOLID, (11.0625 * columns, 11.0 * rows), solids,
                      ("body=[]", 'contact={model="none"}', "force.solid=[0.0, 0.0]"))


def spheres(count: int) -> Suspension:
    """A cubic array of spheres of radius 6 at a fraction of 0.132."""
    return in_shear_wave((19.0 * count,) * 3, [ball(3, 6.0, array([count] * 3))])


def packing(dimension: int, count: int, with_fluid: bool = True) -> Suspension:
    """A centred lattice of discs at a fraction of 0.70, of spheres at 0.55. The contact surfaces all but touch, and one half
    of the solids moves against the other, so that from the first step half of the neighbours are in contact."""
    cell, radius, speed = (24.0, 8.0, 0.5) if dimension == 2 else (15.0, 6.05, 0.3)
    touch = f", contact_radius={cell * math.sqrt(dimension) / 4 * (1 - 1e-6)!r}"
    corner = f", offset={[cell * (1 - 1e-12)] * dimension}"
    moves = f", velocity={[speed] * dimension}"
    bodies = [ball(dimension, radius, array([count] * dimension), touch + moves),
              ball(dimension, radius, array([count] * dimension, corner), touch)]
    return in_shear_wave((cell * count,) * dimension, bodies, with_fluid)


def two_sizes(dimension: int, side: float, large: int, radius: float, small: int) -> Suspension:
    """Large solids in an array, small ones of a tenth of their radius at random between them."""
    bodies = [ball(dimension, radius, array([large] * dimension)),
              ball(dimension, radius / 10, f"random={{count={small}, seed=1, gap=0.5}}")]
    return in_shear_wave((side,) * dimension, bodies)


SUSPENSIONS = {
    "13_2d": gas_solid(8, 9),
    "13_3d": spheres(3),
    "dense_2d": packing(2, 13),
    "dense_3d": packing(3, 4),
    "sizes_2d": two_sizes(2, 316.0, 2, 40.0, 400),
    "sizes_3d": two_sizes(3, 62.0, 1, 15.0, 800),
    "alone_2d": packing(2, 50, with_fluid=False),
    "alone_3d": packing(3, 12, with_fluid=False),
}
QUICK_SUSPENSIONS = {
    "13_2d": gas_solid(2, 2),
    "13_3d": spheres(1),
    "dense_2d": packing(2, 2),
    "dense_3d": packing(3, 2),
    "sizes_2d": two_sizes(2, 96.0, 1, 20.0, 20),
    "sizes_3d": two_sizes(3, 46.0, 1, 10.0, 20),
    "alone_2d": packing(2, 8, with_fluid=False),
    "alone_3d": packing(3, 4, with_fluid=False),
}


@dataclass(frozen=True)
class Cost(Speed):
    """Of one run; `rate` counts steps of PPs, or of solids where they are alone."""

    solids: int = 0
    seconds_a_step: float = 0.0

    def share(self, *names: str) -> float:
        return sum(self.phases[name] for name in names) / sum(self.phases.values())


def cost_of(scene: Suspension, overrides: tuple[str, ...], steps: int, ranks: int, folder: Path) -> Cost:
    options = Options(ranks=ranks, steps=steps, overrides=scene.overrides + overrides)
    record = run(scene.case, folder / "mappm", options).record
    seconds = dict(record["wall_seconds"])
    step = seconds.pop("steps") / record["steps"]
    del seconds["output"]
    counted = record["particles"] - record["frozen_particles"] if scene.with_fluid else record["solids"]
    return Cost(counted / step, record["digest"], seconds, record["solids"], step)


def rounds_of(meter: Meter, name: str, scene: Suspension, steps: int, folder: Path) -> dict[str, list[Cost]]:
    """Of the solids and, where there is one, of the fluid alone: keys solids_1, fluid_1, solids_2, fluid_2."""
    runs: dict[str, Callable[[], Cost]] = {}
    for ranks in (1, 2):
        runs[f"solids_{ranks}"] = lambda r=ranks: cost_of(scene, scene.solids, steps, r, folder)
        if scene.with_fluid:
            runs[f"fluid_{ranks}"] = lambda r=ranks: cost_of(scene, scene.fluid_alone, steps, r, folder)
    found = meter.rounds(name, runs)
    if found["solids_1"][0].digest != found["solids_2"][0].digest:
        raise Broken(f"{name}: the digest on two processes is not that on one")
    return found


def rows_of(name: str, scene: Suspension, found: dict[str, list[Cost]]) -> list[Row]:
    """Of solids in a fluid their shares are of one process; the part `solids` holds the phases of COST."""
    with_solids = found["solids_1"]
    solids = with_solids[0].solids
    rows = [row("solids", solids, suspension=name)]
    if not scene.with_fluid:
        return rows + [row("us_per_solid_and_step", spread_of(1e6 / one.rate for one in found[f"solids_{ranks}"]), "us", suspension=name, ranks=ranks)
                       for ranks in (1, 2)]
    for part, phases in {"solids": COST, "frozen_pairs": ("frozen_pairs",)}.items():
        share = spread_of(cost.share(*phases) for cost in with_solids)
        rows.append(row("share", share, suspension=name, ranks=1, part=part))
    time = spread_of(1e6 * cost.share(*COST) * cost.seconds_a_step / solids for cost in with_solids)
    return [*rows, row("pps", round(with_solids[0].rate * with_solids[0].seconds_a_step), suspension=name),
            row("us_per_solid_and_step", time, "us", suspension=name, ranks=1), *rows_beside_fluid(name, found)]


def rows_beside_fluid(name: str, found: dict[str, list[Cost]]) -> list[Row]:
    """A PP, and a step, over those of the same box full of fluid."""
    rows = []
    for ranks in (1, 2):
        solids, fluid = found[f"solids_{ranks}"], found[f"fluid_{ranks}"]
        steps = spread_of(one.seconds_a_step / other.seconds_a_step for one, other in zip(solids, fluid, strict=True))
        rows += [row("cost_per_pp_over_fluid", ratio_of(fluid, solids), suspension=name, ranks=ranks),
                 row("step_over_fluid", steps, suspension=name, ranks=ranks)]
    return rows


def measure(quick: bool, repeats: int, folder: Path, say: Callable[[str], None]) -> tuple[list[Row], str]:
    """Figures, and the commit they are of. Throws Broken, SolverError."""
    meter = Meter(repeats, say)
    rows = []
    for name, scene in (QUICK_SUSPENSIONS if quick else SUSPENSIONS).items():
        found = rounds_of(meter, name, scene, steps_for(100_000, quick), folder)
        rows += rows_of(name, scene, found)
    return rows, Run(folder / "mappm").record["commit"]


def main() -> int:
    return run_benchmark("solids", __doc__, measure)


if __name__ == "__main__":
    sys.exit(main())
