"""Codes behind the protocol. Oracles: exact solutions, a code written in the README of the protocol, and output broken here."""

import json
import math
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest

from verification.codes.code import Code, all_codes, call, find_code, run_code
from verification.codes.conform import SCENES, Check, checks, velocity_error
from verification.measures.observables import viscosity
from verification.protocol.capability import CAPABILITIES
from verification.protocol.check import check_run
from verification.protocol.errors import Beyond, CaseError, OutputError, SolverError
from verification.protocol.machine import ROOT
from verification.protocol.points import write_points
from verification.protocol.run import Run
from verification.protocol.scene import fault_of, read_scene
from verification.suite.manifest import find_case
from verification.suite.runner import measures_of

WAVE = ROOT / "verification" / "codes" / "scenes" / "shear_wave.toml"
FLUID = frozenset({"fluid"})

# --- exact solutions


@pytest.fixture(scope="module")
def exact() -> Code:
    return find_code("exact")


@pytest.mark.parametrize("name", ["shear_wave", "shear_wave_3d", "shear_wave_k3", "taylor_green", "boost", "abc_flow"])
def test_the_viscosity_of_exact_flows_is_the_declared_one(name: str, exact: Code, tmp_path: Path) -> None:
    measured = viscosity(run_code(exact, find_case(name).file, tmp_path))
    assert not measured.objection
    assert measured.value == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("name", ["taylor_green", "couette_start"])
def test_errors_of_exact_fields_are_rounding(name: str, exact: Code, tmp_path: Path) -> None:
    case = find_case(name)
    run = run_code(exact, case.file, tmp_path)
    for observable in (one for one in case.observables if "error" in one.name):
        measured = measures_of(case.file.parent)[observable.name](run)
        assert not measured.objection
        assert measured.value < 1e-12, observable.name


def test_the_error_of_the_exact_channel_is_its_unfinished_start(exact: Code, tmp_path: Path) -> None:
    """The first mode, (32 / pi^3) exp(-pi^2 nu t / H^2) sin(pi y / H) of the largest velocity, its root mean square."""
    case = find_case("poiseuille")
    measured = measures_of(case.file.parent)["poiseuille"](run_code(exact, case.file, tmp_path))
    assert measured.value == pytest.approx(32 / math.pi**3 * math.exp(-(math.pi**2) * 0.05 * 20.0) / math.sqrt(2), rel=1e-3)


@pytest.mark.parametrize(("name", "reason"), [
    ("cavity", "walls that are not parallel"), ("sound_wave", "sound"), ("cylinder_stokes.phi_0.2", "exact lacks fixed-body"),
    ("taylor_green_3d", "only the start is exact"), ("manufactured", "force that is a field")])
def test_a_scene_without_an_exact_solution_is_beyond_it(name: str, reason: str, exact: Code, tmp_path: Path) -> None:
    with pytest.raises(Beyond, match=reason) as beyond:
        run_code(exact, find_case(name).file, tmp_path)
    assert reason in beyond.value.reason
    assert not (tmp_path / "run.json").exists()

# --- the example of the README


@pytest.fixture(scope="module")
def toy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The code that the README of the protocol shows, in a file of its own."""
    (block,) = re.findall(r"^```python\n(.*?)^```", (ROOT / "verification" / "protocol" / "README.md").read_text(), re.M | re.S)
    file = tmp_path_factory.mktemp("toy") / "toy.py"
    file.write_text(block)
    return file


def failed(found: list[Check]) -> list[str]:
    return [check.line for check in found if not check.holds]


def test_the_code_of_the_readme_conforms(toy: Path) -> None:
    done = subprocess.run([sys.executable, "-m", "verification", "conform", str(toy)], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "PASS  taylor_green: its velocity is the exact one" in done.stdout


def test_the_code_of_the_readme_measures_viscosity(toy: Path, tmp_path: Path) -> None:
    """The second difference of sin ky is smaller by k^2 h^2 / 12 than -k^2 sin ky: here h = 1 / 64."""
    run = run_code(find_code(toy), find_case("shear_wave").file, tmp_path)
    assert run.record["code"] == "toy"
    h = 1 / 64
    assert viscosity(run).value == pytest.approx(2 * (1 - math.cos(2 * math.pi * h)) / (2 * math.pi * h) ** 2, abs=1e-6)


def test_a_code_that_is_wrong_does_not_conform(toy: Path, tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.py"
    wrong.write_text(toy.read_text().replace("return nu * sum", "return 1.3 * nu * sum"))
    lines = failed(list(checks(wrong)))
    assert len(lines) == 2
    assert all(re.search(r"velocity is the exact one within 5 %: differs by [\d.]+ %", line) for line in lines)


@pytest.mark.parametrize(("old", "new", "line"), [
    ("task.steps or steps", "steps", "shear_wave: --steps 2 ends early"),
    ("end / steps, task", "0.8 * end / steps, task", "shear_wave: it runs to the end of the scene"),
    ("u.reshape(2, -1).T)", "u.reshape(2, -1).T * np.nan)", "fluid_000000000.vtkhdf: PointData/velocity: 1024 values"),
    ('raise Cannot("only', 'raise Cannot("', ""),
    ("return Left()", 'raise Cannot("no scene at all")', "it runs a standard scene: none of shear_wave"),
    ("sys.exit(main(Toy()))", "main(Toy())", "a scene that needs walls ends with 3 and a reason: ended with 0, not 3"),
    ("return Left()", "return Left(more={'x': 1}, digest=1)", "run.json: digest: 1: must be a text")])
def test_conform_names_what_is_wrong(toy: Path, tmp_path: Path, old: str, new: str, line: str) -> None:
    """Where `line` is empty the change is none of the protocol's business."""
    assert old in toy.read_text()
    wrong = tmp_path / "wrong.py"
    wrong.write_text(toy.read_text().replace(old, new))
    lines = failed(list(checks(wrong)))
    assert any(line in one for one in lines) if line else lines == []

