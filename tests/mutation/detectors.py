"""What can catch a fault: a case, an equality of bits or a test, named by one line of the manifest.

    case NAME [KEY=VALUE ...]              the judge's verdicts on a case; with overrides, if only of a value by
                                           itself, the scene alone without its levels, which is cheap
    bits SCENE RANKS STEPS [DOMAINS]       digests of the parallel solver and the serial reference at ten samples;
                                           SCENE is a folder of cases/
    pytest FILE::TEST                      of tests/python
    gtest FILE FILTER                      of tests/unit/FILE.cpp
    mpi FILE FILTER RANKS                  of tests/mpi/FILE.cpp
"""

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from tests.mutation.manifest import ROOT, ManifestError
from tests.mutation.tree import BUILD
from verification.codes.mappm import MPI_ENVIRONMENT

# Number of words after the kind: least and most.
KINDS = {"case": (1, 99), "bits": (3, 4), "pytest": (1, 1), "gtest": (2, 2), "mpi": (3, 3)}
# Exit codes that say "failed", apart from death by a signal; any other is trouble of the detector's own.
FAILED = {"case": {1}, "bits": {1}, "pytest": {1}, "gtest": {1}, "mpi": set(range(1, 256))}
FOLDERS = re.compile(r"(?<![\w.])/(?:[^\s/'\":]+/)+")  # of this machine, before the name of a file
# The line that says why, most telling first.
REASONS = (r"^E  +(.*)", r"(.*[,;] (?:FAILED|INCONCLUSIVE|NOT CONVERGING|DIVERGING|CHANGED).*)", r"^(first difference.*)",
           r"^(rank \d+: .*)", r"^error: (.*)", r"(.*: Failure)", r"^(verification: .*)", r"^(\w*Error.*)", r"(.+)")


@dataclass(frozen=True)
class Detector:
    text: str

    @property
    def words(self) -> list[str]:
        return self.text.split()

    @property
    def kind(self) -> str:
        return self.words[0]

    def check(self) -> None:
        least, most = KINDS.get(self.kind, (1, 0))
        if not least <= len(self.words) - 1 <= most:
            raise ManifestError(f"{self.text!r} is no detector; see detectors.py")

    @property
    def test_file(self) -> str | None:
        """The C++ test that the mutated build must have."""
        folder = {"gtest": "unit", "mpi": "mpi"}.get(self.kind)
        return f"tests/{folder}/{self.words[1]}.cpp" if folder else None

    @property
    def targets(self) -> set[str]:
        """What must be built for it."""
        programs = {"gtest": {"mappm-unit-tests"}, "mpi": {"mappm-mpi-tests"}}
        return programs.get(self.kind, {"mappm", "mappm-reference"})

    def command(self, folder: Path) -> list[str]:
        words = self.words[1:]
        match self.kind:
            case "case":
                overrides = [word for setting in words[1:] for word in ("--set", setting)]
                return [sys.executable, "-m", "verification", "run", words[0], "--lab", f"{folder}/run", *overrides]
            case "bits":
                return [sys.executable, "-m", "tests.mutation.bits", f"{folder}/run", *words]
            case "pytest":
                return [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "--basetemp",
                        f"{folder}/run", f"tests/python/{words[0]}"]
            case "gtest":
                return [f"{BUILD}/bin/mappm-unit-tests", f"--gtest_filter={words[1]}", "--gtest_brief=1"]
            case _:
                return ["mpirun", "-np", words[2], f"{BUILD}/bin/mappm-mpi-tests", f"--gtest_filter={words[1]}"]


@dataclass(frozen=True)
class Result:
    """How a detector ended: `failed` is what counts as catching; `trouble` neither passed nor failed."""

    failed: bool
    trouble: bool
    message: str
    seconds: float

    @property
    def passed(self) -> bool:
        return not self.failed and not self.trouble


def first_reason(kind: str, output: str) -> str:
    for pattern in REASONS:
        found = re.search(pattern, output, re.MULTILINE)
        if found:
            line = found[1]
            after = output[found.end() :].split("\n")[1:2] if kind in ("gtest", "mpi") else []
            return FOLDERS.sub("", " ".join([line, *after]).replace(f"{ROOT}/", "")).strip()[:200]
    return "no message"


def run_detector(detector: Detector, number: int | None, tree: Path, timeout: float, hang: bool = False) -> Result:
    """With the fault of that number awake, or none; `tree`: where the Python part lies."""
    environment = os.environ | MPI_ENVIRONMENT | {"MAPPM_BUILD": str(BUILD), "PYTHONPATH": str(tree),
                                                  "PYTHONDONTWRITEBYTECODE": "1"}
    for name in ("MAPPM_MUTANT", "MAPPM_CASES"):
        environment.pop(name, None)
    if number is not None:
        environment["MAPPM_MUTANT"] = str(number)
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        process = subprocess.Popen(detector.command(Path(folder)), cwd=tree, env=environment, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
        try:
            output, _ = process.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            return Result(hang, not hang, f"did not end within {timeout:.0f} s", time.monotonic() - began)
    seconds, code = time.monotonic() - began, process.returncode
    if code == 0 and not re.search(r"PASSED\s+\] 0 tests", output):
        return Result(False, False, "", seconds)
    failed = code < 0 or code in FAILED[detector.kind]
    message = first_reason(detector.kind, output) if code >= 0 else f"died of {signal.Signals(-code).name}"
    return Result(failed, not failed, message if code else "no such test", seconds)
