# SPDX-License-Identifier: BSD-3-Clause
"""What the summary of a drained test says of strength and dilatancy, against its history."""

import numpy as np

from report_support import page
from support import AppTest, columns, tiny_scene

STAGES = ('[[stage]]\nkind = "drained"\nstrain = 0.02\nstrain_rate = "1 1/s"\n'
          '[[stage]]\nkind = "constant-p"\ndirection = "extension"\nstrain = 0.01\nstrain_rate = "1 1/s"\n')


class DrainedReport(AppTest):
    def test_strength_in_history_summary_and_figure(self):
        self.result = self.run_test(self.write("scene.toml", tiny_scene(stages=STAGES)), "-o", "run")
        self.assert_done(self.result)
        self.numbers = self.summary_of("run")
        self.history = columns(self.folder / "run/history.csv")
        self.check_strength()
        self.check_summary_and_figure()

    def check_strength(self):
        """That of the history."""
        h = self.history
        self.assertEqual([stage["stage"] for stage in self.numbers["drained"]], [0, 1])
        for stage in self.numbers["drained"]:
            rows = h["stage"] == stage["stage"]
            ratio = (h["q"] / h["p"])[rows]
            volume = (h["eps_x"] + h["eps_y"] + h["eps_z"])[rows]
            peak = ratio[np.argmax(abs(ratio))]
            self.assert_close(stage["q_over_p_peak"], peak, 0.05, "a mean over 1 % of the strain, a row scatters more")
            sine = 3 * abs(stage["q_over_p_peak"]) / (6 + stage["q_over_p_peak"])
            self.assert_close(stage["friction_peak_deg"], np.degrees(np.arcsin(sine)), 1e-6, "digits of the file")
            self.assert_near(stage["eps_v_end"], volume[-1], 1e-12, "digits of the file")
            self.assert_near(stage["eps_v_max"], volume.max(), 1e-12, "digits of the file")
        self.assertIsNotNone(self.numbers["drained"][0]["dilatancy_deg"])
        self.assertIsNone(self.numbers["drained"][1]["dilatancy_deg"], "of compression alone")

    def check_summary_and_figure(self):
        for name in ("peak friction", "end friction", "largest dilatancy", "volumetric strain"):
            self.assertIn(f"  {name:<25}", self.result.stdout)
        report = page(self.folder / "run", "fig_dilatancy")
        self.assertTrue((self.folder / "run/figures/fig_dilatancy.png").stat().st_size > 10000)
        for part in ("peak friction", "fig_dilatancy"):
            self.assertIn(part, report)
