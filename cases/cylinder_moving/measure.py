"""What the report draws; the drag itself is measured by verification/measures/observables.py."""

from verification.measures.histories import drag_history as curves

__all__ = ["curves"]
