"""Pictures and data inside the page: small, and readable by a browser without a server."""

import base64
import gzip
import io
import re
from collections import Counter
from pathlib import Path
from urllib.parse import quote

from markupsafe import Markup
from PIL import Image

QUALITY = 50  # of WebP
WIDEST, WIDE = 640, 900  # pixels of a field; of one that takes the whole width of the page
SAFE = " <>=:;/',()-._~!*+@?$|[]{}"  # in an address within double quotes
UNUSED = r' id="(?:figure|axes|patch|line2d|text|matplotlib|xtick|ytick|legend)[\w.]*"'  # ids that nothing refers to


def _shorter(number: re.Match) -> str:
    return f"{round(float(number[0]), 1) + 0.0:g}"


def _without_bare_groups(svg: str) -> str:
    """From the innermost outwards."""
    while (fewer := re.sub(r"<g>((?:(?!</?g\b).)*)</g>", r"\1", svg)) != svg:
        svg = fewer
    return svg


def _with_classes(svg: str) -> str:
    """Every style that stands more than once becomes a class."""
    counts = Counter(re.findall(r' style="([^"]*)"', svg))
    names = {style: f"s{k}" for k, style in enumerate(style for style, count in counts.items() if count > 1)}
    svg = re.sub(r' style="([^"]*)"', lambda found: f' class="{names[found[1]]}"' if found[1] in names else found[0], svg)
    sheet = "".join(f".{name}{{{style.replace(': ', ':').replace('; ', ';')}}}" for style, name in names.items())
    start = svg.index(">") + 1
    return f"{svg[:start]}<style>{sheet}</style>{svg[start:]}" if names else svg


def smaller(svg: str) -> str:
    """An SVG of matplotlib without what no browser draws: metadata, comments, fonts beyond two, less than a tenth of a point."""
    svg = svg[svg.index("<svg") :]
    for nothing in (r"<metadata>.*?</metadata>", r"<!--.*?-->", UNUSED):
        svg = re.sub(nothing, "", svg, flags=re.DOTALL)
    svg = re.sub(r"font-family: [^;\"]*", "font-family: DejaVu Sans,sans-serif", svg)
    svg = re.sub(r' transform="rotate\(-0 [^"]*\)"', "", svg)
    svg = re.sub(r'(?<= d=")[^"]*|(?<= [xy]=")[^"]*', lambda found: re.sub(r"-?\d+\.\d{2,}", _shorter, found[0]), svg)
    svg = re.sub(r"\s+", " ", svg)
    svg = re.sub(r" ?([MLQCHVZz]) (?=[-\d\"])", r"\1", svg).replace("> <", "><")
    return _with_classes(_without_bare_groups(svg))


def embedded(file: Path) -> Markup:
    """A picture as a data address: SVG as text, PNG as WebP, which is smaller. It stands in double quotes as it is."""
    if file.suffix == ".svg":
        return Markup("data:image/svg+xml," + quote(smaller(file.read_text()).replace('"', "'"), safe=SAFE))
    buffer = io.BytesIO()
    picture = Image.open(file)
    picture.thumbnail((WIDE, WIDE) if picture.width > 2 * picture.height else (WIDEST, WIDEST))
    picture.save(buffer, "WEBP", quality=QUALITY)
    return Markup("data:image/webp;base64," + base64.b64encode(buffer.getvalue()).decode())


def size_of(file: Path) -> tuple[int, int]:
    """Width and height in CSS pixels, so that nothing moves while the page loads."""
    if file.suffix == ".svg":
        width, height = re.search(r'width="([\d.]+)pt" height="([\d.]+)pt"', file.read_text()).groups()
        return round(float(width) * 4 / 3), round(float(height) * 4 / 3)
    return Image.open(file).size


def packed(text: str) -> str:
    """gzip and base64; the page unpacks it when somebody asks for the data."""
    return base64.b64encode(gzip.compress(text.encode(), 9, mtime=0)).decode()
