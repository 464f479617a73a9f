"""The store and the laboratory. Oracles: runs entered here, files broken here, and a code that counts its calls."""

import errno
import json
import math
import os
import sqlite3
import subprocess
import sys
import textwrap
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest
from tiny_code import SCENE, Tiny, tiny

from verification.codes.code import find_code
from verification.measures.source import measure_id
from verification.protocol.errors import Beyond, StoreError
from verification.protocol.machine import ROOT
from verification.protocol.quantity import Measured
from verification.protocol.sources import sources_of
from verification.store.commands import prune
from verification.store.export import export, import_into
from verification.store.key import canonical, canonical_scene, hash_of, run_key
from verification.store.laboratory import Laboratory, Request
from verification.store.store import Cost, Figure, Found, Ledger, Made, Store, StoredRun
from verification.suite.case import Case
from verification.suite.manifest import read_cases
from verification.suite.result import collect
from verification.suite.runner import jobs_of, look_up, obtain, perform
from verification.suite.stale import stale_of

EXACT_BITS = ("fluid", "exact-ledger", "digest")
MADE = Made("2024-01-02T03:04:05Z", "a machine, 2 cores", "abc", "a command")
COST = Cost(1.5, 0.25, 2.0, 1, 4096)


def a_run(key: str, digest: str = "00ff", **changed) -> StoredRun:
    return replace(StoredRun(key, f"label of {key}", "mappm", "1.0", 2, {"box": {"size": [1.0, 1.0]}}, None, {"problem": "drag"},
                             {"digest": digest, "cost": {}}, MADE, Ledger(3, ("a defect",)), COST), **changed)


@pytest.fixture
def store(tmp_path: Path) -> Store:
    return Store(tmp_path / "store.sqlite")

# --- what is entered is there


def test_a_run_comes_back_as_it_was_entered(store: Store, tmp_path: Path) -> None:
    store.enter(a_run("a"), {"series.csv": b"time\n0\n"})
    again = Store(tmp_path / "store.sqlite")
    assert again.run("a") == a_run("a", made=replace(MADE))
    assert again.files("a") == {"series.csv": b"time\n0\n"}
    assert again.run("b") is None and [run.key for run in again.runs("mappm")] == ["a"] and again.runs("exact") == []


def test_not_a_number_and_infinity_come_back(store: Store, tmp_path: Path) -> None:
    store.enter(a_run("a"))
    store.enter_found("a", "m", Found({"x": Measured(math.nan, math.inf, "not settled"), "y": Measured(-0.1, 1e-300)}))
    export(store, tmp_path / "store.jsonl")
    other = Store(":memory:")
    import_into(other, tmp_path / "store.jsonl")
    for one in (store, other):
        found = one.found("a", "m").values
        assert math.isnan(found["x"].value) and found["x"].uncertainty == math.inf and found["x"].objection == "not settled"
        assert found["y"] == Measured(-0.1, 1e-300)


def test_values_of_another_measure_are_not_found(store: Store) -> None:
    store.enter(a_run("a"))
    store.enter_found("a", "old", Found({"x": Measured(1.0, 0.0)}, {"own": [{"title": "t"}]}))
    assert store.found("a", "new") == Found()
    assert store.found("a", "old").charts == {"own": [{"title": "t"}]}
    assert store.all_found("a") == [("old", "x", Measured(1.0, 0.0))]


def test_what_was_measured_of_other_bits_goes_with_them(store: Store) -> None:
    for digest, values in (("00ff", {"x": Measured(1.0, 0.0)}), ("00fe", {})):
        store.enter(a_run("a"))
        store.enter_found("a", "m", Found({"x": Measured(1.0, 0.0)}, {"own": []}))
        store.enter(a_run("a", digest))
        assert store.found("a", "m") == Found(values, {"own": []} if values else {})


