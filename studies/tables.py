# SPDX-License-Identifier: BSD-3-Clause
"""How studies leave their tables."""
import csv


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
        print(f"\n{name}\n\n| " + " | ".join(header) + " |\n|" + "---|" * len(header))
        print("\n".join("| " + " | ".join(row) + " |" for row in rows))
