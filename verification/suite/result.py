"""A case judged: every verdict there is on it, from what the laboratory holds."""

from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from verification.bits.conservation import Conservation, conservation
from verification.bits.equivalence import Matrix, Row, obstacle, run_matrix
from verification.codes.code import Code, find_code
from verification.codes.mappm import Options, run
from verification.measures.curve import kept_chart
from verification.measures.measures import Point, measures_in
from verification.measures.source import measure_id
from verification.store.key import canonical_scene, hash_of
from verification.store.laboratory import Laboratory, made_now
from verification.store.store import Found, Made
from verification.suite.case import Case, Level
from verification.suite.judge import SKIPPED, Entries, Outcome, beside, judge
from verification.suite.parameters import scene_of
from verification.suite.progress import time_left
from verification.suite.references import Reference, look_up_reference, obtain_reference, resolved
from verification.suite.runner import OWN, Entry, Job, Shelf, jobs_of, look_up, perform

BOTH = "both "  # kind of the charts of a run and of a reference, before the key of that
FACES_STEPS, FACES_RANKS = 200, 4

Say = Callable[[str], None]


@dataclass(frozen=True)
class Exactness:
    """Mass and momentum as equalities of integers, at every sample of every run of a code that counts in integers."""

    runs: int
    samples: int
    defects: tuple[str, ...]  # what does not hold

    @property
    def line(self) -> str:
        if self.defects:
            return "mass and momentum: NOT EXACT: " + "; ".join(self.defects)
        return f"mass and momentum: EXACT at {self.samples} samples of {self.runs} runs"


@dataclass(frozen=True)
class Bits:
    """The equivalence matrix of a case, and the impulses over the faces between domains."""

    matrix: Matrix
    faces: Conservation
    made: Made


@dataclass(frozen=True)
class CaseResult:
    case: Case
    code: Code
    tier: str
    entries: Entries
    outcomes: tuple[Outcome, ...]
    beside: tuple[tuple[str, Outcome], ...]
    exact: Exactness
    bits: Bits | None = None
    live: Reference | None = None
    charts: tuple[dict, ...] = ()  # as kept, of the finest run alone and beside the reference

    @property
    def skipped(self) -> tuple[Outcome, ...]:
        return tuple(outcome for outcome in self.outcomes if outcome.verdict == SKIPPED)

    @property
    def matrix(self) -> Matrix | None:
        return self.bits.matrix if self.bits else None

    @property
    def faces(self) -> Conservation | None:
        return self.bits.faces if self.bits else None

    @property
    def _exact(self) -> bool:
        return not self.exact.defects and (self.bits is None or (self.bits.matrix.equal and self.bits.faces.exact))

    @property
    def holds(self) -> bool:
        return self._exact and all(outcome.holds for outcome in self.outcomes)

    @property
    def passes(self) -> bool:
        """All holds but for misses that are explained."""
        return self._exact and all(outcome.passes for outcome in self.outcomes)

    @property
    def explained(self) -> tuple[Outcome, ...]:
        return tuple(outcome for outcome in self.outcomes if outcome.explained)

    @property
    def finest(self) -> Entry:
        return self.entries[self.case.levels_of(self.tier)[-1].overrides]

    @property
    def made(self) -> Made | None:
        """Of its newest run."""
        found = [entry.stored.made for entry in self.entries.values()] + ([self.bits.made] if self.bits else [])
        return max(found, key=lambda made: made.made) if found else None

    @property
    def lines(self) -> list[str]:
        lines = [outcome.line for outcome in self.outcomes]
        if self.live and not self.outcomes:
            lines += [f"{name} = {quantity.value:.6g}, {quantity.note} ({self.live.code}, shown, not judged)"
                      for name, quantity in self.live.quantities.items()]
        lines += [f"beside it, {label}: {outcome.observable.symbol} = {outcome.measured.value:.6g}, {outcome.error_text} from "
                  f"{outcome.observable.reference:g}, without a verdict" for label, outcome in self.beside]
        if self.bits is not None:
            lines += self.bits.matrix.lines + self.bits.faces.lines
        return [*lines, self.exact.line] if self.exact.runs else lines

    @property
    def point(self) -> Point:
        """For charts of a family."""
        first, finest = self.outcomes[0], self.finest
        reference = {name: found.value for name, found in self.live.quantities.items()} if self.live else {}
        return Point(self.case.family, self.case.name.partition(".")[2], finest.scene, finest.figures, reference, first.measured.value,
                     first.error, first.coverage * first.u_num * first.scale, first.scale)


def exactness(entries: Entries) -> Exactness:
    ledgers = [(entry.stored.label, entry.stored.ledger) for entry in entries.values() if entry.stored.ledger is not None]
    defects = tuple(f"{label}: {line}" for label, ledger in ledgers for line in ledger.defects)
    return Exactness(len(ledgers), sum(ledger.samples for _, ledger in ledgers), defects)


# Equality of bits.


def _bits_key(case: Case, code: Code) -> str:
    labels = [variant.label for variant in case.equivalence.variants]
    return hash_of({"numerics": code.numerics_version, "scene": canonical_scene(scene_of(case, case.base)),
                    "steps": case.equivalence.steps, "every": case.equivalence.every, "variants": labels})[:24]


def _kept_bits(matrix: Matrix, faces: Conservation) -> dict:
    return {"rows": [asdict(row) for row in matrix.rows], "faces": asdict(faces)}


def _bits(kept: dict, made: Made) -> Bits:
    by_step = {name: {int(step): defect for step, defect in value.items()} if isinstance(value, dict) else value
               for name, value in kept["faces"].items()}
    return Bits(Matrix(tuple(Row(**row) for row in kept["rows"])), Conservation(**by_step), made)


