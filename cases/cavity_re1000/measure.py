"""The measures of the cavity at Re = 100."""

from cases.cavity.measure import MEASURES

__all__ = ["MEASURES"]
