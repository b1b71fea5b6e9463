# SPDX-License-Identifier: BSD-3-Clause
"""What the figures of element tests are drawn against, that no legend lies over the points of its curves, and the peaks
that the figures of columns name. Other figures of columns are in figures_test.py."""
import json

import numpy as np
from matplotlib.colors import PowerNorm

import column_fixture as fixture
from figures.column_expansion import expansion
from figures.column_motion import motions, peak_text
from figures.column_results import Column
from figures.column_soil import time_bar
from figures.common import STYLE, Run, plt
from figures.element_test import DRAWING, draw_pressure
from support import CYCLIC, MONOTONIC, AppTest, tiny_scene

DIGITS = "round-off of a sum"
DRAINED = '[[stage]]\nkind = "drained"\nstrain = 0.02\n'


def within(points, box):
    """Which of the points (n x 2) lie in a box, in pixels."""
    return ((points > box.min) & (points < box.max)).all(axis=1)


def covered(figure):
    """Label and number of the points of each line that a legend of its axes, or of the figure, lies over."""
    figure.draw_without_rendering()
    over_all = list(figure.legends)
    found = []
    for axes in figure.axes:
        boxes = [legend.get_window_extent() for legend in (*over_all, axes.get_legend()) if legend]
        for line in axes.lines:
            points = line.get_transform().transform(line.get_xydata())
            points = points[within(points, axes.get_window_extent())]
            n = int(np.any([within(points, box) for box in boxes], axis=0).sum()) if boxes else 0
            if n > 0:
                found.append((line.get_label(), n))
    return found


class Progress(AppTest):
    def run_of(self, strain, load, reversals):
        rows = ["q (kPa),p (kPa),eps_y (-),reversals (-)"]
        rows += [f"{q},100,{e},{n}" for e, q, n in zip(strain, load, reversals)]
        self.write("history.csv", "\n".join(rows) + "\n")
        self.write("summary.json", json.dumps({"p0": 1e5, "shear_stage_first_row": 0}))
        return Run(self.folder)

    def test_cycles(self):
        """Half a cycle at the first reversal, one at the second, as the summary counts; then half of the way back."""
        run = self.run_of([0, 0.5, 1, 0, -1, -0.5, 0], [0, 15, 30, 0, -30, -15, 0], [0, 0, 1, 1, 2, 2, 2])
        self.assert_close(run.progress, [0, 0.25, 0.5, 0.75, 1.0, 1.125, 1.25], 1e-12, DIGITS)
        self.assertEqual(run.progress_label, "Number of cycles (half the reversals)")

    def test_an_unfinished_half_cycle_is_not_drawn_as_a_whole_one(self):
        """It has gone three times as far as the one before, but its load is half of the way up only."""
        run = self.run_of([0, 1, -1, 5], [0, 30, -30, 0], [0, 1, 2, 2])
        self.assert_close(run.progress[-2:], [1.0, 1.25], 1e-12, DIGITS)
        whole = self.run_of([0, 1, -1, 5], [0, 30, -30, 30], [0, 1, 2, 2])
        self.assert_close(whole.progress[-1], 1.5, 1e-12, DIGITS)

    def test_a_path_that_turns_back(self):
        """Compression, then extension: against the strain its measures would cross themselves."""
        run = self.run_of([0, 0.01, 0.02, 0.01, -0.01], [0, 30, 40, 0, -20], [0] * 5)
        self.assert_close(run.progress, [0, 1, 2, 3, 5], 1e-12, DIGITS)
        self.assertIn("Strain travelled", run.progress_label)
        straight = self.run_of([0, 0.01, 0.0199, 0.02], [0, 30, 40, 40], [0] * 4)
        self.assert_close(straight.progress, 100 * np.array([0, 0.01, 0.0199, 0.02]), 1e-12, DIGITS)


