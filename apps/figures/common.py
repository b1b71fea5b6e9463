# SPDX-License-Identifier: BSD-3-Clause
"""What the figures share: style, the history of a run, axes against progress, marks and legends."""
import csv
import re
import sys
import tomllib
import warnings
from string import ascii_lowercase

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

from .files import NOT_SHEARED, BadInput, Damaged, read_parsed

LIQUEFIED = 0.01  # p'/p0' below which a specimen counts as liquefied, unless its scene says otherwise
FLOOR = 1e-4  # lowest p'/p0' that is drawn
NOISE = 1e-3  # of the largest of another component: what is less is round-off, or the error of the mesh
SAME_VOLUME = 1e-6  # change of e below which a test is at constant volume
TURNS = 1.5  # path over range of the strain from which a test counts as turning back
MEDIAN_ROWS = 21
UNITS = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "%": 1e-2}

# Colours that colour-blind readers can distinguish (Okabe and Ito).
BLACK, ORANGE, BLUE, GREEN, RED, GREY = "#1a1a1a", "#e69f00", "#0072b2", "#009e73", "#d55e00", "#7f7f7f"

STYLE = {
    "figure.dpi": 100,
    "savefig.dpi": 220,
    "font.size": 9,
    "axes.labelsize": 9.5,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.5,
    "axes.axisbelow": True,
    "xtick.direction": "out",
    "ytick.direction": "out",
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "lines.linewidth": 1.0,
    "lines.solid_joinstyle": "round",
    "mathtext.fontset": "dejavusans",
    "agg.path.chunksize": 20000,
}


def use_style():
    """Ours alone: a matplotlibrc of the user, or one where Python started, does not count."""
    plt.rcdefaults()
    plt.rcParams.update(STYLE)


def note(text):
    print(f"figures: {text}", file=sys.stderr)


def plain(text):
    """Words of a user, for matplotlib: a dollar sign begins no formula."""
    return str(text).replace("$", r"\$")


# --- reading ---------------------------------------------------------------------------------------------------------


def number(text):
    try:
        return float(text)
    except ValueError:
        return float("nan")


