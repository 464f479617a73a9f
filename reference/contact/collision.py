"""Head-on impact of two balls, or of a ball and a wall, as one equation for the overlap d, solved apart from any time stepping.

    m* d'' = -k d - c d'                      linear, c = -2 b sqrt(m* k), closed form
    m* d'' = -K d^(3/2) - C d^(1/4) d'        Hertz, K = 4/3 E* sqrt(R*), C = -2 b sqrt(5/4 m* K)
                                              (Tsuji, Tanaka and Ishida 1992)

with b = ln e / sqrt(ln^2 e + pi^2): then d' comes back as -e times what it was, when d = 0 (Antypov and Elliott 2011).
Scaled by the largest overlap without loss, (5 m* v^2 / (4 K))^(2/5), Hertz' equation has no parameter but b.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

from reference.contact.scene import ContactScene


@dataclass(frozen=True)
class Collision:
    force: float  # the largest
    time: float  # of contact
    restitution: float


def _loss(restitution: float) -> float:
    log = math.log(restitution)
    return -log / math.hypot(math.pi, log)


def linear(mass: float, stiffness: float, restitution: float, speed: float) -> Collision:
    """The largest force is at the touch where the dashpot outweighs the spring, above a loss of 1/2."""
    loss, rate = _loss(restitution), math.sqrt(stiffness / mass)
    damped = rate * math.sqrt(1 - loss**2)
    # force/m* = rate^2 d + 2 loss rate d' with d = (v / damped) exp(-loss rate t) sin(damped t); its slope vanishes here
    turn = math.atan2(math.sqrt(1 - loss**2) * (1 - 4 * loss**2), loss * (3 - 4 * loss**2)) / damped if loss < 0.5 else 0.0
    decay = math.exp(-loss * rate * turn)
    overlap = speed / damped * decay * math.sin(damped * turn)
    approach = speed * decay * (math.cos(damped * turn) - loss * rate / damped * math.sin(damped * turn))
    return Collision(stiffness * overlap + 2 * loss * rate * mass * approach, math.pi / damped, restitution)


@lru_cache
def _hertz(restitution: float, step: float = 2e-4) -> tuple[float, float, float]:
    """(largest force, time, restitution) of x'' = -5/4 x^(3/2) - 5/2 b' x^(1/4) x', x = 0, x' = 1, by Runge and Kutta."""
    damping = 2.5 * _loss(restitution)

    def pull(x: float, v: float) -> float:
        x = max(x, 0.0)
        return 1.25 * x**1.5 + damping * x**0.25 * v

    x, v, time, largest = 0.0, 1.0, 0.0, 0.0
    while True:
        a1 = -pull(x, v)
        v2 = v + 0.5 * step * a1
        a2 = -pull(x + 0.5 * step * v, v2)
        v3 = v + 0.5 * step * a2
        a3 = -pull(x + 0.5 * step * v2, v3)
        v4 = v + step * a3
        a4 = -pull(x + step * v3, v4)
        next_x = x + step / 6 * (v + 2 * v2 + 2 * v3 + v4)
        next_v = v + step / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
        largest = max(largest, -a1)
        if next_x <= 0:
            share = x / (x - next_x)
            return largest, time + share * step, -(v + share * (next_v - v))
        x, v, time = next_x, next_v, time + step


def hertz(mass: float, stiffness: float, restitution: float, speed: float) -> Collision:
    """`stiffness` is K."""
    overlap = (1.25 * mass * speed**2 / stiffness) ** 0.4
    force, time, back = _hertz(restitution)
    return Collision(force * mass * speed**2 / overlap, time * overlap / speed, back)


def collision_of(scene: ContactScene) -> Collision:
    """Of body 0 with body 1, or with a wall, by their velocities along the normal of the scene's start."""
    one, law = scene.bodies[0], scene.law
    mass, radius = one.mass, one.radius
    if len(scene.bodies) > 1:
        other = scene.bodies[1]
        mass, radius = 1 / (1 / mass + 1 / other.mass), 1 / (1 / radius + 1 / other.radius)
        apart = one.position - other.position
        speed = -float((one.velocity - other.velocity) @ apart) / math.sqrt(float(apart @ apart))
    else:
        nearest = min(scene.faces, key=lambda face: face.sign * (one.position[face.axis] - face.place))
        speed = -nearest.sign * float(one.velocity[nearest.axis])
    if law.model == "linear":
        return linear(mass, law.stiffness, law.restitution, speed)
    young = law.young / (2 * (1 - law.poisson**2))
    return hertz(mass, 4 / 3 * young * math.sqrt(radius), law.restitution, speed)
