"""A fluid with disorder between walls and around discs comes to rest, and a column stands. Oracle: hydrostatics.

Judged after ten viscous times H^2 / nu of the gap, or after 6000 steps, 1500 in space, where these are fewer (one
viscous time at nu / (c h) = .01, in which sound has been damped long ago; two to six at .05). A column weighs rho g H
= .01 rho c^2. Recorded, of this weight: mean pressures are off by 3 to 7 % in the first row at the bottom and in the
two beside it, by 1.5 % and less beyond. 2 % is the goal and is not met there. At nu / (c h) = .5, and in space, PPs
keep to the rows that they started in, and in these the pressure alternates by up to 12 % (28 % under the upper wall in
space) of the weight, with the shift or without it: it is small beside rho c^2, but does not die out.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from verification.codes.mappm import Options, run
from verification.protocol.run import Run

LONGEST = {2: 6000, 3: 1500}  # steps
WEIGHT = 0.01  # rho g H / (rho c^2)


@dataclass(frozen=True)
class Scene:
    """A gap of H = 1 between walls, or a disc (a sphere) of radius .5 in a periodic box."""

    kind: str  # "walls", "column", "fixed" or "free"
    dimension: int = 2
    nodes: int = 12  # to a length of 1
    reach: float = 3.0  # rcut / dx
    sound: float = 10.0  # c
    viscosity: float = 0.05  # nu / (c h)

    @property
    def cutoff(self) -> float:
        return self.reach / self.nodes

    def text(self) -> str:
        nu = self.viscosity * self.sound * 0.5 * self.cutoff
        thick = float(np.ceil(self.reach)) / self.nodes
        width = 1.5
        if self.kind in ("walls", "column"):
            sides = [width] * (self.dimension - 1) + [1.0 + thick]
            body = f'shape = "wall"\nposition = 1.0\nthickness = {thick!r}'
        else:
            sides = [2.0 if self.dimension == 2 else 1.5] * self.dimension
            body = f"""shape = "{'disc' if self.dimension == 2 else 'sphere'}"
                radius = 0.5
                motion = "{self.kind}"
                density = 2.0
                position = {[0.5 * side for side in sides]}"""
        down = [0.0] * (self.dimension - 1) + [-WEIGHT * self.sound**2]
        force = f"[force]\nfluid = {down}" if self.kind == "column" else ""
        return f"""
            name = "at_rest"
            units = "dimensionless"
            box.size = {sides}
            [fluid]
            density = 1.0
            viscosity = {nu!r}
            spacing = {1.0 / self.nodes!r}
            rcut = {self.cutoff!r}
            sound_speed = {self.sound}
            disorder = {{ amplitude = 0.2, seed = 1 }}
            [[body]]
            {body}
            {force}
            [run]
            duration = {10.0 / nu!r}
            [output]
            sample = 1000
        """

    def finished(self, folder: Path) -> Run:
        """Steps are as long as they may be; those that last ten viscous times, or the longest run."""
        (folder / "scene.toml").write_text(self.text())
        step = run(folder / "scene.toml", folder / "one", Options(steps=1)).record["time_step"]
        nu = self.viscosity * self.sound * 0.5 * self.cutoff
        steps = min(LONGEST[self.dimension], int(10.0 / nu / step))
        print(f"{self}: {steps} steps, {steps * step * nu:.1f} viscous times")
        return run(folder / "scene.toml", folder / "out", Options(steps=steps))


def assert_at_rest(scene: Scene, finished: Run) -> None:
    speed = np.linalg.norm(finished.fluid()["velocity"], axis=1) / scene.sound
    rms = np.sqrt((speed**2).mean())
    print(f"    rms velocity {rms:.1e} c, largest {speed.max():.1e} c")
    assert rms < 1e-4
    assert speed.max() < 5e-4


SCENES = [
    Scene("walls"),
    Scene("walls", viscosity=0.01),
    Scene("walls", viscosity=0.5, sound=20.0),
    Scene("walls", reach=3.5, nodes=16),
    Scene("walls", dimension=3, nodes=8, viscosity=0.1),
    Scene("fixed"),
    Scene("fixed", viscosity=0.01, sound=20.0),
    Scene("fixed", viscosity=0.5, reach=3.5),
    Scene("fixed", nodes=16),
    Scene("fixed", dimension=3, nodes=8, viscosity=0.1),
    Scene("free"),
    Scene("free", viscosity=0.5),
    Scene("free", viscosity=0.01, reach=3.5),
    Scene("free", nodes=16, sound=20.0),
]
COLUMNS = [
    Scene("column"),
    Scene("column", viscosity=0.01),
    Scene("column", viscosity=0.5, sound=20.0),
    Scene("column", nodes=16, sound=20.0),
    Scene("column", nodes=16, reach=3.5),
    Scene("column", dimension=3, nodes=8, viscosity=0.1),
]


def name(scene: Scene) -> str:
    return "-".join(str(value) for value in vars(scene).values())


@pytest.mark.parametrize("scene", SCENES, ids=name)
def test_a_disordered_fluid_comes_to_rest(tmp_path: Path, scene: Scene) -> None:
    assert_at_rest(scene, scene.finished(tmp_path))


@pytest.mark.parametrize("scene", COLUMNS, ids=name)
def test_a_column_stands(tmp_path: Path, scene: Scene) -> None:
    finished = scene.finished(tmp_path)
    assert_at_rest(scene, finished)
    fluid = finished.fluid()
    height = fluid["points"][:, scene.dimension - 1]
    row = np.clip((height * scene.nodes).astype(int), 0, scene.nodes - 1)
    off = np.empty(scene.nodes)
    for k in range(scene.nodes):
        here = row == k
        off[k] = (fluid["pressure"][here] / scene.sound**2 - WEIGHT * (1 - height[here])).mean() / WEIGHT
    off -= np.median(off)  # the level is that of all PPs together, whose number is rounded
    print("    rows off by " + " ".join(f"{100 * value:.1f}" for value in off) + " % of rho g H")
    keeps_rows = scene.viscosity > 0.2 or scene.dimension == 3
    assert np.abs(off).max() < ({2: 0.15, 3: 0.35}[scene.dimension] if keeps_rows else 0.07)
    alternating = np.abs(off[3:-3] - 0.5 * (off[2:-4] + off[4:-2])) / 2  # amplitude, away from the walls
    assert alternating.max() < (0.1 if keeps_rows else 0.03)
