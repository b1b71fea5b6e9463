# SPDX-License-Identifier: BSD-3-Clause
"""Errors, tables and the figure."""
import csv
import functools
import itertools

import h5py
import isostat
import matplotlib.pyplot as plt
import numpy as np

from studies.drawing import plain_logarithm, save
from studies.ensembles import mean_and_error, text_of
from studies.history import parsed
from studies.speed_error.figures import front, spread_labels
from studies.tables import write_tables

LIQUEFIED = 0.95
LOOK = {  # Okabe and Ito: colours that colour-blind readers can distinguish
    "default": ("#1a1a1a", "*", "default"),
    "reference": ("#7f7f7f", "P", "I and min_steps"),
    "min_steps": ("#0072b2", "o", "min_steps"),
    "damping": ("#56b4e9", "o", "damping"),
    "free": ("#f0e442", "v", "rattlers left alone"),
    "rate": ("#d55e00", "s", "inertial number I"),
    "step": ("#009e73", "^", "FE step"),
    "fast": ("#e69f00", "D", "I 1e-3, min_steps 10"),
    "size": ("#cc79a7", "h", "scatter of seeds: N grains"),
    "same": ("#000000", "x", "motion 1 ppm larger"),
}
QUANTITIES = {  # of the motions that liquefy levels
    "onset": ("onset, s", "{:.3f}"),
    "thick": ("liquefied, m", "{:.1f}"),
    "peak": ("peak surface acceleration, m/s2", "{:.2f}"),
    "arias": ("integral of its square, m2/s3", "{:.2f}"),
    "ru": ("final r_u, mean over depth, -", "{:.3f}"),
}
QUANTITY_HEADS = [text for text, _ in QUANTITIES.values()]


@functools.lru_cache(maxsize=None)
def read(folder):
    """Histories, profiles and cost of a run."""
    history = isostat.read(folder).history
    data = {name: history[column] for name, column in
            (("t", "time"), ("v", "surface_vx"), ("a", "surface_ax"), ("top", "max_ru"))}
    with h5py.File(folder / "profiles.h5", "r") as file:
        order = np.argsort(file["depth"])
        data.update(time=np.array(file["time"]), depth=np.array(file["depth"])[order],
                    ru=np.array(file["ru"])[:, order])
    times = parsed(folder, "times")
    data["steps"] = times["packing_steps"]
    data["per_call"] = times["packing_steps"] / times["packing_calls"]
    data["seconds"] = times["all_packings"]
    return data


def motion(folder, t):
    data = read(folder)
    return np.interp(t, data["t"], data["v"])


def pressures(folder, time, depth):
    data = read(folder)
    at_time = np.array([np.interp(time, data["time"], column) for column in data["ru"].T]).T
    return np.array([np.interp(depth, data["depth"], row) for row in at_time])


def rms(x):
    return float(np.sqrt(np.mean(np.square(x))))


def differences(folder, reference):
    """Of the surface velocity and of r_u over time and depth: rms of the difference over that of the reference."""
    base = read(reference)
    ru = pressures(folder, base["time"], base["depth"])
    return (rms(motion(folder, base["t"]) - base["v"]) / rms(base["v"]), rms(ru - base["ru"]) / rms(base["ru"]))


def scatter(folders):
    """Standard deviation between runs, surface velocity and r_u: its rms over that of their mean."""
    base, result = read(folders[0]), []
    for look, axes in ((motion, (base["t"],)), (pressures, (base["time"], base["depth"]))):
        values = [look(f, *axes) for f in folders]
        result.append(rms(np.std(values, axis=0, ddof=1)) / rms(np.mean(values, axis=0)))
    return result


def drift(folders, largest):
    """As differences(), of the means of two ensembles."""
    base, result = read(largest[0]), []
    for look, axes in ((motion, (base["t"],)), (pressures, (base["time"], base["depth"]))):
        ours, theirs = (np.mean([look(f, *axes) for f in group], axis=0) for group in (folders, largest))
        result.append(rms(ours - theirs) / rms(theirs))
    return result


