"""Oblique impacts of a sphere on a wall, against LIGGGHTS."""

import math
from pathlib import Path

from reference.contact.scene import ContactScene
from verification.measures.curve import Chart
from verification.measures.impacts import FIGURES, Numbers, family_chart, force_charts, measured, read_published
from verification.measures.measures import Measures, Point

PUBLISHED = Path(__file__).parent / "published.csv"



def slide(scene: ContactScene) -> float:
    """Speed of the sphere's surface at the contact, over its speed of approach."""
    one = scene.bodies[0]
    return abs(one.velocity[0] - one.radius * one.spin[1]) / -one.velocity[2]


def recoil(values: Numbers, scene: ContactScene) -> float:
    """Tangent of the rebound angle of the surface, over the friction."""
    return math.tan(math.radians(values["rebound_angle"])) / scene.law.friction


def surface_restitution(values: Numbers, scene: ContactScene) -> float:
    """Velocity of the surface after the impact over that before, the sign changed."""
    after = values["tangential_velocity"] - scene.bodies[0].radius * values["spin"]
    return -after / (slide(scene) * -scene.bodies[0].velocity[2])


def of_test(number: str):
    """Points of a test by their material."""
    return lambda point: point.split("_")[1] if point.startswith(f"{number}_") else ""


def family_curves(results: list[Point]) -> list[Chart]:
    return [
        family_chart(results, ("Test 4: rebound of the surface", "angle of incidence (degrees)", "rebound angle (degrees)"),
                     lambda scene: math.degrees(math.atan(slide(scene))), lambda values, scene: values["rebound_angle"], of_test("4"),
                     (read_published(PUBLISHED, "4", "oxide, read off Chung and Ooi"),)),
        family_chart(results, ("Test 5: recoil of the surface", "v_t / (mu v_n)", "v_s' / (mu v_n')"),
                     lambda scene: slide(scene) / scene.law.friction, recoil, of_test("5"),
                     (read_published(PUBLISHED, "5", "steel, read off Chung and Ooi"),)),
        family_chart(results, ("Test 6: tangential restitution of the surface", "7/2 mu (1 + e) v_n / v_s", "-v_s' / v_s"),
                     lambda scene: 3.5 * scene.law.friction * (1 + scene.law.restitution) / slide(scene), surface_restitution,
                     of_test("6"), (read_published(PUBLISHED, "6", "alloy, read off Chung and Ooi"),)),
        family_chart(results, ("Linear contact: rebound of the surface", "angle of incidence (degrees)", "rebound angle (degrees)"),
                     lambda scene: math.degrees(math.atan(slide(scene))), lambda values, scene: values["rebound_angle"],
                     lambda point: "linear" if point.startswith("linear") else ""),
    ]


MEASURES = Measures(
    observables=measured("tangential_velocity", "spin", "normal_velocity"),
    figures=FIGURES,
    charts_of_both=force_charts,
    charts_of_family=family_curves,
)
