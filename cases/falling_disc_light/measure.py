"""The measures of the heavy disc."""

from cases.falling_disc.measure import (
    FIGURES,
    charts_of_both,
    curves,
    from_stokes_flow,
    lag,
    reference_options,
    relaxation_time,
    terminal_velocity,
)
from verification.measures.measures import Measures, by_name

MEASURES = Measures(
    observables=by_name(terminal_velocity, relaxation_time, lag, from_stokes_flow),
    figures=FIGURES,
    charts=curves,
    charts_of_both=charts_of_both,
    reference_options=reference_options,
)
