"""The judge itself. Oracles: signals and tables written here, whose answers are known."""

import math
from pathlib import Path

import numpy as np
import pytest

from verification.bits.compare import PairDifference, trace_differences
from verification.bits.equivalence import Row, read_equivalence
from verification.measures.fits import decay_rate, extrapolate, relaxed
from verification.protocol.errors import CaseError
from verification.protocol.quantity import Measured
from verification.protocol.series import first_difference, read_table
from verification.suite.case import Observable
from verification.suite.judge import FAILED, INCONCLUSIVE, WITHIN_GOAL, Outcome
from verification.suite.manifest import all_cases, read_cases
from verification.suite.runner import measures_of

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


def test_extrapolation_with_a_known_time_does_not_follow_a_drift() -> None:
    rising = 3.0 + 0.1 * TIME
    assert extrapolate(TIME, rising, 0.2).value == pytest.approx(3.75, rel=0.01)  # the mean of the second half
    assert extrapolate(TIME, rising).value > 4.0
    assert relaxed(TIME, 3.0 - 2.0 * np.exp(-TIME / 2.5), 2.5).value == pytest.approx(3.0, rel=1e-12)


def test_the_error_of_a_limit_is_that_of_the_mean_of_its_noise() -> None:
    time = np.linspace(0.0, 10.0, 4001)
    noise = np.random.default_rng(1).normal(0.0, 0.1, len(time))
    limit = relaxed(time, 3.0 + noise, 0.01)
    assert limit.noise == pytest.approx(0.1, rel=0.05)
    assert limit.error == pytest.approx(0.1 / np.sqrt(2000), rel=0.6)  # from eight stretches: good to a quarter, twice over


def test_decay_rate_of_an_exponential() -> None:
    rate, error = decay_rate(TIME, 5.0 * np.exp(-0.7 * TIME))
    assert rate == pytest.approx(0.7, rel=1e-12)  # a straight line in the logarithm, fitted to rounding
    assert error < 1e-12


GIVEN = Observable("drag", "F", 50.0, 0.1, "hand", 0.03)


@pytest.mark.parametrize(
    ("value", "objection", "verdict"),
    [(51.49, "", WITHIN_GOAL), (48.51, "", WITHIN_GOAL), (51.51, "", FAILED), (48.49, "", FAILED), (50.0, "unsettled", INCONCLUSIVE)],
)
def test_verdicts(value: float, objection: str, verdict: str) -> None:
    # However noisy a figure is, its noise does not widen the goal.
    outcome = Outcome(GIVEN, Measured(value, 10.0, objection))
    assert outcome.verdict == verdict
    assert outcome.line.startswith(f"F = {value:g} +- 10 (reference 50 +- 0.1, error ")


def test_a_figure_that_is_no_number_has_failed() -> None:
    assert Outcome(GIVEN, Measured(math.nan, 0.0)).verdict == FAILED


def test_every_case_has_a_sound_manifest() -> None:
    cases = all_cases()
    assert len(cases) >= 9
    for case in cases:
        assert all(observable.name in measures_of(case.file.parent) for observable in case.observables)
        assert all(observable.goal >= 0.0 for observable in case.observables)


@pytest.mark.parametrize(
    ("manifest", "message"),
    [
        ("", "case: missing; add a table"),
        ('[case]\ntier = "quick"\ncost = 1', "case.purpose: missing"),
        ('[case]\npurpose = "p"\ntier = "slow"\ncost = 1', "case.tier = 'slow': unknown; known are quick, full"),
        ('[case]\npurpose = "p"\nchapter = "wals"\ntier = "quick"\ncost = 1', "case.chapter = 'wals': unknown; known are rest and bits, "),
        ('[case]\npurpose = "p"\ntier = "quick"\ncost = "1"', "case.cost = '1': wrong type"),
        ('[case]\npurpose = "p"\ntier = "quick"\ncost = 1\ncolour = 2', "case.colour: unknown"),
    ],
)
def test_a_bad_manifest_is_refused(tmp_path: Path, manifest: str, message: str) -> None:
    file = tmp_path / "case.toml"
    file.write_text(manifest)
    with pytest.raises(CaseError) as caught:
        read_cases(file)
    assert str(file) in str(caught.value)
    assert message in str(caught.value)


