"""A published figure."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Published:
    value: float
    uncertainty: float  # standard, absolute
    source: str
