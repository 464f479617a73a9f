"""The report: one self-contained HTML page and a Markdown summary, drawn from what the store holds. It runs nothing, and says of
every figure when, where and from which sources it was made."""

import csv
import json
import math
import shutil
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import timedelta
from pathlib import Path

from verification.protocol.errors import StoreError
from verification.protocol.machine import ROOT
from verification.report.chapters import chapters_of, families_of, rows_of
from verification.report.figures import CaseFigures, case_figures, family_figures, shown_figures, suite_figures
from verification.report.front import classes_of, front_figures
from verification.report.headline import Headline, changes_of_standards, headline
from verification.report.history import changes, errors_of, read_history
from verification.report.map_chart import Map, maps
from verification.report.matrix import matrix_of
from verification.report.page import write_page, write_summary
from verification.report.precision_chart import Precision, precision_charts
from verification.report.provenance import checksum, provenance, reference_checksums
from verification.report.reference_codes import reference_codes
from verification.report.speed_charts import CHARTS
from verification.store.export import export, import_into
from verification.store.figures import Figures, benches_of
from verification.store.laboratory import Laboratory
from verification.store.store import Store, StoredRun
from verification.suite.judge import SKIPPED
from verification.suite.manifest import all_cases
from verification.suite.result import CaseResult, collect
from verification.suite.stale import Stale, stale_of
from verification.suite.table import table
from verification.suite.tier import SHOWN, SHOWN_RANKS, SHOWN_STEPS, cases_of, shown_request, subject

PUBLISHED = ROOT / "reports" / "published"
STORE = PUBLISHED / "store.jsonl"
SHOWN_COMMAND = f"mpirun -np {SHOWN_RANKS} mappm run cases/{SHOWN}/case.toml --steps {{steps}}"
STORED = {"mutation": "mutation.json", "robustness": "robustness.json"}  # made by commands of their own


@dataclass(frozen=True)
class Published:
    """What was published, as a store that nothing is entered into."""

    store: Store


def published() -> Published:
    store = Store(":memory:")
    for file in (STORE, PUBLISHED / "bench.jsonl"):
        if file.exists():
            import_into(store, file)
    return Published(store)


def _agrees(laboratory: Laboratory, published: CaseResult) -> bool:
    """Whether the runs that this laboratory has as well gave the same digests here."""
    pairs = [(entry.stored, laboratory.store.run(entry.stored.key)) for entry in published.entries.values()]
    return all(here is None or here.record.get("digest") == there.record.get("digest") for there, here in pairs)


def _result(laboratory: Laboratory, shelf: Published, case) -> CaseResult | None:
    """At the finest tier that is whole: of this laboratory, or, of the full tier alone, as published. What was published counts
    only where nothing here speaks against it: a quick tier that fails, or another digest of one of its runs."""
    code = subject()
    if (full := collect(laboratory, case, "full", code)) is not None:
        return full
    quick = collect(laboratory, case, "quick", code) if case.tier == "quick" else None
    if quick is not None and not quick.passes:
        return quick
    published = collect(shelf, case, "full", code)
    return published if published is not None and _agrees(laboratory, published) else quick


def results_of(laboratory: Laboratory, shelf: Published) -> tuple[list[CaseResult], list[str]]:
    """(what there is, failures first; names of the cases that were not run)."""
    found, absent = [], []
    for case in cases_of("full"):
        result = _result(laboratory, shelf, case)
        if result is None:
            absent.append(case.name)
        else:
            found.append(result)
    return sorted(found, key=lambda result: result.holds), absent


def _shown(laboratory: Laboratory) -> tuple[StoredRun, int]:
    """The long run, and its steps: of the full tier where that is there."""
    for tier in ("full", "quick"):
        request = shown_request(tier)
        if (stored := laboratory.store.run(request.key)) is not None and laboratory.store.has_files(request.key):
            return stored, SHOWN_STEPS[tier]
    raise StoreError(f"{laboratory.store.file}: has no long run of {SHOWN}; leave out --only-draw")


