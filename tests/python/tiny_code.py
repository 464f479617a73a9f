"""A code of a few lines for tests of what runs codes and keeps what they leave: a fluid that keeps its velocity.

A call of `run` adds a line to the file `calls` beside it. Its digest, where it has one, is the text of the file `digest` there.
Asked for a problem with levels=..., it states that a quantity of that name is 24.8.
"""

from dataclasses import dataclass
from pathlib import Path

from verification.codes.code import Code, find_code

SCENE = {"name": "tiny", "box": {"size": [1.0, 1.0]},
         "fluid": {"density": 1.0, "viscosity": 0.1, "spacing": 0.5, "velocity": [3.0, 0.0]}}
TEXT = """
import sys
from pathlib import Path
import numpy as np
from verification.protocol.adapter import Adapter, Cannot, Failed, Left, main
from verification.protocol.points import write_points
from verification.protocol.quantity import Level, Quantity

HERE = Path(__file__).parent

class Tiny(Adapter):
    name, capabilities = "tiny", frozenset({words!r})

    def version(self):
        return "1"

    def numerics_version(self):
        return {numerics!r}

    def run(self, task):
        with (HERE / "calls").open("a") as calls:
            calls.write("run\\n")
        if "wave" in task.scene["fluid"]:
            raise Cannot("tiny knows no waves")
        velocity = task.scene["fluid"]["velocity"][0]
        rows = [f"{{i}},{{i}},0,4,{{velocity}}" for i in range(3)]
        header = "time,step,momentum_defect_x,fluid_particles,fluid_velocity_x"
        (task.out / "series.csv").write_text("\\n".join([header, *rows]) + "\\n")
        write_points(task.out, 0, 0.0, np.zeros((1, 2)), np.ones((1, 2)))
        drag = {{}}
        if "problem" in task.options:
            if not task.option("levels"):
                raise Failed("no levels are given")
            levels = tuple(Level("N " + word, 1 / int(word), 24.8, 1.5) for word in task.option("levels").split(","))
            drag = {{task.option("problem"): Quantity(24.8, 0.1, levels, 2.0, "Richardson", "N/m")}}
        return Left(drag, digest=(HERE / "digest").read_text(), more={{"inputs": "12ab"}})

if __name__ == "__main__":
    sys.exit(main(Tiny()))
"""


@dataclass(frozen=True)
class Tiny:
    folder: Path
    code: Code

    @property
    def calls(self) -> int:
        """How often it ran."""
        file = self.folder / "calls"
        return len(file.read_text().splitlines()) if file.exists() else 0

    def tells(self, digest: str) -> None:
        (self.folder / "digest").write_text(digest)


def tiny(folder: Path, words: tuple[str, ...] = ("fluid",), numerics: int | None = None) -> Tiny:
    """The code in a folder of its own, with the capabilities `words`; it has a digest where that is one of them."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "tiny.py").write_text(TEXT.format(words=words, numerics=numerics))
    (folder / "digest").write_text("00ff" if "digest" in words else "")
    return Tiny(folder, find_code(folder / "tiny.py"))
