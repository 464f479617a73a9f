"""Impacts of two spinning spheres, against LIGGGHTS."""

from pathlib import Path

from reference.contact.scene import ContactScene
from verification.measures.curve import Chart
from verification.measures.impacts import FIGURES, family_chart, force_charts, measured, read_published
from verification.measures.measures import Measures, Point

PUBLISHED = Path(__file__).parent / "published.csv"



def slide(scene: ContactScene) -> float:
    """Speed of the surface of body 0 at the contact, over its speed of approach."""
    one = scene.bodies[0]
    return abs(one.spin[1]) * one.radius / one.velocity[0]


def obliqueness(scene: ContactScene) -> float:
    """7/2 mu (1 + e) over the slide: below 1 a contact without tangential spring slides throughout."""
    return 3.5 * scene.law.friction * (1 + scene.law.restitution) / slide(scene)


def surface_restitution(values: dict[str, float], scene: ContactScene) -> float:
    """Velocity of the surface of body 0 after the impact over that before, the sign changed."""
    one = scene.bodies[0]
    return -(values["tangential_velocity"] - one.radius * values["spin"]) / (one.radius * abs(one.spin[1]))


def family_curves(results: list[Point]) -> list[Chart]:
    return [
        family_chart(results, ("Test 7: spin after the impact", "spin before (rad/s)", "spin after (rad/s)"),
                     lambda scene: scene.bodies[0].spin[1], lambda values, scene: values["spin"],
                     lambda point: point.split("_")[1] if point.startswith("7") else ""),
        family_chart(results, ("Test 8: tangential restitution of the surface", "7/2 mu (1 + e) v_n / v_s", "-v_s' / v_s"),
                     obliqueness, surface_restitution, lambda point: point.split("_")[0] if point.startswith("8") else "",
                     (read_published(PUBLISHED, "8a", "8a, read off Chung and Ooi"),
                      read_published(PUBLISHED, "8b", "8b, read off Chung and Ooi"))),
    ]


MEASURES = Measures(
    observables=measured("tangential_velocity", "spin", "normal_velocity"),
    figures=FIGURES,
    charts_of_both=force_charts,
    charts_of_family=family_curves,
)
