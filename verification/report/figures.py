"""Which pictures a report has, and where they lie."""

from dataclasses import dataclass
from pathlib import Path

from verification.measures.curve import Chart, chart_of
from verification.measures.measures import measures_in
from verification.protocol.run import Run
from verification.report import charts, suite_charts
from verification.report.pictures import velocity_field
from verification.report.side_by_side import compare_fields
from verification.store.laboratory import Laboratory
from verification.suite.judge import SKIPPED, Outcome
from verification.suite.result import CaseResult


@dataclass(frozen=True)
class CaseFigures:
    field: Path | None
    charts: tuple[Path, ...]
    beside: Path | None = None  # the same field from this code and the reference code


def _drawn(found: list[Chart], name: str, out: Path) -> list[Path]:
    files = [out / f"{name}{k}.svg" for k in range(len(found))]
    for chart, file in zip(found, files, strict=True):
        charts.draw(chart, file)
    return files


def _fields(laboratory: Laboratory, result: CaseResult, out: Path) -> tuple[Path | None, Path | None]:
    """(the field of the finest run, that of both codes), one of them at most, where the laboratory kept it."""
    case, live, finest = result.case, result.live, result.finest
    if laboratory.store.run(finest.stored.key) is None:
        return None, None  # published elsewhere, without fields
    with laboratory.kept(finest.stored.key) as run:
        if not run.snapshots() or not case.scene["fluid"].get("particles", True):
            return None, None
        if live is not None and live.key and laboratory.store.run(live.key) is not None:
            with laboratory.kept(live.key) as other:
                if other.snapshots():
                    beside = out / f"{case.name}_beside.png"
                    compare_fields(run, other, live.code, f"{case.name}, {live.code} {live.version}", beside)
                    return None, beside
        field = out / f"{case.name}_field.png"
        velocity_field(run, field)
        return field, None


def case_figures(laboratory: Laboratory, result: CaseResult, out: Path) -> CaseFigures:
    case = result.case
    if not result.outcomes:
        return CaseFigures(None, ())
    field, beside = _fields(laboratory, result, out)
    drawn = _drawn([chart_of(kept) for kept in result.charts], f"{case.name}_curve", out)
    leveled = {outcome.observable.name: outcome for outcome in reversed(result.outcomes) if len(outcome.levels) > 1}
    for k, outcome in enumerate(leveled.values()):  # once where there are two references for one measure
        if outcome.verdict != SKIPPED:
            drawn.append(out / f"{case.name}_levels{k}.svg")
            charts.convergence(outcome, case.refined, drawn[-1])
    judged = [outcome for outcome in result.outcomes if outcome.verdict != SKIPPED and outcome.observable.goal > 0]
    if any(len(outcome.sources) > 1 for outcome in judged):
        drawn.append(out / f"{case.name}_sources.svg")
        charts.uncertainty_split(result, drawn[-1])
    return CaseFigures(field, tuple(drawn), beside)


def family_figures(results: list[CaseResult], out: Path) -> tuple[Path, ...]:
    """What measure.py draws of several points together."""
    draw = measures_in(results[0].case.file.parent).charts_of_family
    points = [result.point for result in results if result.outcomes]
    return tuple(_drawn(draw(points) if draw and len(points) > 1 else [], f"{results[0].case.family}_family", out))


def suite_figures(rows: list[tuple[str, Outcome]], history: list[dict], out: Path) -> dict[str, Path]:
    """The overview (also as PNG, for the summary) of (name, outcome), and the trend where there is an earlier report."""
    found = {"overview": out / "overview.svg"}
    suite_charts.overview(rows, found["overview"])
    suite_charts.overview(rows, out / "overview.png")
    if len(history) > 1:
        found["trend"] = out / "trend.svg"
        suite_charts.trend(history, list(history[-1]["errors"]), found["trend"])
    return found


def shown_figures(run: Run, out: Path) -> dict[str, Path]:
    found = {name: out / file for name, file in (("field", "field.png"), ("slip_drag", "slip_drag.svg"),
                                                 ("energy", "energy.svg"))}
    velocity_field(run, found["field"])
    charts.slip_and_drag(run, found["slip_drag"])
    charts.energy_budget(run, found["energy"])
    return found
