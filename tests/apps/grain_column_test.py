# SPDX-License-Identifier: BSD-3-Clause
"""soil_column with packings of grains at its Gauss points: a few of 250 grains, shaken until they liquefy in 0.3 s."""
import errno
import os
import random
import re
import shutil
import signal
import subprocess
import time

import h5py
import numpy as np

from column_support import NO_FILES, ColumnTest, history, settings
from support import ROOT, TIME_LIMIT, children, contents, wait_until, written_since

SPECIMENS = ROOT / "apps/scenes/rve_library.toml"
GRAINS = """title = "grains"
[mesh]
degree = 1
[water]
drainage = "undrained"
[[layer]]
thickness = "3 m"
cells = 5
density = "1970 kg/m3"
porosity = 0.41
material = "grains"
relative_density = 0.5
[grains]
library = "{cache}/library.h5"
cache = "{cache}/in_situ.h5"
inertial_number = 1e-3
snapshot_depths = ["1 m", "2.5 m"]
path_depths = ["2.1 m"]
snapshot_interval = "0.1 s"
[[motion]]
axis = "x"
kind = "harmonic"
amplitude = "0.6 g"
frequency = "5 Hz"
duration = "0.4 s"
[load]
surcharge = "10 kPa"
[analysis]
kind = "dynamic"
duration = "0.3 s"
safety = 0.7
[output]
history_interval = "0.005 s"
depths = ["0.5 m", "2 m"]
profile_interval = "0.01 s"
paraview_interval = "0.1 s"
checkpoint = "1e-9 min"
"""


class GrainColumnTest(ColumnTest):
    """Specimens are made once for all tests, and brought to their stress in situ once."""

    def setUp(self):
        super().setUp()
        self.scene = self.write("grains.toml", GRAINS.format(cache=self.cache))
        if not (self.cache / "library.h5").exists():
            self.assert_done(self.run_app(
                "isostat", "library", SPECIMENS, "-o", self.cache / "library.h5", "--pressures", "30 kPa", "-q",
                # 10 mm x (250/10000)^(1/3); so few grains make the density jump with the friction
                *settings(grading__grains=250, grading__cloud_edge="2.924 mm", specimen__density_tolerance=0.04)))

    def whole(self):
        """The folder `whole`, of a run without any disturbance."""
        if not (self.cache / "whole").exists():
            self.assert_done(self.run_column(self.scene, "-o", self.cache / "whole", "-q"))
        shutil.copytree(self.cache / "whole", self.folder / "whole")

    def assert_same_bytes(self, one, other):
        """Of checkpoints, too, except for an older one, which may be there or not."""
        self.assert_same_folders(one, other, (*NO_FILES, "checkpoint/previous.h5"))


