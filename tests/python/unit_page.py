"""The page of the report without a browser. Oracles: numbers worked out by hand, and what the markup must hold."""

import base64
import gzip
import math
import re
from dataclasses import replace
from pathlib import Path

import pytest
from page_content import content

from verification.protocol.quantity import Measured
from verification.report.cards import labelled
from verification.report.chapters import chapters_of, families_of
from verification.report.embed import embedded, packed, smaller
from verification.report.figure import csv_of
from verification.report.front import Class, Point
from verification.report.matrix import FEATURES, matrix_of
from verification.report.page import write_page, write_summary
from verification.suite.case import CHAPTERS
from verification.suite.manifest import all_cases, find_case


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict, str]:
    out = tmp_path_factory.mktemp("page")
    made = content(out)
    write_page(made, out / "index.html")
    write_summary(made, out / "summary.md")
    return made, (out / "index.html").read_text()


def test_every_case_of_the_repository_names_its_chapter() -> None:
    assert {case.family for case in all_cases() if case.chapter == CHAPTERS[-1]} == {"sph_peer"}


def test_chapters_stand_in_their_order_and_cases_of_one_section_together(drawn: tuple[dict, str]) -> None:
    chapters = chapters_of(families_of(drawn[0]["results"]))
    assert [chapter.name for chapter in chapters] == [name for name in CHAPTERS if name in {one.name for one in chapters}]
    waves = next(chapter for chapter in chapters if chapter.name == "waves and decay")
    assert [section.name for section in waves.sections] == ["shear waves"]
    assert [result.case.name for result in waves.sections[0].results] == ["shear_wave", "shear_wave_k2"]
    walls = next(chapter for chapter in chapters if chapter.name == "walls")
    assert (walls.failed, walls.rows[0].result.case.name, walls.rows[0].outcome.verdict) == (1, "cavity", "FAILED")


def test_every_link_leads_somewhere_and_no_name_stands_twice(drawn: tuple[dict, str]) -> None:
    page = re.sub(r'(src|data-gzip)="[^"]*"', "", drawn[1])
    names = re.findall(r' id="([^"]*)"', page)
    assert len(names) == len(set(names)), sorted(name for name in names if names.count(name) > 1)
    links = re.findall(r'href="#([^"]*)"', page)
    assert len(links) > 40 and set(links) <= set(names), set(links) - set(names)


def test_cases_are_folded_and_what_fails_is_linked(drawn: tuple[dict, str]) -> None:
    sections = dict(re.findall(r'<details class="case" id="([^"]*)" data-verdict="[^"]*"([^>]*)>', drawn[1]))
    assert not [name for name, more in sections.items() if "open" in more]
    assert '<a href="#cavity">' in drawn[1]
    assert {"rest", "shear_waves", "cylinder_stokes", "falling_disc", "ten_cate", "crossing_2d"} < set(sections)


def test_figures_are_numbered_and_have_their_data_and_their_command(drawn: tuple[dict, str]) -> None:
    figures = re.findall(r"<figure.*?</figure>", drawn[1], re.DOTALL)
    assert [int(re.search(r"<b>Figure (\d+)\.</b> \S", figure)[1]) for figure in figures] == list(range(1, len(figures) + 1))
    assert all("data-gzip" in figure and "<code>python3 " in figure for figure in figures[:2])
    told = gzip.decompress(base64.b64decode(re.search(r'data-gzip="([^"]*)"', figures[0])[1])).decode().splitlines()
    assert told[0] == "chapter,case,observable,tier,reference,measured,verdict"
    assert len(told) - 1 == sum(len(one.points) for one in drawn[0]["classes"])


def test_words_and_the_paper_are_explained(drawn: tuple[dict, str]) -> None:
    for words in ("<dt>PP</dt>", "<dt>FP</dt>", "<dt>SP</dt>", "doi.org/10.1360/04yb0020", "47 (5), 2004, 434"):
        assert words in drawn[1]


