"""The measures of the heavy disc."""

from dataclasses import replace

from cases.falling_disc.measure import MEASURES as HEAVY
from cases.falling_disc.measure import from_stokes_flow, lag, relaxation_over_exact, terminal_over_exact
from verification.measures.measures import by_name

MEASURES = replace(HEAVY, observables=by_name(terminal_over_exact, relaxation_over_exact, lag, from_stokes_flow))
