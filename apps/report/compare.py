# SPDX-License-Identifier: BSD-3-Clause
"""Two runs of one kind side by side: numbers of their summaries, what differs in their scenes, curves in one figure."""
import re

from figures.common import BadInput, plt, use_style
from figures.files import check_target

from . import compare_curves, html
from .folder import NUMBERS, NoResults, find_results
from .quantities import converted, flat, is_number, named, shown

SAME = 1e-12  # relative difference of numbers that are written with all digits: the same
NAMES = "AB"


def change(first, second):
    """B - A and the same as a share of |A|, as text."""
    if not (is_number(first) and is_number(second)):
        return ("", "") if first == second else ("differs", "")
    difference = second - first
    if abs(difference) <= SAME * max(abs(first), abs(second)):
        return "0", ""
    return f"{difference:+.4g}", f"{100 * difference / abs(first):+.3g} %" if first * second > 0 else ""


def shown_summary(results):
    """{name (unit): value} of a summary. Lists of tables, such as layers, repeat the scene and are left out."""
    return {named(results.program, key): converted(results.program, key, value)
            for key, value in flat(results.numbers).items() if not re.search(r"\.\d+\.", key)}


def number_rows(one, other):
    """A row for each number of two tables {name: value}, those that are the same marked so."""
    for key in dict.fromkeys([*one, *other]):
        values = one.get(key), other.get(key)
        if key == "title" or not any(is_number(value) for value in values):
            continue
        difference = change(*values)
        yield (["same" if difference == ("0", "") else ""], key, *map(shown, values), *difference)


def key_rows(first, second):
    """A row for each key of two tables that has another value, or none, in one of them."""
    one, other = flat(first), flat(second)
    return [(key, shown(one.get(key)), shown(other.get(key))) for key in dict.fromkeys([*one, *other])
            if one.get(key) != other.get(key)]


def difference_table(rows, head, nothing, label):
    return html.table((head, *NAMES), rows, label) if rows else html.paragraph(nothing)


def check(pair):
    """Both finished, and of one kind.   Raises NoResults"""
    for results in pair:
        if results.numbers is None:
            raise NoResults(f"{results.path}: is not finished, because {NUMBERS[results.program]} does not exist yet. "
                            "Wait for the run, or continue with it by its command and --resume.")
    one, other = pair
    if one.program != other.program:
        raise NoResults(f"{one.path} is of {one.program}, {other.path} of {other.program}: they have nothing to "
                        "compare. Give two runs of one program.")
    if one.program not in compare_curves.OF_PROGRAM:
        raise NoResults(f"{one.path}: runs of {one.program} cannot be compared, only those of "
                        f"{', '.join(compare_curves.OF_PROGRAM)}.")


def read_curves(pair):
    """What the curves are drawn from.   Raises NoResults for files that cannot be read or kinds that differ"""
    curves = compare_curves.OF_PROGRAM[pair[0].program]
    read = []
    for results in pair:
        try:
            read.append(curves.drawing.results(results.path))
        except BadInput as error:
            where = "" if str(error).startswith(str(results.path)) else f"{results.path}: "
            raise NoResults(f"{where}{error}. Give the folder as the run has left it.") from error
    kinds = [curves.kind(item) for item in read]
    if kinds[0] != kinds[1]:
        raise NoResults(f"{pair[0].path} is {kinds[0]}, {pair[1].path} {kinds[1]}: their curves are of different "
                        "quantities. Give two runs of one kind.")
    return curves, read


def page(pair):
    curves, read = read_curves(pair)
    use_style()
    names = [f"{name}: {results.path.resolve().name}" for name, results in zip(NAMES, pair)]
    legend = ", ".join(f"{name} {word}" for name, word in zip(names, compare_curves.WORDS)) + "."
    parts = []
    for name, (title, caption, draw) in curves.figures.items():
        figure = draw(read, names)
        if figure is not None:
            figure.draw_without_rendering()
            parts.append(html.figure(name, title, f"{caption(read)} {legend}", figure))
            plt.close(figure)
    one, other = pair
    runs = [("title", one.title, other.title), ("folder", one.path, other.path)]
    runs += [(key, *(results.provenance.get(key, "-") for results in pair)) for key in ("version", "started")]
    provenance = [row for row in key_rows(one.provenance, other.provenance) if row[0] not in ("version", "started")]
    return html.page(
        f"{one.path.resolve().name} and {other.path.resolve().name}", f"Two runs of {one.program}", [
            html.section("Runs", html.table(("", *NAMES), runs, "runs"), name="runs"),
            html.section("Curves", html.figures(parts), name="figures"),
            html.section("Numbers", html.paragraph("Of the curves, then of the summaries. A grey row is the same in "
                                                   "both."),
                         html.table(("", *NAMES, "B - A", "of |A|"),
                                    [*number_rows(*map(curves.numbers, read)),
                                     *number_rows(*map(shown_summary, pair))],
                                    "numbers of both summaries", numbers=(1, 2, 3, 4)), name="numbers"),
            html.section("Scene", difference_table(key_rows(one.scene, other.scene), "key",
                                                   "Every key of the scenes is the same.", "keys that differ"),
                         name="scene"),
            html.section("Provenance", difference_table(provenance, "", "Version and start are above; the rest is "
                                                        "the same.", "what differs in provenance"), name="provenance"),
        ])


def leave(first, second, output):
    """Writes the comparison of two results folders.   Raises BadInput"""
    pair = find_results(first), find_results(second)
    check(pair)
    check_target(output, {output.suffix: html.GENERATOR.encode()})
    text = page(pair)
    try:
        html.write_replacing(output, text)
    except OSError as error:
        raise NoResults(f"{output}: cannot be written ({error.strerror}). Give another --output.") from error
    print(output)
    return 0
