"""python3 -m tests.mutation.bits OUT SCENE RANKS STEPS [DOMAINS]: the parallel solver against the serial reference."""

import sys
from pathlib import Path

from tests.mutation.manifest import ROOT
from verification.bits.compare import compare
from verification.codes.mappm import Options
from verification.protocol.errors import SolverError


def main(out: str, scene: str, ranks: str, steps: str, domains: str | None = None) -> int:
    overrides = (f"output.sample={max(1, int(steps) // 10)}", "output.snapshot=0")
    variants = [Options(ranks=0, steps=int(steps), overrides=overrides),
                Options(ranks=int(ranks), steps=int(steps), overrides=overrides, domains=domains)]
    comparison = compare(ROOT / "cases" / scene / "case.toml", Path(out), variants)
    print("\n".join(comparison.lines))
    return 0 if comparison.equal else 1


if __name__ == "__main__":
    try:
        sys.exit(main(*sys.argv[1:]))
    except SolverError as error:
        print(error)
        sys.exit(1)
