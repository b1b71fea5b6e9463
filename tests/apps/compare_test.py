# SPDX-License-Identifier: BSD-3-Clause
"""The comparison of two runs."""
import contextlib
import io
import json
import os
import re
import shutil

import numpy as np
from matplotlib.colors import to_rgb

from figures.common import BadInput, Run, plt
from report import compare
from report.compare import change, flat
from report.compare_curves import LINES, caption_of_test, numbers_of_test, stress_curves
from report.quantities import SHOWN, converted, is_number, named
from report_support import SCENES, ReportTest
from support import BIN, CYCLIC, columns, contents

DRAINED = '[[stage]]\nkind = "drained"\nstrain = 0.001\nstrain_rate = "5 1/s"\n'
SHEAR = '[[stage]]\nkind = "undrained-cyclic-simple-shear"\nstress_ratio = 0.2\nmax_steps = 500\n'


class Compare(ReportTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.make_test("one", "--no-figures", stages=DRAINED)
        cls.make_test("other", "--no-figures", "--set", "contact.friction=25 deg", stages=DRAINED)
        cls.make_test("cyclic", "--no-figures", stages=CYCLIC.format(steps=3000), output="energy = true")

    def compare(self, first, second, output="compare.html"):
        """The page, made in this process."""
        path = self.folder / output
        with contextlib.redirect_stdout(io.StringIO()):
            compare.leave(self.folder / first, self.folder / second, path)
        return path.read_text(encoding="utf-8")

    def test_two_runs(self):
        self.assert_done(self.run_app("isostat", "compare", self.runs / "one", self.runs / "other"))
        text = (self.folder / "compare.html").read_text(encoding="utf-8")
        self.assert_one_file(text)
        for part in ("A: one wide light blue, B: other thin black.",
                     "<td>contact.friction</td><td>18 deg</td><td>25 deg</td>",
                     '<figure id="curves"', '<tr class="same"><td>grains</td>'):
            self.assertIn(part, text)
        q = columns(self.runs / "one/history.csv")["q"]
        self.assertIn(f'<td>peak q (kPa)</td><td class="number">{q[np.argmax(np.abs(q))] / 1e3:.6g}</td>', text)
        scene = re.search(r'id="scene">.*?</section>', text, re.S)[0]
        self.assertEqual(re.findall(r"<tr><td>([^<]*)", scene), ["contact.friction", "output.folder"])

    def test_units(self):
        """Those of the summary's text: 199.999 kPa for 199999 Pa, deg and Pa at the end of a name stand in brackets."""
        text = self.compare(self.runs / "one", self.runs / "other")
        p0 = json.loads((self.runs / "one/summary.json").read_text(encoding="utf-8"))["p0"]
        self.assertIn(f'<td>p0 (kPa)</td><td class="number">{p0 / 1e3:.6g}</td>', text)
        self.assertIn("<td>p_end (kPa)</td>", text)
        self.assertEqual(named("biaxial", "peak_stress_Pa"), "peak_stress (kPa)")
        self.assertEqual(converted("biaxial", "peak_stress_Pa", 2.5e5), 250)
        self.assertEqual(converted("soil_column", "settlement", None), None)

    def assert_listed(self, program, name):
        numbers = json.loads((self.runs / name / "summary.json").read_text(encoding="utf-8"))
        keys = {key for key, value in flat(numbers).items() if is_number(value) and not re.search(r"\.\d+\.", key)}
        self.assertEqual(keys - SHOWN[program].keys(), set(), "numbers without a unit in report/quantities.py")

    def test_every_number_has_its_unit(self):
        self.make_test("cell", "--no-figures", specimen='domain = "periodic-cell"\npreparation_friction = "10 deg"',
                       stages=SHEAR)
        programs = [("element_test", name) for name in ("one", "cell", "cyclic")]
        if (BIN / "soil_column").exists():
            for program, name, scene, *keys in (
                    ("soil_column", "column", "column/terzaghi", "analysis.steps=4"),
                    ("soil_column", "shaken", "column/recorded_motion", "analysis.duration=1 s"),
                    ("soil_column", "block", "biaxial/iwan", "analysis.load_steps=2", "analysis.axial_strain=0.001"),
                    ("soil_column", "plate", "column/plate_wall", "mesh.cells_across=12", "layer.0.cells=3",
                     "analysis.load_steps=1")):
                self.make(program, name, SCENES / f"{scene}.toml", "--no-figures",
                          *(word for key in keys for word in ("--set", key)))
                programs.append(("biaxial" if name == "block" else program, name))
        for program, name in programs:
            self.assert_listed(program, name)

    def test_with_itself(self):
        before = contents(self.runs / "one")
        text = self.compare(self.runs / "one", self.runs / "one", "same.html")
        self.assertIn("Every key of the scenes is the same.", text)
        self.assertNotIn("differs", text)
        self.assertEqual(contents(self.runs / "one"), before)

    def test_a_run_of_python(self):
        shutil.copytree(self.runs / "one", self.folder / "notebook")
        path = self.folder / "notebook/provenance.txt"
        text, n = re.subn(r"(?m)^(command +).*$", r"\1isostat.run() in Python", path.read_text(encoding="utf-8"))
        self.assertEqual(n, 1)
        path.write_text(text, encoding="utf-8")
        self.compare(self.runs / "one", "notebook")

    def test_equal_curves_are_seen_to_be_two(self):
        """Both colours are there, unmixed, and the legend has the lines of the curves."""
        run = Run(self.runs / "one")
        figure = stress_curves([run, run], ["A", "B"])
        figure.set_dpi(100)
        figure.canvas.draw()
        image = np.asarray(figure.canvas.buffer_rgba())[..., :3].astype(int)
        box = figure.axes[0].get_window_extent()
        panel = image[image.shape[0] - int(box.y1):image.shape[0] - int(box.y0) - 3, int(box.x0) + 3:int(box.x1)]
        for line, shown in zip(LINES, figure.legends[0].get_lines()):
            off = np.abs(panel - 255 * np.array(to_rgb(line["color"]))).max(axis=-1)
            self.assertGreater((off < 30).sum(), 50, line)
            self.assertEqual((shown.get_color(), shown.get_linewidth()), (line["color"], line["linewidth"]))
        plt.close(figure)

    def test_captions_say_what_is_drawn(self):
        run = Run(self.runs / "one")
        self.assertEqual(caption_of_test([run, run]), "(a) q against p', (b) q against axial strain, (c) p' and (d) "
                         "void ratio against axial strain.")

    def test_ends_of_cycles(self):
        """Both, because a peak would be the one or the other by an overshoot; the curves lie within their panels."""
        run = Run(self.runs / "cyclic")
        numbers = numbers_of_test(run)
        self.assertNotIn("peak q (kPa)", numbers)
        self.assertEqual(change(-60.0, -80.0), ("-20", "-33.3 %"))  # of |A|
        self.assertEqual((numbers["smallest q (kPa)"], numbers["largest q (kPa)"]),
                         (run["q"].min() / 1e3, run["q"].max() / 1e3))
        figure = stress_curves([run, run], ["A", "B"])
        figure.draw_without_rendering()
        self.assertGreater(figure.axes[0].get_xlim()[1], 1.02 * run["p"].max() / 1e3)
        self.assertGreater(figure.axes[2].get_ylim()[1], 1.02 * run["p"].max() / 1e3)
        plt.close(figure)

    def refuse(self, first, second, *parts, output="compare.html"):
        with self.assertRaises(BadInput) as caught:
            self.compare(first, second, output)
        for part in parts:
            self.assertIn(part, str(caught.exception))
        self.assertFalse((self.folder / "compare.html").exists())

    def test_no_results(self):
        self.assert_refused(self.run_app("isostat", "compare", self.runs / "one", "nowhere"), "nowhere",
                            "does not exist", "results folder of a run")
        self.refuse(self.folder, self.runs / "one", "is not a results folder", "provenance.txt")

    def test_unfinished(self):
        shutil.copytree(self.runs / "one", self.folder / "part")
        (self.folder / "part/summary.json").unlink()
        self.refuse("part", self.runs / "one", "part: is not finished", "summary.json", "--resume")

    def test_different_kinds(self):
        shutil.copytree(self.runs / "one", self.folder / "column")
        path = self.folder / "column/provenance.txt"
        path.write_text(path.read_text(encoding="utf-8").replace("element_test", "soil_column"), encoding="utf-8")
        self.refuse(self.runs / "one", "column", "is of element_test", "of soil_column", "two runs of one program")

    def test_place_of_the_file(self):
        self.refuse(self.runs / "one", self.runs / "other", "nowhere/compare.html", "--output",
                    output="nowhere/compare.html")

    def test_files_of_others_are_not_replaced(self):
        self.write("thesis.tex", "precious")
        os.mkfifo(self.folder / "pipe")
        for name in ("thesis.tex", "pipe"):
            self.refuse(self.runs / "one", self.runs / "other",
                        f"{name}: exists and is not a file of this command. Give another --output", output=name)
        self.assertEqual((self.folder / "thesis.tex").read_text(encoding="utf-8"), "precious")
