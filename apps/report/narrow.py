# SPDX-License-Identifier: BSD-3-Clause
"""Figures for narrow windows: panels side by side come below each other, so that their labels stay readable.

tested: tests/apps/report_test.py"""
import math

from matplotlib.gridspec import GridSpec

WIDTH = 4.2  # inches of a stacked figure: 9 pt are then as large as the text of a page on a telephone
LEGEND_ROW, LEGEND_EDGE = 0.2, 0.1  # inches
LONG = 60  # letters of a label, from which it takes two lines


def panels_of(figure):
    """The axes of a figure without colour bars, which follow their panels."""
    return [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]


def side_by_side(figure):
    """Whether the panels of a figure are those of one grid with several columns."""
    if not all(hasattr(axes, "get_subplotspec") for axes in panels_of(figure)):
        return False
    specs = [axes.get_subplotspec() for axes in panels_of(figure)]
    if not specs or None in specs:
        return False
    grid = specs[0].get_gridspec()
    return grid.ncols > 1 and len(specs) == grid.nrows * grid.ncols and all(s.get_gridspec() is grid for s in specs)


def stack_legend(figure, legend):
    """The legend of the figure in as many columns as fit. Returns the layout's rectangle next to it."""
    # the handles have another name before matplotlib 3.7
    handles = legend.legend_handles if hasattr(legend, "legend_handles") else legend.legendHandles
    labels = [text.get_text() for text in legend.get_texts()]
    share = legend.get_window_extent().width / figure.bbox.width
    columns = max(1, min(len(labels), int(len(labels) * 0.95 / share)))
    taken = (LEGEND_ROW * math.ceil(len(labels) / columns) + LEGEND_EDGE) / figure.get_figheight()
    above = legend.get_window_extent().y0 > 0.5 * figure.bbox.height
    legend.remove()
    figure.legend(handles, labels, loc="upper right" if above else "lower center", ncols=columns)
    return (0, 0 if above else taken, 1, 1 - taken)


def stack(figure):
    """Lays out a figure again that has been drawn, its panels below each other, row by row."""
    panels = panels_of(figure)
    grid = panels[0].get_subplotspec().get_gridspec()
    rows = [panels[k:k + grid.ncols] for k in range(0, len(panels), grid.ncols)]
    for row in rows:
        for axes, last in zip(row, rows[-1]):
            axes.tick_params(labelbottom=True, labelleft=True)
            label = axes.get_xlabel() or last.get_xlabel()
            axes.set_xlabel(label if len(label) < LONG else label.replace(" (", "\n(", 1))
            axes.set_ylabel(axes.get_ylabel() or row[0].get_ylabel())
    heights = [height for height in grid.get_height_ratios() for _ in range(grid.ncols)]
    whole = GridSpec(len(panels), 1, figure=figure, height_ratios=heights)
    for k, axes in enumerate(panels):
        axes.set_subplotspec(whole[k])
    height = min(figure.get_figheight() / grid.nrows, 0.75 * WIDTH)
    legends = list(figure.legends)
    figure.set_size_inches(WIDTH, height * len(panels) + 2 * LEGEND_ROW)
    figure.set_layout_engine("constrained")
    for legend in legends:
        figure.get_layout_engine().set(rect=stack_legend(figure, legend))
    figure.draw_without_rendering()
