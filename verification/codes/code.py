"""A code: a program that speaks the protocol (verification/protocol/README.md), asked what it is, and run."""

import functools
import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from verification.protocol.adapter import BAD_INPUT, CANNOT
from verification.protocol.capability import CAPABILITIES
from verification.protocol.check import check_run
from verification.protocol.errors import Beyond, CaseError, Killed, SolverError, last_line
from verification.protocol.machine import ROOT
from verification.protocol.run import Run
from verification.protocol.sources import checksum_of_sources, sources_of

FOLDER = Path(__file__).resolve().parent
SPEAKS = re.compile(r'^if __name__ == "__main__":$', re.MULTILINE)
OWN = ("reference", "verification.codes")  # packages that the results of an adapter may depend on
SILENT = "it said nothing"
PATIENCE = 60.0  # seconds that describe may take; a run has a tenth of it to end when told to


@dataclass(frozen=True)
class Code:
    """What a program says that it is."""

    name: str
    title: str  # for people
    program: tuple[str, ...]  # the command line that speaks the protocol
    version: str
    capabilities: frozenset[str]
    missing: str = ""  # what is not installed, and how to get it
    numerics_version: int | None = None
    speed_options: frozenset[str] = frozenset()  # change the speed of a code with digests, and no bit
    adapter: str = ""  # SHA-256 of the adapter's source, and of the modules of this repository that it imports


def all_codes() -> list[str]:
    """Names of the codes that have an adapter here; runs nothing."""
    return sorted(file.stem.replace("_", "-") for file in FOLDER.glob("*.py") if SPEAKS.search(file.read_text()))


def find_code(name_or_path: str | Path) -> Code:
    """One of all_codes(), or the path of an executable or of a .py file, which this interpreter runs. Throws CaseError."""
    program, file = _program(str(name_or_path))
    adapter = checksum_of_sources(sources_of((file,), OWN))
    said = _described(program, adapter, os.environ.get("MAPPM_BUILD", ""))
    if file.parent == FOLDER and said["name"] != str(name_or_path):
        raise CaseError(f"{file} describe: name = {said['name']!r}: must be that of its file, {name_or_path}")
    return Code(said["name"], said.get("title", said["name"]), program, said["version"], frozenset(said["capabilities"]), said["missing"],
                said.get("numerics_version"), frozenset(said.get("speed_options", ())), adapter)


def _program(name: str) -> tuple[tuple[str, ...], Path]:
    """The command line, and the file that it runs."""
    if name in all_codes():
        module = name.replace("-", "_")
        return (sys.executable, "-m", f"verification.codes.{module}"), FOLDER / f"{module}.py"
    file = Path(name).resolve()
    if not file.is_file():
        raise CaseError(f"code {name}: unknown; give one of {', '.join(all_codes())}, or the path of an executable or a .py file")
    if file.suffix == ".py":
        return (sys.executable, str(file)), file
    if not os.access(file, os.X_OK):
        raise CaseError(f"code {name}: cannot be executed; chmod +x, or give a .py file")
    return (str(file),), file


def _environment() -> dict[str, str]:
    """In which an adapter anywhere can import this repository."""
    return os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")]))}


@functools.cache
def _described(program: tuple[str, ...], adapter: str, build: str) -> dict:
    """What `describe` says, checked; asked once for an adapter and a build of MaPPM. Throws CaseError."""
    line = f"{' '.join(program)} describe"
    try:
        done = subprocess.run([*program, "describe"], env=_environment(), capture_output=True, text=True, timeout=PATIENCE)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise CaseError(f"{line}: {error}") from None
    if done.returncode != 0:
        raise CaseError(f"{line}: ended with {done.returncode}: {last_line(done.stderr) or SILENT}")
    try:
        said = json.loads(done.stdout)
    except ValueError as error:
        raise CaseError(f"{line}: no JSON ({error}): {done.stdout[:80]!r}; print one JSON object and nothing else") from None
    if fault := _fault(said):
        raise CaseError(f"{line}: {fault}")
    return said


def _fault(said: object) -> str:
    """What is wrong with a description; empty where nothing is."""
    if not isinstance(said, dict):
        return "must print one JSON object"
    for key, kind in (("name", str), ("version", str), ("capabilities", list), ("missing", str)):
        if key not in said:
            return f"{key}: missing; add it"
        if not isinstance(said[key], kind):
            return f"{key} = {said[key]!r}: must be a {'list' if kind is list else 'text'}"
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9._-]*", said["name"]):
        return f"name = {said['name']!r}: must be a short word"
    unknown = [word for word in said["capabilities"] if word not in CAPABILITIES]
    if unknown:
        return f"capabilities: {', '.join(map(str, unknown))}: unknown; known are {', '.join(CAPABILITIES)}"
    if not said["version"] and not said["missing"]:
        return "version: empty, though nothing is missing"
    number = said.get("numerics_version")
    if number is not None and (not isinstance(number, int) or isinstance(number, bool)):
        return f"numerics_version = {number!r}: must be an integer"
    return ""


def command(code: Code, scene_file: Path, out: Path, cores: int = 1, steps: int | None = None,
            options: Mapping[str, str] | None = None) -> list[str]:
    """The line that run_code runs."""
    line = [*code.program, "run", "--scene", str(scene_file), "--out", str(out), "--cores", str(cores)]
    line += [] if steps is None else ["--steps", str(steps)]
    for key, value in (options or {}).items():
        line += ["--option", f"{key}={value}"]
    return line


def _end(process: subprocess.Popen) -> None:
    """Ends a program and all that it started."""
    for how in (signal.SIGTERM, signal.SIGKILL):
        try:
            os.killpg(process.pid, how)
            process.wait(PATIENCE / 10)
        except ProcessLookupError:
            return
        except subprocess.TimeoutExpired:
            continue


_RUNNING: set[subprocess.Popen] = set()


def end_all() -> None:
    """Ends all programs that run now, of all threads: their calls return with the status of a killed program."""
    for process in list(_RUNNING):
        _end(process)


def call(line: list[str]) -> tuple[int, str, str]:
    """Runs a line in a session of its own, which ends when this one is interrupted: (exit status, stdout, stderr)."""
    process = subprocess.Popen(line, env=_environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               start_new_session=True)
    _RUNNING.add(process)
    try:
        stdout, stderr = process.communicate()
    except BaseException:
        _end(process)
        raise
    finally:
        _RUNNING.discard(process)
    return process.returncode, stdout, stderr


def run_code(code: Code, scene_file: Path, out: Path, cores: int = 1, steps: int | None = None,
             options: Mapping[str, str] | None = None) -> Run:
    """Runs a scene into the folder `out`, which may not hold anything, and checks what was left.

    Throws Beyond where the code cannot do the scene, CaseError where it cannot use its input, SolverError with its last
    words where it failed (Killed where a signal ended it), and OutputError where its files are not those of the protocol.
    """
    if out.exists() and any(out.iterdir()):
        raise CaseError(f"--out {out}: holds files; give a folder that is empty")
    out.mkdir(parents=True, exist_ok=True)
    line = command(code, scene_file, out, cores, steps, options)
    status, stdout, stderr = call(line)
    if status == BAD_INPUT:
        raise CaseError(last_line(stderr) or SILENT)
    if status == CANNOT:
        raise Beyond(last_line(stderr) or SILENT)
    if status != 0:
        raise (Killed if status < 0 else SolverError)(f"{' '.join(line)}\nended with {status}\n{stdout[-2000:]}{stderr[-4000:]}")
    check_run(out, code.capabilities)
    return Run(out)
