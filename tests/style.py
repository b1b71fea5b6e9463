#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The ctest `style`: how long files, functions and lines may be, where a header is tested, why a tolerance is so large;
and phrases that a reader stumbles over, in pages, scenes, messages, comments and names of tests.

    style.py [--root REPOSITORY] [--table]

Prints every violation as file:line and returns 1 if there is one; `--table` prints the files' lengths by folder, too.
"""
import argparse
import ast
import io
import pathlib
import re
import statistics
import sys
import tokenize

MAX_FILE = 400  # lines
MAX_FUNCTION = 60  # lines: one screen
MAX_LINE = 120  # columns; the tables between `clang-format off` and `on` have wider rows
LIBRARIES = ("base", "dem", "fem", "coupling", "apps/common", "apps/deposit")
MIRRORS = {("tests", top) for top in ("base", "dem", "fem", "coupling")}
LICENCE = "SPDX-License-Identifier: BSD-3-Clause"

# A comparison with a tolerance that does not say why, as the helpers of tests/support/near.hpp and support.py do.
SMALL = r"(?:\d(?:\.\d+)?e-\d|(?<![\w.])0?\.\d)"  # a number below one
BARE = {
    ".cpp": re.compile(rf"\b(?:EXPECT|ASSERT)_(?:NEAR|FLOAT_EQ)\(|\bDoubleNear\(|\b(?:EXPECT|ASSERT)_L[TE]\(.*{SMALL}"),
    ".py": re.compile(rf"assertAlmostEqual|\ballclose\(|assert_allclose|\bisclose\(|assertLess(?:Equal)?\(.*{SMALL}"),
}
# Phrases that are not written, and what to write. Names of keys and files are in `code marks`, or a string of one word.
PHRASES = {
    r"anew": "again", r"as good as none": "treated as missing", r"at any price": "(say what happens)",
    r"(?<!-)beside(?!s)": "next to, with, in addition to, besides", r"but for": "except for", r"dear(er)?": "expensive",
    r"for ever": "forever", r"for want of": "because ... is missing", r"free grains?": "rattler",
    r"go(es)? home": "stop", r"go(es)? on|went on": "continue", r"goes without": "is missing",
    r"hang(s|ing)? on": "depend on", r"(has|have) not (a|an|any|its|no|the)": "does not have",
    r"(in|by) turns": "alternately, interleaved", r"(is|are) not there": "does not exist, is missing",
    r"(is|are) to be": "(say who does it)", r"is no key of": "unknown key", r"is said": "(say who says it)",
    r"it takes (fewer|more)": "it needs", r"key twice": "repeated key", r"let go|is lost to": "discarded",
    r"looked at": "checked, inspected, used",
    r"lots?(?! =)": "draw, at random", r"no part in": "is ignored, leaves out", r"nobody|somebody|whoever": "(name it)",
    r"nor none": "or none", r"of no (effect|meaning|use)": "ignored, no effect", r"on its way": "(say to what)",
    r"one's own": "your own, a user's", r"says? all about": "describes", r"so many": "this many", r"so-called": "",
    r"(that|which) (is|are) there": "existing",
    r"(stands?|stood)(?! for\b| in\b|-alone| alone| still)": "is, appears", r"strangers?": "untrusted, a user's",
    r"tells?|told": "says, reports, distinguishes", r"to the bit": "bit for bit",
    r"velocit(y|ies) of (P|S|shear) waves?": "V_s, shear-wave velocity", r"warned of": "a warning names",
    r"what (came|comes) out": "results", r"what is left": "what remains",
    r"who watches": "the observer", r"works as": "is",
}
OVERUSED = re.compile(r"\bof (?:its|their) own\b", re.I)  # at most once in a file
STUMBLE = re.compile(r"\b(?:" + "|".join(PHRASES).replace(" ", r"(?:[ \t]+|[ \t]*\n[ \t]*)") + r")\b", re.I)
TEXTS = {".cpp", ".hpp", ".c", ".h", ".py", ".md", ".toml", ".sh"}  # files whose English is checked
# What of C++ is text for a reader: comments and strings.
CPP_TEXT = re.compile(r"//[^\n]*|/\*.*?\*/|R\"\(.*?\)\"|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'", re.S)
# No text: strings of one word; then code marks, targets of links, and marks that begin or join lines of a comment.
NO_TEXT = (re.compile(r"([\"'])[\w.@/-]*\1"),
           re.compile(r"`[^`\n]*`|\]\([^)\n]*\)|^\s*(?:///?<?|#+|\*|!)|\"\s*\n\s*f?\"", re.M))

TEST_NAME = re.compile(r"^TEST(?:_[FP])?\(\w+,\s*(\w+)\)|def test_(\w+)", re.M)
NEXT_WORD = re.compile(r"_|(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")  # in a name

HELPERS = {"tests/support/near.hpp", "tests/apps/support.py", "tests/style.py"}

# What opens a block of its own but is no function, and what names an existing test in a header's comment.
NO_FUNCTION = re.compile(r"(inline )?namespace\b|(template\s*<.*>\s*)?(class|struct|union|enum)\b|extern\b")
NAMED_TEST = re.compile(r"\btests/([\w/]*)(?:\{([\w,]+)\}(\w*))?\.(cpp|py)\b")


def indent(line):
    return len(line) - len(line.lstrip())


def cpp_functions(lines):
    """(line, length) of each function. A function's brace stands alone, as far in as its signature begins; that of a
    control block stands two further in (.clang-format)."""
    for at, line in enumerate(lines):
        if line.strip() != "{":
            continue
        depth, first = indent(line), at - 1
        while first >= 0 and (not lines[first].strip() or indent(lines[first]) > depth):
            first -= 1
        signature = lines[first].strip() if first >= 0 else ""
        if first < 0 or indent(lines[first]) != depth or NO_FUNCTION.match(signature) or signature[-1:] in ";}:{":
            continue
        last = next((k for k in range(at + 1, len(lines)) if lines[k].startswith(" " * depth + "}")), at)
        yield first + 1, last - first + 1


def python_functions(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef):
            yield node.lineno, node.end_lineno - node.lineno + 1


def statements(lines):
    """(line, text) with a call over several lines put into one, and without what stands in quotation marks."""
    lines = [re.sub(r'"[^"]*"', '""', line) for line in lines]
    at = 0
    while at < len(lines):
        first, text = at, lines[at]
        while text.count("(") > text.count(")") and at + 1 < len(lines) and at < first + 8:
            at += 1
            text += " " + lines[at].strip()
        yield first + 1, text
        at += 1


def named_tests(text):
    """Paths of the tests that a text names; tests/{a,b}_test.cpp are two."""
    return [f"tests/{head}{name}{tail}.{end}" for head, names, tail, end in NAMED_TEST.findall(text)
            for name in names.split(",")]


def check_named(root, name, lines):
    """Tests that a file names and that are not there."""
    return [f"{name}:{at}: names {test}, which is not there" for at, line in enumerate(lines, 1)
            for test in named_tests(line) if not (root / test).is_file()]


def check_tested(root, header, text):
    """Nothing, or why this header of a library is tested nowhere."""
    mirror = root / "tests" / header.parent / (header.stem + "_test")
    if any(mirror.with_suffix(end).is_file() for end in (".cpp", ".py")) or named_tests(text):
        return []
    return [f"{header}: no {mirror.relative_to(root)}.cpp, and no comment names the test that covers it"]


def wide_lines(lines):
    """Numbers of the lines that are too wide, but for tables that clang-format leaves alone."""
    is_table = False
    for at, line in enumerate(lines, 1):
        if "// clang-format o" in line:
            is_table = "// clang-format off" in line
        elif len(line) > MAX_LINE and not is_table:
            yield at


def check_mirrors(root, test):
    """Nothing, or why this test stands where no file of a library is that it could be the test of: stress_test.cpp and
    stress_paths_test.cpp may be those of stress.hpp, or of stress.cpp."""
    mirrored = root / pathlib.Path(*test.parts[1:]).parent
    stem = test.name.removesuffix("_test.cpp")
    sources = {f.stem for f in mirrored.glob("*.?pp")} if mirrored.is_dir() else set()
    if any(stem == s or stem.startswith(s + "_") or stem.endswith("_" + s) for s in sources):
        return []
    return [f"{test}: {mirrored.relative_to(root)} has no file of this name; "
            "what spans several belongs to tests/verification"]


def check_run(root, test):
    """Nothing, or that ctest does not know this file."""
    called = re.search(rf"\b{test.name.removesuffix('_test.py')}\b", (root / "tests/CMakeLists.txt").read_text())
    return [] if called else [f"{test}: is not in tests/CMakeLists.txt, so nothing runs it"]


def blank(text):
    return re.sub(r"[^\n]", " ", text)


def text_of_cpp(text):
    """Comments and strings, everything else blank; at the places they have in the file."""
    kept, at = [], 0
    for found in CPP_TEXT.finditer(text):
        kept += [blank(text[at:found.start()]), blank(found[0]) if found[0][0] == "'" else found[0]]
        at = found.end()
    return "".join(kept) + blank(text[at:])


def text_of_python(text):
    lines = text.split("\n")
    kept = [[" "] * len(line) for line in lines]
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type in (tokenize.STRING, tokenize.COMMENT) or tokenize.tok_name[token.type] == "FSTRING_MIDDLE":
            for row in range(token.start[0], token.end[0] + 1):
                first = token.start[1] if row == token.start[0] else 0
                last = token.end[1] if row == token.end[0] else len(lines[row - 1])
                kept[row - 1][first:last] = lines[row - 1][first:last]
    return "\n".join("".join(line) for line in kept)


def text_of_script(text):
    return "\n".join(" " * line.find("#") + line[line.find("#"):] if "#" in line else "" for line in text.split("\n"))


def check_phrases(root, path):
    """Phrases of this file that a reader stumbles over, each with its line and what to write."""
    name, suffix, text = path.relative_to(root), path.suffix, path.read_text(encoding="utf-8")
    tests = [NEXT_WORD.sub(" ", found[1] or found[2]) for found in TEST_NAME.finditer(text) if suffix in {".cpp", ".py"}]
    if suffix in {".cpp", ".hpp", ".c", ".h"}:
        text = text_of_cpp(text)
    elif suffix == ".py":
        text = text_of_python(text)
    elif suffix != ".md":
        text = text_of_script(text)
    for part in NO_TEXT:
        text = part.sub(lambda found: blank(found[0]), text)
    own = list(OVERUSED.finditer(text))
    problems = [f"{name}: '{own[0][0]}' {len(own)} times; write: separate, or its own X"] if len(own) > 1 else []
    for match in STUMBLE.finditer(text):
        words = " ".join(match[0].split())
        instead = next((write for phrase, write in PHRASES.items() if re.fullmatch(phrase, words, re.I)), "other words")
        problems.append(f"{name}:{text.count(chr(10), 0, match.start()) + 1}: '{words}'; write: {instead}")
    return problems + [f"{name}: a test named '{words}'; write: another word than those of PHRASES" for words in tests if STUMBLE.search(words)]


def check_file(root, path):
    name = path.relative_to(root)
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines()
    problems = [] if LICENCE in "".join(lines[:2]) else [f"{name}: does not start with {LICENCE}"]
    if len(lines) > MAX_FILE:
        problems.append(f"{name}: {len(lines)} lines, more than {MAX_FILE}")
    functions = python_functions(text) if path.suffix == ".py" else cpp_functions(lines)
    problems += [f"{name}:{at}: a function of {n} lines, more than {MAX_FUNCTION}"
                 for at, n in functions if n > MAX_FUNCTION]
    problems += [f"{name}:{at}: more than {MAX_LINE} columns" for at in wide_lines(lines)]
    problems += check_named(root, name, lines) if name.as_posix() not in HELPERS else []
    if path.suffix in {".hpp", ".h"} and name.as_posix().startswith(tuple(f"{library}/" for library in LIBRARIES)):
        problems += check_tested(root, name, text)
    if name.name.endswith("_test.cpp") and name.parts[:2] in MIRRORS:
        problems += check_mirrors(root, name)
    if name.parts[0] == "tests" and name.name.endswith("_test.py"):
        problems += check_run(root, name)
    if name.parts[0] == "tests" and name.as_posix() not in HELPERS:
        bare = BARE[".py" if path.suffix == ".py" else ".cpp"]
        problems += [f"{name}:{at}: a tolerance without its reason: {line.strip()[:80]}"
                     for at, line in statements(lines) if bare.search(line)]
    return problems, len(lines)


def print_table(lengths):
    """Number of files, median and largest length of each folder that holds code."""
    folders = {}
    for name, n in lengths.items():
        folders.setdefault(name.parent.as_posix(), []).append((n, name.name))
    print(f"{'folder':<40} files  median  largest")
    for folder, files in sorted(folders.items()):
        middle = statistics.median(n for n, _ in files)
        print(f"{folder:<40} {len(files):5} {middle:7.0f}  {max(files)[0]:4} {max(files)[1]}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--table", action="store_true", help="print files, median and largest length by folder")
    arguments = parser.parse_args()
    root = arguments.root.resolve()

    tops = ("base", "dem", "fem", "coupling", "apps", "tests", "benchmarks", "studies", "examples", "scripts")
    files = [f for top in tops for f in sorted((root / top).rglob("*")) if f.suffix in {".cpp", ".hpp", ".c", ".h", ".py"}]
    problems, lengths = [], {}
    for file in files:
        found, lengths[file.relative_to(root)] = check_file(root, file)
        problems += found
    texts = [*root.glob("*.md"), *(f for top in (*tops, "docs", "python") for f in sorted((root / top).rglob("*")))]
    for file in texts:
        if file.suffix in TEXTS and file.name != "CHANGELOG.md" and file != pathlib.Path(__file__).resolve():
            problems += check_phrases(root, file)
    for problem in problems:
        print(problem)
    if arguments.table:
        print_table(lengths)
    largest = max(lengths, key=lengths.get)
    print(f"style: {len(files)} files, median {statistics.median(lengths.values()):.0f} lines, largest {largest} with "
          f"{lengths[largest]}; {len(problems)} violations")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
