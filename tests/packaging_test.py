#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Recipes of packages against the build: each names what CMake looks for, and asks for nothing that is not there."""
import ast
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[1]
PACKAGING = ROOT / "packaging"
# what CMake looks for in base, dem, fem, coupling, apps: names in Spack and conda-forge (none: not part of that recipe)
NAMES = {
    "Boost": ("boost", "libboost-headers"), "CLI11": ("cli11", "cli11"), "deal.II": ("dealii", None),
    "Eigen3": ("eigen", "eigen"), "fmt": ("fmt", "fmt"), "HDF5": ("hdf5", "hdf5"), "HWY": ("highway", "libhwy"),
    "MPI": ("openmpi", "openmpi"), "nlohmann_json": ("nlohmann-json", "nlohmann_json"),
    "OMPI": ("openmpi", "openmpi"), "PETSC": ("petsc", None), "PUGIXML": ("pugixml", "pugixml"),
    "ZLIB": ("zlib-api", "zlib"),
}
OF_THE_COMPILER = {"PkgConfig", "Threads"}
NO_CMAKE_FILE = {"random123": "random123", "tomlplusplus": "tomlplusplus"}  # headers that are found without CMake


def looked_for():
    names = set()
    for folder in ("base", "dem", "fem", "coupling", "apps"):
        text = (ROOT / folder / "CMakeLists.txt").read_text(encoding="utf-8")
        names |= set(re.findall(r"(?:find_package|pkg_check_modules)\((\S+)", text))
    return names - OF_THE_COMPILER


class Recipes(unittest.TestCase):
    def test_every_library_has_its_name_in_the_recipes(self):
        self.assertEqual(looked_for(), set(NAMES))

    def test_spack(self):
        tree = ast.parse((PACKAGING / "spack/package.py").read_text(encoding="utf-8"))
        calls = [node for node in ast.walk(tree)
                 if isinstance(node, ast.Call) and ast.unparse(node.func) == "depends_on"]
        found = {re.match(r"[\w-]+", call.args[0].value)[0] for call in calls if isinstance(call.args[0], ast.Constant)}
        self.assertLessEqual({spack for spack, _ in NAMES.values()} | set(NO_CMAKE_FILE), found)

    def test_conda(self):
        text = (PACKAGING / "conda/meta.yaml").read_text(encoding="utf-8")
        host = re.search(r"\n  host:\n((?:    - .*\n)+)", text)[1]
        found = set(re.findall(r'- "?([\w-]+)', host))
        self.assertLessEqual({conda for _, conda in NAMES.values() if conda} | set(NO_CMAKE_FILE.values()), found)
        cmake = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
        version = re.search(r"project\(isostat VERSION ([0-9.]+)", cmake)
        self.assertIn(f'version: "{version[1]}"', text)
        try:
            import yaml
        except ImportError:
            return
        recipe = yaml.safe_load(text)
        self.assertIn("-DISOSTAT_FEM=OFF", " ".join(recipe["build"]["script"]))

    def test_options_are_those_of_cmake(self):
        cmake = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
        for name in ("Containerfile", "spack/package.py", "conda/meta.yaml"):
            for option in set(re.findall(r"ISOSTAT_[A-Z]+", (PACKAGING / name).read_text(encoding="utf-8"))):
                self.assertIn(f"option({option} ", cmake, name)

    def test_container_builds_as_the_scripts_do(self):
        text = (PACKAGING / "Containerfile").read_text(encoding="utf-8")
        for part in ("FROM debian:12", "scripts/setup.sh", "cmake --preset release", "cmake --install"):
            self.assertIn(part, text)
        for python in ("python3-numpy", "python3-matplotlib", "python3-h5py", "python3-scipy", "python3-nlopt"):
            self.assertIn(python, text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
