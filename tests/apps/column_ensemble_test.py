# SPDX-License-Identifier: BSD-3-Clause
"""isostat ensemble: members with packings or records of their own, side by side, on ranks, killed and resumed, and the
bands of all, computed again from the members' files."""
import csv
import re
import shutil
import signal

import h5py
import numpy as np

from column_support import SCENES, ColumnTest, settings
from grain_column_test import GRAINS as COLUMN, SPECIMENS
from support import columns, contents

GRAINS = re.sub(r"((snapshot|path)_)?depths = .*\n|(snapshot|paraview)_interval.*\n", "", COLUMN).replace(
    "cells = 5", "cells = 3").replace('"0.3 s"', '"0.25 s"')
SAND = """title = "sand"
water.drainage = "undrained"
output.history_interval = "0.005 s"
[[layer]]
thickness = "4 m"
cells = 2
density = "1900 kg/m3"
material = "iwan"
reference_pressure = "100 kPa"
k0 = 0.5
shear_velocity = "120 m/s"
[[motion]]
axis = "x"
kind = "record"
file = "first.txt"
unit = "m/s2"
[analysis]
kind = "dynamic"
duration = "0.5 s"
"""
DIGITS = 1e-9  # tables have ten digits


def table(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {name.split(" (")[0]: [row[name] for row in rows] for name in rows[0]}


class Ensemble(ColumnTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("grains.toml", GRAINS.format(cache=self.cache))
        if not (self.cache / "library.h5").exists():
            self.assert_done(self.run_app(
                "isostat", "library", SPECIMENS, "-o", self.cache / "library.h5", "--pressures", "30 kPa", "-q",
                "-n", "6", *settings(grading__grains=120, grading__cloud_edge="2.289 mm",
                                     specimen__density_tolerance=0.05)))

    def run_ensemble(self, *arguments):
        return self.run_app("isostat", "ensemble", *arguments, "--no-figures")

    def ensemble(self, folder, *more):
        """Three members below a folder of this test."""
        self.assert_done(self.run_ensemble(self.scene, "-n", 3, "-o", folder, "-q", *more))

    def kept_ensemble(self, folder):
        """The same without more settings, made once."""
        if not (self.cache / "three").exists():
            self.ensemble(self.cache / "three")
        shutil.copytree(self.cache / "three", self.folder / folder)

    def assert_same_ensemble(self, one, other):
        self.assert_same_folders(one, other, ("provenance", "times.json", "checkpoint", "logs/", ".lock"))

    def test_same_bytes(self):
        """One after the other, two side by side, on the ranks of mpirun, and of a call that was killed."""
        self.kept_ensemble("one")
        self.ensemble("two", "-j", 2)
        self.assert_same_ensemble("one", "two")
        result = self.run_command(["mpirun", "--oversubscribe", "-n", "3", *self.command(
            "isostat", "ensemble", self.scene, "-n", 3, "-o", "ranks", "-q", "--no-figures")])
        self.assert_done(result)
        self.assertEqual(result.stdout.count("3 of 3 finished"), 1, "one report")
        self.assert_same_ensemble("one", "ranks")
        for with_signal, code, member in ((signal.SIGKILL, -signal.SIGKILL, "00"), (signal.SIGTERM, 130, "01")):
            started = (self.folder / f"killed/members/{member}/checkpoint/last.h5", False)
            self.assertEqual(self.run_and_stop(0.05, with_signal, started, "ensemble", self.scene, "-n", 3, "-o",
                                               "killed", program="isostat"), code)
        self.assertFalse((self.folder / "killed/members/02/summary.json").exists())
        self.ensemble("killed")
        self.assert_same_ensemble("one", "killed")

    def test_members_and_bands(self):
        """Members are the runs of their seeds; every number and band is that of their files."""
        self.kept_ensemble("few")
        before = (self.folder / "few/members/01/history.h5").stat().st_mtime_ns
        self.assert_done(self.run_ensemble(self.scene, "-n", 5, "-o", "few", "-q"))
        self.assertEqual((self.folder / "few/members/01/history.h5").stat().st_mtime_ns, before, "kept")
        self.assert_done(self.run_column(self.scene, "-o", "alone", "-q", *settings(layer__0__realisation=3)))
        self.assertEqual((self.folder / "few/members/03/history.csv").read_bytes(),
                         (self.folder / "alone/history.csv").read_bytes())
        few, members = self.folder / "few", [self.folder / f"few/members/{k:02d}" for k in range(5)]
        profiles = {}
        for name in ("peak_ru", "peak_gamma", "peak_acceleration"):
            profiles[name] = []
            for member in members:
                with h5py.File(member / "profiles.h5") as file:
                    profiles[name].append(file[name][()])
        bands = {kind: columns(few / f"bands_{kind}.csv")
                 for kind in ("points", "nodes", "grains", "spectra", "history")}
        spectra = [columns(member / "spectra.csv")["surface_x_SA"] for member in members]
        time = bands["history"]["time"]
        histories = {name: [np.interp(time, rows["time"], rows[name]) for rows in
                            (columns(member / "history.csv") for member in members)]
                     for name in ("surface_ax", "max_ru")}
        for kind, name, values in (("points", "max_ru", profiles["peak_ru"]),
                                   ("points", "max_gamma", profiles["peak_gamma"]),
                                   ("nodes", "max_acceleration", profiles["peak_acceleration"]),
                                   ("spectra", "surface_Sa", spectra),
                                   ("history", "surface_ax", histories["surface_ax"]),
                                   ("history", "max_ru", histories["max_ru"])):
            self.assertGreater(np.std(values, axis=0).max(), 1e-4, f"{name}: members differ")
            for column, expected in (("mean", np.mean(values, axis=0)), ("p16", np.percentile(values, 16, axis=0)),
                                     ("p50", np.median(values, axis=0)), ("p84", np.percentile(values, 84, axis=0))):
                self.assert_close(bands[kind][f"{name}_{column}"], expected, DIGITS, "ten digits of the tables")
        index = [[rows[f"p{k}_IR"] for k in range(3)] for rows in
                 (columns(member / "grain_profiles/history.csv") for member in members)]
        self.assert_close(bands["grains"]["final_I_R_mean"], np.mean([[p[-1] for p in each] for each in index], axis=0),
                          DIGITS, "ten digits of the tables")
        found = columns(few / "members.csv")
        thick = np.sum(np.array(profiles["peak_ru"]) > 0.95, axis=1)  # elements of one metre
        self.assertGreater(thick.max(), 0)
        self.assert_near(found["liquefied_thickness"], thick, DIGITS, "ten digits of the tables")
        arias = [np.pi / (2 * 9.80665) * np.trapz(rows["surface_ax"]**2, rows["time"]) for rows in
                 (columns(member / "history.csv") for member in members)]
        self.assert_close(found["arias_intensity"], arias, DIGITS, "ten digits of the tables")
        told = self.summary_of("few", "ensemble.json")
        self.assertEqual((told["members"], told["asked"]), (5, 5))
        self.assert_close(told["numbers"]["arias_intensity"]["standard_error"],
                          np.std(arias, ddof=1) / np.sqrt(5), DIGITS, "ten digits of the tables")
        self.check_summary(few, found)

    def check_summary(self, folder, found):
        """Names and units as in the summary of a run; a record of each call."""
        text = (folder / "summary.txt").read_text(encoding="utf-8")
        for label, name, factor in (("peak surface (m/s2)", "peak_surface", 1),
                                    ("peak shear strain (%)", "peak_gamma", 100),
                                    ("largest r_u (-)", "max_ru", 1), ("settlement (mm)", "settlement", 1000),
                                    ("S_a(0.3 s) of surface (m/s2)", "surface_Sa_0.3s", 1),
                                    ("liquefied thickness (m)", "liquefied_thickness", 1)):
            row = next(line for line in text.splitlines() if line.startswith(f"  {label} "))
            self.assert_close(float(row[32:].split()[0]), factor * np.mean(found[name]), 1e-3,
                              "four digits of the table")
            self.assertEqual(row.split()[-1], "5")
        self.assertNotIn("the same packings", text)
        calls = (folder / "provenance.txt").read_text(encoding="utf-8").split("\n\n")
        self.assertEqual([re.search(r"-n (\d)", call)[1] for call in calls], ["3", "5"])

    def test_two_members_have_no_band(self):
        self.assert_done(self.run_app("isostat", "ensemble", self.scene, "-n", 2, "-o", "two", "-q"))
        told = self.summary_of("two", "ensemble.json")["numbers"]["peak_surface"]
        self.assertEqual((told["n"], told["p16"], told["p84"]), (2, None, None))
        self.assertEqual(told["p50"], told["mean"])
        bands = columns(self.folder / "two/bands_spectra.csv")
        self.assertTrue(np.isnan(bands["surface_Sa_p16"]).all() and np.isfinite(bands["surface_Sa_p50"]).all())
        self.assertIn("no percentiles           of n = 2",
                      (self.folder / "two/summary.txt").read_text(encoding="utf-8"))
        for name in ("profiles", "redundancy", "spectra", "histories", "numbers"):
            self.assertGreater((self.folder / f"two/figures/fig_ensemble_{name}.png").stat().st_size, 10000)

    def test_members_with_the_same_packings_count_once(self):
        """Four draws of two seeds for one block: two of them at least are alike, bit for bit."""
        self.assert_done(self.run_ensemble(self.scene, "-n", 4, "-o", "out", "-q", *settings(
            layer__0__mixed_realisations=2, layer__0__lot_length="3 m")))
        rows = table(self.folder / "out/members.csv")
        same = {name: of for name, of in zip(rows["member"], rows["same_as"]) if of}
        self.assertGreaterEqual(len(same), 2)
        for name, of in same.items():
            self.assertEqual((self.folder / f"out/members/{name}/history.csv").read_bytes(),
                             (self.folder / f"out/members/{of}/history.csv").read_bytes())
        told = self.summary_of("out", "ensemble.json")
        self.assertEqual((told["members"], told["differing"]), (4, 4 - len(same)))
        self.assertEqual(told["numbers"]["peak_surface"]["n"], 4 - len(same))
        text = (self.folder / "out/summary.txt").read_text(encoding="utf-8")
        for name, of in same.items():
            self.assertIn(f"{name} as {of}", text)
        self.assertIn(f"they count once, n = {4 - len(same)}", text)

    def test_validate_checks_every_member(self):
        result = self.run_ensemble(self.scene, "-n", 3, "--validate")
        self.assert_done(result)
        self.assertIn("# 02: layer.0.realisation = 2", result.stdout)
        self.write("again.toml", result.stdout)
        self.assert_done(self.run_column("again.toml", "--validate"))
        scene = self.write_records()
        two = ("--records", "first.txt,second.txt", "--validate")
        self.assertIn("# r01: record", self.run_ensemble(scene, *two).stdout)
        both = self.write("both.toml", self.scene.read_text(encoding="utf-8").replace(
            'kind = "harmonic"\namplitude = "0.6 g"\nfrequency = "5 Hz"\nduration = "0.4 s"',
            'kind = "record"\nfile = "first.txt"\nunit = "m/s2"'))
        self.assertEqual(re.findall(r"^# (r\w+): layer.0.realisation = (\d) record .*/(\w+).txt$",
                                    self.run_ensemble(both, "-n", 2, *two).stdout, re.M),
                         [("r00_00", "0", "first"), ("r00_01", "1", "first"), ("r01_00", "0", "second"),
                          ("r01_01", "1", "second")])
        for records, parts in (("first.txt,first.txt", ("file 1 of 2", "appears twice")),
                               ("first.txt,", ("file 2 of 2", "has no name"))):
            self.assert_refused(self.run_ensemble(scene, "--records", records, "--validate"), *parts)
        (self.folder / "second.txt").write_text("0 1\nno number\n", encoding="utf-8")
        self.assert_refused(self.run_ensemble(scene, *two), "second.txt")
        self.assertFalse((self.folder / "results").exists())

    def sources(self, name):
        """Specimens of the library that packings in situ came from."""
        with h5py.File(self.cache / name) as file:
            return [str(entry["provenance"].attrs["source"]) for entry in file.values()
                    if "provenance" in entry]

    def test_depths_with_packings_of_their_own(self):
        """At random: another member draws again; several at a point differ. Otherwise all depths have the same."""
        mixed = settings(layer__0__mixed_realisations=5, grains__realisations=2, grains__cache=self.cache / "mixed.h5",
                         analysis__duration="0.01 s")
        self.ensemble("mixed", *mixed)
        drawn = [sorted(self.sources(f"mixed_{member}.h5")) for member in ("00", "01", "02")]
        for sources in drawn:
            self.assertEqual(len(sources), 6, "two packings at three depths")
            self.assertGreater(len(set(sources)), 2, "of several seeds")
        self.assertGreater(len({tuple(sources) for sources in drawn}), 1)
        scene = (self.folder / "mixed/scenes/02.toml").read_text(encoding="utf-8")
        self.assertIn("lot = 2", scene)
        self.assertIn("realisation = 0", scene)
        blocks = [word.replace("mixed.h5", "blocks.h5") for word in mixed] + settings(layer__0__lot_length="3 m")
        self.assert_done(self.run_column(self.scene, "-o", "blocks", "-q", *blocks))
        sources = self.sources("blocks.h5")
        self.assertEqual((len(sources), len(set(sources))), (6, 2), "one draw for all three depths")
        same = settings(grains__cache=self.cache / "same.h5", analysis__duration="0.01 s")
        self.assert_done(self.run_column(self.scene, "-o", "same", "-q", *same))
        self.assertEqual(len(set(self.sources("same.h5"))), 1, "one seed at all depths")

    def test_a_density_far_from_its_limits(self):
        """Packings are taken as the library has them; the summary says that they cannot be."""
        shutil.copy(self.cache / "library.h5", self.folder / "loose.h5")
        with h5py.File(self.folder / "loose.h5", "r+") as file:
            for entry in file.values():
                entry["numbers"].attrs["relative_density"] = -0.5
        result = self.run_column(self.scene, "-o", "out", "-q", *settings(
            grains__library=self.folder / "loose.h5", layer__0__relative_density=-0.5, analysis__duration="0.01 s"))
        self.assert_done(result)
        for text in result.stderr, (self.folder / "out/summary.txt").read_text(encoding="utf-8"):
            self.assertIn("warning: layer.0.relative_density = -0.5: far looser than e_max", text)

    def write_records(self):
        time = np.arange(0, 0.5, 0.005)
        for name, frequency in (("first", 4), ("second", 7)):
            self.write(f"{name}.txt", "\n".join(f"{t:.3f} {np.sin(2 * np.pi * frequency * t):.6f}" for t in time))
        return self.write("sand.toml", SAND)

    def test_slopes_that_packings_cannot_bear(self):
        """Refused before the preparation where no friction would do, else after that of the packing most sheared."""
        for angle, parts in (("30 deg", ("slope.angle = 30 deg", "layer.0", "at a depth of", "more than 60 deg")),
                             ("26 deg", ("rve: layer.0, depth 2.5 m:", "not reached", "may be too steep"))):
            self.assert_refused(self.run_column(self.scene, "-o", "out", "-q", *settings(
                slope__angle=angle, layer__0__k0=1)), *parts)

    def test_boxes(self):
        """Motions instead of packings: how the surface moves, and r_u at the scene's depths, are compared."""
        self.write_records()
        box = SAND.replace('water.drainage = "undrained"', """water.drainage = "coupled"
output.depths = ["1 m", "2 m"]
mesh.dimension = 2
mesh.width = "6 m"
mesh.cells_across = 3
mesh.sides = "walls"
mesh.ground_x = ["0 m", "6 m"]
mesh.ground_z = ["4 m", "3 m"]""").replace("density =", 'permeability = "1e-4 m/s"\ndensity =')
        self.assert_done(self.run_app("isostat", "ensemble", self.write("box.toml", box), "--records",
                                      "first.txt,second.txt", "-j", 0, "-o", "out", "-q"))
        shared = settings(mesh__distributed="true")
        self.assert_refused(self.run_ensemble("box.toml", "--records", "first.txt", *shared), "distributed = true")
        rows = table(self.folder / "out/members.csv")
        self.assertEqual((rows["member"], rows["record"]), (["r00", "r01"], ["first.txt", "second.txt"]))
        self.assertNotEqual(*rows["peak_surface"])
        for k, member in enumerate(("r00", "r01")):
            summary = self.summary_of(f"out/members/{member}")
            for key in ("along_x", "largest", "settlement", "heave"):
                self.assert_close(float(rows[f"surface_{key}"][k]), summary["surface_motion"][key], 1e-9,
                                  "ten digits of a table for people")
        with open(self.folder / "out/bands_history.csv", encoding="utf-8") as file:
            head = file.readline()
        for name in ("surface_ux_mean", "d0_ru_mean", "d1_ru_p50"):
            self.assertIn(name, head)
        for name in ("ru", "histories"):
            self.assertGreater((self.folder / f"out/figures/fig_ensemble_{name}.png").stat().st_size, 10000)
        self.assertIn("2 of 2 have finished", (self.folder / "out/report.html").read_text(encoding="utf-8"))

    def test_refusals(self):
        def refused(scene, *arguments, parts=(), run=self.run_ensemble):
            self.assert_refused(run(scene, "-o", "out", *arguments), *parts)
            self.assertFalse((self.folder / "out").exists())
        sand = self.write_records()
        refused(sand, "-n", 2, parts=("-n 2", "without a layer of grains", "--records"))
        refused(sand, "--records", "first.txt,none.txt", parts=("none.txt",))
        refused(self.scene, "--records", "first.txt", parts=("exactly one [[motion]]", "record"))
        refused(self.scene, "-n", 7, parts=("member 06", "realisation = 6", "6 realisations", "needs 7", "--append"))
        refused(self.scene, "-n", 4, *settings(grains__realisations=2), parts=("6 realisations", "needs 8"))
        refused(self.scene, "--jobs", 2, parts=("-n and --records are missing",))
        refused(SCENES / "terzaghi.toml", "-n", 2, parts=("analysis.kind", "consolidation"))
        own = SAND.replace('"iwan"', '"user"')
        own = self.write("own.toml", re.sub("(shear_velocity|reference_pressure).*", "", own))
        refused(own, "--records", "first.txt", parts=("layer.0.material", "isostat.column.run()"))
        all_seeds = settings(layer__0__mixed_realisations=2, grains__realisations=2)
        refused(self.scene, "-n", 2, *all_seeds, parts=("every point has all seeds", "mixed_realisations"))
        for run, more in (self.run_ensemble, ("-n", 2)), (self.run_column, ()), (self.run_column, ("--validate",)):
            refused(self.scene, *more, *settings(layer__0__mixed_realisations=8, layer__0__realisation=1), run=run,
                    parts=("layer.0.realisation = 1, layer.0.mixed_realisations = 8", "6 realisations", "needs 9"))
        refused(self.scene, *settings(layer__0__mixed_realisations=2, grains__realisations=3), run=self.run_column,
                parts=("layer.0.mixed_realisations", "at least grains.realisations, 3"))
        self.kept_ensemble("out")
        self.assert_refused(self.run_ensemble(self.scene, "-n", 3, "-o", "out",
                                              *settings(motion__0__amplitude="0.5 g")), "another scene", "amplitude")
        (self.folder / "own").mkdir()
        for name in ("scene.toml", "thesis.txt"):
            self.write(f"own/{name}", self.scene.read_text(encoding="utf-8"))
        before = contents(self.folder / "own")
        self.assert_refused(self.run_ensemble(self.scene, "-n", 2, "-o", "own", "--overwrite"),
                            "holds no provenance.txt and may not be a results folder")
        self.assertEqual(contents(self.folder / "own"), before)

    def test_a_member_that_fails(self):
        """The others are kept and compared; the message names the member and why."""
        arguments = (self.write_records(), "--records", "first.txt,second.txt", "-o", "out", "-q")
        self.assert_done(self.run_ensemble(*arguments))
        whole = (self.folder / "out/summary.txt").read_text(encoding="utf-8")
        kept = self.folder / "out/members/r01"

        def assert_failed(*parts):
            result = self.run_ensemble(*arguments)
            self.assertEqual(result.returncode, 1, result.stderr)
            for part in ("1 of 2 members failed", "r01", *parts):
                self.assertIn(part, result.stderr)
            self.assertIn("1 of 2 finished", (self.folder / "out/summary.txt").read_text(encoding="utf-8"))

        profiles = (kept / "profiles.h5").read_bytes()
        (kept / "profiles.h5").write_bytes(profiles[:1000])
        assert_failed("out/members/r01: is damaged", "Remove it")
        shutil.rmtree(kept)
        kept.mkdir()
        (kept / "thesis.txt").write_text("mine", encoding="utf-8")
        assert_failed("exit code 2", "holds no results", "the same command tries again")
        (kept / "thesis.txt").unlink()
        self.assert_done(self.run_ensemble(*arguments))
        (kept / "summary.json").unlink()
        for file in (kept / "checkpoint").iterdir():
            file.write_bytes(b"no checkpoint")  # it begins again
        self.assert_done(self.run_ensemble(*arguments))
        self.assertEqual((self.folder / "out/summary.txt").read_text(encoding="utf-8"), whole)
