"""A free disc in the middle between walls that move in opposite directions: how fast it turns."""

import numpy as np

from reference.stokes.channel import Disc, angular_velocity, angular_velocity_without_transpose
from verification.measures.curve import Chart, Curve
from verification.measures.measures import Measures, by_name
from verification.protocol.quantity import Measured
from verification.protocol.run import Run
from verification.protocol.series import Table, read_table

SETTLED = 0.005
BLOCKS = 8


def shear_rate(run: Run) -> float:
    """Of the walls, which are the second and third body of the scene; the channel is 0 < y < position of the upper one."""
    _, upper, lower = run.scene["body"]
    return (upper["velocity"][0] - lower["velocity"][0]) / upper["position"]


def turning(run: Run) -> Table:
    return read_table(run.folder / "solids.csv")


def spin(run: Run) -> Measured:
    """-omega / G, the mean of the second half. Its uncertainty is that of the mean of eight blocks of it."""
    table = turning(run)
    values = -table["angular_velocity"] / shear_rate(run)
    half = values[len(values) // 2 :]
    blocks = [block.mean() for block in np.array_split(half, BLOCKS)]
    value = float(half.mean())
    drift = float(half[len(half) // 2 :].mean() / value - 1)
    objections = [] if abs(drift) < SETTLED else [f"the last quarter is {100 * drift:+.2f} % from the last half"]
    moved = abs(table["position_y"][-1] / run.scene["body"][0]["position"][1] - 1)
    if moved > 0.01:
        objections.append(f"the disc left the middle by {100 * moved:.1f} % of its height")
    return Measured(value, float(np.std(blocks, ddof=1) / np.sqrt(BLOCKS)), "; ".join(objections))


def curves(run: Run) -> list[Chart]:
    table, (box, _), disc = turning(run), run.scene["box"]["size"], run.scene["body"][0]
    width, rate = run.scene["body"][1]["position"], shear_rate(run)
    scaled = Disc(disc["radius"] / width), box / width
    strain = rate * table["time"]
    ends = strain[[0, -1]]
    return [
        Chart(
            "Spin of the disc",
            "G t",
            "-omega / G",
            (
                Curve("Stokes flow", ends, np.full(2, angular_velocity(*scaled)), reference=True),
                Curve("without grad u^T", ends, np.full(2, angular_velocity_without_transpose(*scaled)), reference=True),
                Curve("measured", strain, -table["angular_velocity"] / rate),
            ),
        ),
        Chart("Height of the disc", "G t", "y / H", (Curve("measured", strain, table["position_y"] / width),)),
    ]


MEASURES = Measures(observables=by_name(spin), charts=curves)