def _ledger(record: dict) -> list[dict]:
    """Per axis: momentum at the start, impulse from outside, momentum at the end, and what does not add up."""
    momentum = record["momentum"]
    rows = zip("xyz", momentum["start"], momentum["impulse"], momentum["end"], strict=False)
    return [
        {"axis": axis, "start": start, "impulse": impulse, "end": end, "defect": int(end) - int(start) - int(impulse)}
        for axis, start, impulse, end in rows
    ]


def _stored() -> dict[str, dict]:
    """Tables that other commands made: their content, file and checksum."""
    found = {}
    for name, file in STORED.items():
        path = PUBLISHED / file
        if path.exists():
            found[name] = {"data": json.loads(path.read_text()), "file": str(path.relative_to(ROOT)), "sha256": checksum(path)}
    return found


def _finite(value):
    """NaN and infinity have no JSON."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _results_json(tier: str, origin: dict[str, str], results: list[CaseResult]) -> dict:
    errors = {key: {name: _finite(value) for name, value in row.items()} for key, row in errors_of(results).items()}
    return {"date": origin["date"], "commit": origin["commit"], "tier": tier, "errors": errors}


def _with_published(laboratory: Laboratory) -> Store:
    """What the laboratory holds, and what was published and it lacks, but for runs of other numerics versions."""
    whole = Store(":memory:")
    whole.enter_rows(laboratory.store.tables())
    held = {run.key for run in whole.runs()}
    if STORE.exists():
        import_into(whole, STORE)
    now = subject()
    whole.remove([run.key for run in whole.runs(now.name) if run.key not in held and run.numerics != now.numerics_version])
    return whole


def _publish(laboratory: Laboratory, page: Path, figures: list[Path], drawn: Mapping[str, Sequence[Precision | Map]], entry: dict) -> None:
    """Copies page, summary and its pictures to reports/published, what was drawn of studies to folders there, with the store as text,
    and adds an entry to the history."""
    PUBLISHED.mkdir(parents=True, exist_ok=True)
    for file in (page / "index.html", page / "summary.md", *figures):
        shutil.copy(file, PUBLISHED / file.name)
    for folder, members in drawn.items():
        (PUBLISHED / folder).mkdir(exist_ok=True)
        for one in members:
            before = PUBLISHED / folder / one.figure.file.with_suffix(".csv").name
            if before.exists() and _rows_with_values(before) > _rows_with_values(one.figure.file.with_suffix(".csv")):
                continue  # a code that is not installed here, or a reference that was not run
            for file in (one.figure.file, one.figure.file.with_suffix(".csv")):
                shutil.copy(file, PUBLISHED / folder / file.name)
    export(_with_published(laboratory), STORE)
    history = [*read_history(PUBLISHED / "history.json"), entry]
    (PUBLISHED / "history.json").write_text(json.dumps(history, indent=1) + "\n")


def _rows_with_values(file: Path) -> int:
    """Of the CSV of a study: rows with an error."""
    with file.open() as text:
        return sum(row.get("error", "nan") not in ("nan", "") for row in csv.DictReader(text))


def _benches(laboratory: Laboratory, shelf: Published) -> dict[str, Figures]:
    """Of each benchmark that has a chart: its figures in this laboratory, or as published."""
    found = benches_of(shelf.store) | benches_of(laboratory.store)
    return {name: found[name] for name in CHARTS if name in found}


def draw_report(laboratory: Laboratory, tier: str, page: Path, publish: bool) -> int:
    """Writes index.html, summary.md and results.json into the folder `page`. Returns 0 where everything holds."""
    started = time.monotonic()
    shutil.rmtree(page, ignore_errors=True)
    page.mkdir(parents=True)
    shelf = published()
    results, absent = results_of(laboratory, shelf)
    # By what the tier itself has run; what is shown may be finer levels, as published.
    by_name, code = {result.case.name: result for result in results}, subject()
    asked = [found for case in cases_of(tier) if (found := collect(laboratory, case, tier, code) or by_name.get(case.name))]
    shown, steps = _shown(laboratory)
    stale: list[Stale] = stale_of(laboratory, absent)
    origin = provenance(shown.record)
    entry = _results_json(tier, origin, results)
    history = read_history(PUBLISHED / "history.json")
    families = [replace(family, charts=family_figures(list(family.results), page)) for family in families_of(results)]
    drawn = {name for family in families for name in family.drawn}
    figures = {result.case.name: case_figures(laboratory, result, page) if result.case.name in drawn else CaseFigures()
               for result in results}
    chapters, codes = chapters_of(families), reference_codes(results)
    rows = rows_of([family for chapter in chapters for family in chapter.families])
    classes = classes_of(chapters)
    suite = suite_figures([(row.name, row.outcome) for row in rows], [*history, entry], page)
    with laboratory.kept(shown.key) as run:
        shown_pictures = shown_figures(run, SHOWN_COMMAND.format(steps=steps), page)
    stored, benches = _stored(), _benches(laboratory, shelf)
    whole = Published(_with_published(laboratory))
    precision, stability = precision_charts(whole, page), maps(whole, page)
    speed_charts = {name: page / f"{name}.svg" for name in benches}
    for name, file in speed_charts.items():
        CHARTS[name](benches[name], file)
    origin |= {code.code: code.version for code in codes}
    content = {
        "tier": tier, "asked": asked, "results": results, "figures": figures, "families": families, "chapters": chapters, "codes": codes,
        "rows": rows, "suite": suite, "classes": classes, "front": front_figures(classes, page),
        "matrix": matrix_of(all_cases()), "shown_pictures": shown_pictures, "shown": SHOWN, "steps": steps,
        "record": shown.record, "shown_made": shown.made,
        "ledger": _ledger(shown.record), "stored": stored, "benches": benches, "precision": precision, "maps": stability,
        "speed_charts": speed_charts, "absent": absent,
        "headline": headline(results, absent, len(stale)), "standards": changes_of_standards(cases_of("full")),
        "stale": stale, "table": table(laboratory), "changes": changes(history, entry["errors"]), "history": history,
        "provenance": origin, "checksums": reference_checksums(),
        "took": str(timedelta(seconds=round(time.monotonic() - started))),
    }
    write_page(content, page / "index.html")
    write_summary(content, page / "summary.md")
    (page / "results.json").write_text(json.dumps(entry, indent=1) + "\n")
    if publish:
        _publish(laboratory, page, [suite["overview"].file.with_suffix(".png"), shown_pictures["field"].file], {"charts": precision, "maps": stability}, entry)
    return _tell(content, page)


def _tell(content: dict, page: Path) -> int:
    """Returns 0 where the tier is whole and all of it holds but for misses that are explained. What is shown of the full tier beside a
    quick one, as published, is told and does not count."""
    results, tier, asked = content["results"], content["tier"], content["asked"]
    gone = [case.name for case in cases_of(tier) if case.name in content["absent"]]
    if gone:
        print(f"report: no result of {', '.join(gone)}, of the {tier} tier: a reference code failed, or it was not run")
    passes = not gone and all(result.passes for result in asked) and not any(row["defect"] for row in content["ledger"])
    for result in results:
        print("\n".join(f"{result.case.name}: {line}" for line in result.lines))
    counts: Headline = content["headline"]
    print(f"{counts.text}; drawn in {content['took']}")
    that_ran = " that was run" if counts.verdicts[SKIPPED] or content["absent"] else ""
    explained = sum(len(result.explained) for result in asked)
    but = f" but {explained}, explained" if explained else ""
    wrong = len({result.case.name for result in results if not result.passes} - {result.case.name for result in asked if not result.passes})
    others = f"; {wrong} cases of the full tier, as published, do not" if wrong else ""
    of_tier = f"everything of the {tier} tier{that_ran} holds{but}{others}"
    print(f"report: {page / 'index.html'}: {of_tier if passes else 'SOMETHING DOES NOT HOLD'}")
    return 0 if passes else 1
