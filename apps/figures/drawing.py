# SPDX-License-Identifier: BSD-3-Clause
"""What a module says of a program's figures, and how they are drawn into a folder."""
import dataclasses
import typing

from .common import STYLE, BadInput, note, plt


@dataclasses.dataclass
class Drawing:
    """The figures of a program.

    read      folder -> results, with a `title` or None; raises BadInput, OSError, KeyError, ValueError on wrong files
    figures   {name: draw}, draw(results) -> figure, or None if there is nothing to draw
    undrawn   called with name and results for each of these
    """

    read: typing.Callable
    figures: dict
    undrawn: typing.Callable = lambda name, results: None

    def draw(self, folder, out, beside=()):
        """Draws every figure of a results folder. Returns the exit code: 2 if the folder cannot be drawn."""
        try:
            results = self.read(folder)
            results.beside = [self.read(other) for other in beside]
            out.mkdir(parents=True, exist_ok=True)
        except KeyError as error:
            note(f"{folder}: {error} is missing in its files, or is no unit")
            return 2
        except (BadInput, OSError, ValueError) as error:
            note(error)
            return 2
        plt.rcParams.update(STYLE)
        for name, draw in self.figures.items():
            self._save(name, draw(results), results, out)
        return 0

    def _save(self, name, figure, results, out):
        if figure is None:
            self.undrawn(name, results)
            return
        if results.title:
            figure.suptitle(results.title, fontsize=9.5, x=0.01, ha="left")
        figure.set_dpi(plt.rcParams["savefig.dpi"])
        figure.draw_without_rendering()  # laid out anew by savefig, with as many ticks as this has found room for
        figure.savefig(out / f"{name}.png")
        plt.close(figure)
        print(out / f"{name}.png")
