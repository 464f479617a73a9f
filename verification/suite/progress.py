"""Stages of long work: how far it is and how long it will take."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager


def _clock(seconds: float) -> str:
    minutes, seconds = divmod(int(seconds), 60)
    return f"{minutes}:{seconds:02}"


def time_left() -> Callable[[float], float]:
    """Seconds to go of work that starts now, by the share of it that is behind."""
    started = time.monotonic()
    return lambda share: (time.monotonic() - started) * (1 - share) / share


class Progress:
    """Stages of a job, one line each; a line that moves on a terminal, one every half minute elsewhere."""

    def __init__(self, stages: int) -> None:
        self._stages, self._stage = stages, 0
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

    def _say(self, text: str, end: str = "") -> None:
        print(f"\r\x1b[K{text}" if self._moving else text, end=end if self._moving else "\n", flush=True)
