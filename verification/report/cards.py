"""Tables that a phone shows as cards: every cell gets the words of its column.

The words stand once, in a style of the table (`--c1`, `--c2`, ...), from which page.css writes them before the cells. A cell
that comes after one over several columns is no longer the child of that number, and carries its words itself.
"""

import re

TABLE = re.compile(r"<table.*?</table>", re.DOTALL)
ROW = re.compile(r"<tr\b[^>]*>.*?(?=<tr\b|</table>|</tbody>)", re.DOTALL)
CELL = re.compile(r"<t([hd])\b([^>]*)>(.*?)(?=</t[hd]>)", re.DOTALL)


def _words(html: str) -> str:
    return " ".join(re.sub(r"<[^>]*>", "", html).split()).replace('"', "&quot;").replace("'", "")


def _span(attributes: str) -> int:
    found = re.search(r'colspan="(\d+)"', attributes)
    return int(found[1]) if found else 1


def _labelled_row(row: str, labels: list[str]) -> str:
    if "colspan" not in row:
        return row
    place = 0

    def cell(found: re.Match) -> str:
        nonlocal place
        label, span = labels[place] if place < len(labels) else "", _span(found[2])
        place += span
        return f"<t{found[1]}{found[2]}" + (f' data-label="{label}">' if label and span == 1 else ">") + found[3]

    return CELL.sub(cell, row)


def _labelled_table(found: re.Match) -> str:
    table = found[0]
    rows = ROW.findall(table)
    if not rows or "<td" in rows[0] or len(rows) < 2:
        return table  # without a head
    labels = [_words(content) for _, attributes, content in CELL.findall(rows[0]) for _ in range(_span(attributes))]
    start = table.index(rows[0])
    body = table[start + len(rows[0]) :].removesuffix("</table>") + "</table>"
    labelled_body = ROW.sub(lambda row: _labelled_row(row[0], labels), body).removesuffix("</table>")
    style = ";".join(f"--c{k}:'{label}'" for k, label in enumerate(labels, start=1) if label)
    opened = table[:start].replace("<table", f'<table style="{style}"', 1)
    return f"{opened}<thead>{rows[0].rstrip()}</thead><tbody>{labelled_body}</tbody></table>"


def labelled(page: str) -> str:
    """The page, with heads of tables marked as such, the words of columns known to their cells, and no indentation of tags."""
    return re.sub(r"\n\s+(?=<)", "\n", TABLE.sub(_labelled_table, page))
