"""Runs in the Python of the peers: driver.py INPUT.npz OUTPUT.npz. A fluid, and walls if there are any, by the transport-velocity
scheme of PySPH.

INPUT: points (n, D), velocity (n, D), wall (n) true in a wall, size (D) of the periodic box, gravity (D), and the numbers
density, viscosity (kinematic), sound_speed, h, mass, step, steps, every. OUTPUT: time (f), points (f, n, D) and velocity (f, n, D) at the
start and every so many steps; setup_seconds, of processor time, in which PySPH is loaded, and generates and compiles its loops.
"""

import itertools
import resource
import sys

import numpy as np
from compyle.config import get_config
from pysph.base.nnps import DomainManager, LinkedListNNPS
from pysph.base.utils import get_particle_array
from pysph.sph.scheme import TVFScheme

FLUID, WALL = "fluid", "wall"


def seconds() -> float:
    """Of processor time, of this process and those that it waited for."""
    both = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(used.ru_utime + used.ru_stime for used in both)


def array_of(name: str, given: dict, chosen: np.ndarray):
    """The chosen particles as an array of PySPH."""
    vectors = {axis: given["points"][chosen, k] for k, axis in enumerate("xyz"[: given["points"].shape[1]])}
    vectors |= {axis: given["velocity"][chosen, k] for k, axis in enumerate("uvw"[: given["points"].shape[1]])}
    return get_particle_array(name=name, m=float(given["mass"]), h=float(given["h"]), rho=float(given["density"]), **vectors)


def domain_of(size: np.ndarray) -> DomainManager:
    sides = {f"{axis}{end}": value for axis, side in zip("xyz", size.tolist(), strict=False)
             for end, value in (("min", 0.0), ("max", side))}
    return DomainManager(**sides, **{f"periodic_in_{axis}": True for axis in "xyz"[: len(size)]})


def scheme_of(given: dict, walls: list[str]) -> TVFScheme:
    """Reference and background pressure are density c^2, as in the examples of PySPH."""
    pressure = float(given["density"] * given["sound_speed"] ** 2)
    force = dict(zip(("gx", "gy", "gz"), given["gravity"].tolist(), strict=False))
    return TVFScheme([FLUID], walls, dim=len(given["size"]), rho0=float(given["density"]), c0=float(given["sound_speed"]),
                     nu=float(given["viscosity"]), p0=pressure, pb=pressure, h0=float(given["h"]), **force)


def solver_of(given: dict, arrays: list):
    """Ready to run, its loops compiled."""
    scheme = scheme_of(given, [array.name for array in arrays if array.name == WALL])
    step, steps = float(given["step"]), int(given["steps"])
    scheme.configure_solver(dt=step, tf=2 * step * steps, n_damp=0, adaptive_timestep=False)
    scheme.setup_properties(arrays)
    for array in arrays:
        array.V[:] = given["density"] / given["mass"]
    solver = scheme.get_solver()
    nnps = LinkedListNNPS(dim=len(given["size"]), particles=arrays, radius_scale=solver.kernel.radius_scale,
                          domain=domain_of(given["size"]), fixed_h=True)
    solver.set_parallel_manager(None)
    solver.setup(particles=arrays, equations=scheme.get_equations(), nnps=nnps, kernel=solver.kernel, fixed_h=True)
    solver.set_disable_output(True)
    solver.set_max_steps(steps)
    return solver


def state(arrays: list, masks: list[np.ndarray], dimension: int) -> tuple[np.ndarray, np.ndarray]:
    """points (n, D) and velocity (n, D), in the order of INPUT; without the images that PySPH keeps for the periodic box."""
    both = np.zeros((2, len(masks[0]), dimension))
    for array, mask in zip(arrays, masks, strict=True):
        for which, names in enumerate(("xyz", "uvw")):
            both[which, mask] = np.column_stack([array.get(name) for name in names[:dimension]])
    return both[0], both[1]


def run(given: dict) -> dict[str, np.ndarray]:
    dimension = len(given["size"])
    wall = given["wall"].astype(bool)
    masks = [~wall, wall] if wall.any() else [~wall]
    arrays = [array_of(name, given, mask) for name, mask in zip((FLUID, WALL), masks, strict=False)]
    frames = [(0.0, *state(arrays, masks, dimension))]
    solver = solver_of(given, arrays)
    setup, steps = seconds(), itertools.count(1)  # the solver counts a step before or after it calls, by its release

    def keep(_) -> None:
        done = next(steps)
        if done % int(given["every"]) == 0:
            frames.append((done * float(given["step"]), *state(arrays, masks, dimension)))

    solver.add_post_step_callback(keep)
    solver.solve(show_progress=False)
    times, points, velocity = (np.array(values) for values in zip(*frames, strict=True))
    return {"time": times, "points": points, "velocity": velocity, "setup_seconds": np.array(setup)}


def main(source: str, target: str) -> None:
    get_config().use_openmp = False
    with np.load(source) as file:
        found = run({name: file[name] for name in file.files})
    np.savez(target, **found)


if __name__ == "__main__":
    main(*sys.argv[1:])
