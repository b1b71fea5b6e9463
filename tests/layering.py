#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The ctest `layering`: who may include whom, that no includes run in a circle, what an executable may load.

    layering.py [--root REPOSITORY] [EXECUTABLE or LIBRARY ...]

Dependencies run one way: python -> apps -> coupling -> {fem, dem} -> base. Inside dem they follow the time step. Prints
every violation as file:line and returns 1 if there is one. Executables, shared libraries and static libraries given as
arguments must not need deal.II or PETSc.
"""
import argparse
import pathlib
import re
import subprocess
import sys

CODE = {".cpp", ".hpp", ".h", ".cc"}

# Top folder -> top folders it may include; base is what all share. Tests and benchmarks may look everywhere.
TOP = {
    "base": {"base"},
    "dem": {"dem", "base"},
    "fem": {"fem", "base"},
    "coupling": {"coupling", "fem", "dem", "base"},
    "apps": {"apps", "coupling", "fem", "dem", "base"},
    "python": {"python", "apps", "coupling", "fem", "dem", "base"},
}

# Library -> its parts, each with the parts it may include besides itself. A part is a folder or a file (without ending)
# below the library; a file belongs to the longest name that fits.
BY_NAME = {"law", "law/parameters"}
GRAINS = {"law", "domain", "state"}
STEP = GRAINS | {"contact", "neighbours", "motion", "measure", "assembly"}
INNER = {
    "base": {
        "error": set(),
        "types": set(),
        "stopwatch": set(),
        "tell": set(),
        "fields": set(),
        "units": {"error"},
        "files": {"error", "types", "fields", "tell"},
        "record": {"error", "files", "stopwatch", "tell"},
        "threads": set(),
        "scene": {"error", "units"},
    },
    "dem": {
        "domain": set(),
        "law": set(),  # what a contact remembers; the interface of laws
        "law/parameters": {"law"},
        "state": {"law", "domain"},
        "contact": GRAINS,
        "contact/dashpot": set(),
        # what laws with resistance to rolling share: scalar form, keys, lanes
        "contact/rolling_resistance": {"law"},
        "contact/rolling_resistance_keys": BY_NAME | {"contact/rolling_resistance"},
        "contact/rolling_resistance-inl": {"law", "contact", "contact/rolling_resistance"},
        "contact/laws": {"law"},  # and every law: with_laws
        "neighbours": GRAINS,
        "motion": GRAINS | {"contact/dashpot"},
        "measure": GRAINS,
        "assembly": GRAINS | {"contact", "neighbours", "motion", "measure"},
        "static": STEP,
        "drive": STEP | {"static"},
        "scene": BY_NAME | {"drive"},
        "io": BY_NAME | GRAINS | {"measure", "drive"},
        "prepare": STEP | BY_NAME | {"scene", "io", "drive"},
        "rve": STEP | BY_NAME | {"scene", "io", "drive", "static"},
    },
    "fem": {
        "material": set(),
        "motion": set(),
        "libraries": set(),
        "linear": set(),
        "ranks": set(),
        "space": {"material", "linear"},
        "water": {"material", "linear", "space"},
        "solve": {"material", "motion", "linear", "ranks", "space", "water"},
    },
    "coupling": {
        "placement": set(),
        "element": set(),
        "in_situ": set(),
        "batch": {"element", "in_situ", "placement"},
        "scene": {"batch", "in_situ"},
    },
    "apps": {
        "common": set(),
        "deposit": {"common"},
        "element_test": {"common"},
        "micromechanics": {"common"},
        "void_ratio_limits": {"common"},
        "soil_column": {"common", "deposit"},
        "rve_replay": {"common", "deposit"},
    },
    "python": {"binding": set()},
}

# Any folder below dem/contact is a law, which knows the interface, the loop that runs it and no other law.
A_LAW = BY_NAME | GRAINS | {"contact"} | {f"contact/rolling_resistance{part}" for part in ("", "_keys", "-inl")}

# What coupling sees of dem: the RVE; scene has the keys of its motion, io stores and reads its state.
COUPLING_SEES = {"rve", "scene", "io"}

# External headers that a folder must not see, with the reason.
DEALII = re.compile(r"^deal\.II/")
PETSC = re.compile(r"^petsc", re.I)
MPI = re.compile(r"^(mpi|omp[il]_mpi)\.h$")
FOREIGN = [
    (("dem", "coupling", "fem/material", "fem/motion"), (DEALII, PETSC), "no deal.II and no PETSc here"),
    (("dem", "fem/material", "fem/motion"), (MPI,), "no MPI call here"),
    (("fem/water", "fem/solve"), (DEALII,), "deal.II ends at fem/space/tables.hpp and fem/linear/vector.hpp"),
    (("fem/space", "apps"), (PETSC,), "PETSc is seen by the two linear systems alone"),
]
HDF5 = re.compile(r"^(hdf5|H5\w*|hdf5_hl)\.(h|hpp)$")
HDF5_HOME = {f"base/files/hdf5_{part}" for part in ("file.cpp", "group.cpp", "handles.hpp")} | {
    "tests/fuzz/damaged_hdf5.cpp"}  # writes what base/files never would

FORBIDDEN_LIBRARIES = ("libdeal", "libpetsc")
FORBIDDEN_SYMBOLS = ("dealii::", "PetscInitialize", "MatCreate", "VecCreate", "KSPCreate")

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def with_laws(root):
    """Enters the existing contact laws in the table of dem."""
    laws = {f"contact/{folder.name}" for folder in (root / "dem/contact").glob("*/")}
    INNER["dem"].update({law: A_LAW for law in laws})
    INNER["dem"]["contact/laws"] |= laws


def by_folder(parts):
    """The table of a library's parts as one of its folders: two that use each other are one, whatever their files."""
    folders = {}
    for part, used in parts.items():
        folder = part.split("/")[0]
        folders.setdefault(folder, set()).update({other.split("/")[0] for other in used} - {folder})
    return folders


