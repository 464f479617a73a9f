"""A sphere that falls in a tank: its largest velocity, and its fall."""

import numpy as np

from reference.published import look_up, ten_cate
from verification.measures.curve import Chart, Curve
from verification.measures.measures import Measures, by_name
from verification.protocol.quantity import Measured
from verification.protocol.run import Run
from verification.protocol.series import read_table

DIAMETER = 0.015


def _fall(run: Run) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(time, velocity downwards, gap between sphere and bottom), SI."""
    table = read_table(run.folder / "solids.csv")
    return table["time"], -table["velocity_z"], table["position_z"] - DIAMETER / 2


def u_max(run: Run) -> Measured:
    """Largest of the mean over 3 % of the run; uncertainty, the scatter about it."""
    _, velocity, _ = _fall(run)
    width = max(3, len(velocity) // 33)
    means = np.convolve(velocity, np.full(width, 1 / width), "valid")
    first = int(np.argmax(means))
    scatter = float(np.std(velocity[first : first + width]))
    objection = "still faster at the end; run longer" if first + width >= len(velocity) - 1 else ""
    return Measured(float(means[first]), scatter, objection)


def time_of_fall(run: Run) -> Measured:
    """Uncertainty: by how much it changes where the ends are found from half of the samples."""
    time, _, gap = _fall(run)
    if gap[-1] > (ten_cate.END - ten_cate.WIDTH) * DIAMETER:
        return Measured(float(time[-1]), 0.0, f"it ends {gap[-1] / DIAMETER:.2g} diameters above the bottom; run longer")
    value, half = (ten_cate.time_of_fall(time[::every], gap[::every] / DIAMETER) for every in (1, 2))
    return Measured(value, abs(value - half))


def curves(run: Run) -> list[Chart]:
    time, velocity, gap = _fall(run)
    measured = look_up("ten_cate_u_max", run.scene).value
    level = Curve("largest velocity measured", time, np.full_like(time, measured), reference=True)
    heights = [Curve("MaPPM", time, gap / DIAMETER)]
    try:
        read_time, read_gap, _ = ten_cate.gap_of(run.scene)
        heights.insert(0, Curve("measured, read off", read_time, read_gap, reference=True))
    except ValueError:
        pass  # of this experiment there is no reading
    return [Chart("Fall of the sphere", "time (s)", "velocity (m/s)", (level, Curve("MaPPM", time, velocity))),
            Chart("Gap below the sphere", "time (s)", "gap / diameter", tuple(heights))]


MEASURES = Measures(observables=by_name(u_max, time_of_fall), charts=curves)