def quantities(folder):
    data = read(folder)
    over = np.flatnonzero(data["top"] > LIQUEFIED)  # from this row on, or else that of the largest r_u, is the onset
    height = np.gradient(data["depth"]).mean()
    return {"onset": data["t"][over[0] if over.size else np.argmax(data["top"])],
            "thick": height * np.count_nonzero(data["ru"].max(axis=0) > LIQUEFIED), "peak": np.abs(data["a"]).max(),
            "arias": float(np.sum(0.5 * (data["a"][1:] ** 2 + data["a"][:-1] ** 2) * np.diff(data["t"]))),
            "ru": data["ru"][-1].mean()}


def percent(value, error=np.nan):
    if not np.isfinite(value):
        return "–"
    return text_of(100 * value, 100 * error, 1)


class Runs:
    """What is there, by case."""

    def __init__(self, there):
        self.all = there

    def of(self, level, label="default", grains=250, cells=10):
        return {c.seed: f for c, f in self.all
                if (c.level, c.label, c.grains, c.cells) == (level, label, grains, cells)}

    def labels(self, level, grains=250):
        return list(dict.fromkeys((c.family, c.label) for c, _ in self.all
                                  if c.level == level and c.grains == grains and c.cells == 10 and c.realisations == 1))

    def groups(self, level, of):
        """Ensembles of the defaults by number of grains or of cells."""
        keys = sorted({getattr(c, of) for c, _ in self.all if c.level == level and c.label == "default"})
        return {key: list(self.of(level, **{of: key}).values()) for key in keys}

    def deviations(self, level):
        """Standard deviation of each quantity between seeds of 250 grains."""
        values = [quantities(f) for f in self.of(level).values()]
        return {q: np.nanstd([v[q] for v in values], ddof=1) if len(values) > 2 else np.nan for q in QUANTITIES}

    def distance(self, level, one, other):
        """Mean over the quantities of the difference over the standard deviation between seeds."""
        a, b, s = quantities(one), quantities(other), self.deviations(level)
        parts = [abs(a[q] - b[q]) / s[q] for q in QUANTITIES if s[q] > 0]
        return float(np.nanmean(parts)) if parts else np.nan

    def between_seeds(self, level):
        runs = list(self.of(level).values())
        return float(np.mean([self.distance(level, a, b) for a, b in itertools.combinations(runs, 2)]))

    def seeds(self, level, grains=250):
        """Seeds of the references: those to compare; and those of the weak motion in which a level liquefies."""
        slow = self.of(level, "reference", grains)
        brink = [s for s, f in slow.items() if level == "weak" and quantities(f)["thick"] > 0]
        return sorted(set(slow) - set(brink)), sorted(brink)

    def errors(self, level, label, grains=250, seeds=None):
        """Rows of errors against the reference of the same seed, and of costs."""
        own, slow = self.of(level, label, grains), self.of(level, "reference", grains)
        rows = []
        for seed in sorted(set(own) & set(self.seeds(level, grains)[0] if seeds is None else seeds)):
            data, (v, r) = read(own[seed]), differences(own[seed], slow[seed])
            ours, theirs = (quantities(f[seed]) for f in (own, slow))
            rows.append({"v": v, "r": r, "bias": ours["ru"] / theirs["ru"] - 1,
                         "onset": ours["onset"], "late": ours["onset"] - theirs["onset"],
                         "peak": ours["peak"] / theirs["peak"] - 1, "cost": data["steps"] * grains,
                         "per_call": data["per_call"], "seconds": data["seconds"],
                         "distance": self.distance(level, own[seed], slow[seed]) if level != "weak" else np.nan})
        return rows


