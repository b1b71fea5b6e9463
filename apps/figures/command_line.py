# SPDX-License-Identifier: BSD-3-Clause
"""Command lines that refuse a mistake as the programs in C++ do: what it is, and what was perhaps meant. Needs nothing
but Python.   tested: tests/apps/command_line_test.py"""
import argparse
import difflib
import sys


def meant(word, known, otherwise=""):
    """"Did you mean damping?", or the other text where nothing is alike."""
    near = difflib.get_close_matches(word, known, 1)
    return f"Did you mean {near[0]}?" if near else otherwise


class CommandLine(argparse.ArgumentParser):
    """Names an unknown option before it asks for what is missing."""

    def parse_args(self, args=None, namespace=None):
        words = sys.argv[1:] if args is None else [str(word) for word in args]
        for word in words[:words.index("--")] if "--" in words else words:
            option, known = word.partition("=")[0], self._option_string_actions
            if option.startswith("--") and " " not in word and not any(name.startswith(option) for name in known):
                self.error(" ".join(filter(None, (f"{option}: unknown option.", meant(option, known)))))
        return super().parse_args(words, namespace)

    def error(self, message):
        """One line, without the usage."""
        print(f"error: {message}\nRun {self.prog} --help for more information.", file=sys.stderr)
        sys.exit(2)
