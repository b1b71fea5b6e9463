# SPDX-License-Identifier: BSD-3-Clause
"""The report of a run: verdicts, summary, figures, scene, provenance, how to go on and how to cite, on one page."""
import importlib
import json
import re

from figures.common import BadInput, note
from figures.drawing import fitting

from . import citation, html, verdicts
from .folder import IN_PYTHON, NoResults, Results
from .quantities import converted, named

REPORT = "report.html"
KEPT = ("resistance", "calibrate", "column_ensemble")  # the same command goes on with what is missing
RESUMED = ("element_test", "soil_column")  # --resume goes on from a checkpoint
FIGURE_LINE = re.compile(r"^(\w+)\.png\s+(\S.*(?:\n[ ]{8,}\S.*)*)", re.M)


def captions(module, kinds):
    """{figure: what it shows}, from the list of figures at the top of the module that draws them: the parts that fit
    results of these kinds."""
    texts = {name: fitting(" ".join(text.split()), kinds) for name, text in FIGURE_LINE.findall(module.__doc__ or "")}
    return {name: (text if text[1:2] == "_" else text[0].upper() + text[1:]) + "."
            for name, text in texts.items() if text}


def title_of(name):
    """"fig_stress_path": "Stress path"."""
    words = name.removeprefix("fig_").replace("_", " ")
    return re.sub(r"\bru\b", "r_u", words[0].upper() + words[1:], flags=re.I)


def name_and_value(line, column):
    """Of a line `  name   value`, whose value begins at this column if a long name leaves one space only; or None."""
    match = re.fullmatch(r"  (\S.*?)\s{2,}(\S.*)", line)
    if match:
        return match.groups()
    is_long = re.fullmatch(r"  \S.*", line) and column < len(line) and line[column - 1] == " " != line[column]
    return (line[2:column].strip(), line[column:]) if is_long else None


def summary_parts(results):
    """Lines `  name   value` as a table; a text that has others, such as tables, as it is. Without a text the
    numbers."""
    lines = results.summary.strip("\n").splitlines()
    if not lines:
        numbers = {named(results.program, key): converted(results.program, key, value)
                   for key, value in (results.numbers or {}).items() if not isinstance(value, (dict, list))}
        return [html.properties((key, f"{value:.6g}" if isinstance(value, float) else value)
                                for key, value in numbers.items())]
    starts = [match.end() for match in (re.match(r"  \S.*?\s{2,}(?=\S)", line) for line in lines[1:]) if match]
    column = max(set(starts), key=starts.count, default=0)
    pairs = [name_and_value(line, column) for line in lines[1:]]
    return [html.properties(pairs)] if pairs and all(pairs) else [html.text_block("\n".join(lines), "summary")]


def calls(results):
    """How to go on with the run, and how to run its scene again: as it was started, from a shell or from Python."""
    function = results.command.split()[0]
    if function not in IN_PYTHON:
        command = results.command.replace(" --overwrite", "")
        return (command if "--resume" in command else command + " --resume",
                f"{results.program} scene.toml --output results/again")
    function, folder = function.removesuffix("()"), json.dumps(results.path.as_posix(), ensure_ascii=False)
    return f"{function}(scene, {folder}, resume=True)", f'{function}(scene, "results/again")'


def resume_parts(results):
    """How to go on and how to repeat the run, as far as its files tell."""
    program, command = results.program, results.command.replace(" --overwrite", "")
    parts = []
    if not command:
        return parts
    resumed, again = calls(results)
    if program in KEPT:
        parts += [html.paragraph("What has been computed is kept. The same command goes on with what is missing:"),
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

    def __init__(self, results, module):
        self.results, self.module = results, module
        self.figures = []

    def add(self, name, figure, drawn):
        """@param drawn  what the figure is drawn from"""
        title = title_of(name)
        caption = captions(self.module, self.module.DRAWING.kinds(drawn)).get(name, title)
        self.figures.append(html.figure(name, title, caption, figure))

    def text(self, drawn, reason):
        """The page.   @param drawn  what the figures are drawn from, or None   @param reason  why there are none"""
        r = self.results
        found = verdicts.of_run(r, drawn)
        items = "\n".join(f'<li class="{v.kind}"><strong>{html.escape(v.name)}</strong>{html.escape(v.text)}</li>'
                          for v in found)
        missing = html.paragraph(f"No figures: {reason}") if reason else ""
        sections = [
            html.section("How it went", f'<ul class="verdicts">\n{items}\n</ul>' if items else "", name="verdicts"),
            html.section("Summary", *summary_parts(r), name="summary"),
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
    module = importlib.import_module(f"figures.{program}")
    page, drawn, reason, failure = None, None, "", None
    try:
        page = Page(Results(folder, program), module)
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
        drawn = module.DRAWING.results(folder)
        module.DRAWING.draw(drawn, folder / "figures", each)
    except (BadInput, OSError) as error:
        note(error)
        reason = str(error)
    try:
        if failure is not None:
            raise failure
        html.write_replacing(folder / REPORT, page.text(drawn, reason))
        print(folder / REPORT)
    except Exception as error:  # pylint: disable=broad-except
        note(f"{folder / REPORT}: not written, because of {type(error).__name__}: {error}")
        return 3
    return 2 if reason else 0
