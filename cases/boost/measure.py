"""What the report draws; the decay itself is measured by verification/observables.py."""

from verification.flows import decay_charts as curves

__all__ = ["curves"]
