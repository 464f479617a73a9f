"""What the tests of the benchmarks share: a benchmark run on small scenes into a laboratory of its own."""

import math
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from bench.meter import shown
from verification.protocol.machine import ROOT
from verification.store.figures import Figures, benches_of
from verification.store.store import Store


def benchmark(name: str, *options: str) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, "-m", f"bench.{name}", "--quick", *options], cwd=ROOT, capture_output=True, text=True)


def figures_in(lab: Path, name: str) -> Figures:
    """Of a benchmark that entered them into this laboratory."""
    return benches_of(Store(lab / "store.sqlite"))[name]


def measured(name: str, lab: Path, *options: str, code: int = 0) -> tuple[Figures, subprocess.CompletedProcess]:
    """Of a run that ends with this code: all figures are finite, each is entered and is a line of what is printed."""
    done = benchmark(name, "--lab", str(lab), *options)
    assert done.returncode == code, done.stderr
    figures = figures_in(lab, name)
    assert sorted(done.stdout.splitlines()) == sorted(shown(figures))
    assert all(math.isfinite(row.value) for row in figures.rows)
    assert figures.made.command.startswith(f"python3 -m bench.{name}") and figures.made.source and figures.made.machine
    return figures, done


def assert_drawn(draw: Callable[[Figures, Path], None], figures: Figures, folder: Path) -> None:
    draw(figures, folder / "chart.svg")
    assert (folder / "chart.svg").stat().st_size > 1000
