"""The measures of the heavy sphere."""

from cases.falling_sphere.measure import (
    FIGURES,
    charts_of_both,
    curves,
    from_history,
    reference_options,
    terminal_velocity,
)
from verification.measures.measures import Measures, by_name

MEASURES = Measures(
    observables=by_name(terminal_velocity, from_history),
    figures=FIGURES,
    charts=curves,
    charts_of_both=charts_of_both,
    reference_options=reference_options,
)