# --- descriptions


def program(folder: Path, text: str) -> Path:
    file = folder / "code.py"
    file.write_text(text)
    return file


def describing(folder: Path, **keys: object) -> Path:
    """A program that prints a description with some keys changed; None leaves one out."""
    whole = {"name": "other", "version": "1", "capabilities": ["fluid"], "missing": ""} | keys
    said = {key: value for key, value in whole.items() if value is not None}
    return program(folder, f"print({json.dumps(json.dumps(said))})")


@pytest.mark.parametrize(("keys", "fault"), [
    ({"version": None}, "version: missing; add it"),
    ({"name": "two words"}, "name = 'two words': must be a short word"),
    ({"capabilities": "fluid"}, "capabilities = 'fluid': must be a list"),
    ({"capabilities": ["fluid", "4d"]}, "capabilities: 4d: unknown; known are fluid, 3d, walls"),
    ({"version": ""}, "version: empty, though nothing is missing"),
    ({"missing": False}, "missing = False: must be a text"),
    ({"numerics_version": "2"}, "numerics_version = '2': must be an integer")])
def test_a_description_that_is_wrong_is_named(keys: dict, fault: str, tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=re.escape(fault)):
        find_code(describing(tmp_path, **keys))


@pytest.mark.parametrize(("text", "fault"), [
    ("print('hello')", "no JSON .* 'hello"), ("print([])", "must print one JSON object"),
    ("raise SystemExit('broken')", "ended with 1: broken")])
def test_a_program_that_does_not_describe_itself_is_named(text: str, fault: str, tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=f"code.py describe: .*{fault}"):
        find_code(program(tmp_path, text))


def test_a_code_that_does_not_exist_or_cannot_be_executed_is_named(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match="code fluent: unknown; give one of .*exact, .*mappm, mappm-reference"):
        find_code("fluent")
    (tmp_path / "binary").write_text("")
    with pytest.raises(CaseError, match="cannot be executed"):
        find_code(tmp_path / "binary")


def test_an_executable_of_any_language_is_a_code(tmp_path: Path) -> None:
    file = tmp_path / "shell"
    file.write_text("""#!/bin/sh
[ "$1" = describe ] && echo '{"name": "shell", "version": "", "capabilities": [], "missing": "a compiler; install one"}' && exit
echo "no compiler" >&2; exit 3
""")
    file.chmod(0o755)
    code = find_code(file)
    assert (code.name, code.version, code.missing, code.numerics_version) == ("shell", "", "a compiler; install one", None)
    with pytest.raises(Beyond, match="^no compiler$"):
        run_code(code, WAVE, tmp_path / "out")


def test_all_codes_are_known_without_being_run() -> None:
    assert {"exact", "mappm", "mappm-reference"} <= set(all_codes())
    assert not {"code", "conform", "--init--"} & set(all_codes())


def test_the_adapter_of_a_code_is_its_source_and_what_it_imports(toy: Path, tmp_path: Path) -> None:
    same, other = tmp_path / "toy.py", tmp_path / "other" / "toy.py"
    other.parent.mkdir()
    same.write_text(toy.read_text())
    other.write_text(toy.read_text() + "\n")
    assert find_code(same).adapter == find_code(toy).adapter != find_code(other).adapter
    assert find_code("mappm").adapter != find_code("mappm-reference").adapter

