"""The measures of the heavy disc."""

from cases.falling_disc.measure import (
    curves,
    from_stokes_flow,
    lag,
    live_curves,
    live_options,
    relaxation_time,
    terminal_velocity,
)

__all__ = ["curves", "from_stokes_flow", "lag", "live_curves", "live_options", "relaxation_time", "terminal_velocity"]
