# SPDX-License-Identifier: BSD-3-Clause
"""Recipes of packages against the build: each names what CMake looks for, and asks for nothing that does not exist."""
import ast
import re
import subprocess
import tomllib
import unittest

from support import BIN, ROOT

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
        setup = (ROOT / "scripts/setup.sh").read_text(encoding="utf-8")
        debian = (PACKAGING / "CMakeLists.txt").read_text(encoding="utf-8")
        for name in ("numpy", "matplotlib", "h5py", "scipy", "nlopt", "mpi4py", "distributed"):
            for part in (text, setup, debian):
                self.assertIn(f"python3-{name}", part)

    def test_the_command_is_in_every_package(self):
        """And nothing is named that is not built."""
        project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
        self.assertEqual(project["project"]["scripts"], {"isostat": "isostat.__main__:main"})
        check = (PACKAGING / "check.sh").read_text(encoding="utf-8")
        named = re.search(r"for program in (.*); do", check)[1].split()
        built = re.findall(r"isostat_app\((\w+)", (ROOT / "apps/CMakeLists.txt").read_text(encoding="utf-8"))
        self.assertLessEqual(set(named), {*built, "isostat"})
        completed = re.search(r"complete -F _isostat ((?:.*\\\n)*.*)",
                              (PACKAGING / "completion.bash").read_text(encoding="utf-8"))[1].replace("\\", "").split()
        self.assertEqual(set(completed), {*built, "isostat"})

    def test_completion(self):
        """Of commands of isostat, and of the options of each."""
        for words, expected in ((("isostat", "lib"), "library"), (("isostat", "library", "--"), "--pressures"),
                                (("element_test", "--"), "--resume")):
            words = (str(BIN / words[0]), *words[1:])
            call = (f"source {PACKAGING / 'completion.bash'}; COMP_WORDS=({' '.join(words)}); "
                    f"COMP_CWORD={len(words) - 1}; _isostat {words[0]}; echo ${{COMPREPLY[@]}}")
            done = subprocess.run(["bash", "-c", call], capture_output=True, text=True, check=False)
            self.assertIn(expected, done.stdout.split(), done.stderr)
