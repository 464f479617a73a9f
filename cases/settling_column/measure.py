"""A column that settles, against LIGGGHTS."""

from pathlib import Path

from verification.measures.curve import Chart
from verification.measures.impacts import centre_chart, measure
from verification.protocol.run import Run

height = measure("height")
middle = measure("middle")
fall_time = measure("fall_time")


def live_curves(run: Run, folder: Path) -> list[Chart]:
    return [centre_chart(run, folder)]
