# SPDX-License-Identifier: BSD-3-Clause
"""What the figures of the campaign share: tables as columns, one style, panels, bands."""
import dataclasses
import pathlib
import tempfile

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

from studies.tables import read_csv

BLUE, ORANGE, GREEN, RED, GREY = "#0072b2", "#e69f00", "#009e73", "#d55e00", "#777777"
STYLE = {"savefig.dpi": 200, "font.size": 8.5, "axes.grid": True, "grid.color": "#e8e8e8", "legend.frameon": False,
         "axes.spines.top": False, "axes.spines.right": False, "legend.fontsize": 7.5, "axes.axisbelow": True}
plt.rcParams.update(STYLE)  # of every study that imports this


class Table:
    """Columns by name; numbers where they are numbers."""

    def __init__(self, path):
        self.rows = read_csv(path)

    def where(self, **conditions):
        """Rows whose columns have these values."""
        return self.of([row for row in self.rows if all(str(row[name]) == str(v) for name, v in conditions.items())])

    @classmethod
    def of(cls, rows):
        table = object.__new__(cls)
        table.rows = rows
        return table

    def values(self, name):
        return list(dict.fromkeys(row[name] for row in self.rows))

    def __getitem__(self, name):
        return np.array([float(row[name]) for row in self.rows])

    def __bool__(self):
        return bool(self.rows)


def panels(rows, columns, width=7.2, height=3.2, **more):
    figure, axes = plt.subplots(rows, columns, figsize=(width, height), layout="constrained", squeeze=False, **more)
    for letter, panel in zip("abcdefgh", axes.flat):
        panel.set_title(f"({letter})", loc="left", fontweight="bold", fontsize=9)
    return figure, axes


def save(figure, path, **more):
    figure.savefig(path, **more)
    plt.close(figure)


def plain_logarithm(axis, form="{x:g}"):
    """Of one axis of a panel, with ticks at 1, 2, 5, 10 written as numbers."""
    axis.axes.set(**{f"{axis.axis_name}scale": "log"})
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(form)
    axis.set_minor_formatter(NullFormatter())


def band(panel, x, mean, deviation, colour, label=None):
    panel.plot(x, mean, color=colour, linewidth=1.1, label=label)
    panel.fill_between(x, mean - np.nan_to_num(deviation), mean + np.nan_to_num(deviation), color=colour, alpha=0.18,
                       linewidth=0)


def bands(panel, rows, columns):
    """Of each (column, colour, label) of the table of phases: to the onset the mean and the range within the cycles,
    behind it mean and standard deviation."""
    cyclic = rows["phase"] < 1
    for column, colour, label in columns:
        x, mean = rows["phase"], rows[column]
        panel.plot(x, mean, color=colour, linewidth=1.1, label=label)
        if f"{column} s.d. of ln" in rows.rows[0]:
            factor = np.exp(np.nan_to_num(rows[f"{column} s.d. of ln"]))
            low, high = mean / factor, mean * factor
        else:
            deviation = np.nan_to_num(rows[f"{column} s.d."])
            low, high = mean - deviation, mean + deviation
        panel.fill_between(x, np.where(cyclic, rows[f"{column} low"], low),
                           np.where(cyclic, rows[f"{column} high"], high), color=colour, alpha=0.18, linewidth=0)


def of_tables(*names):
    """Says from which tables a figure is drawn; it gets the first."""
    def mark(function):
        function.tables = names
        return function
    return mark


def draw_figure(drawing, name, results, path, beside=()):
    """One of the figures of a program (apps/figures) of the results in a folder, next to those of other folders."""
    one = dataclasses.replace(drawing, all=[drawing.figures[name]])
    with tempfile.TemporaryDirectory(dir=path.parent) as aside:
        one.draw(one.results(results, beside), pathlib.Path(aside))
        (pathlib.Path(aside) / f"{name}.png").replace(path)