def test_repeats_are_rows_of_their_own(store: Store) -> None:
    store.enter(a_run("a"))
    later = replace(MADE, made="2024-01-03T00:00:00Z")
    store.enter_cost("a", replace(COST, cores=2), later)
    assert [(made.made, cost.cores) for made, cost in store.costs("a")] == [(MADE.made, 1), (later.made, 2)]


def test_figures_of_a_benchmark_replace_its_earlier_ones(store: Store) -> None:
    def figures(bench: str, count: int) -> list[Figure]:
        return [Figure(bench, {"ranks": i}, "rate", float(i), MADE, "1/s") for i in range(count)]

    for bench, count in (("speed", 3), ("scaling", 2), ("speed", 1)):
        store.enter_figures(figures(bench, count))
    assert store.figures("speed") == figures("speed", 1) and store.figures() == figures("scaling", 2) + figures("speed", 1)


def test_a_run_is_removed_with_all_that_was_measured_of_it(store: Store) -> None:
    for key in "ab":
        store.enter(a_run(key), {"series.csv": b"x"})
        store.enter_found(key, "m", Found({"x": Measured(1.0, 0.0)}))
    assert store.remove(["a", "no such key"]) == 1
    assert [run.key for run in store.runs()] == ["b"]
    assert store.files("a") == {} and store.all_found("a") == [] and store.costs("a") == []
    assert len(store.all_found("b")) == 1

# --- whole or not at all


def test_a_run_is_entered_whole_or_not_at_all(store: Store) -> None:
    store.enter(a_run("a"), {"series.csv": b"old"})
    with pytest.raises(TypeError):
        store.enter(a_run("a", label="new", cost=replace(COST, cores=2)), {"series.csv": b"new", "b": None})
    with pytest.raises(AttributeError):
        store.enter_found("a", "m", Found({"x": Measured(1.0, 0.0), "y": None}))
    assert store.run("a") == a_run("a") and store.files("a") == {"series.csv": b"old"} and store.found("a", "m") == Found()
    store.enter(a_run("b"))  # the store is not left locked


def limited(store: Store, more_pages: int) -> None:
    """As on a disk on which there is no more room than that."""
    (pages,) = store._connection.execute("PRAGMA page_count").fetchone()
    store._connection.execute(f"PRAGMA max_page_count = {pages + more_pages}")


def test_a_full_disk_loses_nothing_that_was_there(store: Store, tmp_path: Path) -> None:
    store.enter(a_run("a"), {"series.csv": b"old"})
    limited(store, 4)
    with pytest.raises(StoreError, match="database or disk is full; free some space and go on: nothing that it held is lost"):
        store.enter(a_run("b"), {"field": bytes(i * i % 251 * i % 256 for i in range(300_000))})
    for one in (store, Store(tmp_path / "store.sqlite")):
        assert [run.key for run in one.runs()] == ["a"] and one.files("a") == {"series.csv": b"old"} and one.files("b") == {}
    limited(store, 10_000)
    store.enter(a_run("b"), {"field": b"x"})
    assert store.files("b") == {"field": b"x"}


ENTERS = """
import sys
from pathlib import Path
sys.path.insert(0, "tests/python")
from unit_store import a_run
from verification.store.store import Store
store = Store(Path(sys.argv[1]))
for i in range(40):
    store.enter(a_run(f"{sys.argv[2]}{i}"), {"series.csv": sys.argv[2].encode() * 1000})
"""


def test_processes_share_a_store_from_its_first_moment(tmp_path: Path) -> None:
    file = tmp_path / "store.sqlite"
    lines = [[sys.executable, "-c", ENTERS, str(file), name] for name in "pq"]
    processes = [subprocess.Popen(line, cwd=ROOT, stderr=subprocess.PIPE, text=True) for line in lines]
    assert [(process.communicate()[1], process.returncode) for process in processes] == [("", 0), ("", 0)]
    store = Store(file)
    assert {run.key for run in store.runs()} == {f"{name}{i}" for name in "pq" for i in range(40)}
    assert store.files("q39") == {"series.csv": b"q" * 1000}

