"""A stack at rest, against the balance of forces and against LIGGGHTS."""


import numpy as np

from reference.contact.motion import Motion
from verification.measures.impacts import accepted, centre_charts, measured, motion_of
from verification.measures.measures import Measures, by_name
from verification.protocol.quantity import Measured
from verification.protocol.run import Run

PART = 5  # the last of so many parts of the run is the rest that is judged



def exact_overlaps(motion: Motion) -> np.ndarray:
    """From the wall up: each contact carries what is above it."""
    bodies, law = motion.scene.bodies, motion.scene.law
    weight = bodies[0].mass * np.linalg.norm(motion.scene.gravity) * np.arange(len(bodies), 0, -1)
    if law.model == "linear":
        return weight / law.stiffness
    radius = np.full(len(bodies), bodies[0].radius / 2)
    radius[0] = bodies[0].radius  # with the wall
    young = law.young / (2 * (1 - law.poisson**2))
    return (weight / (4 / 3 * young * np.sqrt(radius))) ** (2 / 3)


def overlaps(motion: Motion) -> np.ndarray:
    """From the wall up, (n, b): the bodies of the scene are listed from below."""
    radius, heights = motion.scene.bodies[0].radius, motion.position[:, :, 2]
    wall = next(face.place for face in motion.scene.faces if face.sign > 0)
    return np.column_stack([radius - (heights[:, 0] - wall), 2 * radius - np.diff(heights, axis=1)])


def overlap_error(run: Run) -> Measured:
    motion = motion_of(run.folder)
    exact = exact_overlaps(motion)
    return accepted(float(np.max(np.abs(overlaps(motion)[-1] - exact)) / exact[0]))


def drift(run: Run) -> Measured:
    motion = motion_of(run.folder)
    rest = motion.position[-(len(motion.time) // PART) :]
    return accepted(float(np.max(np.abs(rest - rest[0]))) / exact_overlaps(motion)[0])


def energy_growth(run: Run) -> Measured:
    """Of the largest kinetic energy in the last part over that in the part before."""
    motion = motion_of(run.folder)
    body, part = motion.scene.bodies[0], len(motion.time) // PART
    energy = 0.5 * body.mass * np.sum(motion.velocity**2, axis=(1, 2)) + 0.2 * body.mass * body.radius**2 * np.sum(motion.spin**2, axis=(1, 2))
    unit = body.mass * np.linalg.norm(motion.scene.gravity) * exact_overlaps(motion)[0]
    return accepted(float(max(0.0, np.max(energy[-part:]) - np.max(energy[-2 * part : -part])) / unit))


MEASURES = Measures(
    observables=by_name(overlap_error, drift, energy_growth) | measured("height", "lowest_overlap"),
    charts_of_both=centre_charts,
)
