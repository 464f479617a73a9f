"""What the report draws; the drag itself is measured by verification/measures/observables.py."""

from verification.measures.histories import drag_history
from verification.measures.measures import Measures

MEASURES = Measures(charts=drag_history)
