# SPDX-License-Identifier: BSD-3-Clause
"""What a results folder holds besides its tables: program, scene, summary, provenance."""
import re
import tomllib

from figures.files import BadInput, Damaged, check_results, read_parsed

# The file with the numbers of a program's summary; it is written last, so a run that has it is finished. A biaxial
# block is a run of soil_column.
NUMBERS = {"element_test": "summary.json", "soil_column": "summary.json", "biaxial": "summary.json",
           "rve_replay": "summary.json", "resistance": "resistance.json", "soil_test": "soil_test.json",
           "calibrate": "calibrate.json", "micromechanics": "micromechanics.json",
           "column_ensemble": "ensemble.json"}
TOLD_BY_FILE = ("micromechanics", "resistance", "soil_test", "calibrate", "column_ensemble")  # whatever was called

IN_PYTHON = {"isostat.run()": "element_test", "isostat.column.run()": "soil_column"}  # whose files they leave


class NoResults(BadInput):
    """The folder is not what it was taken for; the message says what to do."""


def text_of(path):
    """The text of a file, or nothing if it does not exist."""
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""


def read_provenance(text):
    """{name: value} of lines `name   value`."""
    return dict(re.findall(r"^(\S.*?)\s{2,}(.*\S)\s*$", text, re.M))


def read_calls(text):
    """Of a folder to which a command comes back the provenance of each call, the first first."""
    return [read_provenance(part) for part in text.split("\n\n") if part.strip()]


class Results:
    """The files of a folder. What is missing is empty; `numbers` is None as long as the run is not finished."""

    def __init__(self, path, program):
        self.path, self.program = path, program
        self.calls = read_calls(text_of(path / "provenance.txt"))
        self.provenance = self.calls[-1] if self.calls else {}
        self.scene_text = text_of(path / "scene.toml")
        self.scene = self._table("scene.toml", tomllib.loads) or {}
        self.summary = text_of(path / "summary.txt")
        self.numbers = self._table(NUMBERS[program])

    def _table(self, name, *parse):
        """The table in a file of the folder, or None if it does not exist.   Raises NoResults"""
        try:
            return read_parsed(self.path / name, *parse)
        except OSError:
            return None
        except Damaged as error:
            raise NoResults(error) from error

    @property
    def title(self):
        """That of the scene, or the name of the folder; an analysis has that of the run whose folder it is in."""
        if self.program == "micromechanics":
            return f"Micromechanics of {self.path.resolve().parent.name}"
        given = (self.numbers or {}).get("title") or self.scene.get("title")
        return given or self.path.resolve().name

    @property
    def command(self):
        return self.provenance.get("command", "")

    @property
    def has_checkpoint(self):
        return (self.path / "checkpoint").is_dir()


def find_results(path):
    """The results in a folder, of the program that its provenance names.   Raises BadInput"""
    check_results(path)
    for program in TOLD_BY_FILE:
        if (path / NUMBERS[program]).is_file():
            return Results(path, program)
    words = read_provenance(text_of(path / "provenance.txt")).get("command", "").split()
    program = words[0].rpartition("/")[2] if words else ""
    program = IN_PYTHON.get(program, program)
    if program not in NUMBERS:
        reason = f"its provenance.txt names {program}" if program else "it has no provenance.txt with a command"
        raise NoResults(f"{path}: is not a results folder that can be reported ({reason}). Give the folder in which "
                        f"one of these left its results: {', '.join(NUMBERS)}.")
    results = Results(path, program)
    if program == "soil_column" and results.scene.get("analysis", {}).get("kind") == "biaxial":
        results.program = "biaxial"
    return results