def numerics_table(runs, level, seeds, grains):
    strong, rows_of_table = level != "weak", []
    for _, label in runs.labels(level, grains):
        rows = runs.errors(level, label, grains, seeds)
        if not rows:
            continue
        mean = {key: mean_and_error([r[key] for r in rows]) for key in rows[0]}
        folders = [f for s, f in runs.of(level, label, grains).items() if s in seeds]
        shown = label + ("" if len(rows) == len(seeds) else f" ({len(rows)} of the seeds)")
        cells = [shown, f"{mean['per_call'][0]:.0f}", f"{mean['cost'][0] / 1e6:.0f}", f"{mean['seconds'][0]:.1f}"]
        last = [f"{mean['distance'][0]:.2f}"] if strong else [percent(*mean["bias"])]
        cells += ["–"] * 3 if label == "reference" else [*(percent(*mean[key]) for key in ("v", "r")), *last]
        cells += quantity_cells(folders, spread=False) if strong else [
            " and ".join(f"{read(f)['ru'].max():.2f}" for f in folders)]
        rows_of_table.append(cells)
    return ["setting", "steps a call", "10⁶ grain-steps", "s", "surface velocity, %", "r_u, %",
            *(["quantities, over their scatter", *QUANTITY_HEADS] if strong else
              ["bias of the final r_u, %", "largest r_u"])], rows_of_table


def twins(runs, level):
    """How far runs part that nothing but a millionth of the motion, or their packings in situ, sets apart."""
    pairs = {"default, motion 1 ppm larger": ("motion 1 ppm larger", "default"),
             "reference, motion 1 ppm larger": ("reference, 1 ppm larger", "reference"),
             "packings in situ with I = 5e-4": ("I 5e-4, own packings", "I 5e-4")}
    rows = []
    for text, (one, other) in pairs.items():
        one, other = runs.of(level, one), runs.of(level, other)
        both = sorted(set(one) & set(other))
        if both:
            v, r = np.transpose([differences(one[s], other[s]) for s in both])
            apart = "–" if level == "weak" else f"{np.mean([runs.distance(level, one[s], other[s]) for s in both]):.2f}"
            rows.append([text, len(both), percent(*mean_and_error(v)), percent(*mean_and_error(r)), apart])
    return ["twins", "seeds", "surface velocity, %", "r_u, %", "quantities, over their scatter"], rows


def quantity_cells(folders, spread=True):
    cells, values = [], [quantities(f) for f in folders]
    for q, (_, form) in QUANTITIES.items():
        x = [v[q] for v in values if np.isfinite(v[q])]
        cells.append(form.format(np.mean(x)) if x else "none")
        if len(x) > 1 and spread:
            cells[-1] += " ± " + form.format(np.std(x, ddof=1))
    return cells


def size_table(runs, level):
    """Scatter between seeds by number of grains, and the mean against that of the largest packings."""
    groups, rows = runs.groups(level, "grains"), []
    if len(groups) < 2:
        return [], []
    largest = groups[max(groups)]
    groups["3 × 250"] = list(runs.of(level, "mean of 3").values())
    for key, folders in groups.items():
        if not folders:
            continue
        cost = np.mean([read(f)["steps"] for f in folders]) * (key if isinstance(key, int) else 250) / 1e6
        cells = [f"{key:,}" if isinstance(key, int) else key, len(folders), f"{cost:.0f}",
                 f"{np.mean([read(f)['seconds'] for f in folders]):.1f}"]
        cells += [percent(x) for x in (scatter(folders) if len(folders) > 1 else (np.nan, np.nan))]
        if level != "weak":
            cells += quantity_cells(folders)
        else:
            cells += ["–"] * 2 if folders is largest else [percent(x) for x in drift(folders, largest)]
        rows.append(cells)
    return ["grains", "seeds", "10⁶ grain-steps", "s", "velocity: scatter, %", "r_u: scatter, %",
            *(QUANTITY_HEADS if level != "weak" else
              ["velocity: mean against the largest, %", "r_u: mean against the largest, %"])], rows


