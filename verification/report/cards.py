"""Tables that a phone shows as cards: every cell gets the words of its column."""

import re

TABLE = re.compile(r"<table.*?</table>", re.DOTALL)
ROW = re.compile(r"<tr\b[^>]*>.*?(?=<tr\b|</table>|</tbody>)", re.DOTALL)
CELL = re.compile(r"<t([hd])\b([^>]*)>(.*?)(?=</t[hd]>)", re.DOTALL)


def _words(html: str) -> str:
    return " ".join(re.sub(r"<[^>]*>", "", html).split()).replace('"', "&quot;")


def _span(attributes: str) -> int:
    found = re.search(r'colspan="(\d+)"', attributes)
    return int(found[1]) if found else 1


def _labelled_row(row: str, labels: list[str]) -> str:
    place = 0

    def cell(found: re.Match) -> str:
        nonlocal place
        label, span = labels[place] if place < len(labels) else "", _span(found[2])
        place += span
        named = f' data-label="{label}"' if label and found[1] == "d" and span == 1 else ""
        return f"<t{found[1]}{found[2]}{named}>{found[3]}"

    return CELL.sub(cell, row)


def _labelled_table(found: re.Match) -> str:
    table = found[0]
    rows = ROW.findall(table)
    if not rows or "<td" in rows[0] or len(rows) < 2:
        return table  # without a head
    labels = [_words(content) for _, attributes, content in CELL.findall(rows[0]) for _ in range(_span(attributes))]
    start = table.index(rows[0])
    body = table[start + len(rows[0]) :].removesuffix("</table>")
    return (f"{table[:start]}<thead>{rows[0].rstrip()}</thead><tbody>"
            f"{ROW.sub(lambda row: _labelled_row(row[0], labels), body + '</table>').removesuffix('</table>')}</tbody></table>")


def labelled(page: str) -> str:
    """The page, with heads of tables marked as such and a `data-label` at every cell below them."""
    return TABLE.sub(_labelled_table, page)
