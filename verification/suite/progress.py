"""Watches a run from outside: how far it is and how long it will take."""

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from verification.codes.mappm import Options, start
from verification.protocol.errors import SolverError
from verification.protocol.run import Run


def _clock(seconds: float) -> str:
    minutes, seconds = divmod(int(seconds), 60)
    return f"{minutes}:{seconds:02}"


def _steps_done(series: Path) -> int:
    """Step of the last whole row, 0 before there is one."""
    if not series.exists():
        return 0
    rows = series.read_text().rpartition("\n")[0].splitlines()
    return int(rows[-1].partition(",")[0]) if len(rows) > 1 else 0


class Progress:
    """Stages of a job, one line each; a line that moves on a terminal, one every half minute elsewhere."""

    def __init__(self, stages: int) -> None:
        self._stages, self._stage, self._started = stages, 0, time.monotonic()
        self._moving = sys.stdout.isatty()

    @contextmanager
    def stage(self, title: str) -> Iterator[Callable[..., None]]:
        """Yields say(text, seconds left or None), for what goes on inside."""
        self._stage += 1
        started = said = time.monotonic()
        self._say(f"[{self._stage}/{self._stages}] {title}")

        def say(text: str, left: float | None = None) -> None:
            nonlocal said
            if self._moving or time.monotonic() - said > 20:
                said = time.monotonic()
                to_go = "" if left is None else f", {_clock(left)} to go"
                self._say(f"[{self._stage}/{self._stages}] {title}: {text}{to_go}")

        yield say
        self._say(f"[{self._stage}/{self._stages}] {title}: done in {_clock(time.monotonic() - started)}", end="\n")

    def run(self, scene: Path, out: Path, options: Options, steps: int, title: str) -> Run:
        """Runs a scene of `steps` steps, saying how far it is. Throws SolverError."""
        with self.stage(title) as say:
            process = start(scene, out, options)
            started = time.monotonic()
            while True:
                try:
                    stdout, stderr = process.communicate(timeout=1)
                    break
                except subprocess.TimeoutExpired:
                    if done := _steps_done(out / "series.csv"):
                        say(f"step {done} of {steps}", (time.monotonic() - started) * (steps - done) / done)
            if process.returncode != 0:
                raise SolverError(f"{title} ended with {process.returncode}\n{stdout[-2000:]}{stderr[-4000:]}")
        return Run(out)

    def _say(self, text: str, end: str = "") -> None:
        print(f"\r\x1b[K{text}" if self._moving else text, end=end if self._moving else "\n", flush=True)
