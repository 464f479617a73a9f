"""Kills runs with SIGKILL at random moments and resumes them, on another number of ranks each time.

    python3 -m tests.robustness.kill --times 50 [--ranks 1,2,3] [--seed N] [--json FILE]

A chain is a run that is killed and resumed until it ends. Oracle: the same run undisturbed, whose digest and tables the
end of each chain must equal byte by byte; and the tables themselves, which tell how far a killed run had come.
"""

import argparse
import json
import random
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from tests.robustness import processes, summary
from verification.codes.mappm import Options, run, start
from verification.protocol.machine import ROOT

SCENE = ROOT / "cases" / "crossing_2d" / "case.toml"
STEPS, INTERVAL, SAMPLE = 600, 6, 2
OVERRIDES = (f"output.checkpoint={INTERVAL}", f"output.sample={SAMPLE}", "output.solids=true", "output.snapshot=30")
TABLES = ("series.csv", "solids.csv")
LONGEST_WAIT = 2.5  # s, from the start of a run to its kill
AIMED_SHARE = 0.4  # of the kills: they wait, from their moment on, until a checkpoint is being written


class Broken(AssertionError):
    """A promise of the solver that a kill has broken."""


def promise(holds: bool, what: str) -> None:
    if not holds:
        raise Broken(what)


def checkpoint_steps(folder: Path) -> list[int]:
    return sorted(int(path.stem.rpartition("_")[2]) for path in folder.glob("checkpoints/checkpoint_*.h5"))


def last_whole_row(table: Path) -> tuple[int, bool]:
    """Step of the last row that ends with its newline (0: none), and whether a piece of another follows."""
    text = table.read_text() if table.exists() else ""
    whole, _, rest = text.rpartition("\n")
    rows = whole.splitlines()[1:]
    return (int(rows[-1].partition(",")[0]) if rows else 0), bool(rest)


def partial_files(folder: Path) -> dict[Path, int]:
    """Files half written, and when they were last written to."""
    return {path: path.stat().st_mtime_ns for path in folder.rglob("*.partial")}


def first_step(folder: Path) -> tuple[int, int] | None:
    """Where the run that wrote run.json began, and the identity of that file."""
    path = folder / "run.json"
    return (json.loads(path.read_text())["first_step"], path.stat().st_mtime_ns) if path.exists() else None


def wait_for_checkpoint(out: Path, process: subprocess.Popen) -> None:
    """Until a checkpoint is half written, or the process ends."""
    while process.poll() is None and not any(out.glob("checkpoints/*.partial")):
        time.sleep(0.0002)


@dataclass
class Tally:
    kills: Counter = field(default_factory=Counter)  # by whom the signal hit
    ranks: Counter = field(default_factory=Counter)
    partial: Counter = field(default_factory=Counter)  # kills that left a file half written, by its kind
    aimed: int = 0
    from_the_start: int = 0
    most_lost: int = 0
    chains: int = 0

    def figures(self) -> dict:
        return {
            "kills": self.kills.total(),
            "kills_by_target": dict(self.kills),
            "kills_by_ranks": {str(ranks): count for ranks, count in sorted(self.ranks.items())},
            "kills_aimed_at_a_checkpoint": self.aimed,
            "kills_while_writing": dict(self.partial),
            "restarts_from_the_start": self.from_the_start,
            "checkpoint_interval": INTERVAL,
            "lost_steps_max": self.most_lost,
            "chains_finished": self.chains,
            "digest_and_tables_equal": True,
        }


