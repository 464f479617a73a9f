"""Results change only together with the numerics version, the number in solver/base/numerics_version.hpp.

Oracle: digests that were stored when the version was raised, with that version, in numerics_digests.json beside this file.
They say that nothing has changed, and not that it is right.
"""

import json
import subprocess
from pathlib import Path

from verification.codes.mappm import Options, program, run
from verification.protocol.machine import ROOT

STORED = Path(__file__).parent / "numerics_digests.json"
SINGLE = "fluid.precision=single"
SCENES = {  # steps and overrides of cases; the first two have free solids that turn and touch
    "crossing_2d": ("crossing_2d", 100, ()),
    "crossing_3d": ("crossing_3d", 40, ()),
    "crossing_2d, single precision": ("crossing_2d", 100, (SINGLE,)),
    "crossing_2d, classic": ("crossing_2d", 40, ("fluid.method=classic",)),
    "cavity": ("cavity", 20, ("fluid.disorder={amplitude=0.2,seed=1}",)),
}


def test_results_change_with_the_numerics_version_only(tmp_path: Path) -> None:
    records = {}
    for i, (name, (case, steps, overrides)) in enumerate(SCENES.items()):
        options = Options(steps=steps, overrides=(*overrides, "output.snapshot=0"))
        records[name] = run(ROOT / "cases" / case / "case.toml", tmp_path / str(i), options).record
    (version,) = {record["numerics_version"] for record in records.values()}
    now = {"numerics_version": version, "digests": {name: record["digest"] for name, record in records.items()}}
    stored = json.loads(STORED.read_text())
    text = f"{STORED.name} would now be\n{json.dumps(now, indent=2)}"
    assert version == stored["numerics_version"], (
        f"the numerics version is {version} and the stored digests are of {stored['numerics_version']}: renew both together; {text}"
    )
    changed = [name for name in now["digests"] if now["digests"][name] != stored["digests"].get(name)]
    assert not changed, (
        f"results of {', '.join(changed)} changed without a new numerics version: if they were meant to, raise it in "
        f"solver/base/numerics_version.hpp and renew the digests with it; {text}"
    )
    assert set(stored["digests"]) == set(SCENES)


def test_the_programs_say_the_version() -> None:
    version = json.loads(STORED.read_text())["numerics_version"]
    for name in ("mappm", "mappm-reference"):
        said = subprocess.run([program(name), "--version"], capture_output=True, text=True, check=True).stdout
        assert f", numerics {version}" in said
