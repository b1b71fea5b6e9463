# SPDX-License-Identifier: BSD-3-Clause
"""isostat library on a few grains: what it makes, continues with, and refuses; a test from an entry."""
import re
import signal

import h5py

from support import AppTest, contents, tiny_scene, wait_until

# a narrow grading, so that so few grains fill a cell wider than two of the largest
CELL = 'domain = "periodic-cell"\npressure = "50 kPa"\n'
SCENE = tiny_scene(specimen=CELL + 'preparation_friction = "10 deg"', stages="# none")
NARROW = ("--set", "grading.truncate=[20, 80]", "--set", "grading.grains=150", "--set", "grading.cloud_edge=2.45 mm")
STAGE = '[[stage]]\nkind = "undrained-monotonic"\nstrain = 0.02\nmax_steps = 200\n'


class Library(AppTest):
    def make(self, *arguments):
        scene = self.folder / "rve.toml"
        if not scene.exists():
            scene.write_text(SCENE, encoding="utf-8")
        return self.run_app("isostat", "library", scene, *NARROW, *arguments)

    def make_many(self):
        scene = self.write("rve.toml", SCENE)
        return self.command("isostat", "library", scene, *NARROW, "-n", "40", "-j", "1", "-o", "library.h5", "-q")

    def entries(self, name="library.h5"):
        """Numbers and provenance of every entry, and the bytes of its positions."""
        with h5py.File(self.folder / name) as file:
            self.assertEqual(file.attrs["format"], "isostat-specimen-library")
            return {entry: (dict(group["numbers"].attrs), dict(group["provenance"].attrs),
                            group["snapshot/grains/position"][()].tobytes()) for entry, group in file.items()}

    def test_a_warning_names_densities_far_from_their_limits(self):
        result = self.make("-o", "loose.h5", "-q", "--set", "specimen.e_min=0.2", "--set", "specimen.e_max=0.3",
                           "--set", "contact.friction=5 deg")
        self.assert_done(result)
        self.assertIn("warning: seed 1, isotropic 50 kPa, prepared at 10 deg: the packing is prepared with",
                      result.stderr)
        self.assertRegex(result.stderr, r"warning: s0001: D_r = -\d\.\d+: far looser than e_max\. Do e_min and e_max")

    def test_a_warning_names_unknown_limits_whether_cached_or_not(self):
        for use in ((), ("--overwrite",)):
            result = self.make("-o", "other.h5", *use, "--set", "grading.solid_fraction=0.25",
                               "--set", 'grading.table=[["0.3 mm", 0], ["0.4 mm", 100]]')
            self.assert_done(result)
            self.assertEqual("taken from" in result.stderr, bool(use), result.stderr)
            self.assertIn("warning: seed 1, isotropic 50 kPa, prepared at 10 deg: D_r is unknown", result.stderr)

    def test_make_append_list(self):
        two = ("-n", "2", "-o", "library.h5", "--jobs", "2")
        result = self.make(*two)
        self.assert_done(result)
        self.assertIn("100 %  2 of 2 specimens", result.stderr)
        self.assertFalse((self.folder / "library_preparation").exists())
        first = self.entries()
        self.assertEqual(sorted(first), ["s0001", "s0002"])
        for seed, entry in enumerate(sorted(first), 1):
            numbers, provenance, _ = first[entry]
            self.assertEqual((numbers["seed"], numbers["grains"]), (seed, 150))
            self.assert_close(numbers["pressure_Pa"], 50e3, 0.01,
                              "the servo stops within 0.3 % in each direction")
            self.assert_near(numbers["K0"], 1, 0.02, "a quotient of stresses, each within 0.3 %")
            self.assertEqual(provenance["consolidation"], "isotropic")
            self.assertIn("truncate", provenance["recipe"])
        listed = self.run_app("isostat", "library", "--list", "--output", "library.h5")
        self.assert_done(listed)
        self.assertEqual(listed.stdout, result.stdout)
        for word in ("s0002", "K0", "D_r", "I_R"):
            self.assertIn(word, listed.stdout)

        self.assert_refused(self.make(*two), "library.h5", "exists", "--append", "--overwrite")
        more = ("--append", "--consolidation", "k0", "--pressures", "50 kPa, 80kPa")
        self.assert_done(self.make(*two, *more))
        all_of_them = self.entries()
        self.assertEqual(sorted(all_of_them), [f"s000{k}" for k in range(1, 7)])
        self.assertEqual({name: all_of_them[name] for name in first}, first)
        for name, pressure in (("s0003", 50e3), ("s0004", 50e3), ("s0005", 80e3)):
            numbers, provenance, _ = all_of_them[name]
            self.assert_close(numbers["vertical_stress_Pa"], pressure, 0.02,
                              "the stage ends within its balance and comes to rest after it")
            self.assertTrue(0.2 < numbers["K0"] < 0.8, numbers["K0"])
            self.assertEqual(provenance["consolidation"], "k0")
        self.assert_done(self.make(*two, *more))  # nothing is missing
        self.assertEqual(self.entries(), all_of_them)

        result = self.make(*two, "--overwrite")  # from the cache, to the same bits
        self.assert_done(result)
        self.assertIn("2 taken from", result.stderr)
        self.assertNotIn("ready", result.stderr)
        self.assertEqual(self.entries(), first)

    def test_density_is_that_after_k0_consolidation(self):
        """Soft grains: most of the loss of void ratio comes after the search, which has to allow for it."""
        result = self.make("-o", "soft.h5", "--consolidation", "k0", "--set", "contact.young=10 MPa", "--set",
                           "specimen.density_tolerance=0.04", "--set", "specimen.void_ratio=0.62")
        self.assert_done(result)
        numbers = self.entries("soft.h5")["s0001"][0]
        self.assert_near(numbers["void_ratio"], 0.62, 0.04 * (0.841 - 0.568), "the tolerance that is asked for")

    def test_start_from_an_entry(self):
        self.assert_done(self.make("-n", "2", "-o", "library.h5", "-q"))
        scene = self.write("test.toml", tiny_scene(specimen=CELL + 'file = "library.h5#s0002"', stages=STAGE))
        result = self.run_test(scene, "-o", "out")
        self.assert_done(result)
        self.assertIn("150 grains", result.stdout)
        whole = self.run_test(scene, "-o", "none", "--set", "specimen.file=library.h5")
        self.assert_refused(whole, "library.h5", "none of them is named", "s0001", "s0002", "seed", "50.0")
        self.assert_refused(self.run_test(scene, "-o", "none", "--set", "specimen.file=library.h5#s0009"),
                            "no entry \"s0009\"", "s0001", "library.h5#s0001")
        self.assert_refused(self.run_test(scene, "-o", "none", "--set", "specimen.file=nowhere.h5#s0001"),
                            "specimen.file", "does not exist")
        self.assert_refused(self.run_test(scene, "-o", "none", "--set", "specimen.domain=rigid-box"),
                            "periodic-cell", "rigid-box")

    def interrupt(self, with_signal):
        """A library of 40 that is stopped after two specimens.   Returns the exit code, and what it said"""
        for old in self.cache.glob("*"):
            old.unlink()
        return self.stop_when(lambda: len(list(self.cache.glob("*.h5"))) >= 2, "two specimens", with_signal,
                              self.make_many())

    def test_interrupted_and_again(self):
        for with_signal, code in ((signal.SIGINT, 130), (signal.SIGKILL, -signal.SIGKILL)):
            ended, message = self.interrupt(with_signal)
            self.assertEqual(ended, code, message)
            self.assertFalse((self.folder / "library.h5").exists())
            kept = len(list(self.cache.glob("*.h5")))
            self.assertGreaterEqual(kept, 2)
            result = self.make("-n", str(kept + 1), "-j", "1", "-o", "library.h5")
            self.assert_done(result)
            self.assertGreaterEqual(int(re.search(r"  (\d+) taken from specimens", result.stderr)[1]), 2)
            self.assertEqual(len(self.entries()), kept + 1)
            self.assertFalse((self.folder / "library_preparation").exists())
            (self.folder / "library.h5").unlink()

    def test_what_fails_does_not_stop_the_rest(self):
        limits = ("-o", "library.h5", "--relative-densities", "0.3,1", "--set", "specimen.e_min=0.2",
                  "--set", "specimen.e_max=0.95", "--set")
        result = self.make(*limits, "specimen.density_tolerance=1e-9")
        self.assertEqual(result.returncode, 1, result.stderr)
        for part in ("2 of 2 specimens", "seed 1, isotropic 50 kPa, D_r 0.3: no preparation friction gives",
                     "seed 1, isotropic 50 kPa, D_r 1: specimen density cannot be reached", "library_preparation/logs"):
            self.assertIn(part, result.stderr)
        self.assertFalse((self.folder / "library.h5").exists())
        for use in ((), ("--append",)):
            result = self.make(*limits, "specimen.density_tolerance=0.05", *use)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("1 of 1 specimens" if use else "1 of 2 specimens", result.stderr)
            self.assertEqual(list(self.entries()), ["s0001"])
            self.assertTrue(list((self.folder / "library_preparation/logs").glob("seed1_isotropic50kPa_D_r1.log")))

    def test_ranks(self):
        """Each specimen is prepared once, to the same bits."""
        one = self.command("isostat", "library", self.write("rve.toml", SCENE), *NARROW, "-n", "4", "-o")
        self.assert_done(self.run_command([*one, "one.h5", "--set", "specimen.cache=one"]))
        result = self.run_command(["mpirun", "--oversubscribe", "-n", "3", *one, "two.h5", "--set",
                                   "specimen.cache=two"])
        self.assert_done(result)
        self.assertEqual(result.stderr.count("ready"), 4, result.stderr)
        self.assertEqual(*((self.folder / name).read_bytes() for name in ("one.h5", "two.h5")))

    def test_at_work(self):
        """Two commands do not make one library at once."""
        with self.started(self.make_many()) as process:
            wait_until((self.folder / "library_preparation/scene.toml").exists, "the folder", process)
            process.send_signal(signal.SIGSTOP)
            self.assert_refused(self.make("-o", "library.h5"), "library_preparation", "another program is using it")
            process.send_signal(signal.SIGCONT)
            process.send_signal(signal.SIGINT)
            process.communicate()


