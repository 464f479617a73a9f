"""What flow time costs in two builds of the solver, an older one and this one, side by side.

    python3 -m bench.flow_time --old FOLDER [--quick] [--repeats N] [--lab DIR] [--out DIR]

FOLDER holds the build of another checkout: its bin/mappm is run. Each build takes its own default step (step_factor 1), for
the same flow time. The cost is that of an h/c of flow time for a PP, in core-seconds: a longer step, a dearer step and fewer
processes all show in it; h is half the range of the pair law. The scenes: a periodic fluid at c = 20 U in the plane and in
space; the same with solids at 13 %; Stokes flow past an array of fixed discs, where viscosity limits the step. On one process
and on two. Builds alternate; a figure is a median over rounds, and a ratio the median of ratios within one round.
Where `old_cost_over_new` is above 1 this build is cheaper. Prints a line a figure: name, settings, value, unit.
Ends with 1 where a measurement is broken (a run that failed, digests that differ between one process and two), never because
the machine is slow.
"""

import argparse
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from bench.codes import SCENE, fluid_table
from bench.largest_step import VISCOSITY
from bench.meter import Broken, Meter, Row, Speed, rate_of, ratio_of, row, run_benchmark, spread_of
from bench.solids import GAS_SOLID, QUICK_SUSPENSIONS, SUSPENSIONS, UNSAMPLED, Suspension
from reference.periodic_fluid import Fluid
from verification.codes.mappm import Options, build_folder, run
from verification.protocol.errors import SolverError
from verification.protocol.machine import ROOT
from verification.store.figures import Setting

STOKES = ROOT / "cases" / "cylinder_stokes" / "case.toml"
PROCESSES = (1, 2)
OLD, NEW = "old", "new"


@dataclass(frozen=True)
class Scene:
    case: Path
    overrides: tuple[str, ...]
    unit: float  # h/c, in units of the case
    flow_time: float  # of a run, in h/c


def fluid_alone(dimension: int, side: int, flow_time: float) -> Scene:
    fluid = Fluid(dimension, side, 1, viscosity=VISCOSITY)
    box = f"box.size={[float(side)] * dimension}"
    return Scene(SCENE, (box, fluid_table(fluid), *UNSAMPLED), fluid.time_unit, flow_time)


def with_solids(suspension: Suspension, flow_time: float) -> Scene:
    """rcut and c of the paper's gas, or of the fluid of the other benchmarks."""
    unit = 0.5 / 2.93e-4 if suspension.case == GAS_SOLID else Fluid(len(suspension.box), 10, 1).time_unit
    return Scene(suspension.case, suspension.overrides + suspension.solids, unit, flow_time)


def stokes(count: int, flow_time: float) -> Scene:
    """Discs of radius 1 at a fraction of 0.2. The sound is slow enough for viscosity to limit the step: nu = .9 c h."""
    side, rcut, sound_speed = 3.9633273 * count, 0.4375, 100.0
    fluid = f"density=1.0, viscosity=20.0, spacing=0.125, rcut={rcut}, sound_speed={sound_speed}, velocity=[1.625, 0.0]"
    body = f'shape="disc", radius=1.0, motion="fixed", array={{count=[{count}, {count}]}}'
    return Scene(STOKES, (f"box.size=[{side}, {side}]", f"fluid={{{fluid}}}", f"body=[{{{body}}}]", *UNSAMPLED),
                 rcut / 2 / sound_speed, flow_time)


SCENES = {
    "2d": fluid_alone(2, 400, 50.0),
    "3d": fluid_alone(3, 54, 25.0),
    "solids_2d": with_solids(SUSPENSIONS["13_2d"], 50.0),
    "solids_3d": with_solids(SUSPENSIONS["13_3d"], 20.0),
    "stokes_2d": stokes(10, 40.0),
}
QUICK_SCENES = {
    "2d": fluid_alone(2, 64, 5.0),
    "3d": fluid_alone(3, 16, 5.0),
    "solids_2d": with_solids(QUICK_SUSPENSIONS["13_2d"], 5.0),
    "solids_3d": with_solids(QUICK_SUSPENSIONS["13_3d"], 5.0),
    "stokes_2d": stokes(1, 5.0),
}


@dataclass(frozen=True)
class FlowTime(Speed):
    """Of one run; `rate` counts steps of PPs."""

    step: float = 0.0  # in h/c
    cost: float = 0.0  # core-seconds for an h/c of flow time a PP
    commit: str = ""


def flow_time_of(scene: Scene, build: Path, ranks: int, folder: Path) -> FlowTime:
    default_step = f"run={{step_factor=1.0, duration={scene.flow_time * scene.unit!r}}}"
    options = Options(ranks=ranks, overrides=(*scene.overrides, default_step), build=build, overwrite=False)
    out = folder / "mappm"
    shutil.rmtree(out, ignore_errors=True)  # an older build has no option to overwrite it
    record = run(scene.case, out, options).record
    pps = record["particles"] - record["frozen_particles"]
    seconds = record["wall_seconds"]["steps"] / (record["steps"] - record["first_step"])
    step = record["time_step"] / scene.unit
    return FlowTime(pps / seconds, record["digest"], step=step, cost=ranks * seconds / step / pps, commit=record["commit"])


def rows_of(scene: str, found: dict[tuple[str, int], list[FlowTime]]) -> list[Row]:
    rows = []
    for build in (OLD, NEW):
        here: dict[str, Setting] = {"scene": scene, "build": build}
        rows.append(row("step", found[build, 1][0].step, "h/c", **here))
        for ranks in PROCESSES:
            times = found[build, ranks]
            rows += [row("particle_steps_per_s", rate_of(times), "1/s", **here, ranks=ranks),
                     row("core_s_per_pp", spread_of(time.cost for time in times), "s/(h/c)", **here, ranks=ranks)]
        rows.append(row("two_processes_over_one", ratio_of(found[build, 2], found[build, 1]), **here))
    for ranks in PROCESSES:
        ratios = (old.cost / new.cost for old, new in zip(found[OLD, ranks], found[NEW, ranks], strict=True))
        rows.append(row("old_cost_over_new", spread_of(ratios), scene=scene, ranks=ranks))
    return rows


def measure(quick: bool, repeats: int, folder: Path, say: Callable[[str], None],
            old: Path) -> tuple[list[Row], str]:
    """Figures, and the commits they are of. Throws Broken, SolverError."""
    if not (old / "bin" / "mappm").exists():
        raise SolverError(f"--old {old}: there is no bin/mappm in it; give the folder of a build, such as build/fast of a checkout")
    meter, builds = Meter(repeats, say), {OLD: old.resolve(), NEW: build_folder()}
    rows: list[Row] = []
    for name, scene in (QUICK_SCENES if quick else SCENES).items():
        runs: dict[tuple[str, int], Callable[[], FlowTime]] = {}
        for ranks in PROCESSES:
            for build, where in builds.items():
                runs[build, ranks] = lambda s=scene, w=where, r=ranks: flow_time_of(s, w, r, folder)
        found = meter.rounds(name, runs)
        for build in builds:
            if found[build, 1][0].digest != found[build, 2][0].digest:
                raise Broken(f"{name}, {build} build: the digest on two processes is not that on one")
        rows += rows_of(name, found)
    return rows, f"{found[NEW, 1][0].commit}, beside {found[OLD, 1][0].commit}"


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--old", type=Path, required=True, metavar="FOLDER", help="of an older build, with bin/mappm in it")


def main() -> int:
    return run_benchmark("flow_time", __doc__, measure, add_options)


if __name__ == "__main__":
    sys.exit(main())
