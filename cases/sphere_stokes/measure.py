"""What the report draws; the drag itself is measured by verification/measures/observables.py."""

from verification.measures.curve import Chart
from verification.measures.drag_families import drag_errors, drag_of_one_sphere
from verification.measures.histories import drag_history
from verification.measures.measures import Measures, Point


def family_curves(results: list[Point]) -> list[Chart]:
    return [drag_errors(results), *drag_of_one_sphere(results)]


MEASURES = Measures(charts=drag_history, charts_of_family=family_curves)
