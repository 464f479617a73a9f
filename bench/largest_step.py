"""The largest useful step of a code: up to it flows decay as they do with small steps.

Two flows of an inertial fluid, nu = .01 c h, are followed with each step:
- a shear wave at c = 200 U, until its amplitude has fallen to exp(-1/2). The particles start displaced a little, so that every
  mode of sound is there to grow;
- vortices at c = 20 U, of Taylor and Green in the plane, of Arnold, Beltrami and Childress in space, until they have
  deformed the fluid by 1/2. After that the lattice on which the particles start breaks up, and no two runs are alike.

A step is useful if both decay as they do in the same code at a small step, within 1 %. The rate of decay is half the slope of the
logarithm of the whole kinetic energy over the last three quarters, so that noise counts too. A run that fails is not useful,
nor is one that the code refuses. From the small step on the step is doubled until one is not useful; what lies between is bisected.
"""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from bench.codes import Code
from bench.meter import Broken
from reference.periodic_fluid import ABC, VORTICES, WAVE, Fluid
from reference.scripted import Failed
from verification.protocol.errors import SolverError

VISCOSITY = 0.01  # in c h
TOLERANCE = 0.01  # of a rate of decay
SMALL, LARGEST = 0.05, 3.2  # in h/c
ROWS = 64  # of kinetic energies, at most twice as many
SIDES, QUICK_SIDES = {2: 32, 3: 16}, {2: 16, 3: 10}
RESOLUTION, QUICK_RESOLUTION = 0.05, 0.2  # relative, of the step

Trial = Callable[[float], float]  # the rate of decay of a flow over the step


@dataclass(frozen=True)
class Found:
    step: float  # in h/c
    rates: tuple[float, ...]  # of the trials at the small step


def rate_of_decay(times: list[float], energies: list[float], end: float) -> float:
    """Half the slope of the logarithm of the energy from a quarter of the time on; NaN where there is none."""
    values = np.array(energies)
    if not np.all(np.isfinite(values) & (values > 0)):
        return math.nan
    window = np.linspace(end / 4, end, ROWS)
    return float(-np.polyfit(window, np.interp(window, times, np.log(values)), 1)[0] / 2)


def flows_of(dimension: int, side: int) -> list[tuple[Fluid, float]]:
    """(fluid, time to follow it, in h/c); steps are not set yet."""
    wave = Fluid(dimension, side, 0, flow=WAVE, sound_speed=200.0, viscosity=VISCOSITY, disorder=0.005)
    vortices = Fluid(dimension, side, 0, flow=VORTICES if dimension == 2 else ABC, viscosity=VISCOSITY)
    deformation = 2 * math.pi / side * vortices.time_unit  # in h/c
    return [(wave, 0.5 / wave.decay), (vortices, 0.5 / deformation)]


def trial_of(code: Code, fluid: Fluid, end: float, folder: Path) -> Trial:
    """The rate is in units of the exact one."""

    def rate(step: float) -> float:
        every = max(1, int(end / step) // ROWS)
        steps = every * math.ceil(end / step / every)
        rows = code.energies(replace(fluid, step=step, steps=steps), every, folder)
        return rate_of_decay([step * row for row, _ in rows], [energy for _, energy in rows], end) / fluid.decay

    return rate


def largest_useful(trials: list[Trial], small: float, largest: float, resolution: float,
                   tell: Callable[[float, bool, int], None] = lambda step, useful, left: None) -> Found:
    """`tell` hears of each step whether it is useful, and what is left to do, in the time of this one. Throws what a trial
    throws at the small step, and Broken where a rate is none there."""
    rates = tuple(trial(small) for trial in trials)
    if not all(math.isfinite(rate) and rate > 0 for rate in rates):
        raise Broken(f"rates of decay {rates} at a step of {small} h/c")

    def decays_alike(step: float) -> bool:
        try:
            return all(abs(trial(step) / rate - 1) <= TOLERANCE for trial, rate in zip(trials, rates, strict=True))
        except (SolverError, Failed):
            return False

    good, bad = small, math.inf
    tell(small, True, left_at_most(good, bad, resolution))
    while good < largest and bad > good * (1 + resolution):
        step = min(2 * good, largest) if bad == math.inf else math.sqrt(good * bad)
        useful = decays_alike(step)
        good, bad = (step, bad) if useful else (good, step)
        tell(step, useful, left_at_most(good, bad, resolution))
    return Found(good, rates)


def left_at_most(good: float, bad: float, resolution: float) -> int:
    """What is left to do between a useful step and one that is not, in the time of the last. Doublings take together no
    longer than that: each has half the steps of the one before."""
    halvings = math.ceil(math.log2(math.log(min(bad / good, 2.0)) / math.log1p(resolution)))
    return max(0, halvings) + (1 if bad == math.inf else 0)


def largest_step(code: Code, dimension: int, quick: bool, folder: Path, say: Callable[[str], None]) -> Found:
    """Throws Broken, SolverError, Failed."""
    flows = flows_of(dimension, (QUICK_SIDES if quick else SIDES)[dimension])
    trials = [trial_of(code, fluid, end, folder) for fluid, end in flows]
    last = time.monotonic()

    def tell(step: float, useful: bool, left: int) -> None:
        nonlocal last
        now = time.monotonic()
        word = "useful" if useful else "not useful"
        say(f"largest step of {code.name}, {dimension}D: {step:.3f} h/c is {word}, {left * (now - last):.0f} s left")
        last = now

    return largest_useful(trials, SMALL, LARGEST, QUICK_RESOLUTION if quick else RESOLUTION, tell)
