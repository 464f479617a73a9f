"""How a run came out: the classes of a stability map, each told from measured figures."""

import math
import re
from collections.abc import Mapping

RIGHT, DRIFTING, WRONG, CLUMPED, JAMMED, LEAKED, BLOWN_UP, NO_VALUE, REFUSED = CLASSES = (
    "right", "drifting", "wrong but alive", "clumped", "jammed", "leaked", "blown up", "no value", "refused")
ABOUT = {
    RIGHT: "ends, has settled, and is less than 2 % from the reference",
    DRIFTING: "ends, and is 2 to 5 % from the reference, or has not settled where it is nearer",
    WRONG: "ends, and is more than 5 % from the reference, settled or not",
    CLUMPED: "ends, and PPs stand closer than 0.4 spacings: they form pairs",
    JAMMED: "ends, and the fluid that is driven stands still, below a tenth of the velocity declared",
    LEAKED: "ends, and PPs lie inside a solid",
    BLOWN_UP: "does not end: a particle leaves its surroundings, a density goes out of range, or a figure is no number",
    NO_VALUE: "ends, and too little is left of the flow to measure",
    REFUSED: "is not begun: the solver says which limit the scene is beyond",
}
NEAR, FAR = 0.02, 0.05  # of the error
CLOSE = 0.4  # spacings
STILL = 0.1  # of the velocity declared


def class_of(error: float, objection: str, health: Mapping[str, float]) -> str:
    """Of a run that ended: `error` as in a verdict, `health` as verification/measures/health.py has it. The worst counts."""
    if health.get("inside", 0.0) > 0.0:
        return LEAKED
    if health.get("nearest", 1.0) < CLOSE:
        return CLUMPED
    if health.get("flow", 1.0) < STILL:
        return JAMMED
    if math.isnan(error):
        return NO_VALUE
    if abs(error) > FAR:
        return WRONG
    return DRIFTING if objection or abs(error) > NEAR else RIGHT


def class_of_failure(words: str) -> str:
    """Of a run that did not end, by the solver's last words: those that name a step, or a number that is none, are of a run that was
    begun."""
    return BLOWN_UP if re.search(r"\bstep \d+: |must be a finite number", words) else REFUSED