def look_up_bits(laboratory: Shelf, case: Case, code: Code) -> Bits | None:
    found = laboratory.store.matrix(_bits_key(case, code))
    return _bits(*found) if found else None


def _settled(case: Case, bits: Bits) -> bool:
    """Whether to run it again would tell nothing new."""
    skipped = {row.variant for row in bits.matrix.rows if row.skipped}
    return bits.matrix.equal and bits.faces.exact and all(obstacle(one) for one in case.equivalence.variants if one.label in skipped)


def obtain_bits(laboratory: Laboratory, case: Case, code: Code, say: Say, anew: bool = False) -> Bits:
    """From the store, or run now: the matrix, and the faces at every tenth step. What does not hold is run again, and so is a matrix
    with a variant that was skipped and can now be had."""
    if not anew and (known := look_up_bits(laboratory, case, code)) is not None and _settled(case, known):
        return known
    with TemporaryDirectory(dir=laboratory.folder) as scratch:
        matrix = run_matrix(case.file, case.equivalence, Path(scratch) / "matrix", say)
        options = Options(ranks=FACES_RANKS, steps=min(FACES_STEPS, case.equivalence.steps), faces=True, overrides=("output.sample=10",))
        faces = conservation(run(case.file, Path(scratch) / "faces", options))
    made = made_now()
    laboratory.store.enter_matrix(_bits_key(case, code), case.name, _kept_bits(matrix, faces), made)
    return Bits(matrix, faces, made)


# Judging.


def _keep_charts_of_both(laboratory: Laboratory, case: Case, finest: Entry, live: Reference) -> None:
    """While the folders of both runs are there."""
    draw, kind = measures_in(case.file.parent).charts_of_both, BOTH + live.key
    own, other = laboratory.run(finest.stored.key), laboratory.run(live.key) if live.key else None
    if draw is None or kind in finest.found.charts or own is None or other is None or not live.quantities:
        return
    charts = {kind: [kept_chart(chart) for chart in draw(own, other)]}
    laboratory.store.enter_found(finest.stored.key, measure_id(case.file.parent), Found(charts=charts))


def _charts(laboratory: Shelf, case: Case, finest: Entry, live: Reference | None) -> tuple[dict, ...]:
    kept = laboratory.store.found(finest.stored.key, measure_id(case.file.parent)).charts
    return (*kept.get(OWN, []), *(kept.get(BOTH + live.key, []) if live and live.key else []))


def judged(laboratory: Shelf, case: Case, tier: str, code: Code, entries: Entries, bits: Bits | None = None,
           live: Reference | None = None) -> CaseResult:
    known = resolved(case, live)
    outcomes, others = tuple(judge(known, tier, entries)), tuple(beside(known, entries))
    charts = _charts(laboratory, case, entries[case.levels_of(tier)[-1].overrides], live) if entries else ()
    return CaseResult(known, code, tier, entries, outcomes, others, exactness(entries), bits, live, charts)


def collect(laboratory: Shelf, case: Case, tier: str, code: Code) -> CaseResult | None:
    """From the store alone; None where something of it is missing."""
    entries = {}
    for job in jobs_of(case, tier, code):
        entry = look_up(laboratory, job)
        if entry is None:
            return None
        entries[job.overrides] = entry
    bits = look_up_bits(laboratory, case, code) if case.equivalence is not None else None
    live = look_up_reference(laboratory, case, tier, entries, find_code(case.live.code)) if case.live else None
    if (case.equivalence is not None and bits is None) or (case.live is not None and live is None):
        return None
    return judged(laboratory, case, tier, code, entries, bits, live)


@dataclass(frozen=True)
class Way:
    """How what is missing is run."""

    cores: int = 1  # of each run
    workers: int = 1  # runs at a time
    anew: bool = False  # also what the store has


def finish(laboratory: Laboratory, case: Case, tier: str, code: Code) -> tuple[Entries, Reference | None]:
    """When the runs of a case are there: what was measured, and what the reference code says, which is run where that is missing."""
    entries = {job.overrides: look_up(laboratory, job) for job in jobs_of(case, tier, code)}
    live = obtain_reference(laboratory, case, tier, entries) if case.live else None
    if live is not None and case.observables:
        _keep_charts_of_both(laboratory, case, entries[case.levels_of(tier)[-1].overrides], live)
    return entries, live


def run_case(laboratory: Laboratory, case: Case, tier: str, code: Code, way: Way, say: Say) -> CaseResult:
    """All that the manifest asks for. `say` is told of every run that ends. Throws SolverError, CaseError, Beyond, StoreError."""
    left = time_left()

    def told(job: Job, share: float) -> None:
        say(f"{case.name}: {job.label}: done; {left(share):.0f} s to go")

    jobs = jobs_of(case, tier, code, way.cores)
    perform(laboratory, jobs, way.workers, told, way.anew)
    bits = obtain_bits(laboratory, case, code, say, way.anew) if case.equivalence is not None else None
    entries, live = finish(laboratory, case, tier, code)
    return judged(laboratory, case, tier, code, entries, bits, live)


def run_with(laboratory: Laboratory, case: Case, overrides: tuple[str, ...], code: Code, way: Way) -> CaseResult:
    """The scene alone with overrides of the user: no levels, nothing varied, so the goals alone decide."""
    overrides = case.base + overrides
    observables = tuple(replace(observable, order=None, extrapolated=None) for observable in case.observables)
    alone = replace(case, scene=scene_of(case, overrides), observables=observables, levels=(Level(overrides, "quick"),), vary=(),
                    beside=(), equivalence=None, remark="")
    return run_case(laboratory, alone, "quick", code, way, lambda text: None)
