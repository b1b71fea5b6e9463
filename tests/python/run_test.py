# SPDX-License-Identifier: BSD-3-Clause
"""Runs from Python: the same bits as element_test, callbacks, stopping and resuming, results as arrays."""
import contextlib
import io
import os
import subprocess
import sys
import tomllib

import numpy as np

from package import BINARIES, FolderTest, isostat

SCENE = """title = "small"
[grading]
grains = 300
cloud_edge = "3.1 mm"
[specimen]
domain = "periodic-cell"
preparation_friction = "12 deg"
[[stage]]
kind = "undrained-cyclic"
deviator_amplitude = "10 kPa"  # without friction more would liquefy some packings at once
until.cycles = 6
"""
DRAINED = '''[[stage]]
kind = "drained"
strain = 2e-4
[[stage]]
kind = "undrained-simple-shear"
strain = 1e-3
'''


class RunTest(FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.scene = isostat.Scene(SCENE)
        cls.specimen = isostat.prepare(cls.scene, cache=cls.cache)
        cls.whole = isostat.run(cls.scene, cache=cls.cache)

    def run_scene(self, *arguments, **keywords):
        return self.run_scene_of(self.scene, *arguments, **keywords)

    def run_scene_of(self, scene, *arguments, **keywords):
        return isostat.run(scene, *arguments, cache=self.cache, **keywords)

    def test_another_python_learns_which_one_the_package_is_for(self):
        """Without site packages NumPy is missing, as under most other Pythons."""
        environment = {**os.environ, "PYTHONPATH": str(BINARIES.parent / "python")}
        done = subprocess.run([sys.executable, "-S", "-c", "import isostat"], capture_output=True, text=True,
                              env=environment, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "No module named 'numpy'. This isostat was built for cpython-3[0-9]+-.*; this is "
                                      f"{sys.implementation.cache_tag}, .*python.*/usr/bin/python3 with python3-numpy")

    def test_history_is_that_of_the_program_bit_for_bit(self):
        scene = self.folder / "small.toml"
        scene.write_text(SCENE, encoding="utf-8")
        subprocess.run([BINARIES / "element_test", scene, "-o", self.folder / "program", "--quiet", "--no-figures"],
                       check=True, stdout=subprocess.DEVNULL)
        results = self.run_scene(self.folder / "python")
        for name in ("history.csv", "summary.txt", "scene.toml"):
            one, other = ((self.folder / run / name).read_text() for run in ("program", "python"))
            lines = [[line for line in text.splitlines() if "steps/s" not in line and not line.startswith("folder")]
                     for text in (one, other)]
            self.assertEqual(*lines)
        self.assertTrue(results.finished)
        self.assertEqual(results.history.units["p"], "Pa")
        in_memory = self.whole
        for name in results.history:
            np.testing.assert_array_equal(in_memory.history[name], results.history[name], err_msg=name)
        (self.folder / "python/history.h5").unlink()  # the table has fewer digits
        self.assert_close(isostat.read(self.folder / "python").history["p"], results.history["p"], 1e-9, "its digits")
        np.testing.assert_array_equal(in_memory.snapshot.positions, results.snapshot.positions)
        for name, value in results.summary.items():
            if isinstance(value, float) and name != "seconds":
                self.assert_near(in_memory.summary[name], value, 1e-9 * abs(value), f"digits of a file, in {name}")
            elif name not in ("seconds", "cyclic_response", "liquefaction", "rows"):
                self.assertEqual(in_memory.summary[name], value, name)
        rows, stored = ([row for row in run.summary["rows"] if row[0] != "run"] for run in (in_memory, results))
        self.assertEqual(rows, stored)
        for drawn, stored in zip(in_memory.draw("fig_stress_path"), results.draw("fig_stress_path")):
            for line, other in zip(drawn.lines, stored.lines):
                self.assert_near(np.asarray(line.get_ydata(), float), np.asarray(other.get_ydata(), float), 1e-6,
                                 "digits of a history file")

    def test_figures_of_a_run_without_a_folder_name_no_file(self):
        run = self.run_scene(on_step=lambda moment: moment.step < 500, every=1)
        with contextlib.redirect_stderr(io.StringIO()) as said:
            run.draw("fig_stress_path")
        self.assertEqual(said.getvalue(), "")

    def test_strain_of_volume_pore_pressure_and_cycles(self):
        history = self.whole.history
        self.assert_near(history["eps_v"], sum(history[f"eps_{axis}"] for axis in "xyz"), 1e-15, "rounding of the sum")
        self.assert_near(history["r_u"], 1 - history["p"] / history["p"][0], 0.01, "rows have all parts of the stress")
        cycles, turns = history["cycles"], np.flatnonzero(np.diff(history["reversals"])) + 1
        np.testing.assert_array_equal(cycles[turns], history["reversals"][turns] / 2)
        self.assertTrue((np.diff(cycles) >= 0).all())
        self.assertGreater(len(np.unique(cycles)), 10 * len(turns))
        scene = SCENE[:SCENE.index("[[stage]]")] + '[contact]\nfriction = "18 deg"\n' + DRAINED
        drained = self.run_scene_of(isostat.Scene(scene)).history
        self.assertGreater(np.abs(drained["eps_v"]).max(), 1e-6)
        np.testing.assert_array_equal(drained["r_u"][drained["stage"] == 0], 0)
        undrained = drained["stage"] == 1
        self.assert_near(drained["r_u"][undrained][0], 0, 1e-9, "it counts from where the volume begins to be kept")
        self.assertGreater(drained["r_u"][undrained].max(), 0.001)

    def test_a_finished_run_continues_to_a_later_end(self):
        short = self.scene.with_(**{"stage.0.until.cycles": 1})
        self.assertEqual(self.run_scene_of(short, self.folder / "longer").summary["reversals"], 2)
        later = self.run_scene_of(self.scene, self.folder / "longer", resume=True)
        whole = self.whole
        self.assertEqual(later.summary["reversals"], 12)
        self.assertEqual(later.summary["ended"], whole.summary["ended"])
        np.testing.assert_array_equal(later.snapshot.positions, whole.snapshot.positions)
        with self.assertRaisesRegex(isostat.InputError, "but the checkpoint has 6: only a later end is possible"):
            self.run_scene_of(short, self.folder / "longer", resume=True)

    def test_callbacks_see_the_packing(self):
        seen, moved = [], []

        def look(moment):
            seen.append((moment.step, moment.p, moment.snapshot().measures()["IR"]))

        def step(moment):
            moved.append(moment.positions.copy())

        run = self.run_scene(on_record=look, on_step=step, every=100)
        for k, name in ((0, "step"), (2, "IR")):
            np.testing.assert_array_equal([row[k] for row in seen], run.history[name], err_msg=name)
        self.assert_close([row[1] for row in seen], run.history["p"], 1e-2, "rows have all parts of the stress")
        self.assertGreater(len(moved), 2)
        self.assertFalse(np.array_equal(moved[0], moved[-1]))

    def test_a_callback_stops_a_run_and_it_continues(self):
        whole = self.whole
        half = whole.history["step"][-1] / 2
        stopped = self.run_scene(self.folder / "halves", on_step=lambda moment: moment.step < half, every=1)
        self.assertFalse(stopped.finished)
        read = isostat.read(self.folder / "halves")
        self.assertEqual((read.finished, read.summary), (False, None))
        self.assertEqual(read.history["step"][-1], stopped.history["step"][-1])
        resumed = self.run_scene(self.folder / "halves", resume=True)
        self.assertTrue(resumed.finished)
        np.testing.assert_array_equal(resumed.snapshot.positions, whole.snapshot.positions)

    def test_an_exception_of_a_callback_ends_the_run(self):
        def fail(_):
            raise ZeroDivisionError("mine")

        with self.assertRaisesRegex(ZeroDivisionError, "mine"):
            self.run_scene(on_record=fail)

    def test_a_path_keeps_its_stresses_and_is_repeated(self):
        contact = '[contact]\nfriction = "18 deg"\nrolling = {}\n'
        scene = isostat.Scene(SCENE[:SCENE.index("[[stage]]")].replace("12 deg", "8 deg") + contact + """
[[stage]]
kind = "path"
b = 0.5
x = { keep = "p" }
z = { keep = "b" }
until = { strain = 5e-4 }
[[stage]]
kind = "path"
direction = "extension"
x = { keep = "stress" }
z = { keep = "stress" }
until = { q = "2 kPa", strain = 1e-2 }
[[stage]]
kind = "repeat"
stages = 2
times = 2
""")
        history = isostat.run(scene, cache=self.cache).history
        stages = history["stage"].astype(int)
        self.assertEqual(stages[np.flatnonzero(np.diff(stages, prepend=-1))].tolist(), [0, 1, 0, 1])
        first = np.flatnonzero(np.diff(stages))[0] + 1
        self.assert_close(history["p"][:first], history["p"][0], 0.005, "the servo follows a load that grows")
        x, y, z = (history[f"sigma_{axis}"][:first][-1] for axis in "xyz")
        self.assert_near((z - x) / (y - x), 0.5, 0.01, "the same, of a difference of stresses")

    def test_starts_from_a_packing(self):
        given = isostat.run(self.scene, specimen=self.specimen)
        np.testing.assert_array_equal(given.snapshot.positions, self.whole.snapshot.positions)
        self.assertEqual(self.specimen.numbers["grains"], 300)

    def test_a_given_packing_is_kept_and_the_scene_runs_again(self):
        end = self.whole.snapshot
        self.assertGreater(end.step, 1000)
        folder = self.folder / "given"
        given = isostat.run(self.scene, folder, specimen=end, on_step=lambda moment: moment.step < 500, every=1)
        given = isostat.run(self.scene, folder, resume=True)
        self.assertEqual((given.history["step"][0], given.summary["grains"]), (0, 300))
        self.assert_near(given.summary["void_ratio"], end.void_ratio, 1e-12, "sums of volumes in another order")
        self.assertTrue(given.report().is_file())
        again = isostat.run(folder / "scene.toml", self.folder / "again", threads=1)
        self.assertEqual((folder / "history.csv").read_bytes(), (self.folder / "again/history.csv").read_bytes())
        with self.assertRaisesRegex(isostat.InputError, "specimen that is given: a specimen in a periodic-cell"):
            isostat.run(self.scene.with_(**{"specimen.domain": "rigid-box"}), specimen=end)

    def test_what_a_given_packing_fixes_is_taken_from_it(self):
        other = self.scene.with_(**{"grading.grains": 500, "grading.seed": 4, "specimen.pressure": "100 kPa",
                                    "specimen.preparation_friction": "20 deg", "stage.0.until.cycles": 1})
        folder = self.folder / "other"
        program = ("import sys; sys.path.insert(0, sys.argv[1])\nimport isostat\n"
                   "isostat.run(sys.argv[2], sys.argv[3], specimen=isostat.read_specimen(sys.argv[4]), quiet=False)\n")
        isostat.write_specimen(self.folder / "made.h5", self.specimen)
        done = subprocess.run([sys.executable, "-c", program, BINARIES.parent / "python", other.text, folder,
                               self.folder / "made.h5"], capture_output=True, text=True, check=True)
        for part in ("grading.grains = 500 (300)", "grading.seed = 4 (1)", "preparation_friction = 20 deg (12 deg)",
                     "specimen.pressure = 100 kPa; the test starts from what it has"):
            self.assertIn(part, done.stderr)
        results = isostat.read(folder)
        self.assertEqual(results.scene.to_dict()["grading"].get("grains"), None)
        self.assertNotIn("pressure", tomllib.loads((folder / "scene.toml").read_text())["specimen"])
        self.assertRegex(results.provenance, "seed +1\nspecimen +300 grains, d50 0.[0-9]+ mm, e 0.[0-9]+, "
                                             "p' (199[.]|200)[.0-9]* kPa")
        self.assert_close(results.history["p"][0], 200e3, 0.01, "the servo stops within 0.3 %")
        self.assert_close(results.history["unbalanced"][0], self.specimen.numbers["unbalanced_force"], 0.5,
                          "velocities are those of a step further")
        again = isostat.run(folder / "scene.toml", self.folder / "other_again", threads=1)
        np.testing.assert_array_equal(again.history["p"], results.history["p"])

    def test_what_a_scene_file_writes_out_is_held_against_its_packing(self):
        """Also where it is the default. The file that names the packing is read as the program does."""
        isostat.write_specimen(self.folder / "held.h5", self.specimen)
        path = self.folder / "held.toml"
        text = SCENE.replace('preparation_friction = "12 deg"', 'file = "held.h5"')
        for written, has in ((("", ""), None), (("grains = 300", "grains = 10000"), "grading.grains = 10000 (300)"),
                             (('[specimen]', '[specimen]\npressure = "200 kPa"'), None)):
            path.write_text(text.replace('cloud_edge = "3.1 mm"\n', "").replace(*written), encoding="utf-8")
            scene = isostat.Scene(path)
            self.assertEqual(isostat.Scene(scene.text), scene)
            self.assertEqual('pressure = "200 kPa"' in scene.text, "pressure" in written[1])
            warnings = isostat.run(scene, quiet=True, on_record=lambda moment: False).warnings
            self.assertEqual([has in text for text in warnings], [True] if has else [], warnings)

    def test_another_contact_stiffness_than_that_of_the_packing(self):
        soft = self.scene.with_(**{"contact.young": "2 GPa"})
        with self.assertRaisesRegex(isostat.InputError, r"the specimen that is given: was made with another contact "
                                    r"stiffness than contact.young = 2 GPa \(10 GPa\): .* by 80 % .*`rebalance`"):
            isostat.run(soft, specimen=self.specimen)
        isostat.write_specimen(self.folder / "stiff.h5", self.specimen)
        with self.assertRaisesRegex(isostat.InputError, r"stiff.h5: was made .* contact.young = 2 GPa \(10 GPa\)"):
            isostat.run(soft.with_(**{"specimen.file": str(self.folder / "stiff.h5")}))
        stages = [{"kind": "rebalance"}, {"kind": "hold"}]
        run = isostat.run(isostat.Scene({**soft.to_dict(), "stage": stages}), specimen=self.specimen)
        self.assert_close(run.history["p"][-1], 200e3, 0.01, "the servo stops within 0.3 %")

    def test_a_moment_keeps_its_numbers(self):
        kept, taken = [], []

        def look(moment):
            kept.append((moment, moment.step, moment.time, moment.void_ratio))
            taken.append(moment.snapshot())

        run = self.run_scene(on_step=look, every=200)
        self.assertGreater(len(kept), 2)
        for (moment, *numbers), snapshot in zip(kept, taken):
            self.assertEqual(numbers, [moment.step, moment.time, moment.void_ratio])
            self.assertEqual((moment.step, moment.time), (snapshot.step, snapshot.time))
            self.assertEqual(moment.step % 200, 0)
        self.assertNotEqual(run.snapshot.strain[1], 0)
        self.assert_close(-run.snapshot.strain[1], run.history["eps_y"][-1], 1e-12, "the same sum")

    def test_results_are_read_again(self):
        self.run_scene(self.folder / "read")
        results = isostat.read(self.folder / "read")
        self.assertEqual(results.scene.title, "small")
        self.assertGreater(len(results.snapshots), 0)
        self.assertEqual(len(results.packing(0)), 300)
        self.assertEqual(results.summary["grains"], 300)
        axes = results.draw("fig_redundancy")
        self.assertEqual([panel.get_ylabel() for panel in axes[:2]],
                         ["Redundancy index $I_R$", r"$p^\prime/p_0^\prime$"])
        (self.folder / "read/summary.json").write_text('{\n  "title": "small",\n  "gra', encoding="utf-8")
        with self.assertRaisesRegex(isostat.InputError, r"read/summary.json:3: is damaged \(Unterminated .*Restore it"):
            results.summary
        with self.assertRaisesRegex(isostat.InputError, "no figure of element_test; there are fig_stress_path"):
            results.draw("redundancy")
        with self.assertRaisesRegex(isostat.InputError, "no history.csv"):
            isostat.read(self.folder)
        with self.assertRaisesRegex(isostat.InputError, "results folder exists.*overwrite=True"):
            self.run_scene(self.folder / "read")
        with self.assertRaisesRegex(isostat.InputError, "there is no number 99"):
            results.packing(99)
        self.assertRegex(isostat.__version__, r"^\d+\.\d+")

    def test_a_damaged_file_costs_no_more_than_itself(self):
        folder = self.folder / "damaged"
        whole = self.run_scene(folder).history
        names = ("history.h5", "history.csv")
        series, table = (folder / name for name in names)
        kept = {name: (folder / name).read_bytes() for name in names}
        lines = kept["history.csv"].splitlines(keepends=True)
        n_rows = len(whole["p"])

        def read(warning):
            with self.assertWarnsRegex(isostat.IsostatWarning, warning) as caught:
                results = isostat.read(folder)
            self.assertEqual(caught.filename, __file__)
            self.assertEqual(results.warnings, [str(caught.warning)])
            for name in names:
                (folder / name).write_bytes(kept[name])
            return results.history

        for damage in (kept["history.h5"][:-100], b"", kept["history.h5"].replace(b"p_LW", b"q_LW", 1)):
            series.write_bytes(damage)
            history = read(r"damaged/history\.h5: .*The history is that of .*damaged/history\.csv, to ten digits\.$")
            self.assertEqual((list(history), history.units), (list(whole), whole.units))
            for name in whole:
                self.assert_below(abs(history[name] - whole[name]), 1e-9 * abs(whole[name]), "ten digits")
        for damage, words in (
                (b"", r": is damaged \(it is empty\)"), (b"\xff\xfe", r": is damaged \(it holds bytes"),
                (b"".join([*lines[:3], b"1,2\n", *lines[3:]]), r":4: is damaged \(it holds no row of"),
                (b"".join([lines[0], lines[1].replace(b".", b"x"), *lines[2:]]), r":2: is damaged \(it holds no"),
                (b"".join(lines[:-1]), rf": is damaged \(it ends after {n_rows - 1} of {n_rows} rows\)"),
                (None, ": cannot be read: No such file")):
            if damage is None:
                table.unlink()
            else:
                table.write_bytes(damage)
            history = read(rf"damaged/history\.csv{words}.*The history is that of .*damaged/history\.h5")
            self.assertEqual((set(history), history.units), (set(whole), whole.units))
            for name in whole:
                np.testing.assert_array_equal(history[name], whole[name])
        table.write_bytes(kept["history.csv"] + b"0.5,12")  # killed while it wrote: nothing is damaged
        self.assertEqual(isostat.read(folder).warnings, [])
        table.write_bytes(b"")
        series.write_bytes(b"")
        with self.assertRaisesRegex(isostat.InputError, r"(?s)history\.h5: .*history\.csv: .*No history is"):
            isostat.read(folder)
        (folder / "history.csv").write_bytes(kept["history.csv"])
        (folder / "provenance.txt").write_bytes(b"\xff\xfe")
        (folder / "scene.toml").unlink()
        results = isostat.read(folder)
        with self.assertRaisesRegex(isostat.InputError, r"provenance\.txt: is damaged .*Restore it from a copy"):
            results.provenance
        with self.assertRaisesRegex(isostat.InputError, r"scene\.toml: cannot be read: No such file"):
            results.scene

    def test_a_damaged_packing_leaves_its_grains(self):
        results = self.run_scene(self.folder / "cut")
        path = results.snapshots[-1]
        path.write_bytes(path.read_bytes()[:-50])
        grains = path.name.replace("snapshot_", "grains_").replace(".h5", ".vtp")
        self.assertTrue((self.folder / "cut/paraview" / grains).is_file())
        with self.assertRaisesRegex(isostat.InputError, rf"{path.name}: .*read_packing\('.*/{grains}'\) has its"):
            results.packing(-1)
