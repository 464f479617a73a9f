"""Which pictures a report has, and where they lie."""

from dataclasses import dataclass
from pathlib import Path

from verification import charts
from verification.judge import curves_of
from verification.pictures import velocity_field
from verification.result import CaseResult
from verification.solver import Run


@dataclass(frozen=True)
class CaseFigures:
    field: Path | None
    charts: tuple[Path, ...]


def case_figures(result: CaseResult, out: Path) -> CaseFigures:
    case = result.case
    if not result.outcomes:
        return CaseFigures(None, ())
    finest, drawn, field = result.finest, [], None
    if finest.snapshots() and finest.record["particles"] and case.scene["fluid"].get("particles", True):
        field = out / f"{case.name}_field.png"
        velocity_field(finest, field)
    for k, chart in enumerate(curves_of(case, finest)):
        drawn.append(out / f"{case.name}_curve{k}.svg")
        charts.draw(chart, drawn[-1])
    for k, outcome in enumerate(result.outcomes):
        if len(outcome.levels) > 1:
            drawn.append(out / f"{case.name}_levels{k}.svg")
            charts.convergence(outcome, case.refined, drawn[-1])
    if any(len(outcome.sources) > 1 and outcome.observable.goal > 0 for outcome in result.outcomes):
        drawn.append(out / f"{case.name}_sources.svg")
        charts.uncertainty_split(result, drawn[-1])
    return CaseFigures(field, tuple(drawn))


def suite_figures(results: list[CaseResult], history: list[dict], out: Path) -> dict[str, Path]:
    """The overview (also as PNG, for the summary), and the trend where there is an earlier report."""
    outcomes = [(result.case.name, outcome) for result in results for outcome in result.outcomes]
    found = {"overview": out / "overview.svg"}
    charts.overview(outcomes, found["overview"])
    charts.overview(outcomes, out / "overview.png")
    if len(history) > 1:
        found["trend"] = out / "trend.svg"
        charts.trend(history, list(history[-1]["errors"]), found["trend"])
    return found


def shown_figures(run: Run, out: Path) -> dict[str, Path]:
    found = {name: out / file for name, file in (("field", "field.png"), ("slip_drag", "slip_drag.svg"),
                                                 ("energy", "energy.svg"))}
    velocity_field(run, found["field"])
    charts.slip_and_drag(run, found["slip_drag"])
    charts.energy_budget(run, found["energy"])
    return found
