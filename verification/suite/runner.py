"""The runs that a case needs, and running them a few at a time."""

import hashlib
import shutil
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from verification.codes.mappm import Options, run
from verification.protocol.run import Run
from verification.suite.case import Case
from verification.suite.parameters import overrides_of, scene_of


@dataclass(frozen=True)
class Job:
    """One run of a case. Jobs with the same overrides are run once."""

    case: Case
    overrides: tuple[str, ...]

    @property
    def label(self) -> str:
        return " ".join(self.overrides[len(self.case.base) :]) or "as declared"

    @property
    def folder_name(self) -> str:
        """Short, the same for the same overrides."""
        return hashlib.sha256("\n".join(self.overrides).encode()).hexdigest()[:12] if self.overrides else "scene"

    @property
    def weight(self) -> float:
        """Cost relative to the scene as declared: particles times steps, where the spacing is another."""
        scenes = self.case.scene, scene_of(self.case, self.overrides)
        declared, chosen = (scene.get("fluid", {}).get("spacing") for scene in scenes)
        if not all(isinstance(spacing, (int, float)) for spacing in (declared, chosen)):
            return 1.0
        return (declared / chosen) ** (len(self.case.scene["box"]["size"]) + 1)


def jobs_of(case: Case, tier: str) -> list[Job]:
    """Levels, variations and what is measured beside, without repeats."""
    if not case.observables:
        return []
    base = case.quick_finest().overrides
    sets = [level.overrides for level in case.levels_of(tier)]
    sets += [base + chosen for vary in case.vary for chosen in vary.sets]
    sets += [base] if case.vary else []
    sets += [base + beside.overrides for beside in case.beside]
    return [Job(case, overrides) for overrides in dict.fromkeys(sets)]


Done = Callable[[Job, float], None]


def run_jobs(jobs: list[Job], out: Path, options: Options, workers: int, done: Done = lambda job, share: None) -> dict:
    """Runs all, the longest first, `workers` at a time, each in out/CASE/RUN. Returns {(case name, overrides): Run}.

    `done` is called after each with the share of the expected work that is behind. The first error ends it: SolverError.
    """
    total = sum(job.weight * job.case.cost for job in jobs) or 1.0
    behind, lock = 0.0, threading.Lock()

    def one(job: Job) -> Run:
        nonlocal behind
        chosen = Options(ranks=options.ranks, overrides=overrides_of(job.case, job.overrides) + options.overrides)
        folder = out / job.case.name / job.folder_name
        shutil.rmtree(folder, ignore_errors=True)  # snapshots of an earlier run would be read as of this one
        finished = run(job.case.file, folder, chosen)
        with lock:
            behind += job.weight * job.case.cost
            done(job, behind / total)
        return finished

    ordered = sorted(jobs, key=lambda job: -job.weight * job.case.cost)
    with ThreadPoolExecutor(workers) as pool:
        futures = {(job.case.name, job.overrides): pool.submit(one, job) for job in ordered}
        try:
            return {key: future.result() for key, future in futures.items()}
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
