"""PySPH (Ramachandran et al. 2021): found in the environment of the peers, run there by driver.py."""

import subprocess
from pathlib import Path

import numpy as np

from reference.particles import Particles, ParticleScene, Plan
from reference.scripted import PEERS, Failed, peer_version

MISSING = "PySPH is not in .venv-peers; ./setup --peers"
DRIVER = Path(__file__).with_name("driver.py")
INPUT, OUTPUT = "input.npz", "output.npz"
RANGE = 3.0  # of the quintic spline, in smoothing lengths
LONGEST_WORDS = 300  # kept of the last words of a driver that failed


def version() -> str:
    return peer_version("pysph")


def write_input(file: Path, scene: ParticleScene, particles: Particles, plan: Plan) -> None:
    """What driver.py reads."""
    np.savez(file, points=particles.points, velocity=particles.velocity, wall=~particles.fluid, size=scene.size,
             gravity=scene.gravity, density=scene.density, viscosity=scene.kinematic_viscosity, sound_speed=scene.sound_speed,
             h=scene.reach / RANGE, mass=scene.mass, step=plan.step, steps=plan.steps, every=plan.every)


def run(folder: Path) -> dict[str, np.ndarray]:
    """What driver.py leaves, of INPUT in the folder. Loops that it compiled stay in .venv-peers/home. Throws Failed."""
    home = PEERS / "home"
    home.mkdir(exist_ok=True)
    environment = {"HOME": str(home), "OMP_NUM_THREADS": "1", "PATH": f"{PEERS / 'bin'}:/usr/local/bin:/usr/bin:/bin"}
    done = subprocess.run([PEERS / "bin" / "python", DRIVER, INPUT, OUTPUT], cwd=folder, env=environment, text=True,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        raise Failed(f"exit status {done.returncode}: {done.stdout[-LONGEST_WORDS:]}")
    with np.load(folder / OUTPUT) as file:
        return {name: file[name] for name in file.files}
