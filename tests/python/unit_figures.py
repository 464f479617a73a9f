"""Figures of benchmarks: queries, the way through store and export, and the charts of those published. Oracles: rows by hand."""

from dataclasses import replace
from pathlib import Path

import pytest

from bench.meter import Spread, entered, printed, row, shown, spread_of
from verification.protocol.errors import StoreError
from verification.protocol.machine import ROOT
from verification.report.page import _environment
from verification.report.speed_charts import CHARTS
from verification.store.export import export, import_into
from verification.store.figures import Figures, NoFigure, benches_of, read_benches
from verification.store.store import Figure, Made, Store

PUBLISHED = ROOT / "reports" / "published" / "bench.jsonl"
MADE = Made("2026-01-02T03:04:05Z", "a machine", "abc", "python3 -m bench.speed")
ROWS = [
    row("rate", 3e6, "1/s", fluid="plane", ranks=16),
    row("rate", 2e6, "1/s", fluid="plane", ranks=2),
    row("rate", 1e6, "1/s", fluid="plane", ranks=2, code="other"),
    row("rate", 9e6, "1/s", fluid="space", ranks=2),
    row("lanes", 8),
]


@pytest.fixture
def figures() -> Figures:
    return entered("speed", ROWS, MADE)


@pytest.fixture(scope="module")
def published() -> dict[str, Figures]:
    return read_benches(PUBLISHED)


def test_a_value_is_that_at_just_these_settings(figures: Figures) -> None:
    assert figures.value("rate", fluid="plane", ranks=2) == 2e6
    assert figures.value("rate", ranks=2, code="other", fluid="plane") == 1e6
    assert figures.value("lanes") == 8
    assert figures.get("rate", fluid="plane") is None
    assert figures.get("rate", fluid="plane", ranks=4) is None


def test_where_takes_those_that_contain_the_settings(figures: Figures) -> None:
    assert [found.value for found in figures.where("rate", fluid="plane")] == [1e6, 2e6, 3e6]
    assert [found.value for found in figures.where("rate", ranks=2)] == [1e6, 2e6, 9e6]
    assert figures.where("rate", fluid="air") == [] == figures.where("lanes", ranks=1)


def test_settings_are_numbers_by_size_then_words(figures: Figures) -> None:
    assert figures.settings("ranks") == [2, 16]
    assert figures.settings("fluid") == ["plane", "space"]
    assert figures.settings("none") == []
    assert entered("speed", [row("a", 1, k=value) for value in ("10", 16, 2)], MADE).settings("k") == [2, 16, "10"]


def test_a_figure_that_is_missing_is_named_beside_those_that_are_there(figures: Figures) -> None:
    with pytest.raises(NoFigure) as raised:
        figures.value("lanes", fluid="plane")
    assert str(raised.value).startswith("speed: no lanes at the settings fluid=plane; there are: none. ")
    with pytest.raises(LookupError, match="speed: no rat at the settings none; there are: no rat at all"):
        figures.value("rat")
    with pytest.raises(StoreError, match="solids: there are no figures; make them with `python3 -m bench.solids`"):
        assert Figures("solids", []).made


def test_rows_of_another_benchmark_are_refused(figures: Figures) -> None:
    with pytest.raises(ValueError, match="solids: rows are of speed"):
        Figures("solids", figures.rows)


def test_figures_go_through_store_and_export_unchanged(figures: Figures, tmp_path: Path) -> None:
    store = Store(tmp_path / "store.sqlite")
    store.enter_figures(figures.rows)
    assert benches_of(store)["speed"].rows == figures.rows
    export(store, tmp_path / "bench.jsonl")
    (found,) = read_benches(tmp_path / "bench.jsonl").values()
    assert found.rows == figures.rows
    assert found.made == MADE


def test_a_benchmark_is_entered_in_place_of_the_one_before(figures: Figures) -> None:
    store = Store(":memory:")
    store.enter_figures(figures.rows)
    store.enter_figures(entered("solids", [row("share", 0.5)], MADE).rows)
    store.enter_figures(entered("speed", [row("lanes", 4)], MADE).rows)
    found = benches_of(store)
    assert [len(found[name].rows) for name in ("solids", "speed")] == [1, 1]
    assert found["speed"].value("lanes") == 4


