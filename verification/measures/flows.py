"""The exact periodic flows that a scene can start with or be driven by, as formulas of their own.

A flow is one eigenfunction f of the Laplacian, lap f = -lambda f, whose convection is a gradient or vanishes; so it
decays as exp(-nu lambda t) in an incompressible fluid, and a steady acceleration nu lambda A f keeps it as it is. Of
vortices in space only the start is exact: their convection is no gradient.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from verification.measures.curve import Chart, Curve
from verification.protocol.run import Run, read_points, read_time


@dataclass(frozen=True)
class Flow:
    """`kind` is the key of the scene: wave, vortices or abc; k = 2 pi mode / side, per axis."""

    kind: str
    amplitude: float
    k: np.ndarray
    direction: int = 0
    gradient: int = 0

    @property
    def eigenvalue(self) -> float:
        """lambda."""
        if self.kind == "wave":
            return float(self.k[self.gradient] ** 2)
        return float(np.sum(self.k**2)) if self.kind == "vortices" else float(self.k[0] ** 2)

    def shape(self, points: np.ndarray) -> np.ndarray:
        """f at points (n, 3), for amplitude 1: (n, 3)."""
        dimensions = len(self.k)
        phase = points[:, :dimensions] * self.k
        sine, cosine = np.sin(phase), np.cos(phase)
        value = np.zeros((len(points), 3))
        if self.kind == "wave":
            value[:, self.direction] = sine[:, self.gradient]
        elif self.kind == "vortices":
            depth = cosine[:, 2] if dimensions == 3 else 1.0
            value[:, 0] = sine[:, 0] * cosine[:, 1] * depth
            value[:, 1] = -cosine[:, 0] * sine[:, 1] * depth
        else:
            for axis in range(3):
                value[:, axis] = sine[:, (axis + 2) % 3] + cosine[:, (axis + 1) % 3]
        return value


def read_flow(table: dict, size: list[float]) -> Flow:
    """The flow of a scene's table [fluid] or [force]."""
    (kind,) = [key for key in ("wave", "vortices", "abc") if key in table]
    declared = table[kind]
    axes = {name: "xyz".index(declared[name]) for name in ("direction", "gradient") if name in declared}
    return Flow(kind, declared["amplitude"], 2 * np.pi * declared.get("mode", 1) / np.array(size), **axes)


def initial_flow(run: Run) -> Flow:
    return read_flow(run.scene["fluid"], run.scene["box"]["size"])


def viscosity_of(run: Run) -> float:
    """Kinematic."""
    return run.scene["fluid"]["viscosity"] / run.scene["fluid"]["density"]


@dataclass(frozen=True)
class Field:
    """PPs of one snapshot in the frame that moves with the fluid's declared mean velocity."""

    time: float
    points: np.ndarray
    velocity: np.ndarray


def fields(run: Run) -> Iterator[Field]:
    stream = np.zeros(3)
    declared = run.scene["fluid"].get("velocity", [])
    stream[: len(declared)] = declared
    for file in run.snapshots():
        data, time = read_points(file), read_time(file)
        fluid = data["kind"] == 0
        yield Field(time, data["points"][fluid] - stream * time, data["velocity"][fluid] - stream)


def amplitudes(run: Run, flow: Flow) -> tuple[np.ndarray, np.ndarray]:
    """(time, a): the velocity of every snapshot projected on the flow, in units of its amplitude.

    Least squares over the PPs: what their disorder adds to the velocity is nearly orthogonal and falls out.
    """
    times, found = [], []
    for field in fields(run):
        shape = flow.shape(field.points)
        times.append(field.time)
        found.append(float(np.sum(shape * field.velocity) / np.sum(shape**2)) / flow.amplitude)
    return np.array(times), np.array(found)


def decay_chart(run: Run) -> Chart:
    """Amplitude of the initial flow against its exact decay."""
    flow = initial_flow(run)
    time, amplitude = amplitudes(run, flow)
    fine = np.linspace(0.0, time[-1], 200)
    exact = Curve("exact", fine, np.exp(-viscosity_of(run) * flow.eigenvalue * fine), reference=True)
    measured = Curve("measured", time, amplitude, points=True)
    return Chart("Amplitude of the flow", "time", "u / U", (exact, measured), log=True)


def decay_charts(run: Run) -> list[Chart]:
    """All that a case of nothing but a decaying flow draws."""
    return [decay_chart(run)]
