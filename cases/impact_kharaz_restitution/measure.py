"""Measures of an oblique impact that was measured, and its curve over the angle."""

import numpy as np

from reference.published.impacts import UNCERTAINTY, angle_of, angles_of, kharaz
from verification.measures.curve import Chart, Curve
from verification.measures.impacts import measured
from verification.measures.measures import Measures, Point


def beside_kharaz(figure: str, title: str, label: str) -> Measures:
    """The measure of that name, one of the figures of Kharaz, Gorham and Salman, and over the angle beside the experiment."""
    def family_curves(results: list[Point]) -> list[Chart]:
        angles = angles_of(figure)
        found = sorted((angle_of(point.scene), point.value) for point in results)
        return [Chart(title, "angle between velocity and normal (degrees)", label, (
            Curve("Kharaz, Gorham and Salman 2001", np.array(angles), np.array([kharaz(figure, angle).value for angle in angles]),
                  reference=True, points=True, error=np.full(len(angles), 2 * UNCERTAINTY[figure])),
            Curve("MaPPM", *np.array(found).T, points=True, marker="x")))]

    return Measures(observables=measured(figure), charts_of_family=family_curves)


MEASURES = beside_kharaz("tangential_restitution", "What is left of the tangential velocity", "e_t")
