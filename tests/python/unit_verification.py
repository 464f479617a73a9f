"""The judge itself. Oracles: signals and tables written here, whose answers are known."""

import math
from pathlib import Path

import numpy as np
import pytest

from verification.case import Observable, all_cases, read_case
from verification.errors import CaseError
from verification.fits import decay_rate, extrapolate, minima
from verification.judge import CORRECT, OPEN, WRONG, Outcome, measures
from verification.observables import Measured
from verification.series import first_difference, read_table

TIME = np.linspace(0.0, 10.0, 501)


def table(path: Path, digests: list[str]):
    rows = [f"{100 * i},{0.5 * i},{digest}" for i, digest in enumerate(digests)]
    path.write_text("\n".join(["step,time [s],digest", *rows]) + "\n")
    return read_table(path)


def test_a_table_is_read_with_its_units(tmp_path: Path) -> None:
    read = table(tmp_path / "a.csv", ["00ff", "1e05"])
    assert read.units == {"step": "", "time": "s", "digest": ""}
    assert list(read["time"]) == [0.0, 0.5]
    assert list(read["digest"]) == ["00ff", "1e05"]  # text, though it reads like a number
    with pytest.raises(KeyError, match="no column 'drag'; there are step, time, digest"):
        read["drag"]


def test_the_first_difference_is_named(tmp_path: Path) -> None:
    same = {"a": table(tmp_path / "a.csv", ["1", "2", "3"]), "b": table(tmp_path / "b.csv", ["1", "2", "3"])}
    assert first_difference(same) is None
    other = same | {"c": table(tmp_path / "c.csv", ["1", "9", "3"])}
    assert first_difference(other) == (100, {"a": "2", "b": "2", "c": "9"})
    shorter = same | {"c": table(tmp_path / "d.csv", ["1", "2"])}
    assert first_difference(shorter) == (200, {"a": "3", "b": "3", "c": "no row"})


def test_extrapolation_finds_the_limit_of_a_decay() -> None:
    limit = extrapolate(TIME, 3.0 - 2.0 * np.exp(-TIME / 2.5))
    assert limit.value == pytest.approx(3.0, rel=2e-3)  # tau is searched on a grid of 6 % steps
    assert limit.last == pytest.approx(3.0 - 2.0 * np.exp(-9.5 / 2.5), rel=2e-3)
    unsettled = extrapolate(TIME, 3.0 - 2.0 * np.exp(-TIME / 5.0))
    assert unsettled.gap > 0.05  # 2 exp(-9.5/5) / 3 = 0.10 is still missing


def test_decay_rate_of_an_exponential() -> None:
    rate, error = decay_rate(TIME, 5.0 * np.exp(-0.7 * TIME))
    assert rate == pytest.approx(0.7, rel=1e-12)  # a straight line in the logarithm, fitted to rounding
    assert error < 1e-12


def test_minima_of_a_damped_oscillation() -> None:
    found = minima(TIME, np.cos(2.0 * TIME) ** 2 * np.exp(-0.05 * TIME))
    exact = (np.arange(len(found)) + 0.5) * math.pi / 2.0
    assert len(found) == 6
    assert found == pytest.approx(exact, abs=1e-4)  # a parabola through samples 0.02 apart


GIVEN = Observable("drag", "F", 50.0, 0.1, "hand", 0.03)


@pytest.mark.parametrize(
    ("value", "objection", "verdict"),
    [(51.49, "", CORRECT), (48.51, "", CORRECT), (51.51, "", WRONG), (48.49, "", WRONG), (50.0, "unsettled", OPEN)],
)
def test_verdicts(value: float, objection: str, verdict: str) -> None:
    # However noisy a figure is, its noise does not widen the goal.
    outcome = Outcome(GIVEN, Measured(value, 10.0, objection))
    assert outcome.verdict == verdict
    assert outcome.line.startswith(f"F = {value:g} +- 10 (reference 50 +- 0.1, error ")


def test_a_figure_that_is_no_number_is_wrong() -> None:
    assert Outcome(GIVEN, Measured(math.nan, 0.0)).verdict == WRONG


def test_every_case_has_a_sound_manifest() -> None:
    cases = all_cases()
    assert len(cases) >= 9
    for case in cases:
        assert all(observable.name in measures(case) for observable in case.observables)
        assert all(observable.goal >= 0.0 for observable in case.observables)


@pytest.mark.parametrize(
    ("manifest", "message"),
    [
        ("", "case: missing; add a table"),
        ('[case]\ntier = "quick"\ncost = 1', "case.purpose: missing"),
        ('[case]\npurpose = "p"\ntier = "slow"\ncost = 1', "case.tier = 'slow': unknown; known are quick, full"),
        ('[case]\npurpose = "p"\ntier = "quick"\ncost = "1"', "case.cost = '1': wrong type"),
        ('[case]\npurpose = "p"\ntier = "quick"\ncost = 1\ncolour = 2', "case.colour: unknown"),
    ],
)
def test_a_bad_manifest_is_refused(tmp_path: Path, manifest: str, message: str) -> None:
    file = tmp_path / "case.toml"
    file.write_text(manifest)
    with pytest.raises(CaseError) as caught:
        read_case(file)
    assert str(file) in str(caught.value)
    assert message in str(caught.value)
