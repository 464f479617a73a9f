"""The budget of angular momentum."""

import numpy as np

from verification.measures.curve import Chart, Curve
from verification.measures.measures import Measures, by_name
from verification.protocol.quantity import Measured
from verification.protocol.run import Run
from verification.protocol.series import read_table


def angular_momentum(run: Run) -> Measured:
    """Of disc and fluid together, about the middle of the box: at the end, relative to the start."""
    total = run.series["angular_momentum"]
    return Measured(float(total[-1] / total[0]), 0.0)


def _of_the_disc(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """(time, I omega) of the disc, I = M R^2 / 2."""
    table, (body,) = read_table(run.folder / "solids.csv"), run.scene["body"]
    inertia = 0.5 * np.pi * body["radius"] ** 4 * body["density"]
    return table["time"], inertia * table["angular_velocity"]


def curves(run: Run) -> list[Chart]:
    series = run.series
    start, (time, disc) = series["angular_momentum"][0], _of_the_disc(run)
    total = np.interp(time, series["time"], series["angular_momentum"])
    return [
        Chart("Angular momentum", "time", "L / L(0)", (
            Curve("conserved", time, np.ones_like(time), reference=True),
            Curve("disc and fluid", time, total / start),
            Curve("disc", time, disc / start),
            Curve("fluid", time, (total - disc) / start),
        )),
    ]


MEASURES = Measures(observables=by_name(angular_momentum), charts=curves)
