# SPDX-License-Identifier: BSD-3-Clause
"""The report of a run: verdicts, summary, figures, scene, provenance, how to continue and how to cite, on one page."""
import importlib
import json
import re
import shlex

from figures.common import BadInput, note

from . import citation, column_tables, html, verdicts
from .folder import IN_PYTHON, NoResults, Results
from .quantities import converted, named, shown

REPORT = "report.html"
KEPT = ("resistance", "soil_test", "calibrate", "column_ensemble")  # the same command continues with what is missing
RESUMED = ("element_test", "soil_column", "biaxial")  # --resume continues from a checkpoint


def title_of(name):
    """"fig_stress_path": "Stress path"."""
    words = name.removeprefix("fig_").replace("_", " ")
    return re.sub(r"\bru\b", "r_u", words[0].upper() + words[1:], flags=re.I)


def summary_parts(results):
    """The rows of the summary. Where its file has none, as those of campaigns and of older runs, its text as it is;
    without a text the numbers."""
    numbers = results.numbers or {}
    if "rows" in numbers:
        return [html.properties(numbers["rows"])]
    if results.summary.strip():
        return [html.text_block(results.summary, "summary")]
    return [html.properties((named(results.program, key), shown(converted(results.program, key, value)))
                            for key, value in numbers.items() if not isinstance(value, (dict, list)))]


def calls(results):
    """How to continue with the run, and how to run its scene again: as it was started, from a shell or from Python."""
    function = results.command.split()[0]
    program = "soil_column" if results.program == "biaxial" else results.program
    if function not in IN_PYTHON:
        command = results.command.replace(" --overwrite", "")
        return (command if "--resume" in command else command + " --resume",
                f"{program} {shlex.quote(str(results.path / 'scene.toml'))} --output results/again")
    function, folder = function.removesuffix("()"), json.dumps(results.path.as_posix(), ensure_ascii=False)
    return f"{function}(scene, {folder}, resume=True)", f'{function}(scene, "results/again")'


def resume_parts(results):
    """How to continue and how to repeat the run, as far as its files show."""
    program, command = results.program, results.command.replace(" --overwrite", "")
    parts = []
    if not command:
        return parts
    resumed, again = calls(results)
    if program in KEPT:
        parts += [html.paragraph("What has been computed is kept. The same command continues with what is missing:"),
                  html.text_block(command, "command")]
    elif program in RESUMED and results.has_checkpoint:
        ended = "" if results.numbers is None else " The run has ended; this repeats what came after that checkpoint."
        parts += [html.paragraph("From the newest checkpoint, to the same bits, with the options of the first call."
                                 + ended), html.text_block(resumed, "command")]
    elif program in RESUMED and results.numbers is not None:
        parts.append(html.paragraph("The run has ended and has left no checkpoint; there is nothing to resume."))
    if program not in KEPT and results.scene_text and program != "rve_replay":
        parts += [html.paragraph("The same run again, from the scene below, in another folder:"),
                  html.text_block(again, "command")]
    return parts


class Page:
    """Collects the figures of a run while they are drawn, and writes them with the rest."""

    def __init__(self, results, drawing):
        self.results, self.drawing = results, drawing
        self.figures = []

    def add(self, name, figure, drawn):
        """@param drawn  what the figure is drawn from"""
        caption = self.drawing.caption(name, self.drawing.kinds(drawn))
        self.figures.append(html.figure(name, title_of(name), caption, figure))

    def text(self, drawn, reason):
        """The page.   @param drawn  what the figures are drawn from, or None   @param reason  why there are none"""
        r = self.results
        found = verdicts.of_run(r, drawn)
        items = "\n".join(f'<li class="{v.kind}"><strong>{html.escape(v.name)}</strong>{html.escape(v.text)}</li>'
                          for v in found)
        missing = html.paragraph(f"{'Some' if self.figures else 'No'} figures: {reason}") if reason else ""
        sections = [
            html.section("How it went", f'<ul class="verdicts">\n{items}\n</ul>' if items else "", name="verdicts"),
            html.section("Summary", *summary_parts(r), name="summary"),
            *(column_tables.sections(drawn) if r.program == "soil_column" and drawn else []),
            html.section("Figures", html.figures(self.figures), missing, name="figures"),
            html.section("Going on, and repeating it", *resume_parts(r), name="resume"),
            html.section("Scene", html.text_block(r.scene_text, "scene") if r.scene_text else "", name="scene"),
            html.section("Provenance", *(html.properties(call.items()) for call in r.calls), name="provenance"),
            html.section("Citing", *citation.parts(r.provenance.get("version")), name="citing"),
        ]
        started = f", started {r.provenance['started']}" if "started" in r.provenance else ""
        return html.page(r.title, f"{r.program}{started}", sections)


def leave(folder, program):
    """Draws the figures of a results folder and leaves its report. Returns the exit code: 2 if it cannot be drawn, 3 if
    the figures are there and the report is not."""
    drawing = importlib.import_module(f"figures.{program}").DRAWING
    page, drawn, reason, failure = None, None, "", None
    try:
        page = Page(Results(folder, program), drawing)
    except NoResults as error:
        failure = error

    def each(name, figure):
        nonlocal failure
        try:
            if failure is None:
                page.add(name, figure, drawn)
        except Exception as error:  # pylint: disable=broad-except  (a report never costs a figure)
            failure = error

    try:
        drawn = drawing.results(folder)
        drawing.draw(drawn, folder / "figures", each)
    except (BadInput, OSError) as error:
        reason = str(error)
    try:
        if failure is not None:
            raise failure
        html.write_replacing(folder / REPORT, page.text(drawn, reason))
        print(folder / REPORT)
    except Exception as error:  # pylint: disable=broad-except
        note(f"{folder / REPORT}: not written, because of {type(error).__name__}: {error}")
        failure = error
    if reason:
        note(reason)  # last: the program that has started this repeats the last line
    return 2 if reason else 3 if failure is not None else 0
