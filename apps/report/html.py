# SPDX-License-Identifier: BSD-3-Clause
"""Parts of a page, and the page itself: headings, tables, texts, figures that can be zoomed."""
import html
import os
import pathlib

from figures.files import replacing

from . import narrow, svg

HERE = pathlib.Path(__file__).resolve().parent
GENERATOR = '<meta name="generator" content="Isostat">'  # of every page
LARGEST = 1.7  # pixels of the page for a point of a figure: 9 pt are then as large as a heading
WIDE = 560  # width in points from which a figure takes the whole width of the page
HINT = ("Select a figure with a click, a touch or the tab key. Then turn the wheel, pinch, or press + and - to zoom; "
        "drag or use the arrow keys to move. A double click or 0 brings it back.")


def escape(text):
    return html.escape(str(text))


def section(title, *parts, name):
    """A section with its heading; nothing if it has no parts."""
    body = "\n".join(part for part in parts if part)
    return f'<section id="{name}">\n<h2>{escape(title)}</h2>\n{body}\n</section>\n' if body else ""


def paragraph(text, kind=""):
    return f'<p{attribute("class", kind)}>{escape(text)}</p>'


def attribute(name, value):
    return f' {name}="{escape(value)}"' if value else ""


def text_block(text, label):
    """Text as it is, which may be scrolled."""
    return f'<pre tabindex="0" role="region" aria-label="{escape(label)}">{escape(text.strip(chr(10)))}</pre>'


def properties(pairs):
    """Names and values, one pair a row."""
    rows = "\n".join(f'<tr><th scope="row">{escape(name)}</th><td>{escape(value)}</td></tr>' for name, value in pairs)
    return f'<table class="properties">\n{rows}\n</table>' if rows else ""


def table(head, rows, label, numbers=()):
    """A table with a head. `numbers` are the columns that are set flush right; a row may begin with a class in a
    list: (["same"], cells...)."""
    def cells(row, tag):
        return "".join(f'<{tag}{attribute("class", "number" if k in numbers else "")}>{escape(cell)}</{tag}>'
                       for k, cell in enumerate(row))
    lines = []
    for row in rows:
        kind, row = (row[0][0], row[1:]) if isinstance(row[0], list) else ("", row)
        lines.append(f'<tr{attribute("class", kind)}>{cells(row, "td")}</tr>')
    body = "\n".join(lines)
    return (f'<div class="scroll" tabindex="0" role="region" aria-label="{escape(label)}">\n<table>\n'
            f'<thead><tr>{cells(head, "th")}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table>\n</div>')


def figure(name, title, caption, drawn):
    """A drawn figure of matplotlib that can be zoomed, with its caption. Panels side by side come below each other
    in a narrow window: the page has both."""
    label = f'role="img" tabindex="0" aria-label="{escape(title + ": " + caption)}"'
    element, width = svg.element(drawn, name)
    element = element.replace("<svg", f'<svg class="zoom" {label}', 1)
    if narrow.side_by_side(drawn):
        narrow.stack(drawn)
        stacked, _ = svg.element(drawn, f"{name}-narrow")
        element += stacked.replace("<svg", f'<svg class="zoom narrow" {label}', 1)
    return (f'<figure id="{escape(name)}"{attribute("class", "wide" if width > WIDE else "")}>\n'
            f'<h3>{escape(title)}</h3>\n<div style="max-width:{LARGEST * width:.0f}px">{element}</div>\n'
            f'<figcaption>{escape(caption)}</figcaption>\n</figure>')


def figures(parts):
    """Figures next to each other where there is room."""
    return paragraph(HINT, "hint") + '\n<div class="figures">\n' + "\n".join(parts) + "\n</div>" if parts else ""


def page(title, subtitle, sections):
    """The whole file, with style and script in it."""
    style, script = ((HERE / name).read_text(encoding="utf-8") for name in ("page.css", "zoom.js"))
    return (f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(title)}</title>\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f'{GENERATOR}\n<style>\n{style}</style>\n</head>\n<body>\n<header>\n<h1>{escape(title)}</h1>\n'
            f'{paragraph(subtitle)}\n</header>\n<main>\n{"".join(sections)}</main>\n<script>\n{script}</script>\n'
            '</body>\n</html>\n')


def write_replacing(path, text):
    """Writes next to it, brings that to the disk and renames: a reader sees the old content or the new."""
    with replacing(path) as aside, open(aside, "x", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
