"""What the report draws; the drag itself is measured by verification/observables.py."""

from verification.histories import drag_history as curves

__all__ = ["curves"]
