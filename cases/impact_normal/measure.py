"""Impacts along the normal, against the equation of the overlap and against LIGGGHTS."""

from verification.measures.curve import Chart
from verification.measures.impacts import FIGURES, family_chart, force_charts, measured, over_exact
from verification.measures.measures import Measures, Point


def series_of(point: str) -> str:
    """What points have in common that differ in restitution alone: of 3_oxide_0.2, oxide."""
    words = point.split("_")
    return {"3": words[1], "linear": "linear"}.get(words[0], "")


def family_curves(results: list[Point]) -> list[Chart]:
    return [family_chart(results, ("Restitution", "given", "measured"), lambda scene: scene.law.restitution,
                         lambda values, scene: values["restitution"], series_of)]


MEASURES = Measures(
    observables=measured("contact_force", "contact_time", "restitution") | {
        "force_ratio": over_exact("contact_force", lambda exact: exact.force),
        "time_ratio": over_exact("contact_time", lambda exact: exact.time),
        "restitution_ratio": over_exact("restitution", lambda exact: exact.restitution),
    },
    figures=FIGURES,
    charts_of_both=force_charts,
    charts_of_family=family_curves,
)