# --- how a run ends


ENDING = """
import json, sys
if sys.argv[1] == "describe":
    print(json.dumps({"name": "ending", "version": "1", "capabilities": ["fluid"], "missing": ""}))
else:
    print("first line", file=sys.stderr)
    print("ending: the reason", file=sys.stderr)
    sys.exit(STATUS)
"""


@pytest.mark.parametrize(("status", "error", "words"), [
    (2, CaseError, "^ending: the reason$"), (3, Beyond, "^ending: the reason$"),
    (1, SolverError, "ended with 1\nfirst line\nending"), (0, OutputError, "run.json: missing")])
def test_each_exit_status_is_an_error_of_its_own(status: int, error: type, words: str, tmp_path: Path) -> None:
    code = find_code(program(tmp_path, ENDING.replace("STATUS", str(status))))
    with pytest.raises(error, match=words):
        run_code(code, WAVE, tmp_path / "out")


def test_a_folder_that_holds_files_is_refused(exact: Code, tmp_path: Path) -> None:
    (tmp_path / "note").write_text("")
    with pytest.raises(CaseError, match="holds files; give a folder that is empty"):
        run_code(exact, WAVE, tmp_path)


def test_a_run_that_is_interrupted_ends_with_all_that_it_started(tmp_path: Path) -> None:
    """The child starts a child of its own, and both are gone once the interrupted call has thrown."""
    pids = tmp_path / "pids"
    line = ["/bin/sh", "-c", f"sleep 100 & echo $! $$ > {pids}; wait"]

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        signal.setitimer(signal.ITIMER_REAL, 1.0)
        with pytest.raises(KeyboardInterrupt):
            call(line)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    time.sleep(0.2)
    states = [Path(f"/proc/{pid}/stat") for pid in pids.read_text().split()]
    assert [state for state in states if state.exists() and state.read_text().split()[2] != "Z"] == []

# --- output that is broken


@pytest.fixture
def whole(exact: Code, tmp_path: Path) -> Path:
    """The folder of a run that is sound."""
    return run_code(exact, WAVE, tmp_path / "run", options={"snapshots": "3"}).folder


def edit_record(change: Callable[[dict], None]) -> Callable[[Path], None]:
    def broken(folder: Path) -> None:
        record = json.loads((folder / "run.json").read_text())
        change(record)
        (folder / "run.json").write_text(json.dumps(record))
    return broken


def edit_series(old: str, new: str) -> Callable[[Path], None]:
    """Of the second line on, where `old` is a pattern that begins a line; else of the header."""
    def broken(folder: Path) -> None:
        file = folder / "series.csv"
        text = file.read_text()
        found = re.sub(old, new, text, count=1, flags=re.M)
        assert found != text
        file.write_text(found)
    return broken


def edit_points(change: Callable[[h5py.Group], None]) -> Callable[[Path], None]:
    def broken(folder: Path) -> None:
        with h5py.File(folder / "snapshots" / "fluid_000000002.vtkhdf", "a") as file:
            change(file["VTKHDF"])
    return broken


def replaced(name: str, value: object) -> Callable[[Path], None]:
    """Puts another data set in the place of one of a snapshot."""
    def change(root: h5py.Group) -> None:
        del root[name]
        if value is not None:
            root[name] = value
    return edit_points(change)


def truncated(name: str) -> Callable[[Path], None]:
    def broken(folder: Path) -> None:
        (folder / name).write_bytes((folder / name).read_bytes()[:-100])
    return broken


