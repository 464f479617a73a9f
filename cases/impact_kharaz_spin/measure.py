"""The spin after an oblique impact that was measured."""

from cases.impact_kharaz_restitution.measure import beside_kharaz

MEASURES = beside_kharaz("spin", "Spin after the impact", "omega (rad/s)")
