"""The benchmark of precision as a whole, on small fluids: that it measures, not what. Slowness fails nothing here."""

import json
import shlex
import subprocess
from pathlib import Path

import pytest
from benchmarks import assert_drawn, measured

from bench import precision
from bench.meter import row
from verification.codes.mappm import build_folder
from verification.report.speed_charts import precisions


def test_it_prints_and_enters_figures_of_speed_and_accuracy(tmp_path: Path) -> None:
    figures, _ = measured("precision", tmp_path / "lab", "--out", str(tmp_path / "runs"))
    assert all(row.value > 0 for row in figures.rows)
    coarsest = {"case": precision.CASES[0], "level": 0}
    assert figures.value("single_off_double", **coarsest) < figures.value("double_off_the_answer", **coarsest)
    assert_drawn(precisions, figures, tmp_path)


def test_a_digest_that_depends_on_processes_gives_no_figure(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def depending(overrides: tuple[str, ...], steps: int, ranks: int, folder: Path) -> precision.Speed:
        return precision.Speed(1.0, str(ranks) if precision.SINGLE in overrides else "")

    monkeypatch.setattr(precision, "own_speed", depending)
    with pytest.raises(precision.Broken, match="single precision: the digest on two processes"):
        precision.of_speed(precision.Meter(1, lambda text: None), True, tmp_path)


def test_sums_in_floating_point_are_read_or_left_out(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    program = tmp_path / "bench-pair_numbers"
    monkeypatch.setattr(precision, "FLOATING_SUMS", program)
    assert precision.of_exactness() == []
    program.write_text("#!/bin/sh\necho a round\necho ratio exactness.fluid_2d_39.over 1.5\n")
    program.chmod(0o755)
    assert precision.of_exactness() == [row("over", 1.5, fluid="2d_39", part="pass")]
    program.write_text("#!/bin/sh\necho ratio a.c 1.5\nexit 3\n")
    with pytest.raises(precision.Broken, match="ended with 3"):
        precision.of_exactness()


def test_the_pass_with_floating_sums_compiles() -> None:
    """No build of the tests has it."""
    commands = json.loads((build_folder() / "compile_commands.json").read_text())
    (command,) = [entry["command"] for entry in commands if entry["file"].endswith("solver/parallel/fluid_pass.cpp")]
    words = shlex.split(command)
    del words[words.index("-o") : words.index("-o") + 2]
    done = subprocess.run([*words, "-O0", "-fsyntax-only", "-DMAPPM_FLOATING_SUMS"], cwd=build_folder(), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
