"""A scene as it stands, by OpenFOAM: periodic flows, channels and cavities between plane walls, incompressible and laminar.

The mesh is regular, its cells as wide as `fluid.spacing`; fields start as cell values of the scene's formulas. The step is fixed:
    COURANT of h / u, u the largest sum over the axes of |u_i| at the start or on a wall, or to which a force drives the fluid;
    FRICTION of h / (2 nu k), k the wave number of the start or pi over the distance of the walls.
The first leaves an error of time, by backward differences with (omega dt)^2 / 3, of 2 COURANT^2 = 0.18 of that of space where
flow is carried; the second, with (nu k^2 dt)^2 / 3 beside (k h)^2 / 12, of FRICTION^2 = 0.16 where it decays.
"""

import math
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from reference.exact_flows import FIELDS, wave_axes
from reference.openfoam import read
from reference.openfoam.flow_case import PROGRAM, FlowCase, write_flow_case
from reference.openfoam.room import Room, room_of
from reference.openfoam.run import FailedRun, run
from reference.particles import (
    Frame,
    Particles,
    ParticleScene,
    leave_frames,
    plan_of,
    read_particle_scene,
    start_velocity,
)
from verification.protocol.adapter import Cannot, Failed, Left, Task, core_seconds_of_children
from verification.protocol.quantity import checksum_of

COURANT, FRICTION = 0.3, 0.4


def refuse_sound(scene: ParticleScene) -> None:
    """Throws Cannot."""
    wave = scene.table.get("wave", {})
    if wave and wave["direction"] == wave["gradient"]:
        raise Cannot("fluid.wave along its own gradient is sound, which an incompressible fluid does not have")


def wave_number(scene: ParticleScene, room: Room) -> float:
    """Of the slowest motion that friction ends; 0 where there is none."""
    found = [math.pi / room.size[axis] for axis in room.walls]
    for kind in FIELDS:
        if kind in scene.table:
            k = 2 * math.pi * scene.table[kind].get("mode", 1) / scene.size
            across = wave_axes(scene.table[kind])[1] if kind == "wave" else 0
            found.append(float(np.linalg.norm(k)) if kind == "vortices" else float(k[across]))
    return max(found, default=0.0)


def driven_speed(scene: ParticleScene, room: Room) -> float:
    """To which a force drives the fluid: by the end of the scene, or in the middle of a channel."""
    force = float(np.linalg.norm(scene.gravity))
    across = [room.size[axis] ** 2 / (8 * scene.kinematic_viscosity) for axis in room.walls]
    return force * min([scene.duration, *across])


def largest_step(scene: ParticleScene, room: Room, start: np.ndarray) -> float:
    """By the rule above; start, (n, D), is the velocity of the cells. Infinite where nothing moves."""
    known = np.vstack([start, *(velocity for both in room.walls.values() for velocity in both)])
    rate = float((np.abs(known) / room.width).sum(axis=1).max()) + driven_speed(scene, room) / float(room.width.min())
    friction = 2 * scene.kinematic_viscosity * wave_number(scene, room) / float(room.width.min())
    return min(COURANT / rate if rate else math.inf, FRICTION / friction if friction else math.inf)


def case_of(scene: ParticleScene, steps: int | None) -> FlowCase:
    """Throws Cannot."""
    refuse_sound(scene)
    room = room_of(scene)
    start = start_velocity(scene, room.centres() + room.origin)
    plan = plan_of(scene, largest_step(scene, room, start), steps)
    return FlowCase(room, scene.kinematic_viscosity, scene.gravity, start, plan.step, plan.steps, plan.every)


def frames(folder: Path, case: FlowCase) -> Iterator[Frame]:
    """The start, and what the run wrote. Throws Failed where a velocity is not finite."""
    points, dimension = case.room.centres() + case.room.origin, len(case.room.size)
    yield 0.0, points, case.start
    for place in sorted(read.times(folder), key=lambda path: float(path.name)):
        if (now := float(place.name)) > 0:
            velocity = read.vectors(place / "U", case.room.count)[:, :dimension]
            if not np.isfinite(velocity).all():
                raise Failed(f"{PROGRAM}: the flow has diverged by {now:g}")
            yield now, points, velocity


def subject(task: Task) -> Left:
    """Runs the scene. Set-up is the mesh, the fields at the start, and the translation of what was written: all but the solver.

    Throws BadInput, Cannot or Failed.
    """
    before = time.process_time() + core_seconds_of_children()
    scene = read_particle_scene(task.scene, sound=False)
    case = case_of(scene, task.steps)
    cells = Particles(case.room.centres(), case.start, np.full(case.room.count, -1))
    with tempfile.TemporaryDirectory(prefix="openfoam_") as name:
        folder = Path(name)
        checksum = checksum_of(write_flow_case(folder, case), folder)
        try:
            run(folder, "blockMesh")
            seconds = run(folder, PROGRAM)
        except FailedRun as error:
            raise Failed(str(error)) from None
        leave_frames(task.out, scene, cells, frames(folder, case), scene.density * float(np.prod(case.room.width)))
    setup = time.process_time() + core_seconds_of_children() - before - seconds
    return Left(setup_core_seconds=setup, more={"inputs": checksum, "step": case.step, "steps": case.steps})
