#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The paper's figures as ensembles: monotonic tests at three densities, cyclic tests over a row of preparations,
drained tests beside the laboratory. And what they leave open: resistance curves, critical states, specimens made in
other ways, slower tests and usual ones.

    paper.py                       2,000 grains, three seeds; tables and figures in results/paper/tables
    paper.py --whole               the same to larger strains and over more states
    paper.py --whole --parts resistance critical ways paces               what the figures leave open
    paper.py --dry-run             the number of runs and their estimated time
    paper.py --figures FOLDER      draws figures and judges claims anew from a folder of tables

Finished runs are kept in --work and not run again; an interrupted command goes on from checkpoints.
"""
import argparse
import pathlib
import sys

from paper import claims, figures, plan, tables, variants
from speed_error import runner

MARKDOWN = {"claims": claims.markdown, "ways": variants.markdown, "paces": variants.markdown}
ROOT = pathlib.Path(__file__).resolve().parent.parent


def write(folder, found, add):
    """The tables, and those that are read as texts."""
    if add:
        found = {name: tables.merged(folder / f"{name}.csv", rows) if name in tables.ADDED else rows
                 for name, rows in found.items()}
    for name, rows in found.items():
        if rows:
            tables.write_csv(folder / f"{name}.csv", rows)
        if rows and name in MARKDOWN:
            (folder / f"{name}.md").write_text(MARKDOWN[name](rows), encoding="utf-8")


def draw(folder):
    """Figures and claims from the tables in a folder."""
    needed = {name: tables.read_csv(folder / f"{name}.csv") for name in claims.TABLES}
    if needed["undrained_states"] and needed["cyclic_tests"]:
        write(folder, {"claims": claims.table(needed)}, add=False)
    figures.draw(folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--grains", type=int, default=2000)
    parser.add_argument("--seeds", type=int, default=3, help="specimens of each kind; two more at D_r = 0.64")
    runner.add_arguments(parser, ROOT, "paper")
    parser.add_argument("--parts", nargs="+", choices=plan.PARTS, default=list(plan.FIGURES),
                        help=f"default: {' '.join(plan.FIGURES)}")
    parser.add_argument("--whole", action="store_true", help="all states, not what twenty minutes allow")
    parser.add_argument("--output", help="folder of tables and figures; default: the folder `tables` in --work")
    parser.add_argument("--add", action="store_true",
                        help="rows of tests that are not among these stay in the tables of --output")
    parser.add_argument("--figures", metavar="FOLDER", help="only figures and claims, from the tables in FOLDER")
    options = parser.parse_args()
    if options.figures:
        draw(pathlib.Path(options.figures))
        return 0
    runs = plan.runs_of(options.grains, options.seeds, options.whole, options.parts)
    store, complete = runner.run_campaign(options, runs)
    if complete is None:
        return 0
    folder = pathlib.Path(options.output or pathlib.Path(options.work) / "tables")
    folder.mkdir(parents=True, exist_ok=True)
    write(folder, tables.Results(store, runs).tables(), options.add)
    draw(folder)
    return 0 if complete else 1


if __name__ == "__main__":
    sys.exit(main())
