"""What measure.py of a case offers: one object named MEASURES.

    MEASURES = Measures(observables=by_name(drift, height), charts=charts)

Measures see what a run left, whichever code made it.
"""

import functools
import importlib.util
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from verification.measures.curve import Chart
from verification.protocol.errors import CaseError
from verification.protocol.quantity import Measured
from verification.protocol.run import Run

Measure = Callable[[Run], Measured]


@dataclass(frozen=True)
class Values:
    """One run of a case, as far as it is kept: its scene, and what was measured of it, by name."""

    scene: dict
    values: Mapping[str, float]


@dataclass(frozen=True)
class Point:
    """One point of a family of cases at its finest level, judged, for charts of all of them."""

    family: str
    name: str  # without that of the family; empty where the case has no points
    scene: dict
    values: Mapping[str, float]  # observables and further figures, by name
    reference: Mapping[str, float]  # quantities of the reference code, if one ran
    value: float  # of the first observable
    error: float  # relative, as in the verdict
    half_width: float  # k u_num, absolute
    scale: float  # what the error is relative to


def by_name(*functions: Callable) -> dict[str, Callable]:
    return {function.__name__: function for function in functions}


@dataclass(frozen=True)
class Measures:
    observables: Mapping[str, Measure] = field(default_factory=dict)  # beside those that all cases share
    figures: Mapping[str, Callable[[Run], float]] = field(default_factory=dict)  # further numbers, which nothing judges
    charts: Callable[[Run], list[Chart]] | None = None  # of the finest run
    charts_of_both: Callable[[Run, Run], list[Chart]] | None = None  # of the finest run and of the reference code's
    charts_of_family: Callable[[list[Point]], list[Chart]] | None = None  # of two points or more together
    reference_options: Callable[[Sequence[Values]], dict[str, str]] | None = None  # of the reference code, from all runs


@functools.cache
def measures_in(folder: Path) -> Measures:
    """Those of the case in a folder; none of its own without measure.py. Throws CaseError."""
    file = folder / "measure.py"
    if not file.exists():
        return Measures()
    spec = importlib.util.spec_from_file_location(f"case_{folder.name}", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    found = getattr(module, "MEASURES", None)
    if not isinstance(found, Measures):
        raise CaseError(f"{file}: MEASURES = {found!r}: must be a Measures of verification/measures/measures.py; write "
                        "MEASURES = Measures(...)")
    return found
