"""A folder that holds a store and the folders of its runs; gets a run from it, or makes it.

    FOLDER/store.sqlite     the store
    FOLDER/runs/KEY         what a run left, which may be removed: what counts is in the store
"""

import fcntl
import json
import os
import shutil
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory

from verification.codes.code import Code, run_code
from verification.protocol.capability import EXACT_LEDGER
from verification.protocol.errors import StoreError
from verification.protocol.ledger import defects_of
from verification.protocol.machine import commit, cores, processor
from verification.protocol.run import Run
from verification.protocol.toml_text import scene_text
from verification.store.keep import kept_of
from verification.store.key import run_key
from verification.store.store import Cost, Ledger, Made, Store, StoredRun

STORE = "store.sqlite"


def made_now(command: str = "", source: str | None = None) -> Made:
    return Made(f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%S.%fZ}", f"{processor()}, {cores()} cores",
                commit() if source is None else source, command)


@dataclass(frozen=True)
class Request:
    """A run that is wanted."""

    code: Code
    scene: dict
    label: str
    steps: int | None = None  # None: to its end
    options: Mapping[str, str] = field(default_factory=dict)  # of the code
    cores: int = 1
    field: bool = False  # keep the last snapshot

    @cached_property
    def key(self) -> str:
        return run_key(self.code, self.scene, self.steps, self.options, self.cores)


def cost_of(record: dict) -> Cost:
    return Cost(**{name: record["cost"][name] for name in Cost.__dataclass_fields__})


def plain(scene: Mapping) -> dict:
    """Without the manifest of the case."""
    return {key: value for key, value in scene.items() if key != "case"}


class Laboratory:
    def __init__(self, folder: Path):
        self.folder = folder
        try:
            (folder / "runs").mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise StoreError(f"{folder}: {error.strerror}; name another folder with --lab") from None
        self.store = Store(folder / STORE)

    def run_folder(self, key: str) -> Path:
        return self.folder / "runs" / key

    def run(self, key: str) -> Run | None:
        """What the run left, if its folder is still there: it has that name only where it is whole."""
        folder = self.run_folder(key)
        return Run(folder) if folder.exists() else None

    @contextmanager
    def kept(self, key: str) -> Iterator[Run]:
        """What the store kept of a run, laid out as a run's folder for as long as the context lasts."""
        stored = self.store.run(key)
        with TemporaryDirectory() as scratch:
            for name, data in self.store.files(key).items():
                file = Path(scratch) / name
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_bytes(data)
            record = stored.record | {"scene": {"text": scene_text(stored.scene)}}
            (Path(scratch) / "run.json").write_text(json.dumps(record))
            yield Run(Path(scratch))

    @contextmanager
    def _alone_at(self, key: str) -> Iterator[None]:
        """One process, and one thread of it, at a time for a run. A kill frees the lock."""
        descriptor = os.open(self.folder / "runs" / f"{key}.lock", os.O_CREAT | os.O_RDWR)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX)
            yield
        finally:
            os.close(descriptor)

    def obtain(self, request: Request, anew: bool = False, folder_too: bool = False) -> StoredRun:
        """From the store, or made now. `anew`: made in any case. `folder_too`: made where its folder is gone.

        Throws SolverError, CaseError, Beyond of the code, and StoreError.
        """
        key = request.key
        with self._alone_at(key):
            known = self.store.run(key)
            if known is not None and not anew and not (folder_too and self.run(key) is None):
                self._keep_field(request)
                return known
            return self._make(request, known)

    def _keep_field(self, request: Request) -> None:
        """Of a run that was first made without, while its folder is there."""
        run = self.run(request.key) if request.field else None
        if run is not None and not any(name.startswith("snapshots/") for name in self.store.files(request.key)):
            self.store.enter_files(request.key, kept_of(run, True))

    def _make(self, request: Request, known: StoredRun | None) -> StoredRun:
        folder, part = self.run_folder(request.key), self.run_folder(f"{request.key}.{os.getpid()}-{time.monotonic_ns()}.part")
        for left in (self.folder / "runs").glob(f"{request.key}.*.part"):  # by one that was killed: whoever is here is alone
            shutil.rmtree(left, ignore_errors=True)
        part.mkdir(parents=True)
        try:
            scene_file = part / "scene.toml"
            scene_file.write_text(scene_text(request.scene))
            run = run_code(request.code, scene_file, part / "out", request.cores, request.steps, dict(request.options))
            stored = self._stored(request, run, part)
            self._compare(request, stored, known)
            shutil.rmtree(folder, ignore_errors=True)
            run.folder.replace(folder)
        finally:
            shutil.rmtree(part, ignore_errors=True)
        self.store.enter(stored, kept_of(Run(folder), request.field))
        return stored

    @staticmethod
    def _compare(request: Request, stored: StoredRun, known: StoredRun | None) -> None:
        """Throws StoreError where the same run gave another digest before."""
        if known is not None and known.record.get("digest") != stored.record.get("digest"):
            raise StoreError(
                f"{request.label}: the digest is {stored.record.get('digest')}, and was {known.record.get('digest')} at "
                f"{known.made.source}: results changed without a new numerics version of {request.code.name}; raise that version, "
                f"or remove what is stale with `store prune`")

    @staticmethod
    def _stored(request: Request, run: Run, part: Path) -> StoredRun:
        """Its command names the scene and the folder relative to where it ran."""
        record = {name: value for name, value in run.record.items() if name != "scene"}
        record["command"] = record["command"].replace(f"{part}/", "")
        ledger = None
        if EXACT_LEDGER in request.code.capabilities:
            ledger = Ledger(*defects_of(run))
        made = made_now(record["command"], record.get("commit"))
        return StoredRun(request.key, request.label, request.code.name, request.code.version, request.code.numerics_version,
                         plain(request.scene), request.steps, dict(request.options), record, made, ledger, cost_of(record))

    def drop_folders(self) -> int:
        """Removes the folders of all runs; returns the bytes that came free."""
        freed = 0
        for path in (self.folder / "runs").iterdir():
            if path.is_dir():
                freed += sum(file.stat().st_size for file in path.rglob("*") if file.is_file())
                shutil.rmtree(path)
        return freed
