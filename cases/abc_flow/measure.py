"""What a decaying flow has to show."""

from verification.curve import Chart
from verification.flows import decay_chart
from verification.solver import Run


def curves(run: Run) -> list[Chart]:
    return [decay_chart(run)]
