"""Mass and momentum of a run as equalities of integers, of codes with the capability `exact-ledger`.

Their series.csv has the columns momentum_defect_x, ..., total momentum less that of the start and the impulse from outside,
whole numbers, and fluid_particles, the number of PPs.
"""

from verification.protocol.run import Run
from verification.protocol.series import Table


def axes_of(table: Table, name: str) -> list[str]:
    return [name + "_" + axis for axis in "xyz" if name + "_" + axis in table]


def defect_line(name: str, by_step: dict[int, int]) -> str:
    wrong = [step for step, value in by_step.items() if value]
    if not wrong:
        return f"{name}: 0 at all {len(by_step)} samples"
    return f"{name}: {by_step[wrong[0]]} at step {wrong[0]}, wrong at {len(wrong)} of {len(by_step)} samples"


def totals(run: Run) -> tuple[dict[int, int], dict[int, int]]:
    """(largest |total momentum - start - impulse from outside|, |change of the number of PPs|), by sampled step."""
    series = run.series
    steps = [int(step) for step in series["step"]]
    columns = [[int(total) for total in series[name]] for name in axes_of(series, "momentum_defect")]
    count = series["fluid_particles"]
    momentum = {step: max(map(abs, row)) for step, row in zip(steps, zip(*columns, strict=True), strict=True)}
    return momentum, {step: abs(int(n) - int(count[0])) for step, n in zip(steps, count, strict=True)}


def defects_of(run: Run) -> tuple[int, tuple[str, ...]]:
    """(samples, a line for each equality that does not hold)."""
    momentum, particles = totals(run)
    equalities = (("momentum - start - impulse", momentum), ("change of the number of PPs", particles))
    return len(momentum), tuple(defect_line(name, by_step) for name, by_step in equalities if any(by_step.values()))
