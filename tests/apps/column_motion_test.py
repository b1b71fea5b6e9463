# SPDX-License-Identifier: BSD-3-Clause
"""What soil_column reports of the motion of a surface that rings: rows, spectra, shares, depths, against every step."""

import h5py
import numpy as np

from column_support import SCENES, ColumnTest, history, settings
from figures.column_analysis import response_spectrum
from figures.column_results import Column
from figures.common import read_history


class SurfaceMotion(ColumnTest):
    def run_scene(self, name, *options):
        self.assert_done(self.run_column(SCENES / "recorded_motion.toml", "-o", name, "--quiet", *options))
        folder = self.folder / name
        return self.summary_of(name), history(folder), folder

    def test_rows_and_spectra_are_those_of_every_step(self):
        """Rows every 10 ms against those of every step: no ringing, no aliases, spectra of every step."""
        short = settings(analysis__duration="6 s")
        summary, rows, folder = self.run_scene("rows", *short)
        dt = summary["time_step"]
        stride = round(0.01 / dt)
        self.assert_near(rows["time"], 0.01 * np.arange(601), 1e-12, "the time step divides the interval: round-off")
        every = self.run_scene("every", *short, *settings(output__history_interval="0.001 ms",
                                                          analysis__time_step=f"{dt!r} s"))[1]
        k = np.arange(-6 * stride, 6 * stride + 1)
        weights = np.sinc(0.75 * k / stride) * np.kaiser(2 * (6 * stride + 1) + 1, 4.53)[1:-1]
        for name in ("surface_ax", "surface_ay", "base_ax", "input_ay"):
            means = np.convolve(every[name], weights / weights.sum(), "same")[::stride]
            self.assert_close(rows[name][:-6], means[:len(rows[name]) - 6], 1e-9, "digits of the file")
        self.assert_close(np.hypot(every["surface_ax"], every["surface_ay"]).max(), summary["peak_surface"], 1e-9,
                          "digits of the file")
        spectra = read_history(folder / "spectra.csv")
        for axis in "xy":
            for where in ("input", "surface"):
                for name, pseudo in (("SA", False), ("PSA", True)):
                    expected = response_spectrum(every[f"{where}_a{axis}"], dt, spectra["period"], 0.05, pseudo)
                    self.assert_close(spectra[f"{where}_{axis}_{name}"], expected, 2e-3 if where == "surface" else 2e-2,
                                      "crests between steps of T/64; of the input the steps are not its own samples")
        total = sum((every[f"surface_a{axis}"] ** 2).sum() for axis in "xy")
        power = sum(np.abs(np.fft.rfft(every[f"surface_a{axis}"])) ** 2 for axis in "xy")
        f = np.fft.rfftfreq(len(every["time"]), dt)
        share = (power[1:-1] * (1 - 1 / (1 + (f[1:-1] / 25) ** 8))).sum() * 2 / len(every["time"]) / total
        print(f"above 25 Hz: {100 * summary['share_above']:.1f} % of the squared acceleration")
        self.assert_near(summary["share_above"], share, 0.01, "warping of the bilinear transformation, and the ends")
        self.assert_below(summary["share_above"], 0.2, "71 % without viscosity")
        ringing = self.run_scene("ringing", *short, *settings(analysis__viscosity="0 ms"))[0]
        self.assertGreater(ringing["share_above"], 0.4)

    def test_depths_are_those_of_the_data(self):
        summary, rows, folder = self.run_scene("depths", *settings(
            analysis__duration="0.5 s", output__depths='["1.4 m", "5.2 m"]', output__profile_interval="0.01 s"))
        with h5py.File(folder / "profiles.h5") as file:
            depths = file["depth"][()]
            for k, asked in enumerate((1.4, 5.2)):
                nearest = depths[np.argmin(np.abs(depths - asked))]
                self.assertNotEqual(nearest, asked)
                self.assert_near(rows[f"d{k}_depth"], nearest, 1e-9, "digits of the file")
                self.assert_near(summary["depths"][k], nearest, 1e-12, "digits of the file")
                self.assert_near(Column(folder).points[k][0], nearest, 1e-9, "digits of the file")
                self.assert_close(file["tau_xz"][:, np.argmin(np.abs(depths - asked))], rows[f"d{k}_tau_xz"], 1e-12,
                                  "the same values")


