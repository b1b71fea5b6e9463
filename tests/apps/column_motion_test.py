#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What soil_column tells of the motion of a surface that rings: rows, spectra, shares, depths, against every step."""
import json
import pathlib
import sys

import h5py
import numpy as np

from column_support import SCENES, ColumnTest, history, settings
from support import main

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "apps"))
from figures.column_analysis import response_spectrum  # noqa: E402  (the path comes first)
from figures.column_results import Column  # noqa: E402
from figures.common import read_history  # noqa: E402


class SurfaceMotion(ColumnTest):
    def run_scene(self, name, *options):
        self.assert_done(self.run_column(SCENES / "recorded_motion.toml", "-o", name, "--quiet", *options))
        folder = self.folder / name
        return json.loads((folder / "summary.json").read_text(encoding="utf-8")), history(folder), folder

    def test_rows_and_spectra_are_those_of_every_step(self):
        """Rows every 10 ms against those of every step: no ringing, no aliases, spectra of every step."""
        short = settings(analysis__duration="6 s")
        summary, rows, folder = self.run_scene("rows", *short)
        every = self.run_scene("every", *short, *settings(output__history_interval="0.001 ms"))[1]
        dt = summary["time_step"]
        stride = round(0.01 / dt)
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
                expected = response_spectrum(every[f"{where}_a{axis}"], dt, spectra["period"])
                self.assert_close(spectra[f"{where}_{axis}"], expected, 2e-3 if where == "surface" else 2e-2,
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
            analysis__duration="0.5 s", output__depths='["1.4 m", "5 m"]', output__profile_interval="0.01 s"))
        with h5py.File(folder / "profiles.h5") as file:
            depths = file["depth"][()]
            for k, asked in enumerate((1.4, 5.0)):
                nearest = depths[np.argmin(np.abs(depths - asked))]
                self.assertNotEqual(nearest, asked)
                self.assert_near(rows[f"d{k}_depth"], nearest, 1e-9, "digits of the file")
                self.assert_near(summary["depths"][k], nearest, 1e-12, "digits of the file")
                self.assert_near(Column(folder).points[k][0], nearest, 1e-9, "digits of the file")
                self.assert_close(file["tau_xz"][:, np.argmin(np.abs(depths - asked))], rows[f"d{k}_tau_xz"], 1e-12,
                                  "the same values")


if __name__ == "__main__":
    main()
