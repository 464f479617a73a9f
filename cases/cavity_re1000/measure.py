"""The measures of the cavity at Re = 100."""

from cases.cavity.measure import curves, highest_v, largest_from_ghia, lowest_u, lowest_v, rms_from_ghia

__all__ = ["curves", "highest_v", "largest_from_ghia", "lowest_u", "lowest_v", "rms_from_ghia"]
