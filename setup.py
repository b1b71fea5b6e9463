# SPDX-License-Identifier: BSD-3-Clause
"""`pip install .`: CMake builds the compiled part of the Python package, in some minutes. Needs the packages of
scripts/setup.sh, no deal.II. With ISOSTAT_BUILD=<build tree> in the environment it takes that of a build tree instead,
and with CMAKE_ARGS further options of CMake.   tested: tests/python/wheel_test.py"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, find_packages, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


def build(folder):
    """Configures and builds the compiled part in this folder."""
    options = {"ISOSTAT_FEM": "OFF", "ISOSTAT_TESTS": "OFF", "ISOSTAT_BENCHMARKS": "OFF", "ISOSTAT_PYTHON": "ON",
               "Python_EXECUTABLE": sys.executable}
    subprocess.run(["cmake", "--preset", "release", "-S", ROOT, "-B", folder,
                    *(f"-D{key}={value}" for key, value in options.items()),
                    *os.environ.get("CMAKE_ARGS", "").split()], check=True)
    subprocess.run(["cmake", "--build", folder, "--target", "python_core"], check=True)


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        given = os.environ.get("ISOSTAT_BUILD")
        folder = pathlib.Path(given or pathlib.Path(self.build_temp) / "cmake").resolve()
        if not given:
            build(folder)
        found = list((folder / "python/isostat").glob("_core*.so"))
        if len(found) != 1:
            sys.exit(f"{folder}: holds no compiled part of the package. Configure it with -DISOSTAT_PYTHON=ON and build "
                     "it, or leave ISOSTAT_BUILD unset.")
        target = pathlib.Path(self.get_ext_fullpath(ext.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(found[0], target)


def version():
    """That of the CMake project."""
    return re.search(r"project\(isostat VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]


setup(version=version(), package_dir={"isostat": "python/isostat", "isostat.figures": "apps/figures",
                                        "isostat.report": "apps/report"},
      packages=[*find_packages(ROOT / "python"), "isostat.figures", "isostat.report"],
      package_data={"isostat": ["py.typed", "*.pyi"]},
      ext_modules=[Extension("isostat._core", [])], cmdclass={"build_ext": CMakeBuild})