# --- files that are no store


def test_a_database_of_something_else_is_named_and_left_alone(tmp_path: Path) -> None:
    file = tmp_path / "other.sqlite"
    with sqlite3.connect(file) as other:
        other.execute("CREATE TABLE people (name TEXT)")
    with pytest.raises(StoreError, match="other.sqlite: is a database of something else; name another file"):
        Store(file)
    assert sqlite3.connect(file).execute("SELECT name FROM sqlite_master").fetchall() == [("people",)]


def test_a_store_of_another_format_is_named(store: Store, tmp_path: Path) -> None:
    store._connection.execute("PRAGMA user_version = 7")
    with pytest.raises(StoreError, match="is a store of format 7, and this program writes format 2; export it"):
        Store(tmp_path / "store.sqlite")


def test_a_store_of_the_first_format_is_brought_up_to_date_and_loses_nothing(tmp_path: Path) -> None:
    """There a figure had no range over rounds."""
    file = tmp_path / "old.sqlite"
    made = Made("2026-11-30T12:00:00Z", "machine", "abc", "command")
    Store(file).enter_figures([Figure("speed", {"ranks": 1}, "rate", 2.0, made, "1/s")])
    with sqlite3.connect(file) as old:
        for column in ("low", "high"):
            old.execute(f"ALTER TABLE figures DROP COLUMN {column}")
        old.execute("PRAGMA user_version = 1")
    for _ in range(2):
        assert Store(file).figures() == [Figure("speed", {"ranks": 1}, "rate", 2.0, made, "1/s")]
    Store(file).enter_figures([Figure("speed", {"ranks": 1}, "rate", 2.0, made, "1/s", 1.5, 2.5)])
    assert Store(file).figures()[0].high == 2.5


def test_an_export_names_no_folder_of_the_machine_that_made_it(full: Store, tmp_path: Path) -> None:
    folder = "/home/somebody/runs/runs/0123456789abcdef01234567.12-34.part"
    full.enter_refusal("key", "label", "code", f"solver --scene {folder}/scene.toml --out {folder}/out: failed in '{folder}'")
    export(full, tmp_path / "store.jsonl")
    (line,) = [line for line in (tmp_path / "store.jsonl").read_text().splitlines() if "solver --scene" in line]
    assert "solver --scene scene.toml --out out: failed in ''" in line


def test_an_export_of_the_first_format_is_read(full: Store, tmp_path: Path) -> None:
    file, other = tmp_path / "store.jsonl", Store(":memory:")
    rows = export(full, file)
    file.write_text(file.read_text().replace('"format":2', '"format":1', 1))
    assert import_into(other, file) == rows


def test_a_file_that_is_no_database_is_named_and_left_alone(tmp_path: Path) -> None:
    file = tmp_path / "notes.txt"
    file.write_text("what I have to do\n" * 100)
    with pytest.raises(StoreError, match="notes.txt: file is not a database; move it aside, and make it anew or from an export"):
        Store(file)
    assert file.read_text().startswith("what I have to do")


def test_the_command_line_tells_a_broken_store_in_a_line(tmp_path: Path) -> None:
    (tmp_path / "store.sqlite").write_text("no database at all, but long enough to be taken for something" * 100)
    done = subprocess.run([sys.executable, "-m", "verification", "store", "list", "--lab", str(tmp_path)], cwd=ROOT,
                          capture_output=True, text=True)
    assert (done.returncode, done.stderr.count("\n")) == (1, 1) and "file is not a database; move it aside" in done.stderr

# --- the export


@pytest.fixture
def full(store: Store) -> Store:
    """With a row of every kind."""
    for key in "ab":
        store.enter(a_run(key), {"series.csv": b"x"})
        store.enter_found(key, "m", Found({"x": Measured(math.nan, 0.0)}, {"own": []}))
    store.enter_matrix("c", "bits", {"rows": [1, 2]}, replace(MADE, command=""))
    store.enter_refusal("d", "label", "exact", "no exact solution")
    store.enter_figures([Figure("speed", {"ranks": 2}, "rate", 1.5, MADE, "1/s")])
    return store


