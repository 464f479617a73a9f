"""A full disk, a folder that may not be written and a lost rank: one message, an exit code, and what was there before
stays whole.

Oracle: the rule that a message names the file; the bytes of the files before; the digest of an undisturbed run.
"""

import os
import subprocess
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.robustness import processes
from tests.robustness.kill import SCENE
from verification.codes.mappm import MPI_ENVIRONMENT, Options, run, start
from verification.protocol.run import Run

INPUT = 2
RANKS = (0, 1, 2, 3)
END = 120
KILOBYTE = 1024
LAST_FILES = 420  # kilobytes: room for the last snapshot and a checkpoint, and a little more


@dataclass(frozen=True)
class Disk:
    """A disk of memory."""

    folder: Path

    def fill(self, room: int) -> None:
        """Leaves so many bytes free, in pages of 4 KiB."""
        with open(self.filler, "wb") as file:
            free = os.statvfs(self.folder)
            file.write(bytes(free.f_bavail * free.f_frsize - room))

    def free(self) -> None:
        self.filler.unlink()

    def remount(self, mode: str) -> None:
        subprocess.run(["mount", "-o", f"remount,{mode}", str(self.folder)], check=True)

    @property
    def filler(self) -> Path:
        return self.folder / "filler"


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[Disk]:
    folder = tmp_path / "disk"
    folder.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", str(folder)], capture_output=True)
    if mounted.returncode != 0:
        pytest.skip("only root can mount a small disk")
    yield Disk(folder)
    subprocess.run(["umount", str(folder)], check=True)


def begun(out: Path) -> dict[Path, bytes]:
    """A run to step 50 with a checkpoint of it; the bytes of that."""
    run(SCENE, out, Options(steps=50, overrides=("output.checkpoint=50", "output.snapshot=0", "output.solids=false")))
    return {path: path.read_bytes() for path in out.glob("checkpoints/*")}


def refused(options: Options, out: Path) -> str:
    """The only message of a run that fails."""
    ended = subprocess.run(
        options.command(SCENE, out), env=os.environ | MPI_ENVIRONMENT, capture_output=True, text=True, timeout=120
    )
    assert ended.returncode == INPUT, ended.stderr
    (error,) = (line for line in ended.stderr.splitlines() if line.startswith("error:"))
    assert "cannot be" in error
    return error


def assert_whole(out: Path, kept: dict[Path, bytes]) -> None:
    """The checkpoints before are untouched, nothing half written stays, the table has whole rows."""
    assert {path: path.read_bytes() for path in out.glob("checkpoints/*")} == kept
    assert not list(out.rglob("*.partial"))
    table = (out / "series.csv").read_text()
    assert table.endswith("\n")
    assert len({line.count(",") for line in table.splitlines()}) == 1


def assert_resumes(out: Path, through: Run) -> None:
    resumed = run(SCENE, out, Options(ranks=2, steps=END, overrides=("output.solids=false",), resume=out))
    assert resumed.record["first_step"] > 0
    assert resumed.record["digest"] == through.record["digest"]


@pytest.fixture(scope="module")
def through(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return run(SCENE, tmp_path_factory.mktemp("through"), Options(steps=END))


@pytest.mark.parametrize("ranks", RANKS)
@pytest.mark.parametrize(
    ("outputs", "steps", "room", "named"),
    [
        ((), END, 0, "snapshots/solids_000000120.vtkhdf"),  # tried before the first step
        ((), END, 16, "snapshots/solids_000000120.vtkhdf"),
        (("output.snapshot=5",), END, LAST_FILES, "snapshots/fluid_"),  # there was room for the last one
        (("output.sample=1",), 1_000_000, LAST_FILES, "series.csv"),
    ],
)
def test_a_full_disk_names_the_file_and_leaves_the_others(
    disk: Disk, through: Run, ranks: int, outputs: tuple[str, ...], steps: int, room: int, named: str
) -> None:
    out = disk.folder / "out"
    kept = begun(out)
    disk.fill(room * KILOBYTE)
    overrides = ("output.solids=false", "output.sample=1000", *outputs)
    options = Options(ranks=ranks, steps=steps, overrides=overrides, resume=out)
    error = refused(options, out)
    assert f"{out}/{named}" in error  # or its name with .partial behind
    assert "No space left" in error or "KiB are left on its disk" in error
    assert_whole(out, kept)
    disk.free()
    assert_resumes(out, through)


@pytest.mark.parametrize("ranks", RANKS)
def test_a_folder_that_may_not_be_written_is_named(disk: Disk, through: Run, ranks: int) -> None:
    out = disk.folder / "out"
    kept = begun(out)
    disk.remount("ro")
    try:
        assert f"{out}/run.lock" in refused(Options(ranks=ranks, steps=END, resume=out), out)
        assert f"{disk.folder}/new" in refused(Options(ranks=ranks, steps=END), disk.folder / "new")
        assert_whole(out, kept)
    finally:
        disk.remount("rw")
    assert_resumes(out, through)


@pytest.mark.parametrize("ranks", [2, 3])
def test_a_lost_rank_ends_the_run_and_says_so(tmp_path: Path, through: Run, ranks: int) -> None:
    overrides = ("output.checkpoint=10", "output.sample=5", "output.solids=false")
    process = start(SCENE, tmp_path, Options(ranks=ranks, steps=1_000_000, overrides=overrides))
    while process.poll() is None and len(list(tmp_path.glob("checkpoints/*.h5"))) < 2:
        time.sleep(0.01)
    every = [process.pid, *processes.children(process.pid)]
    processes.kill(processes.ranks(process.pid)[-1:])
    _, stderr = processes.wait_until_gone(process, every)
    assert process.returncode != 0
    assert " ".join(stderr.split()).count("exited on signal 9") == 1, stderr  # Open MPI 5 breaks its lines
    table = (tmp_path / "series.csv").read_text()
    assert len({line.count(",") for line in table.splitlines()}) == 1
    checkpoint = min(tmp_path.glob("checkpoints/*.h5"))
    if int(checkpoint.stem[-9:]) < END:
        assert_resumes(tmp_path, through)
