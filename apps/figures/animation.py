# SPDX-License-Identifier: BSD-3-Clause
"""A run as a moving picture: packings with their contact forces, next to the stress path of a test or r_u of a column.

    isostat animate RESULTS [-o FILE.gif | FILE.mp4] [--rate FRAMES_PER_SECOND]

It shows what the run has stored: `output.snapshots` of a test, `grains.snapshot_depths` of a column. GIF files need
python3-pil, MP4 files ffmpeg.   tested: tests/apps/animation_test.py
"""
import argparse
import pathlib
import sys

import h5py
import matplotlib
import numpy as np
from matplotlib import animation

from .column_picture import draw_packing, forces, snapshot_rows
from .column_results import Column
from .column_soil import depth_axis, pore_pressure_ratio
from .command_line import CommandLine
from .common import BLACK, BLUE, GREY, BadInput, Run, note, plt, use_style
from .files import check_results, check_target

DEFAULT = "figures/animation.gif"


class TestFrames:
    """One frame for each snapshot of an element test."""

    def __init__(self, folder):
        run = Run(folder)
        self.columns, self.files = run.columns, sorted((folder / "snapshots").glob("snapshot_*.h5"))
        self.load, self.label = ("tau_xy", r"$\tau_{xy}$ (kPa)") if run.shear else ("q", "$q$ (kPa)")
        self.length = len(self.files)
        if self.length:
            self.mean_force = forces(self.files[0]).mean()

    def begin(self, figure):
        self.packing, path = figure.subplots(1, 2)
        path.plot(self.columns["p"] / 1e3, self.columns[self.load] / 1e3, color=GREY, linewidth=0.6)
        self.dot, = path.plot([], [], "o", color=BLUE)
        path.set_xlabel("$p'$ (kPa)")
        path.set_ylabel(self.label)

    def draw(self, k):
        self.packing.clear()
        draw_packing(self.packing, self.files[k], self.mean_force, up=1)
        with h5py.File(self.files[k]) as file:
            step = file["snapshot"].attrs["step"]
        row = int(np.argmin(np.abs(self.columns["step"] - step)))
        self.dot.set_data([self.columns["p"][row] / 1e3], [self.columns[self.load][row] / 1e3])


class ColumnFrames:
    """One frame for each moment at which the packings of a column were stored."""

    def __init__(self, folder):
        self.column = Column(folder)
        self.rows, self.ru = snapshot_rows(self.column), pore_pressure_ratio(self.column)
        self.length = min((len(taken) for _, taken in self.rows), default=0)
        self.mean_forces = [forces(taken[0][1]).mean() for _, taken in self.rows]

    def begin(self, figure):
        *self.packings, axes = figure.subplots(1, len(self.rows) + 1)
        self.line, = axes.plot([], [], color=BLACK)
        axes.set_xlim(0, 1.02)
        axes.set_xlabel("$r_u$")
        depth_axis(self.column, axes, self.column.profiles["depth"])
        axes.set_ylabel("Depth (m)")
        self.axes = axes

    def draw(self, k):
        for axes, (depth, taken), mean_force in zip(self.packings, self.rows, self.mean_forces):
            axes.clear()
            draw_packing(axes, taken[k][1], mean_force)
            axes.set_title(f"{depth:g} m", fontsize=9)
        time = self.rows[0][1][k][0]
        self.axes.set_title(f"{time:.2f} s", fontsize=9)
        if self.ru is not None:
            row = int(np.argmin(np.abs(self.column.profiles["time"] - time)))
            self.line.set_data(self.ru[row], self.column.profiles["depth"])


def animate(folder, out, rate):
    """Writes it.   Raises BadInput where there is nothing to show, or no program for this kind of file"""
    check_results(folder)
    kinds = {"grains/d*.pvd": ColumnFrames, "snapshots/snapshot_*.h5": TestFrames}
    frames = next((kind(folder) for pattern, kind in kinds.items() if any(folder.glob(pattern))), None)
    if not frames or not frames.length:
        raise BadInput(f"{folder}: has no two moments of stored packings. Run it with output.snapshots = \"strain\", a "
                       "column with grains.snapshot_depths and a shorter grains.snapshot_interval.")
    if out == folder / DEFAULT:
        out.parent.mkdir(exist_ok=True)
    check_target(out, {".gif": b"GIF8", ".mp4": b"ftyp"})
    name = {".gif": "pillow", ".mp4": "ffmpeg"}[out.suffix]
    if not animation.writers.is_available(name):
        raise BadInput(f"{out}: needs {name}: apt-get install {'python3-pil' if name == 'pillow' else name}")
    use_style()
    figure = plt.figure(figsize=(7.2, 3.4), layout="constrained")
    frames.begin(figure)
    animation.FuncAnimation(figure, frames.draw, frames.length).save(out, writer=name, fps=rate, dpi=110)
    plt.close(figure)
    print(f"{frames.length} frames in {out}")


def main():
    line = CommandLine(prog="isostat animate", description=__doc__,
                       formatter_class=argparse.RawDescriptionHelpFormatter)
    line.add_argument("results", type=pathlib.Path, help="results folder of element_test or soil_column")
    line.add_argument("-o", "--output", type=pathlib.Path, help="default: RESULTS/figures/animation.gif")
    line.add_argument("--rate", type=float, default=4, help="frames per second (default: 4)")
    options = line.parse_args()
    matplotlib.use("Agg")
    out = options.output or options.results / DEFAULT
    try:
        if not options.rate > 0:
            raise BadInput(f"--rate = {options.rate:g}; must be > 0, frames per second.")
        animate(options.results, out, options.rate)
    except (BadInput, OSError, KeyError) as error:
        note(error)
        sys.exit(2)


if __name__ == "__main__":
    main()
