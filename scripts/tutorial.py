#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Follows the tutorial (docs/tutorial) word for word in an empty folder and prints how long each step takes.

    scripts/tutorial.py FOLDER [--figures]    with the programs on PATH and the package on PYTHONPATH

Every scene, table and script is saved under the name above it, every other block is run by bash. Then the files that
the page names must exist. --figures copies those that the pages show to docs/figures/tutorial.

tested: tests/tutorial_test.py
"""
import argparse
import contextlib
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
FIGURES = ROOT / "docs/figures/tutorial"
STEPS = ("first_test", "liquefaction", "calibration", "deposit", "ensemble")
BLOCK = re.compile(r"(?:`([^`\n]+)`:\n\n)?^```(\w+)\n(.*?)^```", re.M | re.S)
FILE = re.compile(r"`([\w./-]+\.(?:csv|gif|html|png|py|toml))`")


def page(step):
    return (ROOT / f"docs/tutorial/{step}.md").read_text(encoding="utf-8")


def run(block, folder):
    """A block of commands; what it has left in the background is ended.   Raises RuntimeError with the output"""
    with tempfile.TemporaryFile("w+", encoding="utf-8") as output:  # a pipe would wait for what is in the background
        with subprocess.Popen(["bash", "-ec", block], cwd=folder, start_new_session=True, stdin=subprocess.DEVNULL,
                              stdout=output, stderr=subprocess.STDOUT) as shell:
            try:
                shell.wait()
            finally:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(shell.pid, signal.SIGKILL)
        if shell.returncode != 0:
            output.seek(0)
            raise RuntimeError(f"{block}returned {shell.returncode}:\n{output.read()}")


def follow(step, folder):
    """Does a page in the folder of the former ones.   Raises RuntimeError"""
    text = page(step)
    for name, language, block in BLOCK.findall(text):
        if language == "sh":
            run(block, folder)
        elif name:
            (folder / name).write_text(block, encoding="utf-8")
        else:
            raise RuntimeError(f"{step}: a block {language} has no name above it")
    missing = [name for name in FILE.findall(BLOCK.sub("", text)) if not (folder / name).is_file()]
    if missing:
        raise RuntimeError(f"{step}: it names {', '.join(missing)}, which the commands do not make")


def figures(step):
    """{file that the page shows: the result that it is a copy of}."""
    text = page(step)
    shown = re.findall(r"^!\[[^\]]+\]\(\.\./figures/tutorial/(\S+)\)$", text, re.M)
    return {FIGURES / name: next(file for file in FILE.findall(text) if file.endswith(f"/{name}")) for name in shown}


def main():
    line = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    line.add_argument("folder", type=pathlib.Path)
    line.add_argument("--figures", action="store_true", help="copy the figures of the pages to docs/figures/tutorial")
    options = line.parse_args()
    options.folder.mkdir(parents=True)
    for step in STEPS:
        begin, cpu = time.monotonic(), os.times()
        follow(step, options.folder)
        used = sum(os.times()[2:4]) - sum(cpu[2:4])
        print(f"{step:<14}{time.monotonic() - begin:5.0f} s, {used:5.0f} s of CPU", flush=True)
        for copy, result in figures(step).items() if options.figures else ():
            copy.parent.mkdir(exist_ok=True)
            shutil.copyfile(options.folder / result, copy)


if __name__ == "__main__":
    main()