class Bits(GrainColumnTest):

    def test_ranks_and_threads(self):
        self.whole()
        summary = self.summary_of("whole")
        names = set(contents(self.folder / "whole"))
        self.assertLessEqual({"history.csv", "history.h5", "profiles.h5", "grain_history/history.csv",
                              "grain_history/history.h5", "grain_profiles/history.h5", "grains/d0_00002.h5",
                              "grains/d1_00002.vtp", "paths/d0/packing.h5", "paths/d0/history.h5",
                              "paraview/column_00002.vtu", "summary.json",
                              "checkpoint/last.h5"}, names)
        self.assertGreater(summary["max_ru"], 0.95)
        self.assertGreater(summary["peak_gamma"], 0.01)
        result = self.run_on_ranks(3, self.scene, "-o", "ranks")
        self.assert_done(result)
        self.assertEqual(result.stdout.count("peak shear strain"), 1)
        self.assert_same_bytes("whole", "ranks")
        result = self.run_column(self.scene, "-o", "threads", "-q", "--threads", 2)
        self.assert_done(result)
        self.assert_same_bytes("whole", "threads")
        outside = float(re.search(r"outside of packings +(\S+) %", result.stdout)[1])
        self.assertTrue(0 < outside < 100, result.stdout)

    def test_another_motion_each_time(self):
        """Through liquefaction as well; ISOSTAT_SEED draws a motion again."""
        seed = int(os.environ.get("ISOSTAT_SEED", time.time_ns() % 1000000))
        draw = random.Random(seed)
        motion = settings(motion__0__amplitude=f"{draw.uniform(0.6, 1.2):.3f} g",
                          motion__0__frequency=f"{draw.uniform(4, 8):.2f} Hz")
        print(f"  ISOSTAT_SEED={seed}", *motion, flush=True)
        self.assert_done(self.run_column(self.scene, "-o", "one", "-q", *motion))
        self.assert_done(self.run_on_ranks(draw.choice((2, 3, 4)), self.scene, "-o", "other", *motion))
        self.assert_same_bytes("one", "other")
        rows = history(self.folder / "one")
        self.assertGreater(rows["max_ru"].max(), 0.9)

    def stop(self, n, with_signal, wait, *more, to_mpirun=False):
        """Starts n ranks; one of them, or mpirun, gets a signal `wait` s after the first checkpoint of this run."""
        last, begin = self.folder / "parts/checkpoint/last.h5", time.time()

        def send(mpirun, number):
            for process in [mpirun.pid] if to_mpirun else children(mpirun)[-1:]:
                os.kill(process, number)

        return self.stop_when(lambda: written_since(last, begin), last, with_signal,
                              self.command_on_ranks(n, self.scene, "-o", "parts", "-q", *more), wait, send)

    def test_kills_and_other_ranks(self):
        self.whole()
        moments, killed = random.Random(20240229), 0
        for n in 5 * (2, 4, 1):
            resume = ["--resume"] if (self.folder / "parts").exists() else []
            code, said = self.stop(n, signal.SIGKILL, moments.uniform(0.02, 0.3), *resume)
            killed += code == 128 + signal.SIGKILL and "exited on signal 9 (Killed)" in " ".join(said.split())
            if killed == 3:
                break
            if code == 0:  # it has ended before enough kills have come: once more
                shutil.rmtree(self.folder / "parts")
        self.assertGreaterEqual(killed, 3)
        self.assert_done(self.run_on_ranks(3, self.scene, "-o", "parts", "-q", "--resume"))
        self.assert_same_bytes("whole", "parts")

    def test_orderly_stops(self):
        """SIGTERM of one rank, and SIGUSR1 of mpirun, which hands it on to all."""
        self.whole()
        for with_signal, to_mpirun, resume in ((signal.SIGTERM, False, []), (signal.SIGUSR1, True, ["--resume"])):
            code, message = self.stop(2, with_signal, 0.1, *resume, to_mpirun=to_mpirun)
            self.assertEqual(code, 130, message)
            self.assertEqual(len(re.findall(r"interrupted at step \d+; continue with --resume", message)), 1)
        self.assert_done(self.run_on_ranks(1, self.scene, "-o", "parts", "-q", "--resume"))
        self.assert_same_bytes("whole", "parts")

    def test_packings_in_balance(self):
        self.scene = self.write("static.toml", GRAINS.format(cache=self.cache).replace(
            "inertial_number = 1e-3", 'drive = "static"\nincrement = 1e-4\nbalance = 0.05'))
        self.assert_done(self.run_column(self.scene, "-o", "whole", "-q"))
        self.assertGreater(self.summary_of("whole")["peak_gamma"], 1e-3)
        code, message = self.stop(2, signal.SIGTERM, 0.1)
        self.assertEqual(code, 130, message)
        self.assert_done(self.run_column(self.scene, "-o", "parts", "-q", "--resume", "--threads", 2))
        self.assert_same_bytes("whole", "parts")
        replay = self.run_app("rve_replay", "whole/paths/d0", "-q", "-o", "alone", "--no-figures")
        self.assertIn("bit for bit after all", replay.stdout)
        tighter = self.run_app("rve_replay", "whole/paths/d0", "-q", "-o", "tighter", "--no-figures", "--balance", 1e-3)
        self.assert_done(tighter)
        alone, tighter = self.summary_of("alone"), self.summary_of("tighter")
        self.assertGreater(tighter["steps"], 1.2 * alone["steps"])
        self.assertGreater(tighter["shear_error"], 0)