SNAPSHOT = "snapshots/fluid_000000002.vtkhdf"
COUNT = 512
BROKEN = [
    (lambda folder: (folder / "run.json").unlink(), "run.json: missing"),
    (truncated("run.json"), "run.json: no JSON, perhaps truncated"),
    (edit_record(lambda record: record.pop("version")), "run.json: version: missing"),
    (edit_record(lambda record: record.update(command=["a"])), "run.json: command: ['a']: must be a text"),
    (edit_record(lambda record: record.pop("scene")), "run.json: scene: missing"),
    (edit_record(lambda record: record["scene"].update(text="[")), "run.json: scene.text: no TOML"),
    (edit_record(lambda record: record["scene"].update(text="a = 1")), "run.json: scene.text: has no box.size"),
    (edit_record(lambda record: record["cost"].pop("wall_seconds")), "run.json: cost.wall_seconds: missing"),
    (edit_record(lambda record: record["cost"].update(core_seconds=-1.0)), "run.json: cost.core_seconds: -1.0: must be"),
    (edit_record(lambda record: record["cost"].update(peak_memory=math.nan)), "run.json: cost.peak_memory: nan: must be"),
    (edit_record(lambda record: record["cost"].update(cores=True)), "run.json: cost.cores: True: must be"),
    (edit_record(lambda record: record["cost"].update(cores=0)), "run.json: cost.cores: 0: must be"),
    (edit_record(lambda record: record.update(quantities={"drag": {"value": math.inf}})), "run.json: quantities.drag.value: inf"),
    (edit_record(lambda record: record.update(quantities={"drag": {"value": 1, "uncertainty": -1, "unit": ""}})),
     "run.json: quantities.drag.uncertainty: -1"),
    (edit_record(lambda record: record.update(objection=None)), "run.json: objection: None"),
    (lambda folder: (folder / "series.csv").write_text(""), "series.csv: header: missing"),
    (lambda folder: (folder / "series.csv").write_text("time,x\n"), "series.csv: holds no row"),
    (edit_series("^time", "t"), "series.csv: time: missing; there are t, fluid_velocity_x"),
    (edit_series("^time,fluid_velocity_x", "time,time"), "series.csv: header: time twice"),
    (edit_series("^time,fluid_velocity_x", "time,1.5"), "series.csv: header: '1.5'"),
    (edit_series("^0,", "0,nan,"), "series.csv: line 2: 6 cells under 5 columns"),
    (edit_series("^0,[^,]*", "0,nan"), "series.csv: fluid_velocity_x: line 2: 'nan': must be a finite number"),
    (edit_series("^0,", "99,"), "series.csv: time: line 3: 0.166667 after 99: must increase"),
    (edit_series("^time,fluid_velocity_x", "time,momentum_x"), "series.csv: momentum_x: line 2: '"),
    (truncated("series.csv"), "series.csv: line 16: no line break at its end; perhaps truncated"),
    (truncated(SNAPSHOT), f"{SNAPSHOT}: truncated, or no HDF5"),
    (lambda folder: (folder / SNAPSHOT).write_text("text"), f"{SNAPSHOT}: truncated, or no HDF5"),
    (edit_points(lambda root: root.attrs.create("Type", b"ImageData")), f"{SNAPSHOT}: Type: 'ImageData'"),
    (replaced("PointData/velocity", None), f"{SNAPSHOT}: PointData/velocity: missing"),
    (replaced("PointData/velocity", np.zeros((COUNT, 2))), f"{SNAPSHOT}: PointData/velocity: shape (512, 2): must be (512, 3)"),
    (replaced("PointData/velocity", np.full((COUNT, 3), np.nan)), f"{SNAPSHOT}: PointData/velocity: 1536 values are not finite"),
    (replaced("PointData/kind", np.zeros(COUNT - 1)), f"{SNAPSHOT}: PointData/kind: shape (511,): must be (512,)"),
    (replaced("PointData/kind", np.full(COUNT, 2)), f"{SNAPSHOT}: PointData/kind: must be 0 or 1"),
    (replaced("Points", np.ones((COUNT, 3))), f"{SNAPSHOT}: Points: third coordinate must be 0 in the plane"),
    (replaced("Points", np.zeros((COUNT - 1, 3))), f"{SNAPSHOT}: NumberOfPoints: not the 511 of Points"),
    (replaced("FieldData/TimeValue", None), f"{SNAPSHOT}: FieldData/TimeValue: missing"),
    (replaced("FieldData/TimeValue", np.array([0.1])), f"{SNAPSHOT}: FieldData/TimeValue: 0.1 after 0.83"),
    (lambda folder: (folder / SNAPSHOT).rename(folder / "snapshots" / "fluid_2.vtkhdf"), "fluid_2.vtkhdf: name: must be fluid_"),
    (lambda folder: (folder / "solids.csv").write_text("time,id,position_x\n0,0,0\n"), "solids.csv: velocity_x: missing"),
    (lambda folder: (folder / "solids.csv").write_text("time,id,position_x,velocity_x\n1,0,0,0\n0,0,0,0\n"),
     "solids.csv: time: line 3: 0 after 1"),
]


@pytest.mark.parametrize(("broken", "message"), BROKEN, ids=[message for _, message in BROKEN])
def test_broken_output_is_one_error_that_names_file_and_field(broken: Callable[[Path], None], message: str, whole: Path) -> None:
    check_run(whole, FLUID)
    broken(whole)
    with pytest.raises(OutputError) as error:
        check_run(whole, FLUID)
    assert str(error.value).startswith(f"{whole}/")
    assert message in str(error.value)


