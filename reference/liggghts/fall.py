"""A body released from rest in a periodic box under a constant force F and the drag (G + B |v|) v.

The linear part is `fix viscous`; a quadratic one goes through `fix addforce` with a variable of the atom. With B = 0 the
exact motion is v = F/G (1 - exp(-t/tau)), tau = M/G, and a run that misses it objects to itself.
"""

import argparse
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reference.liggghts.program import CODE, SCRIPT, run_script
from verification.protocol.quantity import Level, Quantity, Result, checksum_of
from verification.protocol.scene import in_si

ROWS = 400  # of the table
STEPS = (50_000, 100_000)  # of the two levels
ACCURACY = 2.5e-4  # of the terminal velocity: how near the exact motion a linear fall must come
TABLE = "table.csv"


@dataclass(frozen=True)
class Fall:
    """Any one consistent system of units."""

    mass: float
    force: float
    gamma: float
    quadratic: float
    duration: float

    @property
    def terminal(self) -> float:
        """Positive root of F = G v + B v^2."""
        return 2 * self.force / (self.gamma + math.sqrt(self.gamma**2 + 4 * self.quadratic * self.force))


def script_of(fall: Fall, steps: int) -> str:
    """The body has one hundredth of its way for a radius; nothing touches it. The unit style lj has no constants of nature."""
    radius = 0.01 * fall.terminal * fall.duration
    side = 10 * radius
    drag = (f"fix drag all viscous {fall.gamma!r}" if fall.quadratic == 0 else
            f'variable drag atom "-({fall.gamma!r}+{fall.quadratic!r}*sqrt(vx*vx+vy*vy+vz*vz))*vx"\n'
            "fix drag all addforce v_drag 0.0 0.0")
    return f"""units lj
atom_style granular
atom_modify map array
boundary p p p
newton off
communicate single vel yes
region box block {-side!r} {side!r} {-side!r} {side!r} {-side!r} {side!r} units box
create_box 1 box
create_atoms 1 single 0 0 0 units box
set group all diameter {2 * radius!r} density {3 * fall.mass / (4 * math.pi * radius**3)!r}
neighbor {radius!r} bin
neigh_modify delay 0
fix young all property/global youngsModulus peratomtype 1e7
fix poisson all property/global poissonsRatio peratomtype 0.3
fix restitution all property/global coefficientRestitution peratomtypepair 1 1.0
pair_style gran model hertz
pair_coeff * *
timestep {fall.duration / steps!r}
fix motion all nve/sphere
fix weight all addforce {fall.force!r} 0.0 0.0
{drag}
variable time equal step*dt
variable velocity equal vcm(all,x)
fix table all print {steps // ROWS} "${{time}},${{velocity}}" file {TABLE} title "time,velocity" screen no
thermo {steps}
run {steps}
"""


def exact(fall: Fall, time: np.ndarray) -> np.ndarray:
    """Of the linear law."""
    return fall.force / fall.gamma * -np.expm1(-time * fall.gamma / fall.mass)


def read_table(file: Path) -> tuple[np.ndarray, np.ndarray]:
    time, velocity = np.loadtxt(file, delimiter=",", skiprows=1).T
    return time, velocity


def relaxation_time(fall: Fall, time: np.ndarray, velocity: np.ndarray) -> float:
    """When the velocity has come to 1 - 1/e of the terminal one; NaN where the fall is too short for that."""
    return float(np.interp(-math.expm1(-1) * fall.terminal, velocity, time, right=math.nan))


def _quantity(name: str, values: list[float], seconds: list[float]) -> Quantity:
    levels = tuple(Level(f"{n} steps", STEPS[0] / n, value, spent) for n, value, spent in zip(STEPS, values, seconds, strict=False))
    return Quantity(values[-1], abs(values[-1] - values[0]), levels,
                    note=f"{name} of the finer step; uncertainty, its difference from the coarser")


def run(fall: Fall, folder: Path, command: str) -> Result:
    """Two steps, the finer in OUT/table.csv. Throws Failed."""
    end, relaxation, seconds = [], [], []
    for steps in STEPS:
        finished = run_script(script_of(fall, steps), folder)
        time, velocity = read_table(folder / TABLE)
        end.append(float(velocity[-1]))
        relaxation.append(relaxation_time(fall, time, velocity))
        seconds.append(finished.core_seconds)
    quantities = {"final_velocity": _quantity("velocity at the end", end, seconds)}
    if not math.isnan(relaxation[-1]):
        quantities["relaxation_time"] = _quantity("time to 1 - 1/e of the terminal velocity", relaxation, seconds)
    objection = ""
    if fall.quadratic == 0:
        deviation = float(np.max(np.abs(velocity - exact(fall, time)))) / fall.terminal
        quantities["deviation"] = Quantity(deviation, 0.0, note="largest, from F/G (1 - exp(-t/tau)), of the terminal velocity")
        if deviation > ACCURACY:
            objection = f"misses the exact motion under linear drag by {deviation:.1e} of the terminal velocity"
    return Result(CODE, finished.version, command, checksum_of([folder / SCRIPT], folder), quantities, objection, table=TABLE)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--gamma", type=float, required=True, metavar="G", help="linear drag, force per velocity, > 0")
    parser.add_argument("--quadratic", type=float, default=0.0, metavar="B", help="quadratic drag, force per velocity squared")
    parser.add_argument("--force", type=float, required=True, metavar="F", help="constant force on the body, > 0")
    parser.add_argument("--mass", type=float, metavar="M", help="default: of the scene's first body, a sphere or disc")
    parser.add_argument("--duration", type=float, metavar="T", help="default: run.duration of the scene")


def mass_of(scene: dict) -> float:
    """Of the first body. Throws KeyError, which names what the scene has not."""
    body = scene["body"][0]
    radius, density = in_si(body["radius"]), in_si(body["density"])
    return density * (math.pi * radius**2 if len(scene["box"]["size"]) == 2 else 4 / 3 * math.pi * radius**3)


def fall_of(options: argparse.Namespace, scene: dict) -> Fall:
    """Throws ValueError naming option, value and fix."""
    found = {"gamma": options.gamma, "force": options.force, "mass": options.mass, "duration": options.duration}
    try:
        if found["mass"] is None:
            found["mass"] = mass_of(scene)
        if found["duration"] is None:
            found["duration"] = in_si(scene["run"]["duration"])
    except (KeyError, IndexError) as error:
        raise ValueError(f"the scene does not give mass or duration ({error} is missing); give --mass and --duration") from None
    for name, value in found.items():
        if not (value > 0 and math.isfinite(value)):
            raise ValueError(f"--{name} {value}: must be positive")
    if not (options.quadratic >= 0 and math.isfinite(options.quadratic)):
        raise ValueError(f"--quadratic {options.quadratic}: must not be negative")
    return Fall(quadratic=options.quadratic, **found)
