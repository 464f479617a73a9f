"""What adapters in Python share: the command line of the protocol, cost, and run.json. See README.md of this folder.

    class Toy(Adapter):
        name, capabilities = "toy", frozenset({FLUID})
        def version(self): return "1"
        def run(self, task): ...; return Left()

    if __name__ == "__main__":
        sys.exit(main(Toy()))
"""

import argparse
import json
import resource
import shlex
import sys
import time
import tomllib
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path

from verification.protocol.capability import CAPABILITIES, asked_by, lacking
from verification.protocol.quantity import Quantity
from verification.protocol.scene import fault_of

BAD_INPUT, CANNOT, FAILED = 2, 3, 1  # exit statuses


class BadInput(ValueError):
    """Input that a user can mend: names the key, the value and the fix."""


class Cannot(ValueError):
    """A scene that is beyond this code: says why, one sentence."""


class Failed(RuntimeError):
    """The code ended with an error: its own message."""


@dataclass(frozen=True)
class Task:
    """What `run` was asked for."""

    file: Path
    scene: dict
    out: Path  # exists
    cores: int = 1
    steps: int | None = None
    options: Mapping[str, str] = field(default_factory=dict)

    def option(self, key: str, default: str = "") -> str:
        return self.options.get(key, default)


@dataclass(frozen=True)
class Left:
    """What a run tells beside its series and fields."""

    quantities: dict[str, Quantity] = field(default_factory=dict)
    objection: str = ""
    digest: str = ""
    setup_core_seconds: float = 0.0  # of them all
    more: dict = field(default_factory=dict)  # further keys of run.json


class Adapter(ABC):
    """A code behind the protocol."""

    name: str
    capabilities: frozenset[str]
    title: str = ""  # as its authors write it; by default the name
    speed_options: tuple[str, ...] = ()  # of a code with digests: those that change its speed and no bit

    @abstractmethod
    def version(self) -> str:
        """Of the code; only called where nothing is missing."""

    @abstractmethod
    def run(self, task: Task) -> Left:
        """Leaves series and fields in task.out. Throws BadInput, Cannot or Failed."""

    def missing(self) -> str:
        """What is not installed, and the line that installs it; empty where all is there."""
        return ""

    def numerics_version(self) -> int | None:
        return None


def describe(adapter: Adapter) -> dict:
    unknown = adapter.capabilities - set(CAPABILITIES)
    if unknown:
        raise ValueError(f"{adapter.name}: capabilities {', '.join(sorted(unknown))}: unknown; known are {', '.join(CAPABILITIES)}")
    missing = adapter.missing()
    found = {"name": adapter.name, "title": adapter.title or adapter.name, "version": "" if missing else adapter.version(),
             "capabilities": [word for word in CAPABILITIES if word in adapter.capabilities],
             "speed_options": list(adapter.speed_options), "missing": missing}
    number = None if missing else adapter.numerics_version()
    return found if number is None else found | {"numerics_version": number}


def _core_seconds_of(who: int) -> float:
    used = resource.getrusage(who)
    return used.ru_utime + used.ru_stime


def core_seconds_of_children() -> float:
    """Of the programs that ended so far."""
    return _core_seconds_of(resource.RUSAGE_CHILDREN)


def _core_seconds() -> float:
    return _core_seconds_of(resource.RUSAGE_SELF) + core_seconds_of_children()


def _peak_memory() -> int:
    """Bytes: the larger of this process and of the largest of those that it waited for."""
    return 1024 * max(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def _options(pairs: list[str]) -> dict[str, str]:
    for pair in pairs:
        if "=" not in pair:
            raise BadInput(f"--option {pair}: write KEY=VALUE")
    return dict(pair.split("=", 1) for pair in pairs)


def _task(chosen: argparse.Namespace) -> Task:
    """Throws BadInput."""
    for name in ("cores", "steps"):
        value = getattr(chosen, name)
        if value is not None and value < 1:
            raise BadInput(f"--{name} {value}: must be at least 1")
    try:
        scene = tomllib.loads(chosen.scene.read_text())
    except OSError as error:
        raise BadInput(f"--scene {chosen.scene}: {error.strerror}; give the file of a scene") from None
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"--scene {chosen.scene}: no TOML: {error}") from None
    if fault := fault_of(scene):
        raise BadInput(f"{chosen.scene}: {fault}")
    return Task(chosen.scene, scene, chosen.out, chosen.cores, chosen.steps, _options(chosen.option))


def _run(adapter: Adapter, task: Task, command: str) -> None:
    """Runs and writes run.json. Throws BadInput, Cannot or Failed."""
    if missing := adapter.missing():
        raise Cannot(missing)
    if words := lacking(adapter.capabilities, asked_by(task.scene)):
        raise Cannot(f"{adapter.name} lacks {', '.join(words)}")
    task.out.mkdir(parents=True, exist_ok=True)
    began, used = time.monotonic(), _core_seconds()
    left = adapter.run(task)
    whole = _core_seconds() - used
    cost = {"core_seconds": max(0.0, whole - left.setup_core_seconds), "setup_core_seconds": left.setup_core_seconds,
            "wall_seconds": time.monotonic() - began, "cores": task.cores, "peak_memory": _peak_memory()}
    record = left.more | {
        "code": adapter.name, "version": adapter.version(), "command": command,
        "scene": left.more.get("scene", {}) | {"text": task.file.read_text()}, "cost": cost,
        "quantities": {name: asdict(value) for name, value in left.quantities.items()}, "objection": left.objection,
    }
    if left.digest:
        record["digest"] = left.digest
    part = task.out / "run.json.part"
    part.write_text(json.dumps(record, indent=1) + "\n")
    part.replace(task.out / "run.json")


def main(adapter: Adapter, given: list[str] | None = None) -> int:
    """The command line of an adapter; returns its exit status."""
    parser = argparse.ArgumentParser(prog=adapter.name)
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("describe", help="what this code is and can do, as JSON")
    one = commands.add_parser("run", help="run a scene")
    one.add_argument("--scene", type=Path, required=True)
    one.add_argument("--out", type=Path, required=True, help="folder of the files that the run leaves")
    one.add_argument("--cores", type=int, default=1)
    one.add_argument("--steps", type=int, help="of the code's own; by default to the end of the scene")
    one.add_argument("--option", action="append", default=[], metavar="KEY=VALUE", help="of this code alone")
    arguments = sys.argv[1:] if given is None else given
    chosen = parser.parse_args(arguments)
    if chosen.command == "describe":
        print(json.dumps(describe(adapter), indent=1))
        return 0
    try:
        _run(adapter, _task(chosen), shlex.join([adapter.name, *arguments]))
    except (BadInput, Cannot, Failed) as error:
        print(f"{adapter.name}: {error}", file=sys.stderr)
        return {BadInput: BAD_INPUT, Cannot: CANNOT, Failed: FAILED}[type(error)]
    return 0
