"""Waves on a lattice: how much each grows in a step. Oracle: linear theory of the step, in lattice_theory.py.

A wave of 1e-7 c stays linear, and still has eight digits in the integers of the state. Displacement and velocity of its
PPs after each step, projected on the wave, give the map of a step, two by two numbers, which are compared with those of
theory, and so are the factors by which the wave grows. The limit of the step is where the first of them passes -1. The
solver refuses steps beyond the limit of any wave; what it does not know of is a background pressure, which stiffens the
lattice: with it a run just beyond the limit can be seen to grow.
"""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pytest
from lattice_theory import KERNELS, Lattice, Law, growth

from verification.codes.mappm import Options, run
from verification.protocol.run import Run, read_points

NODES = 12  # along each axis
LONG = 48  # along x, for waves so long that they are a flow
REACH = 3.0  # rcut / dx
STEPS = 5
TOLERANCE = 2e-6  # of the map; the state rounds a wave of 1e-7 c at its eighth digit
LARGE_SHARE = 1e8  # shift_shear with which what flows at all has its whole shift
ENGINES = {"mappm": 1, "mappm-reference": 0}


@dataclass(frozen=True)
class Wave:
    """Along x, `mode` wavelengths in the box, velocities along `axis`: 0 is sound. Its speed in c; at rest it would have no
    shift."""

    dimension: int
    kernel: str
    axis: int
    mode: int
    nodes: int = NODES  # along x
    speed: float = 1e-7

    @cached_property
    def lattice(self) -> Lattice:
        return Lattice("square" if self.dimension == 2 else "cubic", REACH, self.kernel)

    @cached_property
    def number(self) -> np.ndarray:
        """k, 1 / rcut"""
        return np.eye(self.dimension)[0] * 2 * np.pi * self.mode * REACH / self.nodes

    def theory(self, law: Law) -> np.ndarray:
        return self.lattice.wave_map(self.number, self.axis, law)

    def limit(self, law: Law) -> float:
        """The step c dt / h from which on it grows."""
        low, high = 0.1, 4.0
        while high - low > 1e-7:
            middle = 0.5 * (low + high)
            stable = growth(self.theory(law.with_step(middle))) < 1 + 1e-9
            low, high = (middle, high) if stable else (low, middle)
        return low

    def scene(self, law: Law) -> str:
        """dx = 1, c = 1, rho_0 = 1."""
        h, direction = 0.5 * REACH, "xyz"[self.axis]
        shift = f"shift_rate = {law.shift}\nshift_shear = {LARGE_SHARE}" if law.shift else "transport = false"
        return f"""
            name = "wave"
            units = "dimensionless"
            [box]
            size = {[float(self.nodes), *[float(NODES)] * (self.dimension - 1)]}
            [fluid]
            density = 1.0
            spacing = 1.0
            rcut = {REACH}
            sound_speed = 1.0
            viscosity = {law.viscosity * h!r}
            kernel = "{self.kernel}"
            background_pressure = {law.background}
            {shift}
            wave = {{ amplitude = {self.speed}, direction = "{direction}", gradient = "x", mode = {self.mode} }}
            [run]
            step = {law.step * h!r}
            steps = {STEPS}
            [output]
            snapshot = 1
        """

    def states(self, finished: Run) -> np.ndarray:
        """Displacement (dx) and velocity (c) times the step of the wave, a row a snapshot."""
        rows = []
        for path in finished.snapshots():
            points = read_points(path)
            order = np.argsort(points["id"])
            x, v = points["points"][order], points["velocity"][order]
            if not rows:
                start = x
                shape = np.sin(2 * np.pi * self.mode * start[:, 0] / self.nodes)
            moved = (x - start + NODES / 2) % NODES - NODES / 2
            rows.append([moved[:, self.axis] @ shape, v[:, self.axis] @ shape * finished.record["time_step"]])
        return np.array(rows) / (shape @ shape)

    def measured(self, law: Law, folder: Path, ranks: int) -> np.ndarray:
        """The map of a step, as `theory` gives it, from a run."""
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "scene.toml").write_text(self.scene(law))
        states = self.states(run(folder / "scene.toml", folder / "out", Options(ranks=ranks)))
        step = np.linalg.lstsq(states[:-1], states[1:], rcond=None)[0].T
        dt = law.step * 0.5
        return step * np.array([[1, dt], [1 / dt, 1]])


