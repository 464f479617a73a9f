"""Drag of spheres in random arrays, F / (6 pi mu R U): F the mean pressure gradient times the volume of a sphere."""

import math

from reference.published.cell import refuse_outside
from reference.published.value import Published
from verification.protocol.scene import in_si

SOURCE = ("Hill, Koch and Ladd, J. Fluid Mech. 448, 2001, 243-278, as put by Koch and Hill, Annu. Rev. Fluid Mech. 33, "
          "2001, 619-647: F_0 + F_3 Re_R")


def koch_hill(fraction: float, reynolds: float) -> Published:
    """`reynolds` on the diameter and the superficial velocity.

    Uncertainty 10 %: what their runs scatter. At small Re inertia goes as Re^2, and the law is high.
    """
    refuse_outside("solids fraction", fraction, 0.01, 0.6, SOURCE)
    refuse_outside("Re", reynolds, 0.0, 120.0, SOURCE)
    if fraction < 0.4:
        top = 1 + 3 * math.sqrt(fraction / 2) + 135 / 64 * fraction * math.log(fraction) + 16.14 * fraction
        stokes = top / (1 + 0.681 * fraction - 8.48 * fraction**2 + 8.16 * fraction**3)
    else:
        stokes = 10 * fraction / (1 - fraction) ** 3
    inertia = 0.0673 + 0.212 * fraction + 0.0232 / (1 - fraction) ** 5
    value = stokes + inertia * 0.5 * reynolds
    return Published(value, 0.1 * value, SOURCE)


def _count(body: dict) -> int:
    if "random" in body:
        return body["random"]["count"]
    return len(body["positions"]) if "positions" in body else 1


def random_spheres(scene: dict) -> Published:
    """For a periodic box of equal spheres. Throws ValueError."""
    sides, fluid, bodies = [in_si(side) for side in scene["box"]["size"]], scene["fluid"], scene.get("body", [])
    radii = {in_si(body.get("radius", 0.0)) for body in bodies}
    if len(sides) != 3 or any(body.get("shape") != "sphere" for body in bodies) or len(radii) != 1:
        raise ValueError("body: the law of Hill, Koch and Ladd holds for equal spheres, in 3 dimensions")
    (radius,), number = radii, sum(_count(body) for body in bodies)
    velocity = in_si(fluid.get("reference_velocity", 0.0))
    reynolds = 2 * radius * velocity * in_si(fluid["density"]) / in_si(fluid["viscosity"])
    return koch_hill(number * 4 / 3 * math.pi * radius**3 / math.prod(sides), reynolds)
