"""The measures of the heavy sphere."""

from dataclasses import replace

from cases.falling_sphere.measure import MEASURES as HEAVY
from cases.falling_sphere.measure import from_history, terminal_over_exact
from verification.measures.measures import by_name

MEASURES = replace(HEAVY, observables=by_name(terminal_over_exact, from_history))
