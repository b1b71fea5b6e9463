# SPDX-License-Identifier: BSD-3-Clause
"""What an engineer takes out of a shaken column, each against a computation of its own: from a run that records every
step, in the frequency domain, by hand."""
import json
import pathlib
import re
import shutil
import subprocess
import tempfile
from unittest import mock

import h5py
import numpy as np

from column_support import SCENES, SOIL, ColumnTest, history, settings
from figures import column_soil, site_response
from figures.column_results import Column
from figures.common import BadInput, plt, read_history
from figures.drawing import pages_of
from figures.soil_column import DRAWING
from report import run
from support import BIN, TIME_LIMIT

ROCK = settings(base__kind="compliant", base__density="2300 kg/m3", base__shear_velocity="800 m/s")
STEP = 0.0005  # s
LINES = "output.depths=[\"1 m\", \"3 m\", \"5 m\"]"


class SiteResponse(ColumnTest):
    """Sand and clay with rows every 10 ms, elastic layers with rows every 5 ms; both again with rows of every step."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.runs = pathlib.Path(tempfile.mkdtemp(prefix="isostat_response_"))
        cls.addClassCleanup(shutil.rmtree, cls.runs)
        (cls.runs / "soil.toml").write_text(SOIL, encoding="utf-8")
        more = [*ROCK, "--set", LINES, *settings(analysis__duration="4 s", analysis__time_step=f"{STEP} s")]
        cls.make("rows", cls.runs / "soil.toml", *more, *settings(output__profile_interval=f"{STEP} s"))
        cls.make("every", cls.runs / "soil.toml", *more, *settings(output__history_interval="0.001 ms"))
        pulse = SCENES / "two_layers_compliant.toml", *settings(analysis__time_step=f"{STEP} s")
        cls.make("elastic", *pulse)
        cls.make("elastic_every", *pulse, *settings(output__history_interval="0.001 ms"))
        cls.column, cls.elastic = Column(cls.runs / "rows"), Column(cls.runs / "elastic")
        cls.every, cls.elastic_every = history(cls.runs / "every"), history(cls.runs / "elastic_every")

    @classmethod
    def make(cls, name, scene, *options):
        command = [str(BIN / "soil_column"), str(scene), "-o", name, "-q", "--no-figures", *options]
        subprocess.run(command, cwd=cls.runs, check=True, capture_output=True, timeout=TIME_LIMIT)

    def test_profile_is_that_of_all_steps(self):
        table = read_history(self.runs / "rows/profile.csv")
        with h5py.File(self.runs / "rows/profiles.h5") as file:
            data = {name: file[name][()] for name in file}
        points = np.isfinite(table["gamma_max"])
        self.assertEqual(list(points), [False] + [True] * len(data["depth"]) + [False])
        shear = np.hypot(data["tau_xz"], data["tau_yz"])
        tau, calm = shear.max(axis=0), np.maximum.accumulate(data["ru"]) < 0.5
        demand = np.where(calm, shear, 0).max(axis=0)
        self.assertTrue((demand < tau).any())  # of sand that dilates after it has liquefied
        for name, expected in (("depth", data["depth"]), ("tau_max", tau), ("CSR", 0.65 * demand / data["sigma_v0"]),
                               ("tau_ratio", tau / data["sigma_v0"]), ("ru_max", data["ru"].max(axis=0)),
                               ("gamma_max", np.hypot(data["gamma_xz"], data["gamma_yz"]).max(axis=0))):
            self.assert_close(table[name][points], expected, 1e-9, "ten digits of the table")
        of_rows = np.hypot(self.column["d0_tau_xz"], self.column["d0_tau_yz"]).max()
        self.assertGreater(tau[np.argmin(np.abs(data["depth"] - self.column.points[0][0]))], of_rows)  # which are fewer
        sizes = {name: np.hypot(*(data[f"node_{what}_{axis}"] for axis in "xy")).max(axis=0)
                 for name, what in (("PGD", "displacement"), ("PGV", "velocity"))}
        for name, tolerance, reason in (("PGD", 1e-9, "ten digits of the table"),
                                        ("PGV", 1e-3, "rows have the mean of two half steps")):
            expected = np.interp(table["depth"], data["node_depth"], sizes[name])
            self.assert_close(table[name], expected, tolerance, reason)
        self.assert_close(table["PGA"][0], np.hypot(self.every["surface_ax"], self.every["surface_ay"]).max(), 1e-9,
                          "ten digits of the table")
        last = data["node_displacement_z"][-1]
        self.assert_near(table["settlement"], np.interp(table["depth"], data["node_depth"], last[-1] - last), 1e-6,
                         "the last profile is a step before the end")
        self.assertGreater(abs(table["settlement"][0]), 1e-4)

    def test_intensity(self):
        for where, axis in (("surface", "x"), ("input", "x"), ("within", "x"), (8.0, "x")):
            found = site_response.intensity_at(self.elastic, where, axis)
            a = self.elastic_every[{"within": "base", 8.0: "d0"}.get(where, where) + f"_a{axis}"]
            share = np.cumsum(a**2) / np.sum(a**2)
            inside = STEP * np.count_nonzero((share >= 0.05) & (share < 0.95))
            expected = {"PGA": np.abs(a).max(), "arias": np.pi / (2 * 9.80665) * STEP * np.sum(a**2), "D5_95": inside,
                        "CAV": STEP * np.abs(a).sum()}
            for name, value in expected.items():
                print(f"{name} at {where} along {axis}: error {found[name] / value - 1:+.1e}")
                self.assert_close(found[name], value, 2e-2, "crests between rows, 5 ms apart; the filter of the rows")

    def test_a_sine(self):
        """Of n whole cycles: A^2 T/2 and 2 A T/pi; 90 % of the time."""
        t = 0.001 * np.arange(10001)
        found = site_response.intensity(2 * np.sin(2 * np.pi * t), 0.001)
        for name, expected in (("PGA", 2), ("arias", np.pi / (2 * 9.80665) * 20), ("D5_95", 9), ("CAV", 40 / np.pi)):
            self.assert_close(found[name], expected, 2e-3, "D5-95 ends within a cycle; else the trapezoidal rule")

    def test_spectra_at_a_depth(self):
        """Absolute and pseudo-acceleration against oscillators in the frequency domain, from every step."""
        a, periods, xi = self.elastic_every["d0_ax"], np.array([0.05, 0.1, 0.2, 0.33, 0.6, 1.0, 2.0]), 0.05
        size = 2 ** int(np.ceil(np.log2(4 * len(a))))
        w, spectrum = 2 * np.pi * np.fft.rfftfreq(size, STEP), np.fft.rfft(a, size)
        _, absolute, pseudo = site_response.spectrum(self.elastic, 8.0, "x", periods)
        for period, sa, psa in zip(periods, absolute, pseudo):
            own = 2 * np.pi / period
            u = -spectrum / (own**2 - w**2 + 2j * xi * own * w)
            n = len(a) + int(period / STEP)
            for value, response in ((sa, (own**2 + 2j * xi * own * w) * u), (psa, own**2 * u)):
                expected = np.abs(np.fft.irfft(response, size)[:n]).max()
                print(f"T = {period} s: error {value / expected - 1:+.1e}")
                self.assert_close(value, expected, 5e-3, "straight lines between rows, crests between steps of T/64")
        self.assertGreater(np.abs(absolute / pseudo - 1).max(), 1e-3)  # they are two things

    def test_site(self):
        """Travel times by hand; the transfer functions of two elastic layers on rock by their waves."""
        column, site = self.elastic, site_response.site(self.elastic)
        time = 8 / 120 + 12 / 300
        for name, expected in (("period", 4 * time), ("V_s30", 30 / (time + 10 / 800)), ("mean_velocity", 20 / time)):
            self.assert_close(site[name], expected, 1e-9, "round-off")
        f = np.linspace(1, 9, 60)
        above, outcrop = two_layers(f)
        for over, expected in (("outcrop", 1 / np.abs(outcrop)), ("within", 1 / np.abs(above))):
            ratio = site_response.transfer(column, "x", over, f)[1]
            clear = expected < 6  # a peak is narrower than the smoothing
            error = np.abs(ratio / expected - 1)[clear].max()
            print(f"surface over {over}: error {error:.1e}")
            self.assert_below(error, 8e-2, "smoothing of peaks 5 % wide over 3 % of a frequency")
        fine = np.linspace(1, 2 / site["period"], 2000)
        f1 = fine[np.argmin(np.abs(two_layers(fine)[1]))]
        self.assert_close(site_response.first_frequency(column), f1, 1e-2, "400 frequencies, and their smoothing")

    def test_a_rigid_base_has_no_outcrop_and_shallow_soil_no_v_s30(self):
        column = Column(self.runs / "elastic")
        column.base = None
        self.assertIsNone(site_response.site(column)["V_s30"])
        with self.assertRaisesRegex(BadInput, "no outcrop motion"):
            site_response.transfer(column, "x", "outcrop")

    def test_at2_is_read_as_the_same_motion(self):
        """From `isostat motion` through motion.file to the input of another run."""
        for words, name in ((["--at", "3 m", "-o", "mine.at2"], "d1_ax"), ([], "surface_ax")):
            self.assert_done(self.run_app("isostat", "motion", self.runs / "rows", *words))
            path = self.folder / "mine.at2" if words else self.runs / "rows/surface_x.at2"
            scene = SOIL.split("[[motion]]")[0].replace("coupled", "dry") + (
                f'[[motion]]\naxis = "x"\nkind = "record"\nfile = "{path}"\n[analysis]\nduration = "4 s"\n'
                f'time_step = "{STEP} s"\n[output]\nhistory_interval = "0.001 ms"\n')
            rows, _ = self.rows_of(scene, f"again_{name}")
            expected = self.column[name]
            error = np.abs(rows["input_ax"][::round(0.01 / STEP)] - expected).max() / np.abs(expected).max()
            print(f"{name}: error {error:.1e}")
            self.assert_below(error, 1e-9, "ten digits of the record")
        self.write("scene.at2", "precious")
        for words, said in ((["-o", "scene.at2"], "scene.at2: exists and is not a file of this command. Give another"),
                            (["-o", "scene.toml"], "scene.toml: must end with .at2."),
                            (["-o", "none/a.at2"], "none/a.at2: cannot be written: there is no folder")):
            self.assert_refused(self.run_app("isostat", "motion", self.runs / "rows", *words), said)
        self.assert_refused(self.run_app("isostat", "motion", "none"), "none: does not exist. Give the results folder")
        for word, message in (("4 m", r"depth = 4 m: must be one of output.depths \(1 m, 3 m, 5 m\)"),
                              ("base", "--at base: must be surface, input, within or a depth"),
                              ("3", "--at 3: must be"), ("3 kPa", "--at 3 kPa: must be"),
                              ("surface", "axis = z: the run has no motion along it, but along x, y")):
            axis = "z" if word == "surface" else "x"
            refused = self.run_app("isostat", "motion", self.runs / "rows", "--at", word, "--axis", axis)
            self.assertEqual(refused.returncode, 2)
            self.assertRegex(refused.stderr, message)

    def test_resistance_and_report(self):
        """CSR against CRR where a layer has one; tables of layers, site and motions; no figure of what is zero."""
        folder = self.runs / "rows"
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        self.assertIsNone(site_response.resistance(self.column))
        summary["layers"][0]["crr"] = 0.12
        with mock.patch.dict(self.column.summary, summary):
            depth, csr, crr, safety = site_response.resistance(self.column)
            self.assertEqual(list(np.isfinite(safety)), list(depth < 3))
            self.assert_close(safety[0], 0.12 / csr[0], 1e-12, "round-off")
            self.assertEqual(set(crr[depth < 3]), {0.12})
            drawn = {name for name, draw in DRAWING.figures.items() if pages_of(draw(self.column))}
            plt.close("all")
            text = run.Page(run.Results(folder, "soil_column"), DRAWING).text(self.column, "")
        with mock.patch.dict(self.column.peak_profile, {"ru_max": np.full(len(depth) + 2, 0.49)}):
            self.assertGreater(site_response.first_frequency(self.column), 0)
        self.assertIsNone(site_response.first_frequency(self.column))  # sand liquefies
        self.assertIn("fig_liquefaction", drawn)
        self.assertNotIn("fig_expansion", drawn)
        for part in ("<td>sand</td>", "0 to 3", "input (outcrop)", "base (within)", "V_s30", "Arias intensity",
                     "Factor of safety", "multiply CRR by MSF", "resultant of x and y", "f1</th><td>not given",
                     "contraction 0.5", "hysteretic"):
            self.assertIn(part, text)
        self.assertEqual(re.findall(r"net expansion", text), [])

    def test_pages(self):
        """At most six depths each."""
        with mock.patch.object(column_soil, "MOST_DEPTHS", 2):
            pages = pages_of(DRAWING.figures["fig_loops"](self.column))
            shown = [[axes.get_title(loc="left") for axes in page.axes if axes.get_title(loc="left")] for page in pages]
        plt.close("all")
        self.assertEqual([len(titles) for titles in shown], [2, 1])
        self.assertIn("Shear loops", DRAWING.caption("fig_loops_2", set()))


def two_layers(f):
    """Motion within and twice the upgoing wave in the rock, of 1 at the surface of the scene two_layers_compliant:
    waves passed down from layer to layer, displacement and stress continuous; viscosity as exact_transfer() has it."""
    w = 2 * np.pi * f
    up, down = 0.5 + 0j * f, 0.5 + 0j * f
    layers = [(8, 120, 1700), (12, 300, 2000), (0, 800, 2300)]
    soft = 1 - 1e-4 * w**2 / (1j * w + 2 * np.pi * 25)
    for (height, velocity, density), (_, below, density_below) in zip(layers, layers[1:]):
        velocity, below = velocity * np.sqrt(soft), below * (np.sqrt(soft) if below < 800 else 1)
        turn = np.exp(1j * w / velocity * height)
        alpha = density * velocity / (density_below * below)
        up, down = (0.5 * up * (1 + alpha) * turn + 0.5 * down * (1 - alpha) / turn,
                    0.5 * up * (1 - alpha) * turn + 0.5 * down * (1 + alpha) / turn)
    return up + down, 2 * up
