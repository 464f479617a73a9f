"""The report: one self-contained HTML file. Every figure in it comes from the runs made for it."""

import base64
import importlib.metadata
import platform
import shutil
import subprocess
from datetime import UTC, datetime
from pathlib import Path

import jinja2

from verification.case import Beside, Case, all_cases, find_case
from verification.charts import slip_and_drag
from verification.compare import Comparison, compare_runs
from verification.judge import CORRECT, Outcome, run_and_judge
from verification.pictures import velocity_field
from verification.progress import Progress
from verification.solver import ROOT, Options, Run

SHOWN = "gas_solid_small"
STEPS = {"quick": 20_000, "full": 60_000}  # of the long run
COMPARED_STEPS, COMPARED_EVERY = 1000, 50
PACKAGES = ("numpy", "h5py", "pyvista", "vtk", "matplotlib", "Jinja2")


def _embedded(file: Path) -> str:
    return "data:image/png;base64," + base64.b64encode(file.read_bytes()).decode()


def _cores() -> str:
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return platform.processor()


def _provenance(run: Run) -> dict[str, str]:
    record = run.record
    return {
        "commit": record["commit"],
        "compiler": f"{record['compiler']}, {record['flags']}",
        "host": f"{record['host']}, {_cores()}",
        "system": platform.platform(),
        "Open MPI": subprocess.run(["mpirun", "--version"], capture_output=True, text=True).stdout.splitlines()[0],
        "Python": ", ".join(
            [platform.python_version(), *(f"{name} {importlib.metadata.version(name)}" for name in PACKAGES)]
        ),
        "date": f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC",
    }


def _ledger(run: Run) -> list[dict]:
    """Per axis: momentum at the start, impulse from outside, momentum at the end, and what does not add up."""
    momentum = run.record["momentum"]
    rows = zip("xyz", momentum["start"], momentum["impulse"], momentum["end"], strict=False)
    return [
        {"axis": axis, "start": start, "impulse": impulse, "end": end, "defect": int(end) - int(start) - int(impulse)}
        for axis, start, impulse, end in rows
    ]


def _digest_rows(comparison: Comparison) -> list[dict]:
    tables = [run.series for run in comparison.runs]
    rows = []
    for i, step in enumerate(tables[0]["step"]):
        digests = [table["digest"][i] if i < len(table) else "no row" for table in tables]
        rows.append({"step": int(step), "digests": digests, "equal": len(set(digests)) == 1})
    return rows


def _compare(progress: Progress, scene: Path, folder: Path) -> Comparison:
    overrides = (f"output.sample={COMPARED_EVERY}",)
    variants = [Options(ranks=ranks, steps=COMPARED_STEPS, overrides=overrides) for ranks in (0, 1, 2)]
    return compare_runs(
        tuple(
            progress.run(scene, folder / str(options.ranks), options, COMPARED_STEPS, f"digests, {options.label}")
            for options in variants
        )
    )


def _judged(progress: Progress, cases: list[Case], folder: Path) -> list[tuple[str, Outcome]]:
    """Outcomes by the name of their case, failures first."""
    outcomes = []
    for case in cases:
        with progress.stage(f"case {case.name}"):
            outcomes += [(case.name, outcome) for outcome in run_and_judge(case, folder / case.name)[1]]
    return sorted(outcomes, key=lambda pair: pair[1].verdict == CORRECT)


def _beside(progress: Progress, cases: list[Case], folder: Path) -> list[tuple[str, Outcome]]:
    """What the manifests ask to measure beside their case: reported as it is, without a verdict."""
    measured = []
    for case, beside in _pairs(cases):
        name = f"{case.name}, {beside.label}"
        with progress.stage(f"case {name}"):
            options = Options(overrides=beside.overrides)
            measured += [(name, outcome) for outcome in run_and_judge(case, folder / name, options)[1]]
    return measured


def _pairs(cases: list[Case]) -> list[tuple[Case, Beside]]:
    return [(case, beside) for case in cases for beside in case.beside]


def _judged_cases(tier: str) -> list[Case]:
    return [case for case in all_cases() if case.observables and (tier == "full" or case.tier == "quick")]


def write_report(tier: str, out: Path) -> int:
    """Runs all that the tier asks for and writes out/index.html. Returns 0 where everything holds."""
    scene = find_case(SHOWN).file
    shutil.rmtree(out, ignore_errors=True)
    runs = out / "runs"
    runs.mkdir(parents=True)
    cases = _judged_cases(tier)
    progress = Progress(stages=5 + len(cases) + len(_pairs(cases)))

    comparison = _compare(progress, scene, runs / "digests")
    outcomes = _judged(progress, cases, runs)
    beside = _beside(progress, cases, runs)
    shown = progress.run(scene, runs / SHOWN, Options(ranks=2, steps=STEPS[tier]), STEPS[tier], f"{SHOWN}, P=2")
    with progress.stage("pictures and page"):
        velocity_field(shown, out / "field.png")
        slip_and_drag(shown, out / "slip_drag.png")
        ledger = _ledger(shown)
        page = jinja2.Environment(
            loader=jinja2.FileSystemLoader(ROOT / "reports" / "templates"),
            undefined=jinja2.StrictUndefined,
            autoescape=True,
        ).get_template("report.html.j2")
        html = page.render(
            tier=tier,
            comparison=comparison,
            digest_rows=_digest_rows(comparison),
            outcomes=outcomes,
            beside=beside,
            record=shown.record,
            samples=len(shown.series),
            ledger=ledger,
            provenance=_provenance(shown),
            field=_embedded(out / "field.png"),
            chart=_embedded(out / "slip_drag.png"),
            shown=SHOWN,
            steps=STEPS[tier],
            compared_steps=COMPARED_STEPS,
            compared_every=COMPARED_EVERY,
        )
        (out / "index.html").write_text(html)
    holds = (
        comparison.equal
        and not any(row["defect"] for row in ledger)
        and all(outcome.verdict == CORRECT for _, outcome in outcomes)
    )
    print("\n".join(comparison.lines))
    for name, outcome in outcomes:
        print(f"{name}: {outcome.line}")
    print(f"report: {out / 'index.html'}: {'everything holds' if holds else 'SOMETHING DOES NOT HOLD'}")
    return 0 if holds else 1