class Records(ColumnTest):
    """Times and units of records, whose values are read from the history and the summary of a short run."""
    LAYER = """[water]
drainage = "dry"
[[layer]]
thickness = "10 m"
cells = 10
density = "1900 kg/m3"
material = "elastic"
shear_velocity = "200 m/s"
[output]
history_interval = "0.005 s"
"""
    DT = 0.02
    SIGNAL = [0.2 * np.sin(2 * np.pi * 2.5 * t * 0.02) * np.sin(np.pi * t / 200) ** 2 for t in range(201)]  # g

    def table(self, name, start, values=None, header=""):
        rows = [f"{start + self.DT * i:.2f} {a:.8f}" for i, a in enumerate(self.SIGNAL if values is None else values)]
        self.write(name, (header or "time (s), a (g)\n") + "\n".join(rows) + "\n")

    def run_motions(self, *motions, duration="7 s", name="run"):
        text = self.LAYER + "".join(f'[[motion]]\naxis = "{axis}"\n{keys}\n' for axis, keys in motions)
        return self.rows_of(text + f'[analysis]\nduration = "{duration}"\n', name)

    @staticmethod
    def record(name, more=""):
        return f'kind = "record"\nfile = "{name}"\n{more}'

    def test_two_records_have_one_clock(self):
        once = 9.80665 * np.array(self.SIGNAL)
        for k, (x, y) in enumerate(((0, 2), (-1, 1), (-3, -5))):
            self.table("x.txt", x)
            self.table("y.txt", y)
            rows, summary = self.run_motions(("x", self.record("x.txt")), ("y", self.record("y.txt")), name=f"run{k}")
            for axis, later in (("x", max(0, x - y)), ("y", max(0, y - x))):
                expected = np.interp(rows["time"] - later, self.DT * np.arange(201), once, 0, 0)
                self.assert_close(rows[f"input_a{axis}"], expected, 5e-3 * once.max(),
                                  "rows are means over 12 intervals of 5 ms, of a signal of 2.5 Hz")
            notes = [w for w in summary["warnings"] if "of its own times" in w]
            self.assertEqual(len(notes), 0 if min(x, y) == 0 else 1, summary["warnings"])

    def test_warnings(self):
        self.table("short.txt", 0)
        _, summary = self.run_motions(("x", self.record("short.txt")), duration="0.6 s", name="short")
        self.assertEqual(len(summary["warnings"]), 1, summary["warnings"])
        self.assertIn("ends at 0.6 s, before the motion along x, which lasts until 3.98 s", summary["warnings"][0])
        self.table("drift.txt", 0, [a + 0.1 for a in self.SIGNAL])
        _, summary = self.run_motions(("x", self.record("drift.txt")), duration="4.1 s", name="drift")
        self.assertEqual(len(summary["warnings"]), 1, summary["warnings"])
        self.assertRegex(summary["warnings"][0],
                         r"along x ends 7\.\S+ m from where it began.*baseline drifts.*baseline = ")
        _, summary = self.run_motions(("x", self.record("drift.txt", 'baseline = "quadratic"')), duration="4.1 s",
                                      name="level")
        self.assertEqual(summary["warnings"], [])
        rows, summary = self.run_motions(("x", self.record("drift.txt", 'baseline = "quadratic"')), name="given",
                                         duration='4.1 s"\ntime_step = "0.3 ms')
        self.assertEqual(len(summary["warnings"]), 1, summary["warnings"])
        self.assertRegex(summary["warnings"][0], r"0\.005 s is 16\.6667 of the time step, .*: rows are 0\.0051 s apart")
        self.assert_near(rows["time"][1], 0.0051, 1e-12, "round-off")

    def test_a_sine_that_starts_at_once_drifts(self):
        """It ends at rest, but far away: its velocity A/omega (1 - cos omega t) has a mean."""
        sine = 'kind = "harmonic"\namplitude = "0.1 g"\nfrequency = "2 Hz"\nduration = "4 s"\n'
        _, summary = self.run_motions(("x", sine), duration="4 s", name="sine")
        self.assertEqual(len(summary["warnings"]), 1, summary["warnings"])
        self.assertRegex(summary["warnings"][0], r"along x ends 0\.312 m from where it began.*motion\.0\.ramp")
        _, summary = self.run_motions(("x", sine + 'ramp = "1 s"\n'), duration="4 s", name="ramp")
        self.assertEqual(summary["warnings"], [])

    def test_two_columns_without_a_unit(self):
        self.table("bare.txt", 0, header="# time, acceleration\n")
        scene = self.LAYER + '[[motion]]\n{}[analysis]\nduration = "0.1 s"\n'
        self.assert_refused(self.run_column(self.write("bare.toml", scene.format(self.record("bare.txt"))), "-o", "no"),
                            "bare.txt:1", "motion.unit", "m/s2")
        self.rows_of(scene.format(self.record("bare.txt", 'peak = "0.2 g"\n')), "scaled")