WHERE = "a/case.toml: case.equivalence"
MATRIX = {"steps": 100, "every": 50, "variants": ["serial", "P=2"]}


def test_words_of_a_variant_become_options() -> None:
    labels = ["serial all-pairs", "domains 2x3", "P=2 threads 2", "rebalance 10", "build clang", "restart 2->3",
              "build portable isa avx2"]
    found = [v.options for v in read_equivalence(MATRIX | {"variants": labels}, WHERE).variants]
    assert [options.ranks for options in found] == [0, 6, 2, 2, 2, 2, 2]
    assert found[0].neighbours == "all-pairs"
    assert found[1].domains == "2x3"
    assert found[2].threads == 2
    assert found[3].rebalance == 10
    assert found[4].build.name == "clang"
    assert (found[6].build.name, found[6].isa) == ("portable", "avx2")
    assert read_equivalence(MATRIX | {"variants": labels}, WHERE).variants[5].resumed_on == 3


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"steps": 0}, "steps = 0: must be a positive"),
        ({"every": 30}, "every = 30: must divide steps = 100"),
        ({"variants": ["serial"]}, "variants = ['serial']: must be a list of at least two"),
        ({"variants": ["serial", "serial"]}, "variants[1] = 'serial': stands twice"),
        ({"variants": ["serial", "P=two"]}, "variants[1] = 'P=two': 'two' is no positive number"),
        ({"variants": ["serial", "ranks 2"]}, "variants[1] = 'ranks 2': 'ranks' is unknown"),
        ({"variants": ["serial", "P=3 domains 2x2"]}, "2x2 are 4 domains, not 3; write P=4"),
        ({"variants": ["serial", "serial threads 2"]}, "the serial reference goes with"),
        ({"variants": ["serial", "isa avx2"]}, "isa is one of plain, avx2, avx512, and goes with a build"),
        ({"variants": ["serial", "build portable isa sse2"]}, "isa is one of plain, avx2, avx512"),
        ({"variants": ["serial", "restart 2"]}, "restart stands alone, as in 'restart 2->3'"),
        ({"colour": 1}, "colour = 1: unknown; known are steps, every, variants"),
    ],
)
def test_a_bad_matrix_is_refused(changed: dict, message: str) -> None:
    with pytest.raises(CaseError) as caught:
        read_equivalence(MATRIX | changed, WHERE)
    assert str(caught.value).startswith(WHERE + ".")
    assert message in str(caught.value)


def test_a_skipped_variant_is_not_equal() -> None:
    assert Row("P=2", "00", samples=3).equal
    assert not Row("P=2", "00", difference=50, samples=3).equal
    assert not Row("build clang", skipped="not built").equal


def test_pairs_that_differ_are_named(tmp_path: Path) -> None:
    head = "step,particle,kind,partner,impulse_x,density\n"
    one, other = tmp_path / "one.csv", tmp_path / "other.csv"
    one.write_text(head + "5,1,PP,7,10,3\n5,1,PP,8,11,3\n5,1,FP,2:31,5,4\n5,1,PP,9,1,1\n")
    other.write_text(head + "5,1,PP,7,10,3\n5,1,PP,8,12,3\n5,1,FP,2:31,5,4\n5,1,FP,2:31,5,4\n")
    assert trace_differences(one, other) == (
        PairDifference("FP 2:31", {}, (1, 2)),
        PairDifference("PP 9", {}, (1, 0)),
        PairDifference("PP 8", {"impulse_x": ("11", "12")}, (1, 1)),
    )
    assert trace_differences(one, other)[-1].line(("a", "b")) == "a | b: pair with PP 8: impulse_x 11 | 12"
    assert trace_differences(one, one) == ()