def test_an_import_takes_the_later_measurement_whole(figures: Figures, tmp_path: Path) -> None:
    """Figures of two times are never mixed, whichever is entered first."""
    later = entered("speed", [row("rate", 1.0, fluid="plane", ranks=16), row("late", 2.0)], replace(MADE, made="2026-02-01T00:00:00Z"))
    files = {"early": figures, "late": later}
    for name, found in files.items():
        store = Store(":memory:")
        store.enter_figures(found.rows)
        export(store, tmp_path / name)
    for first, second, new in (("early", "late", 2), ("late", "early", 0), ("late", "late", 0)):
        store = Store(":memory:")
        assert import_into(store, tmp_path / first) == len(files[first].rows)
        assert import_into(store, tmp_path / second) == new
        assert benches_of(store)["speed"].rows == later.rows


def test_the_published_export_is_as_the_store_writes_it(tmp_path: Path) -> None:
    store = Store(":memory:")
    assert import_into(store, PUBLISHED) == len(PUBLISHED.read_text().splitlines()) - 1
    export(store, tmp_path / "again.jsonl")
    assert (tmp_path / "again.jsonl").read_text() == PUBLISHED.read_text()


@pytest.mark.parametrize("bench", CHARTS)
def test_a_chart_is_drawn_of_the_published_figures(bench: str, published: dict[str, Figures], tmp_path: Path) -> None:
    CHARTS[bench](published[bench], tmp_path / "chart.svg")
    assert (tmp_path / "chart.svg").stat().st_size > 1000


@pytest.mark.parametrize("bench", CHARTS)
def test_a_chart_without_its_figures_says_which_it_misses(bench: str, published: dict[str, Figures], tmp_path: Path) -> None:
    with pytest.raises(NoFigure, match=f"^{bench}: no [a-z_]+ at the settings "):
        CHARTS[bench](Figures(bench, []), tmp_path / "chart.svg")


@pytest.mark.parametrize(("bench", "name", "settings"), [
    ("scaling", "efficiency", {"scaling": "weak", "fluid": "2d", "ranks": 16}),
    ("roofline", "bound_ns_per_pair", {"fluid": "3d_77", "limit": "memory"}),
    ("solids", "share", {"suspension": "sizes_3d", "ranks": 1, "part": "solids"}),
])
def test_a_chart_does_not_pass_over_a_figure(bench: str, name: str, settings: dict, published: dict[str, Figures], tmp_path: Path) -> None:
    (gone,) = published[bench].where(name, **settings)
    left = Figures(bench, [one for one in published[bench].rows if one != gone])
    with pytest.raises(NoFigure, match=f"^{bench}: no {name} at"):
        CHARTS[bench](left, tmp_path / "chart.svg")


def test_the_page_says_how_figures_were_made_and_lists_all(published: dict[str, Figures]) -> None:
    page = _environment(escape=True).get_template("speed.html.j2").render(benches=published, speed_charts={})
    for figures in published.values():
        made = figures.made
        assert f"Made {made.made} on {made.machine}, source {made.source}, by <code>{made.command}</code>" in page
    listed = page.count("<tr><td>") - 15  # those of the table beside the roofline
    assert listed == sum(len(figures.rows) for figures in published.values())
    assert "<td>bound ns per pair</td><td>fluid 2d_39, limit memory</td>" in page
    assert _environment(escape=True).get_template("speed.html.j2").render(benches={}, speed_charts={}).strip() == ""


def test_a_line_of_a_figure_is_name_settings_value_unit() -> None:
    made = Made("", "", "")
    rows = [Figure("speed", {"ranks": 2, "fluid": "space"}, "rate", 9e6, made, "1/s", 8e6, 9.5e6), Figure("speed", {}, "lanes", 8.0, made)]
    assert list(shown(Figures("speed", rows))) == ["lanes 8", "rate fluid=space ranks=2 9e+06 (8e+06 to 9.5e+06) 1/s"]


def test_a_figure_over_rounds_has_its_median_and_its_range() -> None:
    found = spread_of([3.0, 1.0, 2.0])
    assert (found, found.times(2.0)) == (Spread(2.0, 1.0, 3.0), Spread(4.0, 2.0, 6.0))
    (figure,) = entered("speed", [row("rate", found, "1/s", ranks=1)], Made("", "", "")).rows
    assert (figure.value, figure.low, figure.high) == (2.0, 1.0, 3.0)
    kept = Figures("speed", [figure])
    assert kept.off("rate", ranks=1) == (1.0, 1.0) and kept.off("rate", ranks=2) == (0.0, 0.0)


def test_what_programs_print_is_read_by_owner_and_name() -> None:
    found = printed("figure machine.lanes 8\nround 1\nratio fluid_2d_39.block_pairs.loads 1.5\nfigure alone 2\n")
    assert [(one.owner, one.name, one.value) for one in found] == [
        (("machine",), "lanes", 8.0), (("2d_39", "block_pairs"), "loads", 1.5), ((), "alone", 2.0)]