def part_of(path):
    """The part in INNER that a path inside the repository belongs to, or None if the table has none."""
    top, _, inner = path.partition("/")
    stem = inner.rsplit(".", 1)[0]
    fits = [part for part in INNER.get(top, {}) if stem == part or inner.startswith(part + "/")]
    return max(fits, key=len, default=None)


def resolved(root, file, quoted, target):
    """Path of an included file relative to the root, or None for a header from outside."""
    candidates = [root / target] + ([file.parent / target] if quoted else [])
    for candidate in candidates:
        if candidate.is_file():
            path = candidate.resolve()
            return path.relative_to(root).as_posix() if path.is_relative_to(root) else None
    # Not there (yet), but it names one of our folders: judge it by its name.
    return target if target.split("/")[0] in TOP else None


def inner_violation(source, target):
    """Why a file of ours must not include another one, or None."""
    top, target_top = source.split("/")[0], target.split("/")[0]
    if top not in TOP or target_top not in TOP:
        return None
    if target_top not in TOP[top]:
        return f"{top} must not include {target_top}/"
    own, part = part_of(source), part_of(target)
    if part is None:
        return f"{target} is in no part of {target_top}; add it to the table in tests/layering.py"
    if top == "coupling" and target_top == "dem" and part not in COUPLING_SEES:
        return f"coupling sees of dem {', '.join(sorted(COUPLING_SEES))} alone"
    if top == target_top and own is not None and part != own and part not in INNER[top][own]:
        return f"{top}/{own} must not include {top}/{part}"
    return None


def foreign_violation(source, target):
    """Why a file of ours must not include a header from outside, or None."""
    for folders, patterns, reason in FOREIGN:
        if any(source.startswith(folder + "/") for folder in folders) and any(p.search(target) for p in patterns):
            return reason
    return None


def check_file(root, file, includes):
    source = file.relative_to(root).as_posix()
    top = source.split("/")[0]
    text = file.read_text(encoding="utf-8", errors="replace").splitlines()
    problems = []
    if top in INNER and part_of(source) is None:
        problems.append(f"{source}: in no part of {top}; add it to the table in tests/layering.py")
    for number, line in enumerate(text, 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        target = match.group(2)
        inner = resolved(root, file, match.group(1) == '"', target)
        if inner:
            why = "give the path from the repository's top" if ".." in target else inner_violation(source, inner)
            includes.setdefault(source, []).append(inner)
        elif HDF5.match(target) and source not in HDF5_HOME:
            why = f"only {', '.join(sorted(HDF5_HOME))} see the HDF5 headers"
        else:
            why = foreign_violation(source, target)
        if why:
            problems.append(f"{source}:{number}: {line.strip()}: {why}")
    return problems


def circles(graph):
    """Every way along the arrows of a graph {node: nodes} that comes back to where it began, once."""
    found, done, path = [], set(), []

    def follow(node):
        if node in path:
            found.append(path[path.index(node):] + [node])
        elif node not in done:
            path.append(node)
            for target in graph.get(node, ()):
                follow(target)
            done.add(path.pop())

    for node in graph:
        follow(node)
    return found


def check_sources(root):
    files = [f for top in (*TOP, "tests", "benchmarks") for f in sorted((root / top).rglob("*")) if f.suffix in CODE]
    if not any(f.relative_to(root).parts[0] == "dem" for f in files):
        return [], [f"{root}: no code below dem/; is this the repository?"]
    with_laws(root)
    includes = {}
    problems = [problem for f in files for problem in check_file(root, f, includes)]
    problems += [f"includes in a circle: {' -> '.join(circle)}" for circle in circles(includes)]
    for top, parts in INNER.items():
        found = circles(parts) + circles(by_folder(parts))
        problems += [f"the table of {top} runs in a circle: {' -> '.join(circle)}" for circle in found]
    return files, problems


def output_of(*command):
    run = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    return run.returncode, run.stdout + run.stderr


def check_binary(binary):
    path = pathlib.Path(binary)
    if not path.is_file():
        return [f"{binary}: no such file"]
    if path.suffix == ".a":
        code, text = output_of("nm", "-uC", str(path))
        found = sorted({s for s in FORBIDDEN_SYMBOLS for line in text.splitlines() if s in line})
        what = "needs symbols"
    else:
        code, text = output_of("ldd", str(path))
        names = (line.split()[0] for line in text.splitlines() if line.split())
        found = sorted(n for n in names if pathlib.Path(n).name.startswith(FORBIDDEN_LIBRARIES))
        what = "loads"
        if "not a dynamic executable" in text or "statically linked" in text:
            return []
    if code != 0:
        return [f"{binary}: cannot be examined: {text.strip()}"]
    why = "dem and the element tests link neither deal.II nor PETSc"
    return [f"{binary}: {what} {', '.join(found)}; {why}"] if found else []


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("binaries", nargs="*", help="must load neither deal.II nor PETSc")
    arguments = parser.parse_args()

    files, problems = check_sources(arguments.root.resolve())
    for binary in arguments.binaries:
        problems += check_binary(binary)
    for problem in problems:
        print(problem)
    print(f"layering: {len(files)} files, {len(arguments.binaries)} binaries, {len(problems)} violations")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
