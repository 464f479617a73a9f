"""Are the bits equal? Runs one scene in several ways and compares the digests of every sample."""

from dataclasses import dataclass
from pathlib import Path

from verification.series import first_difference
from verification.solver import Options, Run, run


@dataclass(frozen=True)
class Comparison:
    runs: tuple[Run, ...]
    difference: tuple[int, dict[str, str]] | None

    @property
    def equal(self) -> bool:
        return self.difference is None

    @property
    def lines(self) -> list[str]:
        if self.difference is not None:
            step, digests = self.difference
            return [f"first difference at step {step}:", *(f"  {digest}  {name}" for name, digest in digests.items())]
        series = self.runs[0].series
        names = "; ".join(finished.options.label for finished in self.runs)
        return [f"equal at all {len(series)} samples up to step {int(series['step'][-1])}, "
                f"digest {series['digest'][-1]}: {names}"]


def compare(scene: Path, out: Path, variants: list[Options]) -> Comparison:
    """Runs every variant in a folder of its own under `out`; their labels must differ."""
    runs = tuple(run(scene, out / str(i), options) for i, options in enumerate(variants))
    return compare_runs(runs)


def compare_runs(runs: tuple[Run, ...]) -> Comparison:
    tables = {finished.options.label: finished.series for finished in runs}
    if len(tables) != len(runs):
        raise ValueError("two runs of a comparison share a label")
    return Comparison(runs, first_difference(tables))
