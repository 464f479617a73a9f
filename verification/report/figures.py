"""Which pictures a report has, and where they lie."""

from dataclasses import dataclass, replace
from pathlib import Path

from verification.measures.curve import Chart, chart_of
from verification.measures.measures import measures_in
from verification.protocol.run import Run
from verification.report import charts, suite_charts
from verification.report.figure import (
    ROWS,
    Figure,
    csv_of,
    curves_caption,
    curves_csv,
    levels_caption,
    levels_csv,
    run_line,
    sources_caption,
    sources_csv,
)
from verification.report.pictures import velocity_field
from verification.report.side_by_side import compare_fields
from verification.store.laboratory import Laboratory
from verification.suite.judge import SKIPPED, Outcome
from verification.suite.result import CaseResult

TOLD = 3  # reports whose numbers stand behind the trend; history.json has all


@dataclass(frozen=True)
class CaseFigures:
    field: Figure | None = None
    charts: tuple[Figure, ...] = ()
    beside: Figure | None = None  # the same field from this code and the reference code
    convergence: tuple[Figure, ...] = ()  # over levels, and by source of uncertainty

    @property
    def fields(self) -> tuple[Figure, ...]:
        return tuple(one for one in (self.beside, self.field) if one is not None)


def _drawn(found: list[Chart], name: str, stem: str, out: Path, command: str) -> list[Figure]:
    files = [out / f"{stem}{k}.svg" for k in range(len(found))]
    for chart, file in zip(found, files, strict=True):
        charts.draw(chart, file)
    return [Figure(file, curves_caption(name, chart), curves_csv(chart), command)
            for chart, file in zip(found, files, strict=True)]


def _fields(laboratory: Laboratory, result: CaseResult, out: Path) -> CaseFigures:
    """The field of the finest run, or that of both codes, where the laboratory kept it."""
    case, live, finest = result.case, result.live, result.finest
    if laboratory.store.run(finest.stored.key) is None:
        return CaseFigures()  # published elsewhere, without fields
    with laboratory.kept(finest.stored.key) as run:
        if not run.snapshots() or not case.scene["fluid"].get("particles", True):
            return CaseFigures()
        if live is not None and live.key and laboratory.store.run(live.key) is not None:
            with laboratory.kept(live.key) as other:
                if other.snapshots():
                    beside = out / f"{case.name}_beside.png"
                    compare_fields(run, other, live.code, f"{case.name}, {live.code} {live.version}", beside)
                    caption = f"{case.name}: speed of the fluid by MaPPM and by {live.code} on one scale, and their difference."
                    return CaseFigures(beside=Figure(beside, caption, command=run_line(result)))
        field = out / f"{case.name}_field.png"
        velocity_field(run, field)
        where = ", in the middle plane" if len(case.scene["box"]["size"]) == 3 else ""
        caption = f"{case.name}: speed of the fluid at the end of the finest run{where}."
        return CaseFigures(Figure(field, caption, command=run_line(result)))


def _levels(result: CaseResult, out: Path) -> list[Figure]:
    """A chart of each observable over its levels, once where there are two references for one measure."""
    name, refined, found = result.case.name, result.case.refined, []
    leveled = {outcome.observable.name: outcome for outcome in reversed(result.outcomes) if len(outcome.levels) > 1}
    for k, outcome in enumerate(leveled.values()):
        if outcome.verdict != SKIPPED:
            file = out / f"{name}_levels{k}.svg"
            charts.convergence(outcome, refined, file)
            found.append(Figure(file, levels_caption(name, outcome, refined), levels_csv(outcome, refined), run_line(result)))
    return found


def _sources(result: CaseResult, out: Path) -> list[Figure]:
    judged = [one for one in result.outcomes if one.verdict != SKIPPED and one.observable.goal > 0 and one.sources]
    if not any(len(outcome.sources) > 1 for outcome in judged):
        return []
    name, file = result.case.name, out / f"{result.case.name}_sources.svg"
    charts.uncertainty_split(result, file)
    return [Figure(file, sources_caption(name, judged), sources_csv(judged), run_line(result))]


def case_figures(laboratory: Laboratory, result: CaseResult, out: Path) -> CaseFigures:
    if not result.outcomes:
        return CaseFigures()
    name = result.case.name
    curves = _drawn([chart_of(kept) for kept in result.charts], name, f"{name}_curve", out, run_line(result))
    return replace(_fields(laboratory, result, out), charts=tuple(curves),
                   convergence=(*_levels(result, out), *_sources(result, out)))


def family_figures(results: list[CaseResult], out: Path) -> tuple[Figure, ...]:
    """What measure.py draws of several points together."""
    case = results[0].case
    draw = measures_in(case.file.parent).charts_of_family
    points = [result.point for result in results if result.outcomes]
    command = f"python3 -m verification run {case.family} --tier full"
    return tuple(_drawn(draw(points) if draw and len(points) > 1 else [], case.family, f"{case.family}_family", out, command))


def suite_figures(rows: list[tuple[str, Outcome]], history: list[dict], out: Path) -> dict[str, Figure]:
    """The overview (also as PNG, for the summary) of (name, outcome), and the trend where there is an earlier report."""
    shown = [(name, outcome) for name, outcome in rows if outcome.observable.goal > 0 and outcome.verdict != SKIPPED]
    caption = f"Error over goal of {len(shown)} rows, with k u as bars. Inside the band is within the goal."
    over_goal = [(name, one.observable.against, one.error / one.observable.goal, one.bound / one.observable.goal)
                 for name, one in shown]
    data = csv_of(("case", "observable", "error over goal", "k u over goal"), over_goal)
    overview = Figure(out / "overview.svg", caption, data)
    suite_charts.overview(rows, overview.file)
    suite_charts.overview(rows, out / "overview.png")
    found = {"overview": overview}
    if len(history) > 1:
        rows = [(entry["date"], entry["commit"], key, row["error"], row["goal"])
                for entry in history[-TOLD:] for key, row in entry["errors"].items()]
        caption = f"Error over goal of every observable in {len(history)} reports, this one last; data of the last {TOLD}."
        found["trend"] = Figure(out / "trend.png", caption, csv_of(("date", "commit", "observable", "error", "goal"), rows))
        suite_charts.trend(history, list(history[-1]["errors"]), found["trend"].file)
    return found


def _series_csv(run: Run) -> str:
    """The columns of series.csv that the charts of the long run are made of."""
    every = 1 + len(run.series["time"]) // ROWS
    names = [name for name in run.series.columns if name.startswith(("time", "slip", "drag")) or name.endswith("energy")]
    return csv_of(names, list(zip(*(map(float, run.series[name]) for name in names), strict=True))[::every])


def shown_figures(run: Run, command: str, out: Path) -> dict[str, Figure]:
    captions = {
        "field": ("field.png", "Speed of the fluid relative to its mean at the end of the run, the discs drawn over it."),
        "slip_drag": ("slip_drag.svg", "Mean slip velocity of the solids, and mean drag on one along the body force, over time."),
        "energy": ("energy.svg", "The work of the body forces goes into motion and is taken out again by viscosity, the damping "
                                 "of contacts and, in a small part, the disorder of the particles; what is dissipated is the "
                                 "work less what is held."),
    }
    data = {"slip_drag": _series_csv(run), "energy": _series_csv(run)}
    found = {name: Figure(out / file, caption, data.get(name, ""), command) for name, (file, caption) in captions.items()}
    velocity_field(run, found["field"].file)
    charts.slip_and_drag(run, found["slip_drag"].file)
    charts.energy_budget(run, found["energy"].file)
    return found
