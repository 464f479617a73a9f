"""Impacts along the normal, against the equation of the overlap and against LIGGGHTS."""

from verification.measures.curve import Chart
from verification.measures.impacts import family_chart, force_charts, measure, over_exact
from verification.suite.result import CaseResult

force_ratio = over_exact("contact_force", lambda exact: exact.force)
time_ratio = over_exact("contact_time", lambda exact: exact.time)
restitution_ratio = over_exact("restitution", lambda exact: exact.restitution)
contact_force = measure("contact_force")
contact_time = measure("contact_time")
restitution = measure("restitution")

live_curves = force_charts


def series_of(point: str) -> str:
    """What points have in common that differ in restitution alone: of 3_oxide_0.2, oxide."""
    words = point.split("_")
    return {"3": words[1], "linear": "linear"}.get(words[0], "")


def family_curves(results: list[CaseResult]) -> list[Chart]:
    return [family_chart(results, ("Restitution", "given", "measured"), lambda scene: scene.law.restitution,
                         lambda values, scene: values["restitution"], series_of)]