class Mistakes(AppTest):
    def refuse(self, arguments, *parts):
        scene, before = self.write("rve.toml", SCENE), contents(self.cache)
        self.assert_refused(self.run_app("isostat", "library", scene, "-o", "library.h5", *NARROW, *arguments), *parts)
        self.assertFalse((self.folder / "library.h5").exists())
        self.assertEqual(contents(self.cache), before)

    def test_scene(self):
        self.refuse(["--set", "specimen.domain=rigid-box"], "rve.toml", "rigid-box", "domain = \"periodic-cell\"")
        self.write("packing.h5", "")
        self.refuse(["--set", "specimen.file=packing.h5"], "packing.h5", "relative_density")
        self.refuse(["--set", "grading.grain=5"], "grading.grain", "grading.grains")
        self.assert_refused(self.run_app("isostat", "library", "nowhere.toml"), "nowhere.toml", "does not exist")
        self.assert_refused(self.run_app("isostat", "library"), "no scene given", "--help")

    def test_lists(self):
        self.refuse(["--pressures", "50 kPa,20 mm"], "--pressures", "\"20 mm\"", "kPa")
        self.refuse(["--pressures", "50 kPa,"], "--pressures", "\"\"")
        self.refuse(["--pressures", "0 kPa"], "--pressures", "\"0 kPa\"", "[0.001 kPa, ")
        self.refuse(["--pressures", "50 kPa,50000 Pa"], "asked for twice", "50 kPa")
        self.refuse(["--relative-densities", "0.5,1.5"], "--relative-densities", "\"1.5\"", "[0, 1]")
        self.refuse(["--relative-densities", "dense"], "--relative-densities", "\"dense\"")

    def test_command_line(self):
        for wrong in (["--consolidation", "k1"], ["-n", "0"], ["--append", "--overwrite"], ["--job"]):
            scene = self.write("rve.toml", SCENE)
            self.assertEqual(self.run_app("isostat", "library", scene, "-o", "library.h5", *wrong).returncode, 2)

    def test_output(self):
        scene = self.write("rve.toml", SCENE)
        self.assert_refused(self.run_app("isostat", "library", scene, "-o", "library.toml"), "library.toml", ".h5")
        self.assert_refused(self.run_app("isostat", "library", scene, "-o", "rve.toml/library.h5"), "cannot be made")
        self.write("library.h5", "precious")
        for use in ("--append", ""):
            self.assert_refused(self.run_app("isostat", "library", scene, "-o", "library.h5", *filter(None, [use])),
                                "library.h5", "not an HDF5" if use else "exists")
        self.assertEqual((self.folder / "library.h5").read_text(encoding="utf-8"), "precious")

    def test_list(self):
        self.assert_refused(self.run_app("isostat", "library", "--list"), "no library given", "--output")
        self.assert_refused(self.run_app("isostat", "library", "--list", "-o", "no.h5"), "no.h5", "no such file")

    def test_density_out_of_reach(self):
        scene = self.write("rve.toml", SCENE)
        stiff = ("--set", "contact.young=10 GPa", "--set", "specimen.void_ratio=0.3")
        self.assert_refused(self.run_app("isostat", "library", scene, "-o", "library.h5", *NARROW, *stiff), "seed 1",
                            "cannot be reached", "1 of 1")
        self.assertFalse((self.folder / "library.h5").exists())
