"""A small page of made-up results, with every part that the templates know; for tests of the page."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

from verification.bits.conservation import Conservation
from verification.bits.equivalence import Matrix, Row
from verification.measures.curve import Chart, Curve
from verification.protocol.quantity import Measured
from verification.report import charts
from verification.report.chapters import chapters_of, families_of, rows_of
from verification.report.figure import Figure, curves_caption, curves_csv, levels_caption, levels_csv
from verification.report.figures import CaseFigures, suite_figures
from verification.report.front import classes_of, front_figures
from verification.report.headline import changes_of_standards, headline
from verification.report.history import changes, errors_of
from verification.report.map_chart import Map
from verification.report.matrix import matrix_of
from verification.report.precision_chart import Precision
from verification.report.reference_codes import reference_codes
from verification.report.report import PUBLISHED, _stored
from verification.report.speed_charts import CHARTS
from verification.store.figures import read_benches
from verification.store.store import Made
from verification.studies.classes import ABOUT, RIGHT, WRONG
from verification.studies.precision import Front
from verification.suite.case import Case, Observable
from verification.suite.judge import Outcome
from verification.suite.ladder import converge
from verification.suite.manifest import all_cases
from verification.suite.references import Reference
from verification.suite.result import Bits, CaseResult, Exactness

MADE = Made("2026-01-02T03:04:05Z", "a machine, 2 cores", "abcdef0", "mappm run case.toml --some-long-option of_the_command_line")
SHOWN = ("rest", "crossing_2d", "shear_wave", "shear_wave_k2", "cavity", "cylinder_stokes", "falling_disc", "ten_cate")
OFF = 1e-3  # relative, of the finest level
WORST = "cavity"  # whose first observable fails
H = (0.125, 0.0625, 0.03125)


def _outcome(observable: Observable, off: float) -> Outcome:
    """Of second order over three levels; `off` on the finest."""
    held = observable.reference if observable.reference == observable.reference else 12.5
    observable = replace(observable, reference=held, uncertainty=1e-4, source=observable.source or "Some Code 1.2, drag: a note")
    values = [held + (abs(held) or 1.0) * off * (h / H[-1]) ** 2 for h in H]
    found = converge(H, values, held, False)
    return Outcome(observable, Measured(values[-1], 0.0), {"resolution": abs(off * held), "step": 1e-5}, {}, H,
                   tuple(Measured(value, 0.0) for value in values), {"disorder": (held, held * 1.001, held * 0.999)}, found)


def _bits(case: Case) -> Bits | None:
    if case.equivalence is None:
        return None
    rows = tuple(Row(variant.label, "0123456789abcdef", samples=21) for variant in case.equivalence.variants)
    return Bits(Matrix(rows), Conservation({0: 0}, {0: 0}, {0: 0}, {0: 0}, 4, 12345), MADE)


class _Result(CaseResult):
    """Without runs."""

    made = MADE


def made_up(case: Case) -> CaseResult:
    offs = [min(OFF, 0.5 * one.goal) for one in case.observables]
    if case.name == WORST:
        offs[0] = 10 * case.observables[0].goal
    outcomes = tuple(map(_outcome, case.observables, offs))
    live = Reference("Some Code", "1.2", "some-code run with a command", "0" * 64, objection="") if case.live else None
    beside = tuple((one.label, outcomes[0]) for one in case.beside) if outcomes else ()
    return _Result(case, None, "full", {}, outcomes, beside, Exactness(3, 60, ()), _bits(case), live)


def _figures(result: CaseResult, out: Path) -> CaseFigures:
    if not result.outcomes:
        return CaseFigures()
    name, first = result.case.name, result.outcomes[0]
    chart = Chart("speed", "time", "u / U", (Curve("measured", [0.0, 1.0, 2.0], [1.0, 0.6, 0.3]),
                                             Curve("exact", [0.0, 1.0, 2.0], [1.0, 0.61, 0.31], reference=True)))
    files = (out / f"{name}_curve0.svg", out / f"{name}_levels0.svg")
    charts.draw(chart, files[0])
    charts.convergence(first, "spacing", files[1])
    curves = Figure(files[0], curves_caption(name, chart), curves_csv(chart), "python3 -m verification run")
    levels = Figure(files[1], levels_caption(name, first, "spacing"), levels_csv(first, "spacing"))
    return CaseFigures(None, (curves,), None, (levels,))


def _shown(figure: Figure) -> dict:
    record = {"commit": "abcdef0", "steps": 4000, "solids": 32, "particles": 100_000, "ranks": 2,
              "particle_steps_per_second": 1.2e6, "momentum": {"iota": 1e-12}, "terms": ["viscosity", "pressure"],
              "wall_seconds": {"pairs": 1.0}, "warnings": ["one"]}
    ledger = {"axis": "x", "start": "-12345678901234567890", "impulse": "12345678901234567890", "end": "0", "defect": 0}
    return {"record": record, "shown": "gas_solid_small", "steps": 4000, "shown_made": MADE,
            "shown_pictures": {name: figure for name in ("field", "slip_drag", "energy")},
            "ledger": [ledger]}


def content(out: Path) -> dict:
    """All that draw_report hands to the templates."""
    cases = [case for case in all_cases() if case.family in SHOWN]
    results = sorted((made_up(case) for case in cases), key=lambda result: result.holds)
    families = families_of(results)
    chapters = chapters_of(families)
    figures = {result.case.name: _figures(result, out) for result in results}
    entry = {"date": "2026-01-02 03:04 UTC", "commit": "abcdef0", "tier": "full", "errors": errors_of(results)}
    earlier = entry | {"errors": {key: row | {"value": 2 * row["value"]} for key, row in list(entry["errors"].items())[:-2]}}
    benches = {name: found for name, found in read_benches(PUBLISHED / "bench.jsonl").items() if name in CHARTS}
    speed_charts = {name: out / f"{name}.svg" for name in benches}
    for name, file in speed_charts.items():
        CHARTS[name](benches[name], file)
    unrun = next(case for case in all_cases() if case.family not in SHOWN)
    rows, classes = rows_of(families), classes_of(chapters)
    why = "Other lacks walls, free-body and many words more"
    cells = [SimpleNamespace(code="MaPPM", outcome=results[0].outcomes[0], core_seconds=1.5, why=""),
             SimpleNamespace(code="Other", outcome=None, core_seconds=0.0, why=why)]
    figure = next(figures[name].charts[0] for name in figures if figures[name].charts)
    front = Front("mappm", "MaPPM", 0.5, 2e-3, -0.6, 46.4, ((0.02, 0.1, 0.01, "mappm run cases/a/case.toml"), (2e-3, 4.0, 0.01, "mappm run b.toml")))
    without = Front("other", "Other", None, 0.05, None, None, ((0.05, 3.0, 0.0, "python3 -m verification run a --code other"),))
    return _shown(figure) | {
        "precision": [Precision("a.precision", "What it costs.", 5, 6, figure, (front, without))],
        "maps": [Map("a.map", "Where it fails.", figure, ((RIGHT, 3, ABOUT[RIGHT]), (WRONG, 1, ABOUT[WRONG])), (("+9.0 %", "mappm run c.toml"),))],
        "tier": "full", "results": results, "figures": figures, "families": families, "chapters": chapters,
        "codes": reference_codes(results), "rows": rows, "classes": classes, "front": front_figures(classes, out),
        "suite": suite_figures([(row.name, row.outcome) for row in rows], [earlier, entry], out),
        "matrix": matrix_of(all_cases()), "stored": _stored(), "benches": benches, "speed_charts": speed_charts,
        "absent": ["sphere_stokes.phi_0.125"],
        "headline": headline(results, ["sphere_stokes.phi_0.125"], 1), "standards": changes_of_standards(all_cases()),
        "stale": [SimpleNamespace(numerics=1, result=results[0])],
        "table": [SimpleNamespace(case=case, cells=cells) for case in (results[0].case, unrun)],
        "changes": changes([earlier], entry["errors"]), "history": [earlier],
        "provenance": {"date": entry["date"], "commit": "abcdef0", "host": "a-host-with-a-long-name.of.some.domain.example.org"},
        "checksums": {"reference/published/table.csv": "0123456789abcdef" * 4}, "took": "0:00:01",
    }
