"""What the report draws; the decay itself is measured by verification/measures/observables.py."""

from verification.measures.flows import decay_charts
from verification.measures.measures import Measures

MEASURES = Measures(charts=decay_charts)
