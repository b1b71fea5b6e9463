# SPDX-License-Identifier: BSD-3-Clause
"""How studies leave their tables."""
import csv

import numpy as np


def write_tables(folder, tables):
    """{name: (header, rows)}: each as CSV, for readers of data, and all of them as Markdown on stdout, for the page;
    those without rows are left out."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, (header, rows) in tables.items():
        if not rows:
            continue
        rows = [[f"{v:.4g}" if isinstance(v, float) else str(v) for v in row] for row in rows]
        with open(folder / f"{name}.csv", "w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows([header, *rows])
        print(f"\n{name}\n\n{markdown(header, rows)}")


def report_of(results_of, draw):
    """The report() of a study: tables and figures of results_of(store, planned)."""
    def report(store, planned, folder):
        results = results_of(store, planned)
        write_tables(folder, results.tables())
        draw(results, folder)
    return report


def markdown(header, rows):
    """A table of texts."""
    lines = ["| " + " | ".join(row) + " |" for row in (header, *rows)]
    return "\n".join([lines[0], "|" + "---|" * len(header), *lines[1:]])


def write_csv(path, rows, digits=5):
    """A table of dictionaries; columns in the order in which they are first met. A number that is none stays empty."""
    header = list(dict.fromkeys(name for row in rows for name in row))
    with open(path, "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(header)
        out.writerows([number(row.get(name, ""), digits) for name in header] for row in rows)


def number(value, digits=5):
    """A cell of a table."""
    if isinstance(value, (float, np.floating)):
        return "" if np.isnan(value) else f"{value:.{digits}g}"
    return value


def read_csv(path):
    """Rows of a table as dictionaries; none if it does not exist."""
    if not path.exists():
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return [{name: value_of(text) for name, text in row.items()} for row in csv.DictReader(file)]


def value_of(text):
    """Of a cell of a table: a number, a truth value, or text; not a number where it is empty."""
    if text in ("True", "False"):
        return text == "True"
    try:
        return int(text) if text.isdigit() else float(text or "nan")
    except ValueError:
        return text