def onset_table(runs, level, grains):
    """How much later than in the reference of the same seed a level liquefies, by setting."""
    table = []
    for _, label in runs.labels(level, grains):
        rows = runs.errors(level, label, grains)
        if not rows:
            continue
        late, peak, onset, calls, cost = ([r[k] for r in rows] for k in ("late", "peak", "onset", "per_call", "cost"))
        value, error = mean_and_error(late)
        cells = [label, len(rows), f"{np.mean(calls):.0f}", f"{np.mean(cost) / 1e6:.0f}", f"{np.mean(onset):.3f}"]
        cells += ["–"] * 3 if label == "reference" else [
            f"{value:+.3f}" + (f" ± {error:.3f}" if np.isfinite(error) else ""), f"{max(late, key=abs):+.3f}",
            percent(*mean_and_error(peak))]
        table.append(cells)
    return ["setting", "seeds", "steps a call", "10⁶ grain-steps", "onset, s", "later than in the reference, s",
            "largest, s", "surface peak, %"], table


def mesh_table(runs, level):
    """Differences from the finest mesh with the same seeds."""
    meshes, rows = sorted(runs.groups(level, "cells")), []
    if len(meshes) < 2:
        return [], []
    finest = runs.of(level, cells=meshes[-1])
    for mesh in meshes:
        own = runs.of(level, cells=mesh)
        both = sorted(set(own) & set(finest))
        if not both:
            continue
        v, r = np.transpose([differences(own[s], finest[s]) for s in both])
        cells = [mesh, len(both), f"{np.mean([read(own[s])['steps'] for s in both]) * 250 / 1e6:.0f}",
                 f"{np.mean([read(own[s])['seconds'] for s in both]):.1f}"]
        cells += ["–"] * 2 if mesh == meshes[-1] else [percent(*mean_and_error(v)), percent(*mean_and_error(r))]
        rows.append(cells + (quantity_cells([own[s] for s in both]) if level != "weak" else []))
    return ["levels", "seeds", "10⁶ grain-steps", "s", "surface velocity, %", "r_u, %",
            *(QUANTITY_HEADS if level != "weak" else [])], rows


def grouped(points, wide):
    """One label for the default and all that lies on it."""
    x, y = next((p[:2] for p in points if p[2] == "default"), (np.nan, np.nan))
    near = [p for p in points if abs(np.log(p[0] / x)) < wide and abs(p[1] / y - 1) < 0.1]
    return [p for p in points if p not in near] + [
        (x, y, f"default, and {len(near) - 1} like it" if len(near) > 1 else "default", p[3])
        for p in near if p[2] == "default"]


def panel(axes, runs, level, key, factor, title, label):
    points, lines = [], {}
    for family, name in runs.labels(level):
        rows = runs.errors(level, name)
        if name.startswith("reference") or not rows or name.endswith("own packings"):
            continue
        x, y = np.mean([r["cost"] for r in rows]) / 1e6, mean_and_error([r[key] for r in rows])[0]
        if not np.isfinite(y):
            continue
        colour, marker, _ = LOOK[family]
        axes.plot(x, factor * y, marker, color=colour, ms=11 if marker == "*" else 5,
                  zorder=3 + (family == "default"))
        points.append((x, factor * y, name, colour))
    settings = list(points)
    points = grouped(points, 0.05 if level == "weak" else 0.6)
    sizes = {**runs.groups(level, "grains"), 750: list(runs.of(level, "mean of 3").values())}
    for grains, folders in sizes.items():
        if len(folders) > 1 and level == "weak":
            x = np.mean([read(f)["steps"] for f in folders]) * (grains if grains != 750 else 250) / 1e6  # of all three
            y = 100 * scatter(folders)[0]
            axes.plot(x, y, LOOK["size"][1], color=LOOK["size"][0], ms=6)
            points.append((x, y, f"N = {grains:,}" if grains != 750 else "3 × N = 250", LOOK["size"][0]))
    if level != "weak":
        for grains, folders in runs.groups(level, "grains").items():
            onset = [quantities(f)["onset"] for f in folders]
            lines[grains] = np.nanstd(onset, ddof=1) if len(onset) > 2 else np.nan
            axes.axhline(lines[grains], color=LOOK["size"][0], lw=1)
            axes.text(0.99, lines[grains] * 1.02, f"seeds, N = {grains:,}", color=LOOK["size"][0], fontsize=7.5,
                      ha="right", transform=axes.get_yaxis_transform())
    floor = [r[key] for r in runs.errors(level, "reference, 1 ppm larger")]
    if floor:
        axes.axhline(factor * np.mean(floor), color="#1a1a1a", lw=0.7, ls=":")
        axes.text(0.01, factor * np.mean(floor) / 1.03, "reference, motion 1 ppm larger", fontsize=7.5, va="top",
                  transform=axes.get_yaxis_transform())
    axes.set(xlabel="cost, 10⁶ grain-steps", ylabel=label)
    axes.set_title(title, fontsize=9.5, loc="left")
    for axis in (axes.xaxis, axes.yaxis):
        plain_logarithm(axis)
    if not points:
        return
    axes.set_xlim(min(p[0] for p in points) / 1.8, max(p[0] for p in points) * 2.4)
    heights = [p[1] for p in points] + [x for x in lines.values() if np.isfinite(x)]
    axes.set_ylim(min(heights) / 1.4, max(heights) * 1.3)
    front(axes, settings)
    spread_labels(axes, points)