def compare(wave: Wave, law: Law, folder: Path, tolerance: float = TOLERANCE) -> float:
    """Growth of the wave in a step by theory, with which both engines agree."""
    theory = wave.theory(law)
    for engine, ranks in ENGINES.items():
        found = wave.measured(law, folder / engine, ranks)
        print(f"{engine} {wave} {law}: growth {growth(found):.7f}, theory {growth(theory):.7f}, "
              f"largest difference of the maps {np.abs(found - theory).max():.1e}")
        assert found == pytest.approx(theory, abs=tolerance)
        # Two equal factors lie apart by the root of what their map is off by.
        assert growth(found) == pytest.approx(growth(theory), abs=2 * tolerance**0.5)
        assert np.linalg.det(found) == pytest.approx(np.linalg.det(theory), abs=4 * tolerance)
    return growth(theory)


every = [pytest.mark.parametrize("kernel", KERNELS), pytest.mark.parametrize("dimension", [2, 3])]


def for_every(*marks):
    def decorate(test):
        for mark in (*marks, *every):
            test = mark(test)
        return test

    return decorate


@for_every(pytest.mark.parametrize("viscosity", [0.0, 0.001, 0.01, 0.1]))
def test_a_step_maps_a_wave_as_theory_says(tmp_path: Path, dimension: int, kernel: str, viscosity: float) -> None:
    sound, shear = Wave(dimension, kernel, 0, 2), Wave(dimension, kernel, 1, 1)
    compare(shear, Law(1.0, viscosity), tmp_path / "shear")
    # The solver refuses what lies beyond the limit of any wave, at most 8 % less than that of this one.
    below = 0.92 * sound.limit(Law(1.0, viscosity))
    for step in (1.0, below) if dimension == 3 else (0.5, 1.0, below):
        grows = compare(sound, Law(step, viscosity), tmp_path / f"{step}")
        assert grows < 1.0 if viscosity else grows == pytest.approx(1.0, abs=1e-9)


@for_every(pytest.mark.parametrize("viscosity", [0.0, 0.1]))
def test_a_wave_grows_just_beyond_its_limit(tmp_path: Path, dimension: int, kernel: str, viscosity: float) -> None:
    sound = Wave(dimension, kernel, 0, 2 if kernel == "lucy" else 3)
    stiff = Law(1.0, viscosity, background=0.2 if kernel == "lucy" else 0.1)
    limit = sound.limit(stiff)
    assert compare(sound, stiff.with_step(0.998 * limit), tmp_path / "below") < 1 + 1e-9
    assert compare(sound, stiff.with_step(1.002 * limit), tmp_path / "above") > 1.003


@for_every(pytest.mark.parametrize("rate", [0.25, 0.5]))
def test_the_shift_moves_a_wave_as_theory_says(tmp_path: Path, dimension: int, kernel: str, rate: float) -> None:
    for axis, mode in ((0, 3), (1, 1), (1, 3)):
        wave, law = Wave(dimension, kernel, axis, mode, LONG, speed=1e-4), Law(1.0, 0.01, shift=rate)
        # There are nodes right at the cutoff, where G'' of Lucy jumps: an error in proportion to the speed.
        tolerance = 0.2 * wave.speed if kernel == "lucy" else TOLERANCE
        compare(wave, law, tmp_path / f"{axis}{mode}", tolerance)
        if axis == 0:  # the rate does not know the step
            compare(wave, law.with_step(0.5), tmp_path / "half", tolerance)


