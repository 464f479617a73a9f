"""What the report draws; the drag itself is measured by verification/measures/observables.py."""

from verification.measures.curve import Chart
from verification.measures.drag_families import drag_errors, drag_of_one_sphere
from verification.measures.histories import drag_history as curves
from verification.suite.result import CaseResult

__all__ = ["curves", "family_curves", "stored_curves"]


def family_curves(results: list[CaseResult]) -> list[Chart]:
    return [drag_errors(results), *drag_of_one_sphere(results)]


stored_curves = family_curves
