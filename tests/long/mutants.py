#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Do the tests notice a wrong sign? Changes one operator or number at a time in what everything else rests on (contact
law, leapfrog, redundancy index, rate control, Biot's equations), builds and runs the tests of it, and lists the changes
that none of them notices.

    mutants.py BUILD [NUMBER] [--seed S] [--output TABLE]

BUILD is a configured build of its own: the sources that it was made from are changed, and changed back. Less than half
the time than a release build takes one of -O1 with one instruction set:
    cmake --preset release -B BUILD "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG \
-DHWY_DISABLED_TARGETS=HWY_SSSE3+HWY_SSE4+HWY_AVX3+HWY_AVX3_DL"
What TABLE holds is not tried again. A mutant whose test does not end costs a quarter of ISOSTAT_TIME_LIMIT (3600 s).
"""
import argparse
import collections
import csv
import os
import pathlib
import random
import re
import subprocess
import sys
import time

TIME_LIMIT = float(os.environ.get("ISOSTAT_TIME_LIMIT", "3600")) / 4  # s, as in tests/apps/support.py

# Sources, and tests that have to notice: those that take the least time come first.
PLACES = {
    "dem/contact/rolling_resistance.cpp": ("unit_contact", "unit_measure", "verification_energy_balance"),
    "dem/contact/rolling_resistance-inl.hpp": ("unit_contact", "verification_single_grains",
                                               "verification_convergence"),
    "dem/contact/linear_rolling/law.cpp": ("unit_contact", "verification_single_grains", "verification_energy_balance"),
    "dem/contact/dashpot.hpp": ("unit_contact", "verification_single_grains", "verification_critical_step"),
    "dem/motion/leapfrog.cpp": ("unit_motion", "verification_single_grains", "verification_convergence",
                                "verification_energy_balance", "verification_cell"),
    "dem/measure/redundancy.cpp": ("unit_measure", "verification_invariants"),
    "dem/drive/rate_control.cpp": ("unit_drive", "verification_programme", "verification_cell_programme"),
    "fem/water/biot_integrals.cpp": ("verification_consolidation", "verification_waves"),
    "fem/water/pressure_system.cpp": ("verification_consolidation", "verification_waves"),
    "fem/water/pore_fluid.cpp": ("unit_fem_input", "verification_consolidation"),
}

SWAPS = [(r" < ", " > "), (r" > ", " < "), (r" <= ", " > "), (r" >= ", " < "), (r" == ", " != "), (r" && ", " || "),
         (r" \|\| ", " && "), (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "), (r" \+= ", " -= "),
         (r" -= ", " += "), (r"\(-(?=\w)", "("), (r"\bmin\(", "max("), (r"\bmax\(", "min("), (r"\b0\.5\b", "0.25"),
         (r"\b2 \*", "3 *"), (r"\btrue\b", "false"), (r"\bfalse\b", "true")]

Mutant = collections.namedtuple("Mutant", "path line before after text")


def code_of(line):
    """Without comments, texts, and what is no computation."""
    if re.match(r"\s*(#|//|template|using|static_assert|namespace)", line):
        return ""
    return re.sub(r'"[^"]*"', lambda text: " " * len(text[0]), line.split("//")[0])


def mutants_of(root, path):
    for number, line in enumerate((root / path).read_text(encoding="utf-8").splitlines(), 1):
        code = code_of(line)
        for pattern, other in SWAPS:
            for found in re.finditer(pattern, code):
                yield Mutant(path, number, line, line[:found.start()] + other + line[found.end():], found[0].strip())


class Builds:
    def __init__(self, folder):
        self.folder = folder
        cache = (folder / "CMakeCache.txt").read_text(encoding="utf-8")
        self.root = pathlib.Path(re.search(r"CMAKE_HOME_DIRECTORY:INTERNAL=(.*)", cache)[1])

    def build(self, tests):
        return subprocess.run(["ninja", "-C", str(self.folder), *tests], capture_output=True, text=True, check=False)

    def failed_test(self, tests):
        """The first that fails, or none."""
        for name in tests:
            try:
                run = subprocess.run([str(self.folder / "bin" / name), "--gtest_brief=1", "--gtest_fail_fast"],
                                     capture_output=True, text=True, timeout=TIME_LIMIT, check=False)
            except subprocess.TimeoutExpired:
                return name + " (does not end)"
            if run.returncode != 0:
                found = re.search(r"\[  FAILED  \] (\S+?)[,. ]", run.stdout + " ")
                return f"{name}: {found[1] if found else 'crash'}"
        return None

    def verdict(self, mutant):
        source = self.root / mutant.path
        whole = source.read_text(encoding="utf-8")
        lines = whole.splitlines(keepends=True)
        lines[mutant.line - 1] = mutant.after + "\n"
        source.write_text("".join(lines), encoding="utf-8")
        try:
            if self.build(PLACES[mutant.path]).returncode != 0:
                return "does not compile"
            return self.failed_test(PLACES[mutant.path]) or "SURVIVES"
        finally:
            source.write_text(whole, encoding="utf-8")


def verdicts_of(table):
    if not table.exists():
        return {}
    with open(table, encoding="utf-8", newline="") as file:
        return {(row["file"], row["line"], row["code"]): row["noticed by"] for row in csv.DictReader(file)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("number", type=int, nargs="?", default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("mutants.csv"))
    options = parser.parse_args()
    builds = Builds(options.build.resolve())
    everything = sorted({test for tests in PLACES.values() for test in tests})
    built = builds.build(everything)
    if built.returncode != 0 or builds.failed_test(everything):
        sys.exit("the tests do not pass to begin with\n" + built.stdout[-2000:])
    everyone = [mutant for path in PLACES for mutant in mutants_of(builds.root, path)]
    chosen = random.Random(options.seed).sample(everyone, min(options.number, len(everyone)))
    known = verdicts_of(options.output)
    counts, begin = collections.Counter(), time.monotonic()
    with open(options.output, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(("file", "line", "changed", "code", "noticed by"))
        for k, mutant in enumerate(chosen, 1):
            verdict = known.get((mutant.path, str(mutant.line), mutant.after.strip())) or builds.verdict(mutant)
            counts[verdict if verdict in ("SURVIVES", "does not compile") else "noticed"] += 1
            table.writerow((mutant.path, mutant.line, mutant.text, mutant.after.strip(), verdict))
            file.flush()
            print(f"{k} of {len(chosen)}, {time.monotonic() - begin:.0f} s, {dict(counts)}: "
                  f"{mutant.path}:{mutant.line} {mutant.text} -> {verdict}", flush=True)
    builds.build(everything)


if __name__ == "__main__":
    main()
