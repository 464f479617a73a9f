"""The page of the report in Chromium, at the width of a desk and of a phone, light and dark. Oracle: the browser."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from browser import Browser, browser, find_browser
from page_content import content

from verification.report.page import write_page

pytestmark = pytest.mark.skipif(find_browser() is None, reason="Chromium is not installed: apt-get install chromium, or ./setup")

WIDTHS, STYLES = (1280, 390), ("light", "dark")
FACTOR = 4.5  # least contrast of text, WCAG 2 AA
UNFOLD = "document.querySelectorAll('details').forEach(one => { one.open = true; })"
BEYOND = """[...document.querySelectorAll('main *, nav *')].filter(one => one.getBoundingClientRect().right > innerWidth + 1)
  .slice(0, 5).map(one => one.tagName + ' ' + one.className + ': ' + one.textContent.slice(0, 60))"""
CONTRAST = """(() => {
  const numbers = colour => colour.match(/[\\d.]+/g).map(Number);
  const light = ([r, g, b]) => [r, g, b].map(v => v / 255).map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
  const ground = one => { for (; one; one = one.parentElement) {
    const c = numbers(getComputedStyle(one).backgroundColor); if (c.length < 4 || c[3] > 0) return c; } return [255, 255, 255]; };
  const found = {};
  for (const one of document.querySelectorAll('body *')) {
    if (['SCRIPT', 'STYLE', 'OPTION'].includes(one.tagName) || !one.getClientRects().length) continue;
    if (![...one.childNodes].some(node => node.nodeType === 3 && node.textContent.trim())) continue;
    const [a, b] = [light(numbers(getComputedStyle(one).color)), light(ground(one))].sort((x, y) => y - x);
    const ratio = (a + 0.05) / (b + 0.05);
    if (ratio < LEAST) found[one.tagName + '.' + one.className] = ratio;
  }
  return found;
})()""".replace("LEAST", str(FACTOR))


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("page")
    write_page(content(out), out / "index.html")
    return out / "index.html"


@pytest.fixture(scope="module")
def tab() -> Iterator[Browser]:
    with browser() as opened:
        yield opened


@pytest.mark.parametrize("style", STYLES)
@pytest.mark.parametrize("width", WIDTHS)
def test_nothing_is_cut_off_or_hard_to_read(tab: Browser, page: Path, width: int, style: str) -> None:
    tab.open(page, width, style)
    assert tab.value("matchMedia('(prefers-color-scheme: dark)').matches") == (style == "dark")
    tab.value(UNFOLD)
    assert tab.value("document.documentElement.scrollWidth") <= width, tab.value(BEYOND)
    assert tab.value(BEYOND) == []
    assert tab.value(CONTRAST) == {}
    assert tab.complaints == []


def test_the_page_is_small_and_no_longer_than_it_may_be(tab: Browser, page: Path) -> None:
    """4 MB and 30 000 pixels, as verification/report/README.md has them."""
    tab.open(page, 1280)
    assert page.stat().st_size < 4e6 and tab.value("document.documentElement.scrollHeight") < 30_000


def test_every_link_within_the_page_has_its_target(tab: Browser, page: Path) -> None:
    tab.open(page, 1280)
    lost = "[...document.querySelectorAll('a[href^=\"#\"]:not(.csv)')].filter(one => !document.getElementById(one.hash.slice(1)))"
    assert tab.value(f"{lost}.map(one => one.hash)") == []


def test_a_link_unfolds_the_case_it_leads_to(tab: Browser, page: Path) -> None:
    tab.open(page, 1280)
    assert tab.value("document.getElementById('shear_wave_k2').checkVisibility()") is False
    tab.value("""new Promise(done => {
      addEventListener('hashchange', () => setTimeout(done, 0));
      location.hash = 'shear_wave_k2';
    })""")
    assert tab.value("document.getElementById('shear_wave_k2').open && document.getElementById('shear_waves').open")


TYPE = "{ const box = document.querySelector('.filter input'); box.value = '%s'; box.dispatchEvent(new Event('input')); }"
SHOWN = "[...document.querySelectorAll('tr.row')].filter(row => !row.hidden).map(row => row.textContent)"


def test_rows_are_filtered_by_words_and_by_verdicts(tab: Browser, page: Path) -> None:
    tab.open(page, 1280)
    everything = len(tab.value(SHOWN))
    tab.value(TYPE % "SHEAR k2")
    found = tab.value(SHOWN)
    assert 0 < len(found) < everything and all("shear_wave_k2" in text for text in found)
    tab.value(TYPE % "")
    assert len(tab.value(SHOWN)) == everything
    tab.value("document.querySelector('.filter button[value=FAILED]').click()")
    found = tab.value(SHOWN)
    assert found and all("FAILED" in text for text in found)
    assert tab.value("document.querySelector('.filter output').textContent") == f"{len(found)} of {everything} rows"
    assert tab.value("document.getElementById('chapter_rest_and_bits').hidden")


def test_a_click_on_a_head_sorts_by_numbers_and_a_second_turns_it_round(tab: Browser, page: Path) -> None:
    tab.open(page, 1280)
    table = "document.querySelector('#chapter_falling_bodies table')"
    values = f"[...{table}.tBodies[0].rows].map(row => parseFloat(row.cells[2].textContent))"
    tab.value(f"{table}.tHead.rows[0].cells[2].click()")
    rising = tab.value(values)
    assert rising == sorted(rising) and len(set(rising)) > 2
    tab.value(f"{table}.tHead.rows[0].cells[2].click()")
    assert tab.value(values) == sorted(rising, reverse=True)


def test_the_data_of_a_figure_are_unpacked(tab: Browser, page: Path) -> None:
    tab.open(page, 1280)
    text = tab.value("""new Promise(done => {
      const make = URL.createObjectURL;
      URL.createObjectURL = blob => { blob.text().then(done); return make(new Blob()); };
      document.querySelector('a.csv').click();
    })""")
    assert text.startswith("chapter,case,observable,tier,reference,measured,verdict\n") and text.count("\n") > 10
    assert tab.complaints == []


def test_without_scripts_the_page_is_whole(page: Path) -> None:
    text = page.read_text()
    assert text.count("<nav>") == 1 and ".js .filter { display: block }" in text and '<a class="csv" hidden' in text