class Sands(GrainColumnTest):
    """Two layers of different sands, each from a library of its own."""

    def test_each_layer_has_its_own_packings(self):
        self.assert_done(self.run_app(
            "isostat", "library", SPECIMENS, "-o", self.cache / "stiff.h5", "--pressures", "30 kPa", "-q",
            *settings(grading__grains=300, grading__cloud_edge="3.107 mm", specimen__density_tolerance=0.04,
                      contact__young="1 GPa")))
        layer = GRAINS[GRAINS.index("[[layer]]"):GRAINS.index("[grains]")].replace("3 m", "1.5 m").replace("= 5", "= 3")
        stiff = layer + f'library = "{self.cache}/stiff.h5"\n'
        text = GRAINS.replace(GRAINS[GRAINS.index("[[layer]]"):GRAINS.index("[grains]")], layer + stiff)
        scene = self.write("sands.toml", text.format(cache=self.cache))
        short = settings(analysis__duration="0.05 s")
        self.assert_done(self.run_column(scene, "-o", "one", "-q", *short))
        self.assert_done(self.run_on_ranks(2, scene, "-o", "two", "-q", *short))
        self.assert_same_bytes("one", "two")
        for depth, grains in (("d0", 250), ("d1", 300)):
            with h5py.File(self.folder / f"one/grains/{depth}_00000.h5") as file:
                self.assertEqual(len(file["snapshot/grains/mass"]), grains)
        own = text.replace(layer + stiff, stiff + stiff).replace('library = "{cache}/library.h5"\n', "")
        scene = self.write("own.toml", own.format(cache=self.cache))
        self.assert_done(self.run_column(scene, "--validate"))
        result = self.run_column(scene, "-o", "out", *settings(layer__1__library="nowhere.h5"))
        self.assert_refused(result, "layer.1.library", "nowhere.h5", "does not exist")


class Rest(GrainColumnTest):
    """5,000 steps without motion."""

    LONG = settings(analysis__duration="18 s", output__history_interval="0.1 s", output__profile_interval="5 s",
                    output__paraview_interval="100 s", grains__snapshot_interval="100 s", output__checkpoint="10 min")

    def rest(self, *more):
        result = self.run_column(self.scene, "-o", "rest", "-q", "--overwrite", *self.LONG, *more)
        self.assert_done(result)
        rows = history(self.folder / "rest")
        self.assertGreater(rows["step"][-1], 5000)
        return rows, float(re.search(r"calls, ([\d.]+) time steps each", result.stdout).group(1))

    def test_frozen_column_stays_still_bit_for_bit(self):
        self.scene = self.write("frozen.toml", re.sub(r"\[\[motion\]\][^\[]*", "", GRAINS.format(cache=self.cache)))
        rows, steps = self.rest()
        for name in ("surface_ux", "surface_uy", "surface_uz", "surface_ax", "d0_u", "d1_u", "d1_gamma_xz"):
            self.assertEqual(np.abs(rows[name]).max(), 0, name)
        for name in ("d0_sigma_v", "d1_sigma_v", "d0_tau_xz", "d1_p"):
            self.assertEqual(np.ptp(rows[name]), 0, name)
        self.assertEqual(steps, 0)  # of grains

    def test_touched_column_settles_down(self):
        """A touch of 1e-6 g sets the grains going; what they had left of unbalanced forces dies away."""
        rows, steps = self.rest(*settings(motion__0__amplitude="1e-6 g"))
        self.assertGreater(steps, 0.9)
        for name in ("surface_ux", "surface_uy"):
            self.assert_below(np.abs(rows[name]).max(), 2e-7, f"m, left of unbalanced forces; 4e-8 measured ({name})")
        for name in ("d0_sigma_v", "d1_sigma_v"):
            self.assert_below(np.ptp(rows[name]), 2e-4 * rows[name][0], f"as above; 7e-5 measured ({name})")
        for name in ("d0_tau_xz", "d1_tau_xz"):
            self.assert_below(np.ptp(rows[name]), 3, f"Pa, of 13 and 30 kPa vertical stress; 0.5 measured ({name})")
        late = rows["time"] > 13
        for name in ("surface_ux", "surface_uy"):
            self.assert_below(np.ptp(rows[name][late]), 3e-8, f"m, what still creeps ({name})")


