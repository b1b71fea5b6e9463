# SPDX-License-Identifier: BSD-3-Clause
"""What a module says of a program's figures, and how they are drawn into a folder."""
import dataclasses
import re
import textwrap
import traceback
import typing

from .common import BadInput, plain, plt, use_style
from .files import replacing


def draws(name, parts=None):
    """Of a function draw(results) -> figure, pages of it, or None if there is nothing to draw: the name of the figure;
    pages from the second on have their number behind it. Its caption is the docstring of the function, with the
    parts {kind of results: text} that fit."""
    def mark(draw):
        draw.name, draw.parts = name, parts or {}
        return draw
    return mark


def pages_of(drawn):
    """The figures that a function has drawn."""
    return drawn if isinstance(drawn, list) else [] if drawn is None else [drawn]


@dataclasses.dataclass
class Drawing:
    """The figures of a program.

    read      folder -> results, with a `title` or None; raises BadInput, OSError, KeyError, ValueError on wrong files
    all       what draws them, in their order
    undrawn   called with name and results for each without a figure
    kinds     results -> the kinds they are of
    """

    read: typing.Callable
    all: list
    undrawn: typing.Callable = lambda name, results: None
    kinds: typing.Callable = lambda results: set()

    @property
    def figures(self):
        return {draw.name: draw for draw in self.all}

    def caption(self, name, kinds):
        """As a sentence, with the parts that fit results of these kinds."""
        draw = self.figures[re.sub(r"_\d+$", "", name)]
        own = " ".join((draw.__doc__ or "").split()).removesuffix(".")
        text = "; ".join(filter(None, (own, *(part for kind, part in draw.parts.items() if kind in kinds))))
        return f"{text if text[1] == '_' else text[0].upper() + text[1:]}."

    def results(self, folder, beside=()):
        """What is read from a results folder, with that of others next to it.   Raises BadInput"""
        try:
            results = self.read(folder)
            results.beside = [self.read(other) for other in beside]
            return results
        except KeyError as error:
            raise BadInput(f"{folder}: {error} is missing in its files, or is no unit") from error
        except (OSError, ValueError) as error:
            raise BadInput(error) from error

    def draw(self, results, out, each=lambda name, figure: None):
        """Leaves every figure of the results in a folder. `each` is called with name and figure when it is saved.
        Raises BadInput, when the others are drawn, with the names of those that fail, and OSError"""
        out.mkdir(parents=True, exist_ok=True)
        use_style()
        failed = []
        for name in self.figures:
            try:
                self._draw(name, results, out, each)
            except OSError:
                raise
            except Exception as error:  # pylint: disable=broad-except  (one figure does not cost the others)
                traceback.print_exc()
                failed.append(f"{name} ({type(error).__name__}: {error})")
                plt.close("all")
        if failed:
            raise BadInput(f"not drawn: {', '.join(failed)}")

    def _draw(self, name, results, out, each):
        pages = pages_of(self.figures[name](results))
        if not pages:
            self.undrawn(name, results)
        for number, figure in enumerate(pages, 1):
            page = name if number == 1 else f"{name}_{number}"
            self._save(page, figure, results, out)
            each(page, figure)
            plt.close(figure)

    @staticmethod
    def _save(name, figure, results, out):
        if results.title:
            lines = textwrap.wrap(results.title, int(14 * figure.get_figwidth()))  # letters in an inch, at this size
            figure.suptitle(plain("\n".join(lines)), fontsize=9.5, x=0.01, ha="left")
        figure.set_dpi(plt.rcParams["savefig.dpi"])
        figure.draw_without_rendering()  # laid out again by savefig, with as many ticks as this has found room for
        path = out / f"{name}.png"
        with replacing(path) as aside:
            figure.savefig(aside, format="png")
        print(path)