def read_history(path):
    """Columns of history.csv by name, in SI; the header's cells are `name (unit)`."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from error
    if len(rows) < 2:
        raise BadInput(f"{path}: no data rows")
    width = len(rows[0])
    body = [row for row in rows[1:] if len(row) == width]
    if len(body) < len(rows) - 1:
        note(f"{path.name}: {len(rows) - 1 - len(body)} incomplete rows left out")
    columns = {}
    for index, cell in enumerate(rows[0]):
        name, unit = re.fullmatch(r"\s*(.*?)\s*(?:\(([^()]*)\))?\s*", cell).groups()
        columns[name] = np.array([number(row[index]) for row in body]) * UNITS.get(unit, 1.0)
    return columns


def read_summary(path):
    try:
        return read_parsed(path)
    except OSError as error:
        note(f"{path.name} cannot be read ({error}); p0 and the onset of liquefaction are taken from the history")
    except Damaged as error:
        note(f"{error} Until then p0 and the onset of liquefaction are taken from the history")
    return {}


def first_sheared_row(folder, summary, stages):
    """The row of the history with which its first shear stage begins, or None: from the summary, and as long as there
    is none from the scene. Without a scene all rows count.   @param stages  column of the history"""
    if "shear_stage_first_row" in summary:
        return summary["shear_stage_first_row"]
    try:
        scene = tomllib.loads((folder / "scene.toml").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return 0
    sheared = [number for number, stage in enumerate(scene.get("stage", []))
               if stage.get("kind") not in NOT_SHEARED and not stage.get("consolidation")]
    rows = np.flatnonzero(np.isin(stages, sheared))
    return int(rows[0]) if rows.size else None


class Run:
    """The shear stages of a run, or all of one that has none: columns, p0 (Pa; None: it is not sheared), onset of
    liquefaction (row among the shear rows, or None). Columns of all stages are in `whole`.

    `shear` says that it is simple shear in a cell: its strain is gamma_xy; that of a triaxial test is eps_y.
    """

    def __init__(self, folder):
        summary = read_summary(folder / "summary.json")
        columns = read_history(folder / "history.csv")
        total = len(next(iter(columns.values())))
        started = first_sheared_row(folder, summary, columns.get("stage", np.zeros(total)))
        self.sheared, first = started is not None, int(started or 0)
        if not 0 <= first < total:
            raise BadInput(f"summary.json: shear_stage_first_row = {first}, but history.csv has {total} rows")
        self.whole = columns
        self.columns = {name: values[first:] for name, values in columns.items()}
        self.n_rows = total - first
        self.shear = (self.sheared and self.has("gamma_xy")
                      and np.nanmax(abs(self["gamma_xy"])) > np.nanmax(abs(self["eps_y"])))
        for name in ("p", "tau_xy", "sigma_y") if self.shear else ("p", "q", "eps_y"):
            if not self.has(name):
                raise BadInput(f"history.csv: column `{name}` is missing or empty")
        self.drained_stages = summary.get("drained") or []
        self.title = summary.get("title") or folder.resolve().name
        self.p0 = float(summary.get("p0") or self["p"][0]) if self.sheared else None
        self.p_ratio = self["p"] / self.p0 if self.sheared else None
        self.onset, self.onset_cycle = self._find_onset(summary, first)
        self.cyclic = self.has("reversals") and np.nanmax(self["reversals"]) >= 1
        self.strain = self["gamma_xy"] if self.shear else self["eps_y"]
        self.strain_label = r"Shear strain $\gamma$ (%)" if self.shear else r"Axial strain $\varepsilon_1$ (%)"
        self.progress, self.progress_label = self._progress()

    @property
    def drained(self):
        """Whether the volume changes while it is sheared."""
        return self.has("e") and np.ptp(self["e"]) > SAME_VOLUME

    def has(self, name):
        return name in self.columns and np.isfinite(self.columns[name]).any()

    def __getitem__(self, name):
        return self.columns[name]

    def _find_onset(self, summary, first):
        self.liquefied_ratio = LIQUEFIED
        if "liquefaction" in summary or not self.sheared:
            event = summary.get("liquefaction")
            if not event or event.get("row") is None:
                return None, None
            self.liquefied_ratio = event.get("ratio", LIQUEFIED)
            return min(max(int(event["row"]) - first, 0), self.n_rows - 1), event.get("cycle")
        below = np.flatnonzero(self.p_ratio < LIQUEFIED)
        return (int(below[0]), None) if below.size else (None, None)

    def _progress(self):
        """What the measures are drawn against, and its label: a path that turns back would cross itself."""
        if not self.sheared:
            return self["step"], "Time step"
        if self.cyclic:
            return self._cycles(), "Number of cycles (half the reversals)"
        steps = np.abs(np.diff(self.strain, prepend=self.strain[0]))
        if np.nansum(steps) < TURNS * np.ptp(self.strain):
            return 100 * self.strain, self.strain_label
        symbol = r"\gamma" if self.shear else r"\varepsilon_1"
        return 100 * np.nancumsum(steps), rf"Strain travelled $\int|\mathrm{{d}}{symbol}|$ (%)"

    def _cycles(self):
        """Cycles as a running number: half a cycle to the first reversal and from each to the next, as in summaries."""
        strain = self.strain
        reversals = np.nan_to_num(self["reversals"]).astype(int)
        reversals -= reversals[0]
        starts = np.flatnonzero(np.diff(reversals, prepend=-1))
        cycles = np.zeros(self.n_rows)
        spans = {}
        for start, end in zip(starts, [*starts[1:], self.n_rows]):
            count = reversals[start]
            moved = np.maximum.accumulate(np.abs(strain[start:end] - strain[start]))
            span = abs(strain[end] - strain[start]) if end < self.n_rows else 0.0
            if end == self.n_rows:  # unfinished: as long as the longest of the last two, or as its load says
                whole = moved[-1] / self._loaded(start)
                span = max(spans.get(count - 1, 0.0), spans.get(count - 2, 0.0), whole)
            spans[count] = span
            cycles[start:end] = 0.5 * (count + np.clip(moved / span if span > 0 else 0 * moved, 0, 1))
        return cycles

    def _loaded(self, start):
        """The part of its load that the last half cycle has behind it: of twice the largest one before."""
        load = self["tau_xy"] if self.shear else self["q"]
        whole = 2 * np.nanmax(np.abs(load[:start + 1] - load[0]))
        return np.clip(np.nanmax(np.abs(load[start:] - load[start])) / whole, 0.05, 1) if whole > 0 else 1.0


def index_label(constraints):
    """The redundancy index of a contact law, named by the constraints of a contact: `constraints` of some rows."""
    counts = np.unique(constraints)
    if len(counts) != 1:
        return r"$I_R$ of the law in force"
    n = int(counts[0])
    return r"$I_R$, Eq. (2)" if n == 6 else rf"$I_R$, {n} constraint{'s' if n > 1 else ''} a contact"


# --- drawing ---------------------------------------------------------------------------------------------------------


def cut_ends(values, low, high):
    """Which ends of a colour bar from low to high leave values out: the arrows it has to have."""
    above, below = np.nanmax(values) > high, np.nanmin(values) < low
    return "both" if above and below else "max" if above else "min" if below else "neither"


def panel_letter(axes, letter):
    axes.set_title(f"({letter})", loc="left", fontsize=9.5, fontweight="bold", pad=5)


def letters(panels):
    """(a), (b), ... of panels, row by row."""
    for axes, letter in zip(np.ravel(panels), ascii_lowercase):
        panel_letter(axes, letter)


def mark_level(axes, level, text, colour=GREY):
    """A dashed horizontal line with its meaning at the right margin."""
    axes.axhline(level, color=colour, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1.5)
    axes.annotate(text, (1.005, level), xycoords=("axes fraction", "data"), xytext=(2, 0),
                  textcoords="offset points", ha="left", va="center", fontsize=8, color=colour, annotation_clip=False)


def mark_onset(run, panels):
    """A vertical line where the specimen liquefies; it joins the legend of the first panel."""
    if run.onset is not None:
        for axes in panels:
            axes.axvline(run.progress[run.onset], color=RED, linewidth=0.9, linestyle=(0, (1, 1.2)), zorder=1.6,
                         label="onset of liquefaction" if axes is panels[0] else None)


def legend_above(axes):
    handles, labels = axes.get_legend_handles_labels()
    if handles:
        axes.legend(handles, labels, loc="lower right", bbox_to_anchor=(1.0, 0.985), ncols=len(labels), borderaxespad=0,
                    handlelength=1.4, columnspacing=1.2)


def plain_log_ticks(axis):
    """1, 2, 5 of each decade on a logarithmic axis, written out: for a range of one decade or two."""
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(lambda value, _: f"{value:g}")
    axis.set_minor_formatter(NullFormatter())


def stretch_after(axes, low, kink, high):
    """Half of the axis for what follows the kink: few cycles, but most of what there is to see."""
    before, after = 0.5 / (kink - low), 0.5 / (high - kink)

    def forward(x):
        x = np.asarray(x, dtype=float)
        return np.where(x < kink, (x - low) * before, 0.5 + (x - kink) * after)

    def inverse(y):
        y = np.asarray(y, dtype=float)
        return np.where(y < 0.5, low + y / before, kink + (y - 0.5) / after)

    axes.set_xscale("function", functions=(forward, inverse))
    ticks = [t for t in MaxNLocator(5, integer=True).tick_values(low, kink) if t <= kink - 0.1 * (kink - low)]
    ticks += [t for t in MaxNLocator(5).tick_values(kink, high) if kink + 0.02 * (high - kink) < t <= high]
    axes.set_xticks(ticks, [f"{t:g}" for t in ticks])


def progress_axes(run, panels):
    """Limits, ticks and label of the common x axis."""
    x = run.progress[np.isfinite(run.progress)]
    low, high = float(x.min()), float(x.max())
    label = run.progress_label
    if run.cyclic and run.onset is not None:
        kink = float(run.progress[run.onset])
        if high - kink >= 0.5 and high - kink < 0.8 * (kink - low):
            for axes in panels:
                stretch_after(axes, low, kink, high)
            label = label.removesuffix(")") + "; scale stretched after the onset)"
    if high > low:
        for axes in panels:
            axes.set_xlim(low, high)
    panels[-1].set_xlabel(label)


def running_median(values):
    half = MEDIAN_ROWS // 2
    padded = np.pad(values, half, mode="edge")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # no contact at all in a whole window: nothing is drawn
        return np.nanmedian(np.lib.stride_tricks.sliding_window_view(padded, MEDIAN_ROWS), axis=1)


def curves(run, axes, specs, steady=False):
    """Draws the columns that exist; a spec is (column, label, line properties).

    `steady` is for averages over contacts, of which a liquefied specimen has a handful: after the onset every row is
    drawn pale and the running median on top.
    """
    for name, label, style in specs:
        if not run.has(name):
            note(f"no column `{name}`; its curve is left out")
            continue
        x, y = run.progress, run[name]
        if steady and run.onset is not None and run.n_rows - run.onset > 5 * MEDIAN_ROWS:
            after = slice(run.onset, None)
            axes.plot(x[after], y[after], **{**style, "linewidth": 0.4, "alpha": 0.3, "zorder": 1.8})
            x, y = x.copy(), np.concatenate([y[: run.onset], running_median(y[after])])
        axes.plot(x, y, label=label, **style)


def explain_median(run, axes):
    if run.onset is not None and run.n_rows - run.onset > 5 * MEDIAN_ROWS:
        text = f"After the onset: pale, every row; full, running median of {MEDIAN_ROWS} rows."
        caption = axes.figure.text(0.99, 0.006, text, ha="right", va="bottom", fontsize=7, color=GREY)
        caption.set_in_layout(False)
        axes.figure.get_layout_engine().set(rect=(0, 0.025, 1, 0.975))


def coloured_parts(run):
    """(rows, colour, label) before liquefaction and after it."""
    cut = run.n_rows if run.onset is None else run.onset + 1
    parts = [(slice(0, cut), BLUE, "before liquefaction")]
    if cut < run.n_rows:
        parts.append((slice(cut - 1, None), ORANGE, "after liquefaction"))
    return parts


def draw_path(run, axes, x, y):
    """A stress path or stress-strain curve with its start and the onset of liquefaction."""
    for rows, colour, label in coloured_parts(run):
        axes.plot(x[rows], y[rows], color=colour, label=label, linewidth=0.8)
    axes.axhline(0, color=BLACK, linewidth=0.6, zorder=1.4)
    axes.plot(x[0], y[0], "o", color=BLACK, markersize=3.5, zorder=5, label="start", clip_on=False)
    if run.onset is not None:
        axes.plot(x[run.onset], y[run.onset], "D", color=RED, markersize=4, zorder=6, clip_on=False,
                  label=rf"$p^\prime/p_0^\prime < {run.liquefied_ratio:g}$")


def legend_below(figure, axes, height, ncols=None, **more):
    """Of one panel or several that share it, in the lowest `height` of the figure; in one row by default."""
    handles, labels = axes.get_legend_handles_labels()
    figure.get_layout_engine().set(rect=(0, height, 1, 1 - height))
    figure.legend(handles, labels, loc="lower center", ncols=ncols or len(labels), **more)


def legend_of_path(run, figure, axes):
    """Without liquefaction it would have a single entry."""
    if run.onset is not None:
        legend_below(figure, axes, 0.07)


def two_rows(run, heights=(1, 1)):
    figure, panels = plt.subplots(2, 1, figsize=(6.6, 4.9), sharex=True, height_ratios=heights,
                                  layout="constrained")
    progress_axes(run, panels)
    letters(panels)
    return figure, panels
