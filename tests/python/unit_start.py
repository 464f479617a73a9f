"""What would fail at the end of a run is tried at its start: paths, memory; and what was printed has arrived.

Oracle: the limits of the system, and the exit codes of the README.
"""

import json
import os
import subprocess
import time
from pathlib import Path

import pytest

from verification.codes.mappm import MPI_ENVIRONMENT, Options, program, run, start

SCENE = Path(__file__).parent / "scenes" / "random_discs.toml"
LONGEST_PATH = 4095  # bytes, of Linux
INPUT = 2


def call(options: Options, out: Path, *before: str, **keywords) -> subprocess.CompletedProcess:
    return subprocess.run([*before, *options.command(SCENE, out)], env=os.environ | MPI_ENVIRONMENT, text=True,
                          stderr=subprocess.PIPE, **({"stdout": subprocess.PIPE} | keywords))


def only_error(finished: subprocess.CompletedProcess) -> str:
    assert finished.returncode == INPUT, finished.stderr
    (error,) = (line for line in finished.stderr.splitlines() if line.startswith("error: "))
    return error


def folder_of_length(parent: Path, length: int) -> Path:
    path = str(parent)
    while length - len(path) > 200:
        path += "/" + "d" * 99
    return Path(path + "/" + "e" * (length - len(path) - 1))


@pytest.mark.parametrize("ranks", [0, 1, 2])
@pytest.mark.parametrize("length", [203, 1000, LONGEST_PATH - 60])
def test_a_long_path_works(tmp_path: Path, ranks: int, length: int) -> None:
    options = Options(ranks=ranks, steps=2, overrides=("output.checkpoint=2",))
    out = folder_of_length(tmp_path, length)
    assert len(str(out)) == length
    finished = run(SCENE, out, options)
    assert finished.record["state"] == "finished"
    assert len(list(out.glob("*/*.*"))) == 3  # two snapshots and a checkpoint


@pytest.mark.parametrize("ranks", [0, 1, 2])
@pytest.mark.parametrize("length", [LONGEST_PATH - 40, LONGEST_PATH - 5])
def test_a_path_too_long_for_the_last_file_is_refused_at_the_start(tmp_path: Path, ranks: int, length: int) -> None:
    out = folder_of_length(tmp_path, length)
    error = only_error(call(Options(ranks=ranks, steps=2), out))
    assert str(out) in error
    assert "File name too long" in error
    assert not out.exists()


@pytest.mark.parametrize("ranks", [0, 1, 2])
def test_a_scene_beyond_the_memory_is_refused_by_its_spacing(tmp_path: Path, ranks: int) -> None:
    options = Options(ranks=ranks, overrides=("fluid.spacing=0.00001", "fluid.rcut=0.00003"))
    error = only_error(call(options, tmp_path / "out", "prlimit", "--as=4000000000"))
    for part in ("fluid.spacing = 1e-05", "2e+10 PPs", "bytes", "are there"):
        assert part in error
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("ranks", [0, 1])
def test_the_memory_foretold_is_about_what_is_taken(tmp_path: Path, ranks: int) -> None:
    def memory(spacing: float) -> tuple[float, float]:
        """Bytes taken, as far as they are seen from outside, and foretold."""
        overrides = (f"fluid.spacing={spacing}", f"fluid.rcut={3 * spacing}")
        process = start(SCENE, tmp_path, Options(ranks=ranks, steps=5, overrides=overrides))
        status, taken = Path(f"/proc/{process.pid}/status"), 0.0
        while process.poll() is None:
            peak = [line.split()[1] for line in status.read_text().splitlines() if line.startswith("VmHWM")]
            taken = max([taken, *(1024 * float(kibibytes) for kibibytes in peak)])
            time.sleep(0.005)
        stdout, stderr = process.communicate()
        assert process.returncode == 0, stderr
        words = stdout.partition("about ")[2].split()
        return taken, float(words[0]) * {"MB": 1e6, "GB": 1e9}[words[1]]

    small, large = memory(0.05), memory(0.003)
    assert (large[0] - small[0]) / (large[1] - small[1]) == pytest.approx(1.0, abs=0.35)


@pytest.mark.parametrize("buffer", [(), ("stdbuf", "-oL")])  # that of a file, and that of a terminal, which fails at once
@pytest.mark.parametrize("ranks", [0, 1])
def test_standard_output_that_is_full_is_an_error(tmp_path: Path, ranks: int, buffer: tuple[str, ...]) -> None:
    with open("/dev/full", "w") as full:
        error = only_error(call(Options(ranks=ranks, steps=2), tmp_path, *buffer, stdout=full))
        assert "standard output" in error
        for words in (["--version"], ["run", "--help"]):
            said = subprocess.run([program("mappm"), *words], stdout=full, stderr=subprocess.DEVNULL)
            assert said.returncode == INPUT
    assert json.loads((tmp_path / "run.json").read_text())["state"] == "finished"  # what was computed is all there


def test_a_reader_that_is_gone_does_not_end_the_run(tmp_path: Path) -> None:
    read, write = os.pipe()
    os.close(read)
    error = only_error(call(Options(steps=20), tmp_path, stdout=write))
    os.close(write)
    assert "standard output" in error
    assert json.loads((tmp_path / "run.json").read_text())["state"] == "finished"


@pytest.mark.parametrize("name", ["mappm", "mappm-reference"])
def test_a_closed_standard_output_lends_its_number_to_no_file(tmp_path: Path, name: str) -> None:
    line = f"'{program(name)}' run '{SCENE}' --steps 2 --out '{tmp_path}' >&- 2>&-"
    assert subprocess.run(["sh", "-c", line]).returncode == 0
    for path in tmp_path.rglob("*"):
        assert path.is_dir() or b"particle-steps/s" not in path.read_bytes(), path


def test_the_last_state_stands_in_the_tables(tmp_path: Path) -> None:
    finished = run(SCENE, tmp_path, Options(ranks=2, steps=25, faces=True, overrides=("output.sample=10",)))
    assert list(finished.series["step"]) == [0, 10, 20, 25]
    assert finished.series["digest"][-1] == finished.record["digest"]
    assert (tmp_path / "solids.csv").read_text().splitlines()[-1].startswith("25,")
    assert (tmp_path / "faces.csv").read_text().splitlines()[-1].startswith("25,")
