"""The SPH styles of a program that reads scripts, on the periodic fluid: how far they repeat themselves, how fast they are."""

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reference.periodic_fluid import Fluid
from reference.scripted import Finished
from verification.protocol.quantity import Quantity, Result, checksum_of

DUMP = "dump.txt"
ROUNDING = 1e-9  # differences of velocities below this are of rounding alone, over some hundred steps


@dataclass(frozen=True)
class Peer:
    code: str
    script: str  # name of its file
    skins: tuple[float, ...]  # of the lists of neighbours, in spacings; the first is the usual one
    fluid_script: Callable[[Fluid, float], str]  # with a skin: all but what is printed and written, and the run
    run_script: Callable[[str, Path, int], Finished]  # in a folder, on so many ranks; throws Failed
    line_format: str  # the words of dump_modify before the format of a line
    objection: str  # where it does not repeat itself


def state_script(peer: Peer, fluid: Fluid, skin: float) -> str:
    """Writes the state of the start and of the end to DUMP."""
    return peer.fluid_script(fluid, skin) + f"""dump end all custom {fluid.steps} {DUMP} id x y z vx vy vz
dump_modify end sort id {peer.line_format} "%d %.17g %.17g %.17g %.17g %.17g %.17g"
thermo {fluid.steps}
run {fluid.steps}
"""


def timed_script(peer: Peer, fluid: Fluid, skin: float) -> str:
    """Writes nothing."""
    return peer.fluid_script(fluid, skin) + f"thermo {fluid.steps}\nrun {fluid.steps}\n"


def energies_script(peer: Peer, fluid: Fluid, every: int) -> str:
    """Prints the kinetic energy of a particle every so many steps."""
    return peer.fluid_script(fluid, peer.skins[0]) + f"""thermo {every}
thermo_style custom step ke
thermo_modify norm yes format float "%.15g"
run {fluid.steps}
"""


def last_state(dump: Path, fluid: Fluid) -> tuple[np.ndarray, np.ndarray]:
    """(position, velocity) of the last snapshot, (n, 3), by the lattice nodes of the first: numbers depend on the ranks."""
    rows, block = dump.read_text().splitlines(), 9 + fluid.particles
    first, last = (np.array([row.split()[1:] for row in rows[start + 9 : start + block]], dtype=float)
                   for start in (0, len(rows) - block))
    nodes = np.round(first[:, :3]).astype(int) % fluid.side
    order = np.lexsort(nodes.T)
    return last[order, :3], last[order, 3:]


def differences(one: tuple[np.ndarray, np.ndarray], other: tuple[np.ndarray, np.ndarray], side: int) -> tuple[float, float]:
    """Largest of the positions, by the nearest image and in spacings, and of the velocities, over the amplitude."""
    apart = one[0] - other[0]
    apart -= side * np.round(apart / side)
    return float(np.max(np.abs(apart))), float(np.max(np.abs(one[1] - other[1])))


def peer_result(peer: Peer, fluid: Fluid, folder: Path, command: str) -> Result:
    """One rank, two ranks, and one rank with another skin. Throws Failed."""

    def once(ranks: int, skin: float) -> tuple[tuple[np.ndarray, np.ndarray], float, str]:
        finished = peer.run_script(state_script(peer, fluid, skin), folder, ranks)
        state = last_state(folder / DUMP, fluid)
        (folder / DUMP).unlink()
        return state, finished.core_seconds, finished.version

    usual, other = peer.skins[:2]
    other_skin, _, _ = once(1, other)
    two_ranks, _, _ = once(2, usual)
    plain, seconds, version = once(1, usual)
    quantities = {"particle_steps_per_core_second": Quantity(fluid.particles * fluid.steps / seconds, 0.0,
                                                             note=f"{fluid.particles} particles, {fluid.steps} steps, one rank")}
    for name, state, how in (("ranks", two_ranks, "two ranks and one"),
                             ("skin", other_skin, f"skins of {other} and {usual} spacings")):
        position, velocity = differences(plain, state, fluid.side)
        note = f"largest after {fluid.steps} steps between {how}"
        quantities[f"{name}_position"] = Quantity(position, 0.0, note=f"{note}, in spacings")
        quantities[f"{name}_velocity"] = Quantity(velocity, 0.0, note=f"{note}, over the amplitude of the wave")
    repeats = all(quantities[f"{name}_velocity"].value < ROUNDING for name in ("ranks", "skin"))
    return Result(peer.code, version, command, checksum_of([folder / peer.script], folder), quantities,
                  "" if repeats else peer.objection)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--dimension", type=int, default=2, choices=(2, 3), help="default 2")
    parser.add_argument("--side", type=int, default=64, metavar="N", help="particles along a side, at least 10; default 64")
    parser.add_argument("--steps", type=int, default=100, metavar="N", help="default 100")


def fluid_of(options: argparse.Namespace) -> Fluid:
    """Throws ValueError naming option, value and fix."""
    if options.side < 10:
        raise ValueError(f"--side {options.side}: must be at least 10, or the box is too small for the range of the kernel")
    if options.steps < 1:
        raise ValueError(f"--steps {options.steps}: must be at least 1")
    return Fluid(options.dimension, options.side, options.steps)
