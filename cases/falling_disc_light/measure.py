"""The measures of the heavy disc."""

from dataclasses import replace

from cases.falling_disc.measure import MEASURES as HEAVY
from cases.falling_disc.measure import from_stokes_flow, lag, relaxation_time, terminal_velocity
from verification.measures.measures import by_name

MEASURES = replace(HEAVY, observables=by_name(terminal_velocity, relaxation_time, lag, from_stokes_flow))
