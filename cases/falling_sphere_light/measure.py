"""The measures of the heavy sphere."""

from cases.falling_sphere.measure import (
    curves,
    from_history,
    live_curves,
    live_options,
    terminal_velocity,
)

__all__ = ["curves", "from_history", "live_curves", "live_options", "terminal_velocity"]
