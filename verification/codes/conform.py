"""Holds an adapter against the protocol, step by step, on small scenes whose solution is exact: a line a check.

    python3 -m verification conform ADAPTER
"""

import tempfile
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reference.exact_flows import exact_flow
from verification.codes.code import FOLDER, Code, call, command, find_code, run_code
from verification.protocol.adapter import BAD_INPUT, CANNOT
from verification.protocol.capability import CAPABILITIES, asked_by, lacking
from verification.protocol.errors import Beyond, CaseError, SolverError, last_line
from verification.protocol.run import Run, read_points, read_time
from verification.protocol.scene import in_si

LARGEST_ERROR = 0.05  # of the answers, coarse as the scenes are; a wrong viscosity, unit or start is far beyond it
OVERSHOOT = 0.05  # of the duration, by which the last step of a code may miss it
SCENES = ("shear_wave", "taylor_green", "poiseuille")

WAVE = (FOLDER / "scenes" / "shear_wave.toml").read_text()
DISC = '\n[[body]]\nshape = "disc"\nradius = 0.125\nposition = [0.25, 0.5]\n'
BEYOND = {  # a scene that asks for the word, and a code without it has to refuse
    "3d": WAVE.replace("[0.5, 1.0]", "[0.5, 1.0, 0.5]"),
    "walls": (FOLDER / "scenes" / "poiseuille.toml").read_text(),
    "fixed-body": WAVE + DISC + 'motion = "fixed"\n',
    "moving-body": WAVE + DISC + 'motion = "moving"\nvelocity = [0.01, 0.0]\n',
    "free-body": WAVE + DISC + "density = 1.0\n",
}
BAD = {  # a scene that no code can use, and the word that the last line of stderr has to hold
    "a scene that is no TOML": (WAVE + "\n[run\n", "TOML"),
    "a scene without a viscosity": (WAVE.replace("viscosity = 0.01\n", ""), "viscosity"),
}


@dataclass(frozen=True)
class Check:
    """One line: what was asked, whether it holds, and what is wrong or was found."""

    what: str
    holds: bool
    words: str = ""

    @property
    def line(self) -> str:
        return f"{'PASS' if self.holds else 'FAIL'}  {self.what}" + (f": {self.words}" if self.words else "")


def velocity_error(run: Run) -> float | None:
    """Root-mean-square difference of the fluid's velocity from the exact one, the largest over the snapshots, in units of
    the largest exact one; None where the run has no snapshot."""
    flow, errors, scales = exact_flow(run.scene), [], []
    for file in run.snapshots():
        data, time = read_points(file), read_time(file)
        fluid = data["kind"] == 0
        exact = flow.velocity(data["points"][fluid], time)
        errors.append(np.sqrt(np.mean((data["velocity"][fluid] - exact) ** 2)))
        scales.append(np.sqrt(np.mean(exact**2)))
    return float(max(errors) / max(scales)) if errors else None


def _written(folder: Path, name: str, text: str) -> tuple[Path, Path]:
    """The file of a scene, and the empty folder of its run."""
    file, out = folder / f"{name}.toml", folder / name
    file.write_text(text)
    out.mkdir()
    return file, out


def _ends(code: Code, folder: Path, what: str, text: str, status: int, word: str = "") -> Check:
    """Whether a scene ends with a status and a reason that holds a word, and leaves no run."""
    file, out = _written(folder, what.replace(" ", "_"), text)
    found, _, stderr = call(command(code, file, out))
    reason = last_line(stderr)
    faults = []
    if found != status:
        faults.append(f"ended with {found}, not {status}")
    if not reason:
        faults.append("said nothing on stderr")
    elif word not in reason:
        faults.append(f"does not name {word} in its last line")
    if (out / "run.json").exists():
        faults.append("left a run.json")
    return Check(f"{what} ends with {status} and a reason", not faults, "; ".join(faults + [reason] if faults else [reason]))


def _leftovers(out: Path) -> str:
    """What has no place in the folder of a run that is whole."""
    return ", ".join(sorted(path.name for path in out.rglob("*") if path.suffix in (".part", ".tmp")))