def _luminance(colour: str) -> float:
    """Relative, by WCAG 2."""
    parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def test_every_colour_of_text_stands_out_from_both_grounds_in_both_styles(drawn: tuple[dict, str]) -> None:
    light_and_dark = re.findall(r":root \{(.*?)\}", drawn[1], re.DOTALL)[:2]
    for style in (dict(re.findall(r"--(\w+): (#[0-9a-f]{6})", block)) for block in light_and_dark):
        for ground in (style["page"], style["panel"]):
            for name in ("ink", "soft", "link", "good", "bad", "skip"):
                dark, light = sorted((_luminance(style[name]), _luminance(ground)))
                assert (light + 0.05) / (dark + 0.05) >= 4.5, (name, style[name], ground)


def test_bias_and_spread_are_mean_and_deviation_of_the_logarithm(drawn: tuple[dict, str]) -> None:
    outcome = drawn[0]["classes"][0].points[0].outcome
    held = replace(outcome, observable=replace(outcome.observable, reference=2.0))
    values = (2.0 * math.e**0.01, 2.0 * math.e**0.03)
    one = Class("c", tuple(Point("c", "full", replace(held, measured=Measured(value, 0.0))) for value in values))
    assert one.bias == pytest.approx(math.exp(0.02))
    assert one.spread == pytest.approx(0.01 * math.sqrt(2))
    assert one.furthest.ratio == pytest.approx(math.exp(0.03))


def test_the_matrix_says_what_a_case_has_and_what_none_has() -> None:
    matrix = matrix_of([*(case for case in all_cases() if case.family in ("cylinder_stokes", "crossing_2d"))])
    rows = {row.name: row for row in matrix.rows}
    assert {"plane", "fluid", "fixed bodies", "reference code", "published or computed"} <= rows["cylinder_stokes"].features
    assert {"equal bits", "over processes", "free bodies", "contact"} <= rows["crossing_2d"].features
    assert matrix.without_reference == ["crossing_2d"]
    assert "space" in matrix.empty and "walls" in matrix.empty and "plane" not in matrix.empty
    assert "over processes" not in matrix.missing("contact", "plane") and "over processes" in matrix.missing("contact", "space")
    assert rows["cylinder_stokes"].points == len([case for case in all_cases() if case.family == "cylinder_stokes"])
    assert set(matrix.counts) == set(FEATURES)
    assert find_case("rest").chapter == "rest and bits"


def test_cells_carry_the_words_of_their_column() -> None:
    head, row = "<tr><th>case</th><th>k u<sub>val</sub></th><th>tier</th></tr>", "<tr><td>one</td><td>2</td><td>full</td></tr>"
    page = f'<p><table class="a">{head}{row}<tr><td colspan="2">x</td><td>full</td></tr></table>'
    style = "--c1:'case';--c2:'k uval';--c3:'tier'"
    assert labelled(page) == (f'<p><table style="{style}" class="a"><thead>{head}</thead><tbody>{row}'
                              '<tr><td colspan="2">x</td><td data-label="tier">full</td></tr></tbody></table>')
    headless = "<table><tr><th>key</th><td>value</td></tr></table>"
    assert labelled(headless) == headless


def test_a_picture_is_embedded_small_and_whole(tmp_path: Path) -> None:
    svg = ('<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg" width="72pt" height="36pt">\n <metadata>x</metadata>\n'
           ' <g id="axes_1"><path id="kept" d="M 1.23456 2.0 \nL 3.99999 -0.001 \n" style="font-family: A, B"/></g>\n</svg>\n')
    assert smaller(svg) == ('<svg xmlns="http://www.w3.org/2000/svg" width="72pt" height="36pt"><path id="kept" '
                            'd="M1.2 2.0L4 0 " style="font-family: DejaVu Sans,sans-serif"/></svg> ')
    twice = '<svg a="1"><path style="fill: red; x: 1"/><g clip-path="url(#c)"><path style="fill: red; x: 1"/></g></svg>'
    assert smaller(twice) == ('<svg a="1"><style>.s0{fill:red;x:1}</style><path class="s0"/>'
                              '<g clip-path="url(#c)"><path class="s0"/></g></svg>')
    (tmp_path / "a.svg").write_text(svg)
    address = embedded(tmp_path / "a.svg")
    assert address.startswith("data:image/svg+xml,<svg xmlns='http") and '"' not in address and "#" not in address
    assert gzip.decompress(base64.b64decode(packed("a,b\n"))) == b"a,b\n"
    assert csv_of(("a", "b"), [("x, y", 1 / 3)]) == 'a,b\n"x, y",0.333333\n'
