"""Measures of an oblique impact that was measured, and its curve over the angle."""

import numpy as np

from reference.published.impacts import UNCERTAINTY, angle_of, angles_of, kharaz
from verification.measures.curve import Chart, Curve
from verification.measures.impacts import measured
from verification.measures.measures import Measures, Point

FIGURE = "tangential_restitution"


def family_curves(results: list[Point]) -> list[Chart]:
    """The measure over the angle, beside the experiment."""
    angles = angles_of(FIGURE)
    found = sorted((angle_of(point.scene), point.value) for point in results)
    return [Chart("What is left of the tangential velocity", "angle between velocity and normal (degrees)", "e_t", (
        Curve("Kharaz, Gorham and Salman 2001", np.array(angles), np.array([kharaz(FIGURE, angle).value for angle in angles]),
              reference=True, points=True, error=np.full(len(angles), 2 * UNCERTAINTY[FIGURE])),
        Curve("MaPPM", *np.array(found).T, points=True, marker="x")))]


MEASURES = Measures(observables=measured(FIGURE), charts_of_family=family_curves)
