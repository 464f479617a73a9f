"""What a code can do, in words, and which of them a scene asks for."""

FLUID, SPACE, WALLS = "fluid", "3d", "walls"
FIXED_BODY, MOVING_BODY, FREE_BODY, CONTACT = "fixed-body", "moving-body", "free-body", "contact"
FORCE_ON_BODY, EXACT_LEDGER, DIGEST = "force-on-body", "exact-ledger", "digest"
CAPABILITIES = (FLUID, SPACE, WALLS, FIXED_BODY, MOVING_BODY, FREE_BODY, CONTACT, FORCE_ON_BODY, EXACT_LEDGER, DIGEST)
OF_MOTION = {"fixed": FIXED_BODY, "moving": MOVING_BODY, "free": FREE_BODY}


def _count(body: dict) -> int:
    """Of solids that a table [[body]] declares."""
    if "array" in body:
        count = 1
        for side in body["array"]["count"]:
            count *= side
        return count
    return len(body.get("positions", [None])) if "random" not in body else int(body["random"].get("count", 2))


def asked_by(scene: dict) -> set[str]:
    """Capabilities without which a scene cannot be run."""
    found = {FLUID} if scene.get("fluid", {}).get("particles", True) else set()
    if len(scene["box"]["size"]) == 3:
        found.add(SPACE)
    free = 0
    bodies = scene.get("body", [])
    for body in bodies:
        if body["shape"] == "wall":
            found.add(WALLS)
            continue
        motion = body.get("motion", "free")
        found.add(OF_MOTION[motion])
        free += _count(body) if motion == "free" else 0
    touches = free > 1 or (free and any(body["shape"] == "wall" for body in bodies))
    if touches and scene.get("contact", {}).get("model") != "none":
        found.add(CONTACT)
    return found


def lacking(capabilities: set[str] | frozenset[str], asked: set[str]) -> list[str]:
    """What is asked and not offered, in the order of CAPABILITIES."""
    return [word for word in CAPABILITIES if word in asked - set(capabilities)]
