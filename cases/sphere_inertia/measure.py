"""What the report draws; the drag itself is measured by verification/observables.py."""

from verification.curve import Chart
from verification.drag_families import drag_errors, drag_of_one_sphere
from verification.histories import drag_history as curves
from verification.result import CaseResult

__all__ = ["curves", "family_curves", "stored_curves"]


def family_curves(results: list[CaseResult]) -> list[Chart]:
    return [drag_errors(results), *drag_of_one_sphere(results)]


stored_curves = family_curves
