# SPDX-License-Identifier: BSD-3-Clause
"""Figures: error against minutes, and ensembles by setting."""
import numpy as np
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)
from matplotlib import ticker  # noqa: E402

from speed_error import paths  # noqa: E402

STYLE = {"savefig.dpi": 200, "font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
         "grid.color": "#e4e4e4", "grid.linewidth": 0.5, "axes.axisbelow": True, "legend.frameon": False}
LOOK = {  # Okabe and Ito: colours that colour-blind readers can tell apart
    "default": ("#1a1a1a", "*", "default"),
    "inertia": ("#0072b2", "o", "inertial number"),
    "step": ("#009e73", "^", "time step (of critical)"),
    "damping": ("#cc79a7", "v", "damping"),
    "old": ("#d55e00", "s", "free grains, walls"),
    "grains": ("#7f7f7f", "h", "number of grains"),
}


def spread_labels(axes, points):
    """Writes each label beside its point where it covers neither points nor labels; a thin line leads to far ones."""
    figure = axes.figure
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    marks = [axes.transData.transform((x, y)) for x, y, _, _ in points]
    taken = [matplotlib.transforms.Bbox.from_extents(x - 5, y - 5, x + 5, y + 5) for x, y in marks]
    frame = axes.get_window_extent(renderer)
    places = [(radius * dx, radius * dy) for radius in (8, 14, 22, 32, 44, 58)
              for dx, dy in ((1, 0), (1, 0.7), (1, -0.7), (-1, 0), (-1, 0.7), (-1, -0.7), (0, 1), (0, -1))]
    for (x, y, label, colour), mark in sorted(zip(points, marks), key=lambda item: -item[1][1]):
        for dx, dy in places:
            text = axes.annotate(label, (x, y), (dx, dy), textcoords="offset points", fontsize=7.5, color=colour,
                                 bbox={"fc": "white", "ec": "none", "pad": 0.6, "alpha": 0.85},
                                 ha="left" if dx > 0 else "right" if dx < 0 else "center", va="center",
                                 arrowprops={"arrowstyle": "-", "lw": 0.4, "color": "#9a9a9a", "shrinkB": 3}
                                 if max(abs(dx), abs(dy)) > 8 else None)
            text.update_positions(renderer)
            box = matplotlib.text.Text.get_window_extent(text, renderer)
            inside = frame.x0 <= box.x0 and box.x1 <= frame.x1 + 40 and frame.y0 <= box.y0 and box.y1 <= frame.y1
            if inside and not any(box.overlaps(other) for other in taken):
                break
            text.remove()
        else:
            text = axes.annotate(label, (x, y), (8, 0), textcoords="offset points", fontsize=7.5, color=colour)
        taken.append(matplotlib.text.Text.get_window_extent(text, renderer).padded(1))


def scatter_panel(axes, rows, seconds, window, title):
    points = []
    for row in rows:
        colour, marker, _ = LOOK[row.family]
        mean, _, error, _ = row.error(window)
        x = seconds(row)
        if not (np.isfinite(mean) and np.isfinite(x)) or mean <= 0:
            continue
        low, high = (100 * min(error, 0.7 * mean), 100 * error) if np.isfinite(error) else (0, 0)
        axes.errorbar(x, 100 * mean, [[low], [high]], fmt=marker, color=colour, ms=9 if marker == "*" else 5,
                      elinewidth=0.7, capsize=2)
        points.append((x, 100 * mean, row.setting.label, colour))
    axes.set(xscale="log", yscale="log", xlabel="CPU time, s",
             ylabel="largest error of the path, % of p0'")
    axes.set_title(title, fontsize=9.5, loc="left")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(ticker.FuncFormatter(lambda v, _: f"{v:g}"))
        axis.set_minor_formatter(ticker.NullFormatter())
    if points:
        xs, ys = [p[0] for p in points], [p[1] for p in points]
        axes.set_xlim(min(xs) / 1.6, max(xs) * 2.2)
        axes.set_ylim(min(ys) / 2, max(ys) * 1.8)
        front(axes, points)
        spread_labels(axes, points)


def front(axes, points):
    """Steps along the settings that no other beats in both error and time."""
    best, line = np.inf, []
    for x, y, _, _ in sorted(points):
        if y < best:
            line.append((x, y))
            best = y
    axes.step(*np.array(line).T, where="post", color="#bdbdbd", lw=1.2, zorder=0)


def pareto(results, path):
    with plt.rc_context(STYLE):
        figure, (left, right) = plt.subplots(1, 2, figsize=(11, 5.4))
        figure.subplots_adjust(left=0.065, right=0.975, top=0.85, bottom=0.1, wspace=0.17)
        rows, limits = results.rows, results.limits
        scatter_panel(left, rows, lambda r: r.seconds_to_onset, "longer",
                      f"(a) cyclic: path to reversal {limits.longer_reversals}; time to the onset")
        scatter_panel(right, rows, lambda r: paths.ensemble(r.monotonic_cpu)[0], "monotonic",
                      f"(b) monotonic: path to {100 * limits.early_strain:g} % strain; time to there")
        shown = {r.family for r in rows}
        handles = [plt.Line2D([], [], color=c, marker=m, ls="", ms=9 if m == "*" else 5, label=text)
                   for family, (c, m, text) in LOOK.items() if family in shown]
        figure.legend(handles=handles, loc="upper center", ncol=len(handles), fontsize=8, handletextpad=0.2,
                      columnspacing=1.4)
        figure.savefig(path)
        plt.close(figure)


def ensembles(results, path):
    rows = [r for r in results.rows if r.cycles]
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(1, 2, figsize=(9.5, 0.26 * len(rows) + 1.3), sharey=True)
        figure.subplots_adjust(left=0.2, right=0.98, bottom=0.7 / (0.26 * len(rows) + 1.3), top=0.97, wspace=0.06)
        for panel, name, label in zip(axes, ("cycles", "redundancy"),
                                      ("cycles to initial liquefaction", "I_R at onset")):
            slow = results.slow
            if slow:
                mean, deviation, _, n = paths.ensemble(getattr(slow, name).values())
                if n > 1:
                    panel.axvspan(mean - deviation, mean + deviation, color="#ececec", zorder=0)
                panel.axvline(mean, color="#9a9a9a", lw=0.8, zorder=0)
            for place, row in enumerate(rows):
                colour = LOOK[row.family][0]
                values = np.array(list(getattr(row, name).values()))
                mean, deviation, error, n = paths.ensemble(values)
                panel.plot(values, np.full(n, place + 0.22), "o", ms=2.5, color=colour, alpha=0.45, mew=0)
                if n > 1:
                    panel.errorbar(mean, place, xerr=deviation, color=colour, elinewidth=0.7, capsize=0)
                    panel.errorbar(mean, place, xerr=error, color=colour, elinewidth=2.4, capsize=0)
                panel.plot(mean, place, LOOK[row.family][1], color=colour, ms=8 if row.family == "default" else 5)
            panel.set_xlabel(label)
            panel.grid(axis="y", visible=False)
        axes[0].set_yticks(range(len(rows)), [r.setting.label for r in rows])
        axes[0].set_ylim(len(rows) - 0.4, -0.6)
        figure.savefig(path)
        plt.close(figure)
