# SPDX-License-Identifier: BSD-3-Clause
"""Isostat as a user has it who installed it: the programs find what they need next to themselves, and the examples are
built from outside by find_package(isostat) and show what their first lines say."""
import ctypes
import pathlib
import shutil
import subprocess
import tempfile

import numpy as np

import support

EXAMPLES = support.ROOT / "examples"


def run(*command, cwd=None):
    result = subprocess.run([str(word) for word in command], cwd=cwd, capture_output=True, text=True, check=False,
                            timeout=support.TIME_LIMIT)
    if result.returncode != 0:
        raise AssertionError(f"{command} returned {result.returncode}\n{result.stdout}{result.stderr}")
    return result.stdout


class Installed(support.ToleranceTest):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="isostat_installed_", dir=support.DISK))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.prefix, cls.work = cls.folder / "prefix", cls.folder / "work"
        cls.work.mkdir()
        run("cmake", "--install", support.BIN.parent, "--prefix", cls.prefix)
        cls.build = cls.folder / "build"
        run("cmake", "-S", EXAMPLES, "-B", cls.build, f"-DCMAKE_PREFIX_PATH={cls.prefix}",
            "-DCMAKE_C_FLAGS=-pedantic -Wall -Wextra -Werror", "-DCMAKE_Fortran_FLAGS=-std=f2018 -Wall -Wextra -Werror")
        run("cmake", "--build", cls.build)
        scene = support.tiny_scene(specimen='preparation_friction = "10 deg"\ndomain = "periodic-cell"', stages="\n")
        (cls.work / "cell.toml").write_text(scene, encoding="utf-8")
        run(cls.prefix / "bin/element_test", "cell.toml", "--quiet", "--no-figures", cwd=cls.work)
        (cls.specimen,) = (cls.work / "results/specimens").glob("*.h5")

    def element_test(self, *arguments):
        return run(self.prefix / "bin/element_test", *arguments, cwd=self.work)

    def test_figures_are_those_of_the_installation(self):
        (self.work / "tiny.toml").write_text(support.tiny_scene(), encoding="utf-8")
        output = self.element_test("tiny.toml", "--quiet")
        self.assertIn("figures in", output)
        self.assertTrue((self.work / "results/tiny/figures/fig_stress_path.png").is_file())
        self.assertIn("The Isostat authors", (self.work / "results/tiny/report.html").read_text(encoding="utf-8"))
        run(self.prefix / "bin/isostat", "compare", "results/tiny", "results/tiny", cwd=self.work)
        figures = self.prefix / "share/isostat/figures"
        figures.rename(figures.with_name("elsewhere"))
        self.addCleanup(figures.with_name("elsewhere").rename, figures)
        self.assertIn("figures were not drawn", self.element_test("tiny.toml", "--quiet", "--overwrite"))

    def test_scenes_are_found_by_their_names(self):
        scene = self.element_test("quick_cyclic_liquefies.toml", "--validate")
        self.assertIn('folder = "results/quick_cyclic_liquefies"', scene)

    def test_the_python_package_is_installed_with_its_figures(self):
        if not (support.BIN.parent / "python").is_dir():
            self.skipTest("built without -DISOSTAT_PYTHON=ON")
        (packages,) = self.prefix.glob("lib/python3*/dist-packages")
        program = (f"import sys; sys.path.insert(0, {str(packages)!r}); import isostat, isostat.figures.element_test; "
                   f"print(isostat.Scene(specimen={{'preparation_friction': '9 deg'}}, title='installed'))")
        self.assertIn('title = "installed"', run("/usr/bin/python3", "-c", program, cwd=self.work))

    def rows(self, example, *arguments):
        """The table that an example prints, without its head."""
        lines = run(self.build / example, *arguments, cwd=self.work).splitlines()[1:]
        return np.array([[float(word) for word in line.split()] for line in lines])

    def test_rve_path(self):
        gamma_xy, gamma_zy, tau_xy, tau_zy, p, e = self.rows("rve_path").T
        self.assert_near(p[0], 200, 4, "compacted to within 1 %, and at rest")
        self.assert_below(p[-1], 0.95 * p[0], "sheared round a closed path at constant volume, p' falls")
        self.assertGreater(np.ptp(tau_xy), 5)
        self.assertGreater(np.ptp(tau_zy), 5)
        self.assert_near([gamma_xy[-1], gamma_zy[-1]], [0, 0], 1e-4, "closes: the digits that are printed")
        self.assert_near(e, e[0], 1e-4, "constant volume, to second order in strains of 0.1 %")

    def test_rve_in_c_and_fortran_is_that_in_cpp_bit_for_bit(self):
        expected = self.rows("rve_in_cpp", self.specimen)
        sigma, tau, e = expected[:, 1:4], expected[:, 4], expected[:, 5]
        self.assertEqual(len(expected), 12)
        self.assertGreater(tau[10], 10e3)
        self.assert_close(e[:11], e[0], 1e-12, "closed pores: round-off")
        self.assert_close(sigma[11], sigma[10], 2e-3, "pores are open: stresses stay within the tolerance of the servo")
        self.assertNotEqual(e[11], e[10])
        self.assertEqual(self.rows("rve_in_c", self.specimen).tolist(), expected.tolist())
        if shutil.which("gfortran") is None:
            self.skipTest("no Fortran compiler")
        self.assertEqual(self.rows("rve_in_fortran", self.specimen).tolist(), expected.tolist())

    def test_programs_in_c_and_fortran_say_what_is_wrong(self):
        for program in ("rve_in_c", "rve_in_fortran"):
            if not (self.build / program).exists() and shutil.which("gfortran") is None:
                continue
            with self.assertRaisesRegex(AssertionError, "returned 1\n(?s:.*)isostat_rve_create: .*nowhere.h5"):
                run(self.build / program, "nowhere.h5", cwd=self.work)

    def test_laws_are_libraries(self):
        """What they compute: tests/fem/material/umat_test.cpp, tests/python/umat_test.py."""
        laws = [self.build / "elastic.so", *self.build.glob("drucker_prager.so")]
        if (support.BIN.parent / "python").is_dir():
            laws.append(self.prefix / "lib/libisostat_umat.so")
        for law in laws:
            self.assertTrue(ctypes.CDLL(str(law)).umat_)

    def test_element_test_in_code(self):
        axial, p, q, e = self.rows("element_test_in_code").T
        self.assert_near(axial[-1], 2, 0.05, "rows come each 0.1 %")
        self.assert_near(p - q / 3, 100, 5, "the lateral stress, which a servo keeps")
        self.assertGreater(q[-1], p[-1])
        self.assertLess(e.min(), e[0])
        self.assertGreater(e[-1], e.min())

    def test_grains_do_without_deal_ii(self):
        build = self.folder / "without"
        run("cmake", "-S", EXAMPLES, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}",
            "-DCMAKE_DISABLE_FIND_PACKAGE_deal.II=ON")
        targets = run("cmake", "--build", build, "--target", "help")
        self.assertIn("rve_path", targets)
        self.assertNotIn("own_material", targets)

    def test_own_material(self):
        if not (self.prefix / "include/isostat/fem").exists():
            self.skipTest("the build has no continuum half")
        output = run(self.build / "own_material", cwd=self.work)
        ratio = float(output.split()[-1])
        self.assertGreater(abs(ratio / 5 - 1), 0.01, output)  # a linear material gives 5 to round-off
