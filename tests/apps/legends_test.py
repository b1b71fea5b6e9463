# SPDX-License-Identifier: BSD-3-Clause
"""No legend of a figure lies over the points of its curves: element tests; columns are in figures_test.py."""

import numpy as np

from figures.common import STYLE, plt
from figures.element_test import DRAWING
from support import AppTest, CYCLIC, MONOTONIC, tiny_scene

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
