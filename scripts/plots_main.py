# SPDX-License-Identifier: BSD-3-Clause
"""The command line of the scripts that draw the figures of a results folder."""
import argparse
import pathlib

from plots_common import STYLE, BadInput, note, plt


def save_figures(results, figures, out, undrawn=None):
    """Draws every figure into the folder `out`; see draw_results."""
    plt.rcParams.update(STYLE)
    for name, draw in figures.items():
        figure = draw(results)
        if figure is None:
            if undrawn:
                undrawn(name, results)
            continue
        figure.suptitle(results.title, fontsize=9.5, x=0.01, ha="left")
        figure.savefig(out / f"{name}.png")
        plt.close(figure)
        print(out / f"{name}.png")


def draw_results(description, files, read, figures, undrawn=None):
    """Draws every figure of a folder that is named on the command line.

    description   what the script says of itself
    files         what the folder must hold, in words
    read          folder -> results with a `title`; raises BadInput, OSError, KeyError, ValueError on wrong files
    figures       {name: draw}, draw(results) -> figure, or None if there is nothing to draw
    undrawn       called with name and results for each of these
    Returns the exit code: 2 if the folder cannot be drawn.
    """
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("results", type=pathlib.Path, help=f"folder with {files}")
    parser.add_argument("--out", type=pathlib.Path, help="folder of the figures; default: RESULTS/figures")
    arguments = parser.parse_args()
    out = arguments.out or arguments.results / "figures"
    try:
        results = read(arguments.results)
        out.mkdir(parents=True, exist_ok=True)
    except KeyError as error:
        note(f"{arguments.results}: {error} is missing in its files, or is no unit")
        return 2
    except (BadInput, OSError, ValueError) as error:
        note(error)
        return 2
    save_figures(results, figures, out, undrawn)
    return 0
