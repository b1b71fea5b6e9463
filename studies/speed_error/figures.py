# SPDX-License-Identifier: BSD-3-Clause
"""Figures: error against cost, and cycles specimen by specimen."""
import numpy as np
import matplotlib
import matplotlib.pyplot as plt

from studies.drawing import plain_logarithm, save
from studies.ensembles import ensemble
from studies.speed_error import plan

DYNAMIC, STATIC = ("#d55e00", "s"), ("#0072b2", "o")  # Okabe and Ito: colours that colour-blind readers can distinguish
KINDS = [("rigid-box", "(a) boxes"), ("periodic-cell", "(b) cells")]


def look(setting):
    return STATIC if setting.label.startswith("static") else DYNAMIC


def spread_labels(axes, points):
    """Writes each label next to its point where it covers neither points nor labels; a thin line leads to far ones."""
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


def front(axes, points):
    """Steps along the settings that no other beats in both error and time."""
    best, line = np.inf, []
    for x, y, _, _ in sorted(points):
        if y < best:
            line.append((x, y))
            best = y
    axes.step(*np.array(line).T, where="post", color="#bdbdbd", lw=1.2, zorder=0)


def error_against_cost(results, path):
    figure, panels = plt.subplots(1, 2, figsize=(11, 4.8), sharey=True)
    figure.subplots_adjust(left=0.065, right=0.955, top=0.93, bottom=0.11, wspace=0.13)
    drawn = [(axes, [key for key in results.keys() if key[:2] == (domain, plan.GRAINS)])
             for axes, (domain, _) in zip(panels, KINDS)]
    points = {}
    for axes, keys in drawn:
        for key in keys:
            found = list(results.distances(key).values())
            if not found or key[2] == plan.FINEST:
                continue
            steps = np.nanmean([test.path_steps for test in results.cyclic[key].values()])
            low, middle, high = np.quantile(found, (0.25, 0.5, 0.75))
            colour, marker = look(key[2])
            axes.errorbar(steps, middle, [[middle - low], [high - middle]], fmt=marker, color=colour, ms=5,
                          elinewidth=0.7, capsize=2)
            label = key[2].label.replace("static, ", "").replace("balance ", "")
            points.setdefault(axes, []).append((steps, middle, label, colour))
    for axes, (_, title) in zip(panels, KINDS):
        axes.set_xlabel("time steps or evaluations of all forces to reversal 10")
        axes.set_title(title, fontsize=9.5, loc="left")
        for axis in (axes.xaxis, axes.yaxis):
            plain_logarithm(axis, "{x:,g}")
        axes.margins(0.2, 0.15)
    panels[0].set_ylabel("distance to the finest path, % of p0'")
    panels[0].legend([plt.Line2D([], [], color=c, marker=m, ls="") for c, m in (DYNAMIC, STATIC)],
                     ["dynamic", "static: increment, balance"], loc="lower left", fontsize=8)
    for axes, marks in points.items():
        spread_labels(axes, marks)
    save(figure, path)


def cycles(results, path):
    """Cycles of each setting less those of the static default, one dot for each specimen, and their mean."""
    figure, panels = plt.subplots(1, 2, figsize=(9.5, 3.6), sharey=True)
    labels = list(dict.fromkeys(key[2].label for key in results.keys()
                                if any(np.isfinite(t.cycles) for t in results.cyclic[key].values())))
    for axes, (domain, title) in zip(panels, KINDS):
        for key in (key for key in results.keys() if key[:2] == (domain, plan.GRAINS) and key[2].label in labels):
            values = np.array([a.cycles - b.cycles for a, b in results.pairs(key, plan.STATIC).values()])
            values = values[np.isfinite(values)]
            place, colour = labels.index(key[2].label), look(key[2])[0]
            spread = place + np.linspace(-0.2, 0.2, len(values))
            axes.plot(values, spread, "o", ms=3, color=colour, alpha=0.4, mew=0)
            mean, _, error, n = ensemble(values)
            axes.errorbar(mean, place, xerr=error if n > 1 else 0, fmt="D", ms=5, color=colour, elinewidth=2)
        axes.axvline(0, color="#9a9a9a", lw=0.8, zorder=0)
        axes.set_title(title, fontsize=9.5, loc="left")
        axes.set_xlabel("cycles less those of the static default")
    panels[0].set_yticks(range(len(labels)), labels)
    panels[0].invert_yaxis()
    figure.tight_layout()
    save(figure, path)


def draw(results, folder):
    error_against_cost(results, folder / "error_against_cost.png")
    cycles(results, folder / "cycles.png")
