"""Published figures, looked up for a scene. README.md beside this file lists the tables and what they are worth."""

from reference.published import arrays, impacts, random_arrays, sphere, ten_cate
from reference.published.value import Published

TABLES = {
    "square_array_stokes": arrays.square_array_stokes,
    "simple_cubic_stokes": arrays.simple_cubic_stokes,
    "simple_cubic_hasimoto": arrays.simple_cubic_hasimoto,
    "isolated_sphere": sphere.isolated_sphere,
    "random_spheres": random_arrays.random_spheres,
    "ten_cate_u_max": ten_cate.largest_velocity,
    "ten_cate_fall": ten_cate.fall,
    "kharaz_restitution": impacts.kharaz_restitution,
    "kharaz_spin": impacts.kharaz_spin,
}


def look_up(name: str, scene: dict) -> Published:
    """The figure of table `name` for a scene, as verification.protocol.scene reads it; fluid.reference_velocity is the velocity U.

    Throws KeyError on a name that is not known, ValueError where the scene lies outside the range of the table.
    """
    if name not in TABLES:
        raise KeyError(f"{name}: no such published table; known are {', '.join(sorted(TABLES))}")
    return TABLES[name](scene)


__all__ = ["TABLES", "Published", "look_up"]
