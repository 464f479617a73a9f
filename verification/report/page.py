"""Fills the templates of reports/templates."""

import itertools
import math
from pathlib import Path

import jinja2

from verification.protocol.machine import ROOT
from verification.report.cards import labelled
from verification.report.chapters import tier_of
from verification.report.embed import embedded, packed, size_of
from verification.report.headline import standard_text
from verification.suite.judge import CODE_TO_CODE, SKIPPED, VALIDATED, VERDICTS, WITHIN_GOAL
from verification.suite.ladder import CONVERGING, FORMAL, NOISE_LIMITED, order_text
from verification.suite.student import NORMAL

TEMPLATES = ROOT / "reports" / "templates"


TONES = {VALIDATED: "good", CONVERGING: "good", WITHIN_GOAL: "plain", CODE_TO_CODE: "plain", NOISE_LIMITED: "plain",
         SKIPPED: "skip"}


def _tone(word: str) -> str:
    """Class of a verdict, or of what levels show."""
    return TONES.get(word, "bad")


def _environment(escape: bool) -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES), undefined=jinja2.StrictUndefined, autoescape=escape,
        trim_blocks=True, lstrip_blocks=True,
    )
    environment.filters |= {"embedded": embedded, "packed": packed, "size": size_of,
                            "number": lambda value: f"{value:.4g}", "g": lambda value: f"{value:g}",
                            "order": order_text, "isnan": math.isnan, "standard": standard_text, "tier": tier_of}
    environment.globals |= {"SKIPPED": SKIPPED, "NORMAL": NORMAL, "FORMAL": FORMAL, "VERDICTS": VERDICTS, "tone": _tone,
                            "number_of_figure": itertools.count(1).__next__}
    return environment


def write_page(content: dict, file: Path) -> None:
    file.write_text(labelled(_environment(escape=True).get_template("report.html.j2").render(**content)))


def write_summary(content: dict, file: Path) -> None:
    """For the repository: pictures lie beside it."""
    file.write_text(_environment(escape=False).get_template("summary.md.j2").render(**content))
