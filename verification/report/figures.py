"""Which pictures a report has, and where they lie."""

from dataclasses import dataclass
from pathlib import Path

from verification.measures.curve import Chart
from verification.protocol.run import Run
from verification.report import charts
from verification.report.pictures import velocity_field
from verification.report.side_by_side import compare_fields
from verification.report.stored import stored_families
from verification.suite.judge import SKIPPED, Outcome, own
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


def _live_figures(result: CaseResult, out: Path) -> tuple[Path | None, list[Path]]:
    """(the field of both codes, charts of both codes) where the case has a reference code that ran."""
    case, live = result.case, result.live
    if live is None or not live.result.quantities or not result.outcomes:
        return None, []
    beside = None
    if live.result.field and result.finest.snapshots():
        beside = out / f"{case.name}_beside.png"
        compare_fields(result.finest, live, f"{case.name}, {live.result.code} {live.result.version}", beside)
    curves = own(case, "live_curves")
    return beside, _drawn(curves(result.finest, live.folder) if curves else [], f"{case.name}_live", out)


def case_figures(result: CaseResult, out: Path) -> CaseFigures:
    case = result.case
    if not result.outcomes:
        return CaseFigures(None, ())
    finest, field = result.finest, None
    beside, live_charts = _live_figures(result, out)
    if beside is None and finest.snapshots() and finest.record["particles"] and case.scene["fluid"].get("particles", True):
        field = out / f"{case.name}_field.png"
        velocity_field(finest, field)
    curves = own(case, "curves")
    drawn = _drawn(curves(finest) if curves else [], f"{case.name}_curve", out) + live_charts
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


def family_figures(results: list[CaseResult], out: Path, kind: str = "family") -> tuple[Path, ...]:
    """What measure.py draws of several points together: by family_curves, or of kind "stored" by stored_curves."""
    curves = own(results[0].case, f"{kind}_curves") if len(results) > 1 else None
    return tuple(_drawn(curves(results) if curves else [], f"{results[0].case.family}_{kind}", out))


def stored_figures(entries: dict[str, dict], out: Path) -> list[Path]:
    """Of all families in the file of stored results."""
    return [file for results in stored_families(entries) for file in family_figures(results, out, "stored")]


def suite_figures(rows: list[tuple[str, Outcome]], history: list[dict], out: Path) -> dict[str, Path]:
    """The overview (also as PNG, for the summary) of (name, outcome), and the trend where there is an earlier report."""
    found = {"overview": out / "overview.svg"}
    charts.overview(rows, found["overview"])
    charts.overview(rows, out / "overview.png")
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
