"""What the report draws; the decay itself is measured by verification/measures/observables.py."""

from verification.measures.flows import decay_charts as curves

__all__ = ["curves"]
