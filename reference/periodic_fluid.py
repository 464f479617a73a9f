"""A periodic fluid that several codes start alike: particles on a lattice that carry one of three flows.

The spacing of the lattice, the density and the largest velocity of the flow are 1. The smoothing length h is half the range
of the pair law. Steps are counted in h/c, with c the sound speed, and viscosity in c h: a limit that sound sets is then about
the same number in the plane and in space.

LAMMPS and LIGGGHTS, which grew from it, share the words that make such a fluid and the table that they print.
"""

import math
import re
from dataclasses import dataclass

NEIGHBOURS = {2: 39, 3: 77}
SEED = 123457  # LIGGGHTS takes no other than large primes
WAVE, VORTICES, ABC = "wave", "vortices", "abc"


@dataclass(frozen=True)
class Fluid:
    dimension: int
    side: int  # particles along a side of the box
    steps: int
    step: float = 0.25  # in h/c
    flow: str = WAVE
    sound_speed: float = 20.0
    viscosity: float = 0.00625  # kinematic, in c h
    disorder: float = 0.0  # each particle is displaced by up to this along each axis, at random

    @property
    def particles(self) -> int:
        return self.side**self.dimension

    @property
    def smoothing_length(self) -> float:
        """Half the range that holds so many neighbours and the particle itself."""
        held = NEIGHBOURS[self.dimension] + 1
        return 0.5 * (math.sqrt(held / math.pi) if self.dimension == 2 else (3 * held / (4 * math.pi)) ** (1 / 3))

    @property
    def reach(self) -> float:
        """Range of the pair law."""
        return 2 * self.smoothing_length

    @property
    def time_unit(self) -> float:
        """h/c, in spacings over the largest velocity."""
        return self.smoothing_length / self.sound_speed

    @property
    def dynamic_viscosity(self) -> float:
        return self.viscosity * self.sound_speed * self.smoothing_length

    @property
    def decay(self) -> float:
        """Rate at which the flow decays: of the exact solution, in c/h."""
        wave_number = 2 * math.pi / self.side * self.smoothing_length
        return self.viscosity * wave_number**2 * (2 if self.flow == VORTICES else 1)


def velocity_of(fluid: Fluid) -> list[str]:
    """Components as formulas of LAMMPS, by the axis. A shear wave; vortices of Taylor and Green, in the plane; or the flow of
    Arnold, Beltrami and Childress, in space."""
    x, y, z = (f"2*PI*{axis}/{fluid.side}" for axis in "xyz")
    if fluid.flow == WAVE:
        return [f"sin({y})"]
    if fluid.flow == VORTICES:
        return [f"sin({x})*cos({y})", f"-cos({x})*sin({y})"]
    return [f"(sin({z})+cos({y}))/sqrt(6.0)", f"(sin({x})+cos({z}))/sqrt(6.0)", f"(sin({y})+cos({x}))/sqrt(6.0)"]


def box_of(fluid: Fluid) -> str:
    """Lattice and box, as commands."""
    depth = "-0.5 0.5" if fluid.dimension == 2 else f"0 {fluid.side}"
    return f"""lattice {"sq" if fluid.dimension == 2 else "sc"} 1.0
region box block 0 {fluid.side} 0 {fluid.side} {depth} units box
create_box 1 box
create_atoms 1 box
mass 1 1.0"""


def start_of(fluid: Fluid) -> str:
    """Displacement and velocity, as commands."""
    lines = []
    if fluid.disorder:
        deep = fluid.disorder if fluid.dimension == 3 else 0.0
        lines.append(f"displace_atoms all random {fluid.disorder!r} {fluid.disorder!r} {deep!r} {SEED} units box")
    components = velocity_of(fluid)
    lines += [f'variable flow_{axis} atom "{formula}"' for axis, formula in zip("xyz", components, strict=False)]
    given = [f"v_flow_{axis}" for axis in "xyz"[: len(components)]] + ["0.0"] * (3 - len(components))
    return "\n".join([*lines, f"velocity all set {' '.join(given)} units box"])


def energies_of(log: str) -> list[tuple[int, float]]:
    """(step, kinetic energy of a particle) of the table that was printed."""
    rows = re.findall(r"^ *(\d+) +([-+.\de]+|-?nan|-?inf) *$", log, re.MULTILINE)
    return [(int(step), float(energy)) for step, energy in rows]


def loop_seconds(log: str, fluid: Fluid) -> float:
    """Wall seconds of the last run's steps. Throws ValueError where they are not told, or told of another number of particles."""
    loops = re.findall(r"Loop time of (\S+) on \d+ procs for \d+ steps with (\d+) atoms", log)
    if not loops or int(loops[-1][1]) != fluid.particles:
        raise ValueError(f"no loop time for {fluid.particles} particles: {log[-300:]}")
    return float(loops[-1][0])