def test_a_capability_has_to_be_kept(whole: Path) -> None:
    with pytest.raises(OutputError, match="run.json: digest: missing"):
        check_run(whole, FLUID | {"digest"})
    text = WAVE.read_text().replace("[output]", "[output]\nsolids = true") + '\n[[body]]\nshape = "disc"\n'
    edit_record(lambda record: record["scene"].update(text=text))(whole)
    with pytest.raises(OutputError, match="solids.csv: missing, though the scene has output.solids = true"):
        check_run(whole, FLUID | {"free-body"})


def test_momentum_may_be_longer_than_a_double(whole: Path) -> None:
    (whole / "series.csv").write_text("step,time,momentum_x,digest\n0,0,-156695893084163680123456789,1e05\n1,1,0,00ff\n")
    check_run(whole, FLUID)

# --- MaPPM


@pytest.mark.parametrize("name", ["mappm", "mappm-reference"])
def test_mappm_speaks_the_protocol(name: str, tmp_path: Path) -> None:
    code = find_code(name)
    assert not code.missing
    assert code.capabilities == set(CAPABILITIES)
    assert re.fullmatch(r"\d+\.\d+\.\d+", code.version)
    assert code.numerics_version >= 2
    run = run_code(code, WAVE, tmp_path, steps=20)
    assert run.record["steps"] == 20
    assert run.record["digest"] == run.series["digest"][-1]
    assert run.record["scene"]["text"] == WAVE.read_text()
    cost = run.record["cost"]  # in which the wall clock is no less than the processor's, on one core, but for the grain of that
    assert 0 < cost["core_seconds"] <= cost["wall_seconds"] + 0.02
    assert velocity_error(run) < 0.01


def test_both_programs_and_all_ranks_tell_the_same_digest(tmp_path: Path) -> None:
    mappm = find_code("mappm")
    runs = [run_code(find_code("mappm-reference"), WAVE, tmp_path / "serial", steps=20),
            *(run_code(mappm, WAVE, tmp_path / f"{cores}", cores=cores, steps=20) for cores in (1, 2)),
            run_code(mappm, WAVE, tmp_path / "threads", cores=2, steps=20, options={"threads": "2"})]
    assert len({run.record["digest"] for run in runs}) == 1
    assert [run.record["cost"]["cores"] for run in runs] == [1, 1, 2, 2]
    assert [run.record["ranks"] for run in runs[1:]] == [1, 2, 1]


@pytest.mark.parametrize(("name", "asked", "fault"), [
    ("mappm-reference", {"cores": 2}, "--cores 2: mappm-reference takes 1"),
    ("mappm", {"options": {"threads": "2"}}, "--cores 1: must be a multiple of threads=2"),
    ("mappm", {"options": {"colour": "red"}}, "--option colour: unknown; known are domains, threads"),
    ("mappm", {"options": {"isa": "z80"}}, "--isa: .*z80")])
def test_what_mappm_cannot_use_is_named(name: str, asked: dict, fault: str, tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=fault):
        run_code(find_code(name), WAVE, tmp_path, **asked)


def test_a_program_that_is_not_built_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MAPPM_BUILD", str(tmp_path))
    code = find_code("mappm")
    assert "bin/mappm is missing; build it first" in code.missing
    assert code.version == "" and code.numerics_version is None
    with pytest.raises(Beyond, match="build it first"):
        run_code(code, WAVE, tmp_path / "out")


@pytest.mark.parametrize("name", ["exact", "mappm"])
def test_codes_here_conform(name: str) -> None:
    found = list(checks(name))
    assert failed(found) == []
    assert sum("velocity is the exact one" in check.what for check in found) == len(SCENES)

# --- scenes


@pytest.mark.parametrize(("override", "fault"), [
    ("fluid.viscosity=thin", "fluid.viscosity = 'thin': must be a number"),
    ("fluid.density=0.0", "fluid.density = 0.0: must be positive"),
    ("box.size=[1.0]", "box.size = [1.0]: must be two or three lengths"),
    ("box.size=[1.0,-1.0]", "box.size = -1.0: must be positive"),
    ("body=[{radius=1.0}]", "body.0.shape: missing"), ("fluid=1", "fluid: missing; add a table"), ("name=any", "")])
def test_what_no_code_could_use_is_named(override: str, fault: str) -> None:
    assert fault_of(read_scene(WAVE, [override])).startswith(fault)
    assert bool(fault_of(read_scene(WAVE, [override]))) == bool(fault)


def test_points_are_written_as_they_are_checked(whole: Path) -> None:
    write_points(whole, 9, 99.0, np.ones((4, 2)), np.ones((4, 2)), np.array([0, 1, 0, 1]))
    check_run(whole, FLUID)
    assert len(Run(whole).fluid()["points"]) == 2