class Failures(GrainColumnTest):
    def fail(self, depth, *more):
        result = self.run_on_ranks(2, self.scene, "-o", "out", "--overwrite", "-q", *settings(layer__0__cells=4), *more)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(result.stderr.count("failed: "), 1)
        self.assertRegex(result.stderr, r"failed: step \d+ \(t = [\d.]+ s\): "
                         rf"rve: layer\.0, depth {depth} m: an increment .*\n"
                         r"  last good checkpoint: out/checkpoint/last.h5\n")
        with h5py.File(self.folder / "out/checkpoint/last.h5") as file:
            self.assertGreater(file.attrs["step"], 0)

    def test_packing_of_the_first_rank(self):
        self.fail("2.625", *settings(motion__0__amplitude="1e5 g"))

    def test_packing_of_another_rank(self):
        self.fail("0.375", *settings(load__kind="harmonic", load__direction="x", load__amplitude="1 GPa",
                                     load__frequency="5 Hz"))

    def test_full_disk(self):
        disk = self.folder / "disk"
        disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16m", "tmpfs", disk], check=False,
                          capture_output=True).returncode != 0:
            self.skipTest("no right to mount a small disk")
        self.addCleanup(subprocess.run, ["umount", "-l", disk], check=False)
        self.whole()
        run = ("-o", "disk/out", "-q")
        with self.started(self.command_on_ranks(2, self.scene, *run)) as process:
            last = disk / "out/checkpoint/last.h5"
            wait_until(last.exists, last, process)
            with open(disk / "filler", "wb", buffering=0) as filler:
                try:
                    while True:
                        filler.write(b"\0" * 4096)
                except OSError as error:
                    self.assertEqual(error.errno, errno.ENOSPC)
            _, message = process.communicate(timeout=TIME_LIMIT)
        self.assertEqual(process.returncode, 1, message)
        self.assertEqual(message.count("failed: "), 1, message)
        self.assertRegex(message, r"failed: step \d+ \(t = [\d.]+ s\): disk/out/.*free space")
        self.assertIn("last good checkpoint: disk/out/checkpoint/last.h5", message)
        (disk / "filler").unlink()
        self.assert_done(self.run_column(self.scene, *run, "--resume"))
        self.assert_same_bytes("whole", "disk/out")


