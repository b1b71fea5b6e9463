# SPDX-License-Identifier: BSD-3-Clause
"""The paper's figures as ensembles: monotonic tests at three densities, cyclic tests over a row of preparations,
drained tests next to the laboratory.

    isostat study paper                                             2,000 grains, three seeds
    isostat study paper --quick                                     one seed, fewer states (5 CPU minutes)
    isostat study paper --grains 10000 -o results/paper_10000 --tables docs/results/paper_10000
    isostat study paper --figures docs/results/paper                figures and claims again from tables

Rows that a folder of tables has of other tests stay in it: delete the folder to begin again.
"""
import pathlib
import sys

from isostat.campaign import study
from studies.paper import claims, figures, plan, tables
from studies.tables import read_csv, write_csv

DEFAULTS, QUICK = {"seeds": 3}, {"seeds": 1}
SIZES = {"2,000 grains": "paper", "10,000 grains": "paper_10000"}  # folders of their tables, side by side


def add_options(line):
    line.add_argument("--grains", type=int, default=2000)
    line.add_argument("--parts", nargs="+", choices=plan.PARTS, default=list(plan.PARTS), help="default: all")
    line.add_argument("--figures", type=pathlib.Path, metavar="FOLDER",
                      help="only figures and claims, from the tables in FOLDER")


def runs(options):
    return plan.runs_of(options.grains, options.seeds, not options.quick, options.parts)


def do(options, executor):
    if options.figures:
        draw(options.figures)
    else:
        study.do_runs(sys.modules[__name__], options, executor)


def report(store, planned, folder):
    found = tables.Results(store, planned).tables()
    write(folder, {name: tables.merged(folder / f"{name}.csv", rows) if name in tables.ADDED else rows
                   for name, rows in found.items()})
    draw(folder)


def write(folder, found):
    for name, rows in found.items():
        if rows:
            write_csv(folder / f"{name}.csv", rows)


def draw(folder):
    """Figures and claims from the tables in a folder."""
    needed = {name: read_csv(folder / f"{name}.csv") for name in claims.TABLES}
    if needed["undrained_states"] and needed["cyclic_tests"]:
        write(folder, {"claims": claims.table(needed)})
        tested = {size: read_csv(folder.with_name(name) / "claims.csv") for size, name in SIZES.items()}
        if any(tested.values()):
            first = next(SIZES[size] for size, rows in tested.items() if rows)
            (folder.with_name(first) / "claims.md").write_text(claims.markdown(tested), encoding="utf-8")
    figures.draw(folder)
