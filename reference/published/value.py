"""A published figure."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Published:
    value: float
    uncertainty: float  # standard, absolute
    source: str
    input: float = 0.0  # standard uncertainty of the figure from what the experiment does not say of its inputs, absolute