def test_an_export_brings_all_rows_into_another_store_once(full: Store, tmp_path: Path) -> None:
    file, other = tmp_path / "store.jsonl", Store(":memory:")
    rows = export(full, file)
    assert rows == 2 + 2 + 2 + 1 + 1 + 1  # runs, values, costs, bits, refusals, figures
    assert import_into(other, file) == rows and import_into(other, file) == 0
    assert list(other.tables()) == list(full.tables()) and other.run("a") == full.run("a")
    assert other.matrix("c") == full.matrix("c") and other.refusal("d") == "no exact solution" and other.figures() == full.figures()
    assert other.files("a") == {} and other.found("a", "m").charts == {}


def test_an_export_is_the_same_in_whatever_order_runs_were_entered(tmp_path: Path) -> None:
    for name, keys in (("one", "abc"), ("other", "cab")):
        store = Store(":memory:")
        for key in keys:
            store.enter(a_run(key))
        export(store, tmp_path / name)
    assert (tmp_path / "one").read_text() == (tmp_path / "other").read_text()


def test_what_a_store_has_stays_where_an_export_says_otherwise(full: Store, tmp_path: Path) -> None:
    export(full, tmp_path / "store.jsonl")
    other = Store(":memory:")
    other.enter(a_run("a", label="mine"))
    import_into(other, tmp_path / "store.jsonl")
    assert other.run("a").label == "mine" and other.run("b").label == "label of b"


def test_a_run_with_another_digest_is_not_imported(full: Store, tmp_path: Path) -> None:
    export(full, tmp_path / "store.jsonl")
    other = Store(":memory:")
    other.enter(a_run("a", "beef"))
    before = list(other.tables())
    with pytest.raises(StoreError, match="the digest is another one here.*Nothing was entered"):
        import_into(other, tmp_path / "store.jsonl")
    assert list(other.tables()) == before


def with_last(text: str, line: str) -> str:
    """With another last line."""
    return "\n".join([*text.splitlines()[:-1], line]) + "\n"