def _told(code: Code, run: Run, text: str) -> Check:
    """What run.json says of code and scene."""
    faults = []
    for key, wanted in (("code", code.name), ("version", code.version)):
        if run.record[key] != wanted:
            faults.append(f"{run.folder / 'run.json'}: {key} = {run.record[key]!r}, describe says {wanted!r}")
    if run.scene != tomllib.loads(text):
        faults.append(f"{run.folder / 'run.json'}: scene.text is not the scene that was given")
    if left := _leftovers(run.folder):
        faults.append(f"{left} left in the folder")
    return Check("run.json tells code, version and scene as given", not faults, "; ".join(faults))


def _reaches(run: Run) -> Check:
    """Whether series and snapshots go to the end of the scene, which a step of a solver may overshoot."""
    end, found = in_si(run.scene["run"]["duration"]), {}
    if (run.folder / "series.csv").exists():
        found["series.csv"] = float(run.series["time"][-1])
    if run.snapshots():
        found[run.snapshots()[-1].name] = read_time(run.snapshots()[-1])
    faults = [f"{name} ends at {time:g}" for name, time in found.items() if abs(time / end - 1) > OVERSHOOT]
    return Check(f"it runs to the end of the scene, {end:g}", not faults, "; ".join(faults))


def _answer(run: Run) -> Check:
    error = velocity_error(run)
    what = f"its velocity is the exact one within {100 * LARGEST_ERROR:g} %"
    if error is None:
        return Check(what, True, "no snapshot to compare")
    return Check(what, error <= LARGEST_ERROR, f"differs by {100 * error:.2g} %")


def _runs(code: Code, folder: Path, name: str) -> Iterator[Check]:
    """The checks of one standard scene; none after a run that fails."""
    text = (FOLDER / "scenes" / f"{name}.toml").read_text()
    if lacking(code.capabilities, asked_by(tomllib.loads(text))):
        return
    file, out = _written(folder, name, text)
    what = f"{name}: runs and leaves valid files"
    try:
        run = run_code(code, file, out)
    except Beyond as beyond:
        yield Check(f"{name}: is refused with a reason", bool(beyond.reason), beyond.reason)
        return
    except (CaseError, SolverError) as error:
        yield Check(what, False, str(error))
        return
    yield Check(what, True, f"{run.record['cost']['wall_seconds']:.2g} s")
    for check in (_told(code, run, text), _reaches(run), _answer(run)):
        yield Check(f"{name}: {check.what}", check.holds, check.words)
    yield _stops(code, file, folder / f"{name}_short", name)


def _stops(code: Code, file: Path, out: Path, name: str) -> Check:
    what = f"{name}: --steps 2 ends early"
    try:
        run = run_code(code, file, out, steps=2)
    except (Beyond, CaseError, SolverError) as error:
        return Check(what, False, str(error))
    late = [read_time(path) for path in run.snapshots()[-1:]]
    if (run.folder / "series.csv").exists():
        late.append(float(run.series["time"][-1]))
    end = in_si(run.scene["run"]["duration"])
    return Check(what, all(time < 0.9 * end for time in late), f"at {max(late):g} of {end:g}" if late else "")


def checks(name_or_path: str | Path) -> Iterator[Check]:
    """All checks of an adapter, each as it is made."""
    try:
        code = find_code(name_or_path)
    except CaseError as error:
        yield Check("describe is valid", False, str(error))
        return
    words = ", ".join(word for word in CAPABILITIES if word in code.capabilities)
    yield Check("describe is valid", True, f"{code.name} {code.version}: {words}")
    if code.missing:
        yield Check("it is installed", False, code.missing)
        return
    with tempfile.TemporaryDirectory(prefix="conform_") as place:
        folder, ran = Path(place), False
        for name in SCENES:
            for check in _runs(code, folder, name):
                ran |= check.what.endswith("valid files")
                yield check
        yield Check("it runs a standard scene", ran, "" if ran else f"none of {', '.join(SCENES)}")
        for word, text in BEYOND.items():
            if word not in code.capabilities:
                yield _ends(code, folder, f"a scene that needs {word}", text, CANNOT)
        for what, (text, word) in BAD.items():
            yield _ends(code, folder, what, text, BAD_INPUT, word)


def conform(name_or_path: str | Path) -> int:
    """Prints a line a check; 0 where all hold, else 1."""
    hold = True
    for check in checks(name_or_path):
        print(check.line, flush=True)
        hold &= check.holds
    return 0 if hold else 1
