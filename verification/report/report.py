"""The report: one self-contained HTML page and a Markdown summary. Every figure in it comes from the runs made for it, or
names the command, date and checksum of the stored one.
"""

import json
import shutil
import time
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

from verification.codes.mappm import Options
from verification.protocol.machine import ROOT, cores
from verification.protocol.run import Run
from verification.report.chapters import chapters_of, families_of, rows_of
from verification.report.figures import CaseFigures, case_figures, family_figures, shown_figures, stored_figures, suite_figures
from verification.report.history import changes, errors_of, read_history
from verification.report.page import write_page, write_summary
from verification.report.provenance import checksum, provenance, reference_checksums
from verification.report.speed_charts import CHARTS
from verification.report.stored import FULL, PUBLISHED, finite
from verification.suite.case import Case
from verification.suite.judge import CORRECT, SKIPPED
from verification.suite.manifest import all_cases, find_case
from verification.suite.progress import Progress
from verification.suite.references import run_all_live
from verification.suite.result import CaseResult, judged, run_bits
from verification.suite.runner import Job, jobs_of, run_jobs

SHOWN = "gas_solid_small"
STEPS = {"quick": 4_000, "full": 30_000}  # of the long run
# Made by commands of their own.
STORED = {"full": FULL.name, "mutation": "mutation.json", "robustness": "robustness.json"} | {name: f"{name}.json" for name in CHARTS}


def _cases(tier: str) -> list[Case]:
    return [case for case in all_cases() if case.judged and (tier == "full" or case.tier == "quick")]


def _run_all(progress: Progress, cases: list[Case], tier: str, folder: Path) -> dict:
    jobs = [job for case in cases for job in jobs_of(case, tier)]
    with progress.stage(f"{len(jobs)} runs of {len(cases)} cases") as say:
        started, ended = time.monotonic(), 0

        def done(job: Job, share: float) -> None:
            nonlocal ended
            ended += 1
            left = (time.monotonic() - started) * (1 - share) / share
            say(f"{ended} of {len(jobs)} runs, last {job.case.name}", left)

        return run_jobs(jobs, folder, Options(), cores(), done)


def _judge_all(progress: Progress, cases: list[Case], tier: str, folder: Path) -> list[CaseResult]:
    """Failures first."""
    found = _run_all(progress, cases, tier, folder)
    runs = {case.name: {key: run for (name, key), run in found.items() if name == case.name} for case in cases}
    with progress.stage("reference codes") as say:
        live = run_all_live(cases, tier, runs, folder, say)
    results = []
    for case in cases:
        bits = None
        if case.equivalence is not None:
            with progress.stage(f"bits of {case.name}") as say:
                bits = run_bits(case, folder, say)
        results.append(judged(case, tier, runs[case.name], bits, live.get(case.name)))
    return sorted(results, key=lambda result: result.holds)


def _ledger(run: Run) -> list[dict]:
    """Per axis: momentum at the start, impulse from outside, momentum at the end, and what does not add up."""
    momentum = run.record["momentum"]
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


def _results_json(tier: str, origin: dict[str, str], results: list[CaseResult]) -> dict:
    errors = {key: {name: finite(value) for name, value in row.items()} for key, row in errors_of(results).items()}
    return {"date": origin["date"], "commit": origin["commit"], "tier": tier, "errors": errors}


def _publish(out: Path, figures: list[Path], entry: dict) -> None:
    """Copies page, summary and its pictures to reports/published and adds an entry to the history there."""
    PUBLISHED.mkdir(parents=True, exist_ok=True)
    for file in (out / "index.html", out / "summary.md", *figures):
        shutil.copy(file, PUBLISHED / file.name)
    history = [*read_history(PUBLISHED / "history.json"), entry]
    (PUBLISHED / "history.json").write_text(json.dumps(history, indent=1) + "\n")


def write_report(tier: str, out: Path, publish: bool) -> int:
    """Runs all that the tier asks for, writes out/index.html, out/summary.md and out/results.json. Returns 0 where everything
    holds."""
    started = time.monotonic()
    shutil.rmtree(out, ignore_errors=True)
    runs = out / "runs"
    runs.mkdir(parents=True)
    cases = _cases(tier)
    progress = Progress(stages=5 + sum(case.equivalence is not None for case in cases))
    results = _judge_all(progress, cases, tier, runs)
    shown = progress.run(find_case(SHOWN).file, runs / SHOWN / "shown", Options(ranks=2, steps=STEPS[tier]), STEPS[tier],
                         f"{SHOWN}, P=2")
    origin = provenance(shown)
    entry = _results_json(tier, origin, results)
    history = read_history(PUBLISHED / "history.json")
    with progress.stage("pictures") as say:
        figures: dict[str, CaseFigures] = {}
        for result in results:
            say(result.case.name)
            figures[result.case.name] = case_figures(result, out)
        families = [replace(family, charts=family_figures(list(family.results), out)) for family in families_of(results)]
        chapters = chapters_of(results, figures, families)
        rows = rows_of(families)
        suite = suite_figures([(row.name, row.outcome) for row in rows], [*history, entry], out)
        shown_pictures = shown_figures(shown, out)
        stored = _stored()
        full_charts = stored_figures(stored["full"]["data"], out) if "full" in stored else []
        speed_charts = {name: out / f"{name}.svg" for name in CHARTS if name in stored}
        for name, file in speed_charts.items():
            CHARTS[name](stored[name]["data"]["figures"], file)
    with progress.stage("page"):
        origin |= {chapter.code: chapter.version for chapter in chapters}
        content = {
            "tier": tier, "results": results, "figures": figures, "families": families, "chapters": chapters,
            "rows": rows, "suite": suite, "shown_pictures": shown_pictures,
            "shown": SHOWN, "steps": STEPS[tier], "record": shown.record, "ledger": _ledger(shown), "stored": stored,
            "speed_charts": speed_charts,
            "full_charts": full_charts, "purposes": {case.name: case.purpose for case in all_cases()},
            "changes": changes(history, entry["errors"]), "history": history, "provenance": origin,
            "checksums": reference_checksums(), "took": str(timedelta(seconds=round(time.monotonic() - started))),
        }
        write_page(content, out / "index.html")
        write_summary(content, out / "summary.md")
        (out / "results.json").write_text(json.dumps(entry, indent=1) + "\n")
    if publish:
        _publish(out, [suite["overview"].with_suffix(".png"), shown_pictures["field"]], entry)
    holds = all(result.holds for result in results) and not any(row["defect"] for row in content["ledger"])
    for result in results:
        print("\n".join(f"{result.case.name}: {line}" for line in result.lines))
    verdicts = [outcome.verdict for result in results for outcome in result.outcomes]
    skipped = f", {verdicts.count(SKIPPED)} SKIPPED" if SKIPPED in verdicts else ""
    print(f"{verdicts.count(CORRECT)} of {len(verdicts)} observables CORRECT{skipped}; took {content['took']}")
    that_ran = " that was run" if skipped else ""
    print(f"report: {out / 'index.html'}: {f'everything{that_ran} holds' if holds else 'SOMETHING DOES NOT HOLD'}")
    return 0 if holds else 1
