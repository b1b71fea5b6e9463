#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the cells of notebooks from the first to the last and stores what they print and draw, without Jupyter.

    scripts/notebook.py examples/notebooks/*.ipynb    with Debian's Python, from an empty folder, package on PYTHONPATH

tested: tests/tutorial_test.py
"""
import base64
import contextlib
import io
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)


def run(notebook, name):
    """The notebook (parsed JSON) with the outputs of its code cells: printed text and figures."""
    variables = {"__name__": "__main__"}
    code = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    for number, cell in enumerate(code, 1):
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            program = compile("".join(cell["source"]), f"{name}, cell {number}", "exec")
            exec(program, variables)  # pylint: disable=exec-used
        cell["execution_count"] = number
        cell["outputs"] = []
        if printed.getvalue():
            cell["outputs"].append({"output_type": "stream", "name": "stdout",
                                    "text": printed.getvalue().splitlines(keepends=True)})
        for figure in map(plt.figure, plt.get_fignums()):
            png = io.BytesIO()
            figure.savefig(png, dpi=80, format="png", metadata={"Software": None})
            image = base64.b64encode(png.getvalue()).decode()
            cell["outputs"].append({"output_type": "display_data", "metadata": {},
                                    "data": {"image/png": image, "text/plain": ["<Figure>"]}})
        plt.close("all")
    return notebook


def main():
    if not sys.argv[1:] or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    for path in map(pathlib.Path, sys.argv[1:]):
        notebook = run(json.loads(path.read_text(encoding="utf-8")), path.name)
        path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
