# SPDX-License-Identifier: BSD-3-Clause
"""The quick form of isostat study sand_calibration, some ten minutes on two cores: opened packings are what the page
says. Not part of the usual tests: ctest --preset long."""
import csv
import subprocess
import tempfile
import unittest

from support import BIN, ROOT


class QuickForm(unittest.TestCase):
    def test_opened_packings_yield_early_and_collapse(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([BIN / "isostat", "study", "sand_calibration", "--quick", "-q", "-o", folder], check=True,
                           cwd=ROOT)

            def rows(name):
                with open(f"{folder}/tables/{name}.csv", encoding="utf-8") as file:
                    return list(csv.DictReader(file))

            dense = {row["label"]: row for row in rows("variants") if row["contact"] == "compacted"}
            closed, opened = dense["4 deg, expansion 0"], dense["4 deg, expansion 0.02"]
            for name, factor in (("Z", 0.75), ("q at 0.2 % (kPa)", 0.6), ("least p' (kPa)", 0.6)):
                self.assertLess(float(opened[name]), factor * float(closed[name]), name)
            self.assertEqual(len(rows("cyclic")), 22 + 4, "opened; of compacted packings those that are known")
            loose = [row for row in rows("cyclic") if float(row["D_r"]) < 0.4]
            self.assertTrue(all(float(row["median of seeds"]) < 5 for row in loose), "the sand takes 5 and 72")