class Alone(GrainColumnTest):
    """One packing of the column, strained again in the same way by rve_replay."""

    def setUp(self):
        super().setUp()
        self.whole()

    def replay(self, *arguments):
        result = self.run_app("rve_replay", "whole/paths/d0", "-q", *arguments)
        self.assert_done(result)
        return result.stdout, self.summary_of(arguments[1])

    def test_stress_is_that_of_the_column_bit_for_bit(self):
        text, summary = self.replay("-o", "alone", "--every", 5)
        self.assertIn("bit for bit after all", text)
        self.assertGreater(summary["increments"], 50)
        self.assertEqual(summary["equal"], summary["increments"])
        self.assertEqual(summary["largest_error"], 0)
        self.assertGreater(summary["largest_strain"], 1e-4)
        rows = history(self.folder / "alone")
        np.testing.assert_array_equal(rows["tau"], rows["tau_column"])
        self.assertGreater(np.ptp(rows["p"]), 1e3)
        self.assertEqual(len(history(self.folder / "alone/grain_history")["IR"]), summary["increments"] // 5)
        self.assertIn("figures in", text)
        self.assertTrue((self.folder / "alone/figures/fig_path.png").exists())

    def test_other_rates_give_other_stress(self):
        text, summary = self.replay("-o", "fast", "--no-figures", "--inertial-number", 4e-3, "--min-steps", 1)
        self.assertIn("of tau", text)
        self.assertLess(summary["equal"], summary["increments"])
        self.assertGreater(summary["shear_error"], 1e-4)

    def test_mistakes(self):
        def refuse(parts, *arguments):
            self.assert_refused(self.run_app("rve_replay", *arguments, "-q"), *parts)
        refuse(["whole", "packing.h5", "grains.path_depths"], "whole")
        for option, value in (("--min-steps", 0), ("--inertial-number", 2)):
            wrong = self.run_app("rve_replay", "whole/paths/d0", option, value)
            self.assertEqual(wrong.returncode, 2)
            self.assertIn(option[2:], wrong.stderr)
        packing = self.folder / "whole/paths/d0/packing.h5"
        data = bytearray(packing.read_bytes())
        data[len(data) // 2] ^= 1
        packing.write_bytes(data)
        refuse(["packing.h5", "damaged"], "whole/paths/d0")
        packing.write_bytes(data[:1000])
        refuse(["packing.h5"], "whole/paths/d0")
        self.assertFalse((self.folder / "whole/paths/d0/replay").exists())


class Mistakes(GrainColumnTest):
    def refuse(self, parts, *arguments, scene=None):
        result = self.run_column(scene or self.scene, "-o", "out", "-q", *arguments)
        self.assert_refused(result, *parts)
        self.assertFalse((self.folder / "out").exists())

    def test_library(self):
        self.refuse(["grains.library", "nowhere.h5", "does not exist"], *settings(grains__library="nowhere.h5"))
        self.refuse(["grains.toml", "not an HDF5 file"], *settings(grains__library="grains.toml"))
        self.refuse(["0 realisations", "of 0.9", "isostat library --append", "s0001"],
                    *settings(layer__0__relative_density=0.9))
        self.refuse(["1 realisations", "needs 3", "isostat library --append"], *settings(layer__0__realisation=2))
        result = self.run_on_ranks(2, self.scene, "-o", "out", *settings(layer__0__relative_density=0.9))
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stderr.count("error: "), 1, result.stderr)

    def test_scene(self):
        text = GRAINS.format(cache=self.cache)
        for old, new, *parts in (
                ('relative_density = 0.5', 'relative_density = 0.5\nshear_velocity = "150 m/s"', "shear_velocity",
                 "does not belong"),
                (f'library = "{self.cache}/library.h5"\n', "", "grains.library", "isostat", "library"),
                ('snapshot_depths = ["1 m", "2.5 m"]', 'snapshot_depths = ["4 m"]', "snapshot_depths",
                 "entry 1 is 4 m"),
                ('depths = ["0.5 m", "2 m"]', 'depths = ["4 m"]', "output.depths", "4 m"),
                ("inertial_number = 1e-3", "increment = 1e-4", "grains.increment", 'drive = "static"'),
                ('drainage = "undrained"', 'drainage = "coupled"', "degree = 2")):
            self.assertIn(old, text)
            self.refuse([*parts, "changed.toml:"], scene=self.write("changed.toml", text.replace(old, new, 1)))

    def test_too_little_stress(self):
        self.refuse(["p' =", "below 0.5 kPa", "surcharge"], *settings(load__surcharge="0 kPa", layer__0__cells=20))

    def test_consolidation(self):
        text = re.sub(r"\[\[motion\]\][^\[]*", "", GRAINS.format(cache=self.cache))
        text = re.sub(r"\[analysis\][^\[]*", '[analysis]\nkind = "consolidation"\nfirst_time = "1 s"\n'
                      'last_time = "9 s"\nsteps = 5\n', text).split("[output]")[0]
        text = re.sub(r"\[load\]", '[load]\nkind = "step"\namplitude = "10 kPa"', text)
        text = text.replace('"undrained"', '"coupled"').replace("degree = 1", "degree = 2")
        text = text.replace("cells = 5", 'cells = 5\npermeability = "1e-5 m/s"')
        self.refuse(["changed.toml:", "grains", "dynamic"], scene=self.write("changed.toml", text))


class Drained(GrainColumnTest):
    def test_pore_pressure_falls_after_shaking(self):
        result = self.run_column(self.scene, "-o", "out", "-q", *settings(
            mesh__degree=2, water__drainage="coupled", layer__0__cells=3, layer__0__permeability="1e-2 m/s",
            motion__0__amplitude="0.15 g", analysis__duration="0.8 s", output__checkpoint="1 min"))
        self.assert_done(result)
        rows = history(self.folder / "out")
        shaking, after = rows["time"] < 0.4, rows["time"] > 0.75
        self.assertGreater(rows["d1_ru"][shaking].max(), 0.15)  # 0.25 to 0.4, as the contacts open
        for name in ("d0_u", "d1_u"):
            self.assert_below(np.abs(rows[name][after]).max(), 0.1 * rows[name][shaking].max(),
                              f"drained: 10 % of the largest pore pressure may be left ({name})")
        settled = rows["settlement"]
        self.assertGreater(settled[-1], 1e-3)
        self.assert_below(np.ptp(settled[after]), 0.02 * settled[-1], "drained: it settles no more, except for 2 %")
        self.assert_below(abs(rows["residual"][-1]), 1e-10 * np.abs(rows["external"]).max(), "round-off of the work")