@pytest.mark.parametrize(("change", "words"), [
    (lambda text: text[: len(text) // 2], r"store.jsonl:\d+: .*cut off: take it again"),
    (lambda text: "", "store.jsonl:1: .*no export of a store"),
    (lambda text: "\n".join(text.splitlines()[1:]), "store.jsonl:1: the first line is not"),
    (lambda text: text.replace('"format":2', '"format":3'), "the first line is not"),
    (lambda text: "\n".join(text.splitlines()[:-1]) + "\n", "of so many rows as follow"),
    (lambda text: with_last(text, '{"runs":3}'), "no export of a store"),
    (lambda text: with_last(text, "[]"), "no export of a store"),
    (lambda text: with_last(text, '{"sqlite_master":{"name":"x"}}'), "sqlite_master: is no table of a store; known are runs, measured"),
    (lambda text: with_last(text, '{"runs":{"keys":"x"}}'), "no column named keys")])
def test_an_export_that_is_broken_enters_nothing(full: Store, tmp_path: Path, change, words: str) -> None:
    file, other = tmp_path / "store.jsonl", Store(":memory:")
    export(full, file)
    file.write_text(change(file.read_text()))
    with pytest.raises(StoreError, match=words):
        import_into(other, file)
    assert list(other.tables()) == []


def test_an_export_that_cannot_be_written_leaves_the_old_one(full: Store, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def no_space(descriptor: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    file = tmp_path / "store.jsonl"
    file.write_text("old")
    monkeypatch.setattr("verification.store.export.os.fsync", no_space)
    with pytest.raises(StoreError, match="store.jsonl: No space left on device; free some space, or name another file"):
        export(full, file)
    assert file.read_text() == "old" and not (tmp_path / "store.jsonl.part").exists()
    with pytest.raises(StoreError, match="name another file"):
        export(full, file / "below a file")
    with pytest.raises(StoreError, match="none.jsonl: no such file; name one that `store export` wrote"):
        import_into(full, tmp_path / "none.jsonl")

# --- the key of a run


def test_scenes_of_the_same_values_are_one() -> None:
    one = {"name": "x", "case": {"purpose": "p"}, "box": {"size": [1, 2.0]}, "fluid": {"spacing": 1e-1, "on": True}}
    other = {"fluid": {"on": True, "spacing": 0.1}, "box": {"size": [1.0, 2]}, "name": "y"}
    assert hash_of(canonical_scene(one)) == hash_of(canonical_scene(other))
    assert "name" not in canonical_scene(one) and "case" not in canonical_scene(one)


@pytest.mark.parametrize(("one", "other"), [
    (1, 1.0000000000000002), (1, True), (1, "1"), ([1, 2], [2, 1]), (2**60, 2**60 + 1), ("a", "b"), ([1], 1), (0, None)])
def test_other_values_are_another_scene(one: object, other: object) -> None:
    assert hash_of({"a": one}) != hash_of({"a": other})
    assert hash_of({"a": one}) != hash_of({"b": one})


def test_numbers_that_no_scene_can_hold_are_refused() -> None:
    for value in (math.nan, math.inf, -math.inf):
        with pytest.raises(ValueError, match="is no number that a scene can hold"):
            canonical({"a": [value]})


def test_cores_are_in_the_key_of_a_code_without_digest_alone(tmp_path: Path) -> None:
    bits, other = tiny(tmp_path / "bits", EXACT_BITS, 2).code, tiny(tmp_path / "other").code
    assert run_key(bits, SCENE, cores=1) == run_key(bits, SCENE, cores=4)
    assert run_key(other, SCENE, cores=1) != run_key(other, SCENE, cores=4)


def test_options_that_change_the_speed_alone_are_in_the_key_of_a_code_without_digest_alone(tmp_path: Path) -> None:
    quick = {"speed_options": frozenset({"threads"})}
    bits, other = replace(tiny(tmp_path / "bits", EXACT_BITS, 2).code, **quick), replace(tiny(tmp_path / "other").code, **quick)
    assert run_key(bits, SCENE, options={"threads": "2"}) == run_key(bits, SCENE) != run_key(bits, SCENE, options={"levels": "2"})
    assert run_key(other, SCENE, options={"threads": "2"}) != run_key(other, SCENE)
    assert {"threads", "isa", "domains"} <= find_code("mappm").speed_options


def test_what_makes_another_run_makes_another_key(tmp_path: Path) -> None:
    code = tiny(tmp_path, EXACT_BITS, 2).code
    keys = [run_key(code, SCENE), run_key(code, SCENE, 10), run_key(code, SCENE, options={"a": "1"}),
            run_key(code, SCENE | {"box": {"size": [1, 2]}}), run_key(code, SCENE | {"run": {"steps": 10}}),
            run_key(code, SCENE | {"fluid": SCENE["fluid"] | {"viscosity": 0.2}}), run_key(replace(code, numerics_version=3), SCENE),
            run_key(replace(code, name="another"), SCENE)]
    assert len(set(keys)) == len(keys)
    assert run_key(replace(code, version="9", adapter="9"), SCENE) == keys[0]  # the numerics version says it all
    without = replace(code, numerics_version=None)
    assert len({run_key(one, SCENE) for one in (without, replace(without, version="9"), replace(without, adapter="9"))}) == 3

# --- the laboratory


@pytest.fixture
def bits(tmp_path: Path) -> Tiny:
    return tiny(tmp_path / "code", EXACT_BITS, 2)


@pytest.fixture
def laboratory(tmp_path: Path) -> Laboratory:
    return Laboratory(tmp_path / "runs")


def test_a_run_is_made_once(bits: Tiny, laboratory: Laboratory) -> None:
    first, again = (laboratory.obtain(Request(bits.code, scene, "tiny", cores=cores))
                    for scene, cores in ((SCENE, 1), (SCENE | {"name": "other"}, 2)))
    assert bits.calls == 1 and first.key == again.key
    assert first.ledger == Ledger(3) and first.cost.cores == 1 and first.scene == SCENE
    laboratory.drop_folders()
    assert laboratory.obtain(Request(bits.code, SCENE, "tiny")).record["digest"] == "00ff" and bits.calls == 1
    with laboratory.kept(first.key) as run:
        assert run.scene == SCENE and list(run.series["fluid_velocity_x"]) == [3.0] * 3
    laboratory.obtain(Request(bits.code, SCENE, "tiny"), folder_too=True)
    assert bits.calls == 2 and laboratory.run(first.key) is not None


def test_a_field_that_is_wanted_later_is_kept_then(bits: Tiny, laboratory: Laboratory) -> None:
    request = Request(bits.code, SCENE, "tiny")
    key = laboratory.obtain(request).key
    assert list(laboratory.store.files(key)) == ["series.csv"]
    for _ in range(2):
        laboratory.obtain(replace(request, field=True))
        assert sorted(laboratory.store.files(key)) == ["series.csv", "snapshots/fluid_000000000.vtkhdf"]
    with laboratory.kept(key) as run:
        assert run.fluid()["velocity"].tolist() == [[1.0, 1.0, 0.0]] and bits.calls == 1


def test_threads_that_want_one_run_make_it_once(bits: Tiny, laboratory: Laboratory) -> None:
    with ThreadPoolExecutor(4) as pool:
        keys = set(pool.map(lambda _: laboratory.obtain(Request(bits.code, SCENE, "tiny")).key, range(4)))
    assert len(keys) == 1 and bits.calls == 1


def test_a_digest_that_differs_is_never_taken(bits: Tiny, laboratory: Laboratory) -> None:
    key = laboratory.obtain(Request(bits.code, SCENE, "tiny")).key
    laboratory.store.enter_found(key, "m", Found({"x": Measured(1.0, 0.0)}))
    before = laboratory.run(key).record
    bits.tells("00fe")
    for _ in range(2):
        with pytest.raises(StoreError, match="tiny: the digest is 00fe, and was 00ff at .*without a new numerics version of tiny"):
            laboratory.obtain(Request(bits.code, SCENE, "tiny"), anew=True)
    assert laboratory.store.run(key).record["digest"] == "00ff" and laboratory.store.found(key, "m").values["x"].value == 1.0
    assert laboratory.run(key).record == before  # the folder is that of the run that the store knows


def test_a_run_that_ends_badly_leaves_nothing(tmp_path: Path, laboratory: Laboratory) -> None:
    code = tiny(tmp_path / "code").code
    with pytest.raises(Beyond, match="tiny knows no waves"):
        laboratory.obtain(Request(code, SCENE | {"fluid": SCENE["fluid"] | {"wave": 1}}, "wave"))
    assert laboratory.store.runs() == [] and [path for path in (laboratory.folder / "runs").iterdir() if path.is_dir()] == []


def test_a_run_that_did_not_fit_is_made_again(bits: Tiny, laboratory: Laboratory) -> None:
    limited(laboratory.store, 0)
    with pytest.raises(StoreError, match="full"):
        for i in range(1000):
            laboratory.store.enter(a_run(f"filler {i}"))
    with pytest.raises(StoreError, match="full"):
        laboratory.obtain(Request(bits.code, SCENE, "tiny"))
    limited(laboratory.store, 10_000)
    assert laboratory.obtain(Request(bits.code, SCENE, "tiny")).record["digest"] == "00ff" and bits.calls == 2


def test_pruning_removes_runs_of_older_numerics_alone(bits: Tiny, laboratory: Laboratory, capsys: pytest.CaptureFixture) -> None:
    mappm = find_code("mappm")
    laboratory.store.enter(a_run("now", numerics=mappm.numerics_version))
    laboratory.store.enter(a_run("old", numerics=mappm.numerics_version - 1))
    laboratory.store.enter(a_run("exact", code="exact", numerics=None))
    key = laboratory.obtain(Request(bits.code, SCENE, "tiny")).key  # of a code that has no name here: nobody knows its version
    prune(laboratory, folders=True)
    assert {run.key for run in laboratory.store.runs()} == {"now", "exact", key}
    assert "1 stale runs removed" in capsys.readouterr().out and laboratory.run(key) is None

# --- measures and cases

MANIFEST = """
name = "drift"
[case]
purpose = "p"
tier = "quick"
cost = 1
[[case.observable]]
name = "velocity"
symbol = "u"
reference = 3.0
uncertainty = 0.0
source = "nobody at all"
goal = 0.01
since = 2026-11-22
[box]
size = [1.0, 1.0]
[fluid]
density = 1.0
viscosity = 0.1
spacing = 0.5
velocity = [3.0, 0.0]
"""
MEASURE = """
from verification.measures.curve import Chart, Curve
from verification.measures.measures import Measures, by_name
from verification.protocol.quantity import Measured

def velocity(run):
    return Measured(FACTOR * float(run.series["fluid_velocity_x"][-1]), 0.0)

def charts(run):
    return [Chart("u", "t", "u", (Curve("u", run.series["time"], run.series["fluid_velocity_x"]),))]

MEASURES = Measures(observables=by_name(velocity), figures={"runs": lambda run: 1.0}, charts=charts)
"""


def case_in(folder: Path, factor: str = "1.0") -> Case:
    folder.mkdir(parents=True)
    (folder / "case.toml").write_text(MANIFEST)
    (folder / "measure.py").write_text(MEASURE.replace("FACTOR", factor))
    (case,) = read_cases(folder / "case.toml")
    return case


def test_an_edited_measure_measures_the_same_run_anew(bits: Tiny, laboratory: Laboratory, tmp_path: Path) -> None:
    for place, factor, value in (("one", "1.0", 3.0), ("same", "1.0", 3.0), ("edited", "1.1", 3.3)):
        case = case_in(tmp_path / place, factor)
        (job,) = jobs_of(case, "quick", bits.code)
        assert (look_up(laboratory, job) is not None) == (place == "same")
        assert obtain(laboratory, job).found.values["velocity"].value == pytest.approx(value)
        assert collect(laboratory, case, "quick", bits.code).outcomes[0].measured.value == pytest.approx(value)
    assert bits.calls == 1


def test_an_edited_measure_runs_again_what_is_no_more_there(bits: Tiny, laboratory: Laboratory, tmp_path: Path) -> None:
    for place, factor, calls in (("one", "1.0", 1), ("edited", "1.1", 2)):
        (job,) = jobs_of(case_in(tmp_path / place, factor), "quick", bits.code)
        perform(laboratory, [job], 1)
        laboratory.drop_folders()
        assert bits.calls == calls


def test_a_run_of_which_a_value_is_missing_is_measured_anew(bits: Tiny, laboratory: Laboratory, tmp_path: Path) -> None:
    (job,) = jobs_of(case_in(tmp_path / "one"), "quick", bits.code)
    for name in ("velocity", "figure runs"):
        assert obtain(laboratory, job).figures == {"velocity": 3.0, "runs": 1.0}
        laboratory.store._connection.execute("DELETE FROM measured WHERE name = ?", (name,))
        assert look_up(laboratory, job) is None
    assert bits.calls == 1


def test_charts_are_kept_of_the_finest_run_and_asked_for(bits: Tiny, laboratory: Laboratory, tmp_path: Path) -> None:
    case = case_in(tmp_path / "one")
    (job,) = jobs_of(case, "quick", bits.code)
    assert job.finest
    obtain(laboratory, replace(job, finest=False))
    assert look_up(laboratory, job) is None  # the chart is missing
    obtain(laboratory, job)
    (chart,) = collect(laboratory, case, "quick", bits.code).charts
    assert chart["curves"][0]["y"] == [3.0] * 3 and bits.calls == 1


def test_the_id_of_a_measure_follows_its_sources_and_tables(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a copy of the modules that measures may be made of."""
    folder = tmp_path / "cases" / "drift"
    folder.mkdir(parents=True)
    (folder / "measure.py").write_text("from verification.measures.fits import decay_rate\n")
    measures = tmp_path / "verification" / "measures"
    measures.mkdir(parents=True)
    for name in ("observables", "fits", "flows"):
        (measures / f"{name}.py").write_text("import verification.measures.histories\n" if name == "fits" else "")
    (measures / "histories.py").write_text("")
    for module in ("measures.source", "protocol.sources"):
        monkeypatch.setattr(f"verification.{module}.ROOT", tmp_path)

    def identity() -> str:
        sources_of.cache_clear()
        measure_id.cache_clear()
        return measure_id(folder)

    known = {"at first": identity()}
    assert identity() == known["at first"]
    for name, counts in (("cases/drift/measure.py", True), ("verification/measures/fits.py", True),
                         ("verification/measures/observables.py", True), ("verification/measures/histories.py", True),
                         ("verification/measures/flows.py", False), ("cases/drift/reference.csv", True),
                         ("cases/drift/case.toml", False)):
        file = tmp_path / name
        file.write_text((file.read_text() if file.exists() else "") + "# changed\n")
        assert (identity() not in known.values()) == counts, name
        known[name] = identity()


def test_results_of_older_numerics_are_stale_and_apart(bits: Tiny, laboratory: Laboratory, tmp_path: Path,
                                                       monkeypatch: pytest.MonkeyPatch) -> None:
    case = case_in(tmp_path / "cases" / "drift")
    monkeypatch.setenv("MAPPM_CASES", str(case.file.parents[1]))
    perform(laboratory, jobs_of(case, "quick", bits.code), 1)
    newer = replace(bits.code, numerics_version=3)
    monkeypatch.setattr("verification.suite.stale.subject", lambda: newer)
    assert collect(laboratory, case, "quick", newer) is None
    (stale,) = stale_of(laboratory, ["drift"])
    assert stale.numerics == 2 and stale.result.outcomes[0].measured.value == 3.0


def test_what_was_exported_is_judged_without_a_run(bits: Tiny, laboratory: Laboratory, tmp_path: Path) -> None:
    case = case_in(tmp_path / "one")
    perform(laboratory, jobs_of(case, "quick", bits.code), 1)
    export(laboratory.store, tmp_path / "store.jsonl")
    other = Laboratory(tmp_path / "elsewhere")
    import_into(other.store, tmp_path / "store.jsonl")
    (outcome,) = collect(other, case, "quick", bits.code).outcomes
    assert outcome.measured.value == 3.0 and outcome.holds and bits.calls == 1


def test_the_commands_of_the_store(bits: Tiny, laboratory: Laboratory, tmp_path: Path) -> None:
    key = laboratory.obtain(Request(bits.code, SCENE, "a label")).key

    def said(*words: str) -> str:
        done = subprocess.run([sys.executable, "-m", "verification", "store", *words, "--lab", str(laboratory.folder)], cwd=ROOT,
                              capture_output=True, text=True)
        return done.stdout if done.returncode == 0 else textwrap.shorten(done.stderr, 200)

    assert f"{key[:12]}  tiny numerics 2" in said("list") and "1 runs in" in said("list")
    assert "a label" in said("show", key[:6]) and json.dumps(SCENE["box"]["size"])[1:4] in said("show", key)
    assert "0 runs have a key that starts so" in said("show", "zz")
    assert "2 rows in" in said("export", str(tmp_path / "e.jsonl"))  # the run, and what it took
    assert "0 rows of" in said("import", str(tmp_path / "e.jsonl"))