class Panels(AppTest):
    def scale_of(self, pressures):
        rows = [f"{k},{p},{0.01 * k},0" for k, p in enumerate(pressures)]
        self.write("history.csv", "q (kPa),p (kPa),eps_y (-),reversals (-)\n" + "\n".join(rows) + "\n")
        self.write("summary.json", json.dumps({"p0": 1e5, "shear_stage_first_row": 0}))
        axes = plt.figure().subplots()
        self.addCleanup(plt.close, "all")
        draw_pressure(Run(self.folder), axes)
        return axes.get_yscale(), axes.get_ylim()[0]

    def test_decades_are_for_what_liquefies(self):
        self.assertEqual(self.scale_of([100, 150, 160]), ("linear", 0))
        self.assertEqual(self.scale_of([100, 50, 0.5])[0], "log")

    def test_time_bar_says_where_its_colours_end(self):
        """A motion of 0.87 s in a run of 4 s: the bar ends there, and says that later times have one colour."""
        for last, said in (4.0, "Time (s); one colour after 0.87 s"), (0.87, "Time (s)"):
            figure, panels = plt.subplots(1, 2)
            self.addCleanup(plt.close, figure)
            time_bar(figure, panels, PowerNorm(1.0, 0, 0.87), last)
            self.assertEqual(figure.axes[-1].get_ylabel(), said)


class Expansion(AppTest):
    def test_both_sides_have_one_scale(self):
        """Expansion and compression of one size are equally far from white, and the label says how the scale runs."""
        figure = expansion(Column(fixture.capped(self.folder / "run")))
        self.addCleanup(plt.close, figure)
        norm = figure.axes[1].collections[0].norm
        self.assertEqual(norm.vmin, -norm.vmax)
        for strain in norm.vmax, 0.3 * norm.vmax, 0.01 * norm.vmax:
            self.assert_near(norm(strain) + norm(-strain), 1, 1e-12, DIGITS)
        self.assertIn(f"logarithmic beyond {norm.linthresh:g} %", figure.axes[-1].get_ylabel())


class Peaks(AppTest):
    def test_of_all_steps(self):
        self.assertEqual(peak_text(3.64, 3.861), "3.64 m/s$^2$ (3.86 in all steps)")
        self.assertEqual(peak_text(3.861, 3.8612), "3.86 m/s$^2$")
        self.assertEqual(peak_text(3.64, None), "3.64 m/s$^2$")

    def test_labels_lie_within_their_panels(self):
        """Peaks up and down, early and late, and values of all steps next to them: nothing lies over an axis."""
        column = Column(fixture.elastic(self.folder / "run"))
        column.peaks = {name: 1.01 * column.peak(name) for name in ("input_ax", "surface_ax")}
        plt.rcParams.update(STYLE)
        for sign in (1, -1):
            for shift in range(0, len(column.time), len(column.time) // 12):
                for name in column.peaks:
                    column.columns[name] = sign * np.roll(column[name], shift)
                figure = motions(column)
                figure.draw_without_rendering()
                for axes in figure.axes:
                    label, panel = axes.texts[0].get_window_extent(), axes.get_window_extent()
                    inside = (label.min > panel.min).all() and (label.max < panel.max).all()
                    self.assertTrue(inside, f"{axes.texts[0].get_text()}: {label} in {panel}")
                plt.close(figure)


class Legends(AppTest):
    def check(self, folder):
        plt.rcParams.update(STYLE)
        results = DRAWING.results(folder)
        figures = {name: draw(results) for name, draw in DRAWING.figures.items()}
        for name, figure in figures.items():
            if figure is not None:
                self.assertEqual(covered(figure), [], f"{folder.name}: {name}")
                plt.close(figure)
        self.assertGreater(sum(figure is not None for figure in figures.values()), 1)

    def test_a_covered_curve_is_found(self):
        figure, axes = plt.subplots()
        axes.plot([0, 1, 2], [0, 1, 2], label="below")
        axes.legend(loc="upper right")
        self.assertEqual(covered(figure), [("below", 1)])
        axes.legend(loc="upper left")
        self.assertEqual(covered(figure), [])
        plt.close(figure)

    def test_element_tests(self):
        for name, stages in (("cyclic", CYCLIC.format(steps=4000)), ("monotonic", MONOTONIC.format(steps=4000)),
                             ("drained", DRAINED)):
            self.assert_done(self.run_test(self.write("scene.toml", tiny_scene(stages=stages)), "-o", name, "--quiet"))
            self.check(self.folder / name)