def draw(runs, path):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 5.4))
    figure.subplots_adjust(left=0.065, right=0.975, top=0.85, bottom=0.1, wspace=0.17)
    panel(left, runs, "weak", "v", 100, "(a) weak motion, N = 250, far from liquefaction: surface velocity",
          "rms error, % of the rms")
    panel(right, runs, "strong", "late", 1, "(b) strong motion, N = 250: onset of liquefaction",
          "later than in the reference, s")
    handles = [plt.Line2D([], [], color=c, marker=m, ls="", ms=9 if m == "*" else 5, label=text)
               for c, m, text in LOOK.values()]
    figure.legend(handles=handles, loc="upper center", ncol=5, fontsize=8, handletextpad=0.2, columnspacing=1.4)
    save(figure, path, dpi=150)


def write_csv(runs, path):
    with open(path, "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file)
        out.writerow(["level", "family", "label", "grains", "cells", "seed", "realisations", "steps", "grain_steps",
                      "seconds", "error_velocity", "error_ru", *QUANTITIES])
        for case, folder in runs.all:
            data, slow = read(folder), runs.of(case.level, "reference", case.grains, case.cells).get(case.seed)
            error = differences(folder, slow) if slow and case.realisations == 1 else ("", "")
            out.writerow([case.level, case.family, case.label, case.grains, case.cells, case.seed, case.realisations,
                          data["steps"], data["steps"] * case.grains, data["seconds"], *error,
                          *quantities(folder).values()])


def tables(runs):
    found = {}
    for level in dict.fromkeys(case.level for case, _ in runs.all):
        for grains in (250, 1000):
            for kind, seeds in zip(("numerics", "brink"), runs.seeds(level, grains)):
                found[f"{kind}_{level}_{grains}"] = numerics_table(runs, level, seeds, grains)
            if level != "weak":
                found[f"onset_{level}_{grains}"] = onset_table(runs, level, grains)
        found |= {f"twins_{level}": twins(runs, level), f"grains_{level}": size_table(runs, level),
                  f"mesh_{level}": mesh_table(runs, level)}
        if level != "weak" and len(runs.of(level)) > 2:
            found[f"seeds_{level}"] = (
                ["two seeds differ by, standard deviations"], [[f"{runs.between_seeds(level):.2f}"]])
    return found


def write(store, planned, folder):
    runs = Runs([(run, store.folder(run)) for run in planned if store.is_done(run)])
    write_csv(runs, folder / "runs.csv")
    write_tables(folder, tables(runs))
    if runs.of("weak", "reference") and runs.of("strong", "reference"):
        draw(runs, folder / "error.png")