class Campaign:
    def __init__(self, folder: Path, ranks: list[int], seed: int) -> None:
        self.folder, self.rank_choices = folder, ranks
        self.random = random.Random(seed)
        self.tally = Tally()
        self.through = run(SCENE, folder / "through", Options(ranks=1, steps=STEPS, overrides=OVERRIDES))

    def go(self, times: int) -> None:
        """Kills at least `times` times and lets the chain under way end."""
        while self.tally.kills.total() < times:
            self.chain(times)

    def chain(self, times: int) -> None:
        out = self.folder / f"chain_{self.tally.chains}"
        ranks = self.random.choice(self.rank_choices)
        while True:
            enough = self.tally.kills.total() >= times
            if self.launch(out, ranks, enough):
                break
            if not checkpoint_steps(out):
                self.tally.from_the_start += 1
            ranks = self.random.choice([other for other in self.rank_choices if other != ranks] or [ranks])
        self.compare(out, ranks)
        shutil.rmtree(out)
        self.tally.chains += 1

    def launch(self, out: Path, ranks: int, to_the_end: bool) -> bool:
        """Starts or resumes the run; true if it came to its end, false if it was killed before."""
        kept = checkpoint_steps(out)
        before = first_step(out)
        resume = out if kept else None
        partial_before = partial_files(out)  # left by kills before this one
        process = start(SCENE, out, Options(ranks=ranks, steps=STEPS, overrides=OVERRIDES, resume=resume))
        moment = self.random.uniform(0.0, LONGEST_WAIT)
        aimed = self.random.random() < AIMED_SHARE
        try:
            _, stderr = process.communicate(timeout=None if to_the_end else moment)
        except subprocess.TimeoutExpired:
            if aimed:
                self.tally.aimed += 1
                wait_for_checkpoint(out, process)
            hit = self.strike(process, ranks)
            self.check_start(out, kept, before, must=False)
            self.after_kill(out, ranks, hit, moment, partial_before)
            return False
        promise(process.returncode == 0, f"a resumed run ends well:\n{stderr}")
        promise("instead" not in stderr, f"every checkpoint that a kill left is sound:\n{stderr}")
        self.check_start(out, kept, before, must=True)
        return True

    def strike(self, process: subprocess.Popen, ranks: int) -> str:
        """Kills all processes, or one rank, or mpirun alone; waits until none is left."""
        pids = processes.ranks(process.pid)
        hit = self.random.choice(["all", "one rank", "mpirun"]) if ranks > 1 else "all"
        every = [process.pid, *processes.children(process.pid)]
        targets = {"all": every, "one rank": [self.random.choice(pids)], "mpirun": [process.pid]}
        ended = process.poll() is not None  # before the signal could reach it
        processes.kill(targets[hit])
        processes.wait_until_gone(process, every)
        promise(ended or process.returncode != 0, "a killed run does not claim success")
        return hit

    def check_start(self, out: Path, kept: list[int], before: tuple[int, int] | None, must: bool) -> None:
        """The run, if it came so far as to say so, began at the newest checkpoint there was."""
        now = first_step(out)
        if now == before:
            promise(not must, "a finished run wrote run.json")
        elif now is not None:
            promise(now[0] == max(kept, default=0), f"a run resumes at step {max(kept, default=0)}, not {now[0]}")

    def after_kill(self, out: Path, ranks: int, hit: str, moment: float, partial_before: dict[Path, int]) -> None:
        """Nothing that was there before the kill is lost but the steps since the last checkpoint."""
        newest = max(checkpoint_steps(out), default=0)
        reached, row_cut = last_whole_row(out / "series.csv")
        # A row is written before the checkpoint of its step: the checkpoint of an earlier step was there by then.
        promised = (reached - 1) // INTERVAL * INTERVAL if reached else 0
        promise(newest >= promised, f"step {reached} was reached, the checkpoint of {promised} is gone: {newest} is left")
        own = [path for path, written in partial_files(out).items() if partial_before.get(path) != written]
        partial = {path.parent.name if path.parent != out else path.name for path in own}
        kinds = sorted(partial | ({"row of series.csv"} if row_cut else set()))
        lost = max(reached - newest, 0)
        tally = self.tally
        tally.kills[hit] += 1
        tally.ranks[ranks] += 1
        tally.partial.update(kinds)
        tally.most_lost = max(tally.most_lost, lost)
        while_writing = f", while writing {', '.join(kinds)}" if kinds else ""
        print(
            f"kill {tally.kills.total()}: {ranks} ranks, {hit}, after {moment:.2f} s, checkpoint {newest}, "
            f"step {reached}{while_writing}",
            flush=True,
        )

    def compare(self, out: Path, ranks: int) -> None:
        record = json.loads((out / "run.json").read_text())
        promise(record["digest"] == self.through.record["digest"], "the digest is that of the undisturbed run")
        for table in TABLES:
            same = (out / table).read_bytes() == (self.through.folder / table).read_bytes()
            promise(same, f"{table} has the bytes of the undisturbed run")
        left = [str(path.relative_to(out)) for path in out.rglob("*.partial")]
        promise(not left, f"a finished run leaves no partial file: {left}")
        print(f"chain {self.tally.chains + 1} ended on {ranks} ranks: digest {record['digest']}, tables equal", flush=True)


def main(words: list[str] | None = None) -> Tally:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--times", type=int, default=50, help="kills")
    parser.add_argument("--ranks", default="1,2,3", help="numbers of ranks to choose from")
    parser.add_argument("--seed", type=int, default=int(time.time()), help="of the moments and the choices")
    parser.add_argument("--json", type=Path, help="summary to which the figures are added")
    options = parser.parse_args(words)
    print(f"seed {options.seed}", flush=True)
    with tempfile.TemporaryDirectory(prefix="mappm-kill-") as folder:
        campaign = Campaign(Path(folder), [int(ranks) for ranks in options.ranks.split(",")], options.seed)
        campaign.go(options.times)
    figures = campaign.tally.figures()
    print(json.dumps(figures, indent=2))
    if options.json:
        summary.write(options.json, "kill", "python3 -m tests.robustness.kill", {"seed": options.seed, **figures})
    return campaign.tally


if __name__ == "__main__":
    try:
        main()
    except Broken as broken:
        sys.exit(f"broken promise: {broken}")