@pytest.mark.parametrize("ranks", ENGINES.values())
def test_what_differs_from_one_pp_to_the_next_has_no_shift(tmp_path: Path, ranks: int) -> None:
    wave, unshifted = Wave(2, "wendland-c2", 0, 4, speed=1e-4), Law(1.0, 0.01)
    shifted = Law(1.0, 0.01, shift=0.5)
    assert np.abs(wave.theory(shifted) - wave.theory(unshifted)).max() > 0.1
    assert wave.measured(shifted, tmp_path, ranks) == pytest.approx(wave.theory(unshifted), abs=10 * wave.speed)


@pytest.mark.parametrize("ranks", ENGINES.values())
def test_the_share_of_the_shift_follows_shear_and_agitation(tmp_path: Path, ranks: int) -> None:
    """All pairs of the start, by the formulas: u = kappa c h sum (V_i^2 + V_j^2) / (2 V_0) G r, its share
    C min(1, (a h S / c)^2), C from 0 to 1 where S^2 / S_0^2 goes from 0.7 to 0.9."""
    rate, a, h = 0.5, 100.0, 0.5 * REACH
    scene = tmp_path / "scene.toml"
    scene.write_text(f"""
        name = "share"
        units = "dimensionless"
        box.size = [{NODES}.0, {NODES}.0]
        [fluid]
        density = 1.0
        spacing = 1.0
        rcut = {REACH}
        sound_speed = 1.0
        viscosity = 0.0
        shift_rate = {rate}
        shift_shear = {a}
        vortices = {{ amplitude = 0.02 }}
        disorder = {{ amplitude = 0.2, seed = 1 }}
        [run]
        steps = 1
        [output]
        snapshot = 1
    """)
    finished = run(scene, tmp_path / "out", Options(ranks=ranks))
    start, end = finished.fluid(0), finished.fluid(1)
    dt = finished.record["time_step"]
    for points in (start, end):
        order = np.argsort(points["id"])
        points.update({name: values[order] for name, values in points.items()})

    def nearest(d: np.ndarray) -> np.ndarray:
        return (d + NODES / 2) % NODES - NODES / 2

    r = nearest(start["points"][:, None, :2] - start["points"][None, :, :2])
    v = start["velocity"][:, None, :2] - start["velocity"][None, :, :2]
    q = np.linalg.norm(r, axis=2) / REACH
    # G in 1 / dx^2, with V_0 = 1
    g = np.where((q > 0) & (q < 1), KERNELS["wendland-c2"][2](q), 0.0)
    g *= Lattice("square", REACH, "wendland-c2").scales[1]
    g *= 0.5 * (start["density"][:, None] ** -2.0 + start["density"][None, :] ** -2.0) / REACH**2
    shift = rate * h * np.einsum("ij,ijk->ik", g, r) * dt
    lattice = np.stack(np.meshgrid(*[np.arange(-3, 4)] * 2), -1).reshape(-1, 2)
    even = np.linalg.norm(lattice, axis=1) / REACH
    gradient = np.where((even > 0) & (even < 1), KERNELS["wendland-c2"][2](even), 0.0)
    moment = (gradient * even**6).sum() / (gradient * even**2).sum()
    agitation = (g * (v**2).sum(axis=2)).sum(axis=1) / 2
    square = (g * q**4 * (v**2).sum(axis=2)).sum(axis=1) / (2 * moment)
    coherence = np.clip((square / agitation - 0.7) / 0.2, 0.0, 1.0)
    by_shear = np.minimum(1.0, (a * h) ** 2 * square)
    assert 0.2 < (by_shear < 1).mean() < 0.8
    assert 0.2 < (coherence < 1).mean() < 0.8
    share = coherence * by_shear
    found = nearest(end["points"][:, :2] - start["points"][:, :2] - dt * end["velocity"][:, :2])
    assert found == pytest.approx(share[:, None] * shift, abs=2e-9)  # a share has some eight digits
    assert np.abs(shift).max() > 1e-2
