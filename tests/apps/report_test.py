# SPDX-License-Identifier: BSD-3-Clause
"""report.html of a run: what it holds, that it is one file, how it looks in a browser, what its failure costs, and
messages about damaged files."""
import html
import importlib
import json
import pathlib
import re
import shutil
import subprocess
import tomllib
import unittest
from types import SimpleNamespace
from unittest import mock

from figures import element_test, soil_column
from figures.__main__ import PROGRAMS
from figures.common import plt
from figures.files import Damaged, read_parsed
from report import column_tables, narrow
from report.folder import NoResults, find_results
from report.run import calls
from report_support import SCENES, ReportTest, page
from support import BIN, CYCLIC, TIME_LIMIT, AppTest, contents, tiny_scene

BROWSER = shutil.which("chromium")
REST = '[[stage]]\nkind = "hold"\nbalance = 0.05\n'  # three figures in place of eight
MONOTONIC = '[[stage]]\nkind = "undrained-monotonic"\nstrain = 0.001\n'

# What the page says of itself when its script has run: width of the content, number of figures that leave the window or
# would have to be scrolled, view of the first figure before and after the wheel, after the double click.
PROBE = """<script>
const seen = [...document.querySelectorAll("svg.zoom")].filter(svg => svg.getBoundingClientRect().width > 0);
const first = seen[0], box = first.getBoundingClientRect();
const views = [first.getAttribute("viewBox")];
const at = { clientX: box.x + box.width / 2, clientY: box.y + box.height / 2, bubbles: true, cancelable: true };
const note = () => views.push(first.getAttribute("viewBox"));
first.dispatchEvent(new WheelEvent("wheel", { deltaY: -300, ...at })); note();
first.focus();
first.dispatchEvent(new WheelEvent("wheel", { deltaY: -300, ...at })); note();
first.dispatchEvent(new KeyboardEvent("keydown", { key: "+", bubbles: true })); note();
first.dispatchEvent(new MouseEvent("dblclick", at)); note();
const cut = seen.filter(svg => {
  const { left, right } = svg.getBoundingClientRect(), around = svg.parentElement;
  return left < 0 || right > innerWidth || around.scrollWidth > around.clientWidth;
});
document.body.dataset.probe = [document.documentElement.scrollWidth, innerWidth, cut.length, ...views].join("|");
</script>"""


class Captions(unittest.TestCase):
    def test_they_fit_the_kind_of_test(self):
        path = "fig_stress_path"
        caption = element_test.DRAWING.caption
        self.assertEqual(caption(path, {"triaxial"}), "(a) q against p', (b) q against axial strain.")
        self.assertEqual(caption(path, {"triaxial", "drained triaxial"}), "(a) q against p', (b) q "
                         "against axial strain; (c) volumetric strain against axial strain.")
        self.assertEqual(caption(path, {"simple shear"}), "Tau against (a) sigma'_v, (b) p', (c) gamma.")
        caption = soil_column.DRAWING.caption
        self.assertNotIn("smoothed", caption("fig_transfer", {"one elastic layer"}))
        self.assertRegex(caption("fig_transfer", {"other soil"}),
                         r"^Fourier amplitudes, .*; smoothed, too \(Konno and Ohmachi 1998, b = 80\)\.$")
        self.assertEqual(caption("fig_histories", {"wet"}),
                         "r_u at the output depths and its largest value anywhere; dashed, red: r_u = 1.")

    def test_every_figure_has_one(self):
        for program in PROGRAMS:
            drawing = importlib.import_module(f"figures.{program}").DRAWING
            for draw in drawing.all:
                self.assertTrue(draw.__doc__ or draw.parts, draw.name)


class Narrow(unittest.TestCase):
    def test_panels_come_below_each_other(self):
        """Each with labels and numbers of its own, and the legend within the figure."""
        figure, panels = plt.subplots(1, 3, figsize=(9.6, 3.3), sharey=True, layout="constrained")
        for axes, label in zip(panels, ("one", "two", "three")):
            axes.plot([0, 1], [0, 1], label=f"a legend that is long {label}")
            axes.set_xlabel(label)
        panels[0].set_ylabel("shared")
        figure.legend(*(sum(texts, []) for texts in zip(*(axes.get_legend_handles_labels() for axes in panels))),
                      loc="lower center", ncols=3)
        figure.draw_without_rendering()
        self.assertTrue(narrow.side_by_side(figure))
        narrow.stack(figure)
        self.addCleanup(plt.close, figure)
        boxes = [axes.get_tightbbox(figure.canvas.get_renderer()) for axes in panels]
        for above, below in zip(boxes, boxes[1:]):
            self.assertGreaterEqual(above.y0, below.y1)
        self.assertEqual([axes.get_ylabel() for axes in panels], 3 * ["shared"])
        legend = figure.legends[0].get_window_extent()
        self.assertEqual(len(figure.legends[0].get_texts()), 3)
        self.assertTrue(legend.x0 >= 0 and legend.x1 <= figure.bbox.width and legend.y1 <= boxes[-1].y0, legend)
        self.assertFalse(narrow.side_by_side(figure))

    def test_a_colour_bar_stays_next_to_its_panels(self):
        figure, panels = plt.subplots(1, 2, layout="constrained")
        self.addCleanup(plt.close, figure)
        bar = figure.colorbar(panels[0].scatter([0], [0], c=[1]), ax=panels).ax
        figure.draw_without_rendering()
        self.assertTrue(narrow.side_by_side(figure))
        narrow.stack(figure)
        one, two, beside = (axes.get_window_extent() for axes in (*panels, bar))
        self.assertGreater(one.y0, two.y1)
        self.assertGreater(beside.x0, max(one.x1, two.x1))
        self.assertTrue(beside.y0 <= two.y0 + 1 and beside.y1 >= one.y1 - 1, beside)


class Reports(ReportTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.said = cls.make_test("cyclic", output='checkpoint = "0.001 s"', stages=CYCLIC.format(steps=2000))
        cls.make_test("whole", motion="damping = 0.2", stages=MONOTONIC)
        cls.make_test("rest", stages=REST)
        cls.make_test("fast", "--set", "contact.young=10 GPa", "--set", "stage.0.deviator_amplitude=60 kPa",
                      motion="inertial_number = 0.02\nload_per_wave = 0", stages=CYCLIC.format(steps=20000))

    def test_cyclic(self):
        words = self.assert_whole("cyclic")
        self.assertIn("ended by max_steps = 2000 before any of its conditions was met", words)
        self.assertIn("(a) q against p', (b) q against axial strain. ", words)
        self.assertNotIn("simple shear", words)
        self.assertIn("Rate: fixed at 2 1/s, not controlled.", words)
        self.assertIn("-o cyclic -q --resume", words)
        self.assertIn("results/again", words)
        self.assertIn("The Isostat authors", words)
        self.assertIn(f"all on one page in {pathlib.Path('cyclic/report.html')}", self.said.stdout)

    def test_target(self):
        words = self.assert_whole("whole")
        self.assertIn("Stage 0 (undrained-monotonic): ended by strain = 0.1 % (0.1 % reached).", words)
        self.assertIn("Rate: controlled, I = 4e-05 at p0', or less: the load changes by 10 % of p0' at most", words)
        self.assertRegex(words, r"largest quasi-static indicator before liquefaction is [0-9.]+; above 0\.2 a test")
        self.assertIn('<li class="good"><strong>Rate:', self.report("whole"))
        self.assertIn("Not liquefied:", words)

    def test_a_fast_test_asks_for_attention(self):
        """Its verdict has the indicator of the summary, and no bound on the load where there is none."""
        words = self.assert_whole("fast")
        verdict = re.search(r"Rate: .*? of the rate\.", words)[0]
        self.assertIn("I is above 0.001 and the indicator is above 0.2, so the test counts as fast.", verdict)
        self.assertIn("controlled, I = 0.02 at p0'.", verdict)
        self.assertNotIn("load", verdict)
        largest = float(re.search(r"indicator before liquefaction is ([0-9.]+);", verdict)[1])
        self.assertIn(f"largest indicator {largest:.4f} (recorded", words)
        self.assertIn('<li class="attention"><strong>Rate:', self.report("fast"))

    def test_started_from_python(self):
        """What continues and what repeats are calls, not commands of a shell."""
        shutil.copytree(self.runs / "rest", self.folder / "out")
        provenance = self.folder / "out/provenance.txt"
        for function in ("isostat.column.run", "isostat.run"):
            text = provenance.read_text(encoding="utf-8")
            provenance.write_text(re.sub(r"(?m)^(command\s+).*$", rf"\1{function}() in Python", text), encoding="utf-8")
            self.assertEqual(calls(find_results(self.folder / "out")), (
                f'{function}(scene, "{self.folder}/out", resume=True)', f'{function}(scene, "results/again")'))
        text = html.unescape(page(self.folder / "out"))
        self.assertIn(f'>isostat.run(scene, "{self.folder}/out", resume=True)<', text)
        self.assertNotIn("in Python --resume", text)

    def test_without(self):
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=300)))
        self.assert_done(self.run_test(scene, "-o", "out"))
        self.assertFalse((self.folder / "out/report.html").exists())

    def test_unfinished(self):
        """Nothing is concluded of a run without a summary; no figures and a reason without a history."""
        shutil.copytree(self.runs / "whole", self.folder / "out")
        for name in ("summary.json", "summary.txt"):
            (self.folder / "out" / name).unlink()
        text = page(self.folder / "out", "fig_stress_path")
        self.assertIn("Not finished:", text)
        self.assertNotIn("ended by", text)
        (self.folder / "out/history.csv").unlink()
        text = page(self.folder / "out", code=2)
        self.assertIn(f"No figures: {self.folder}/out/history.csv", text)
        self.assert_one_file(text)

    def test_failure_costs_nothing(self):
        """A folder in the way of the report: one line says so, and the run is done."""
        shutil.copytree(self.runs / "rest", self.folder / "rest")
        shutil.copy(self.runs / "rest.toml", self.folder)
        (self.folder / "rest/summary.json").unlink()  # as if it had been stopped before its end
        (self.folder / "rest/report.html").unlink()
        (self.folder / "rest/report.html").mkdir()
        result = self.run_app("element_test", "rest.toml", "-o", "rest", "-q", "--resume")
        self.assert_done(result)
        lines = [line for line in result.stderr.splitlines() if "ended by max_steps" not in line]
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertIn("report.html: not written", result.stderr)
        self.assertIn("figures in rest/figures", result.stdout)
        self.assertNotIn("one page", result.stdout)

    def test_a_title_is_words(self):
        """Neither markup nor formula, whatever is in it."""
        title = "<script>alert(1)</script> $x_{ % $ \\frac{"
        scene = (self.runs / "rest.toml").read_text(encoding="utf-8").replace('"tiny"', f"'{title}'")
        self.assertIn(title, scene)
        result = self.run_app("element_test", self.write("odd.toml", scene), "-o", "odd", "-q")
        self.assert_done(result)
        self.assertIn("all on one page", result.stdout)
        text = (self.folder / "odd/report.html").read_text(encoding="utf-8")
        self.assertNotIn("<script>alert", text)
        self.assertIn(html.escape(title), text)

    def test_python_of_the_working_folder_is_left_alone(self):
        """An untrusted folder of results may hold anything."""
        shutil.copytree(self.runs / "rest", self.folder / "rest")
        shutil.rmtree(self.folder / "rest/figures")
        shutil.copy(self.runs / "rest.toml", self.folder)
        for name in ("report", "figures", "json", "numpy", "random"):
            self.write(f"{name}.py", "open('was_run', 'w').close()")
        (self.folder / "rest/report.html").unlink()
        self.assert_done(self.run_app("element_test", "rest.toml", "-o", "rest", "-q", "--resume"))
        self.assertTrue((self.folder / "rest/report.html").exists())
        self.assert_done(self.run_app("isostat", "report", "rest"))
        self.assertTrue((self.folder / "rest/figures").is_dir())
        self.assertFalse((self.folder / "was_run").exists())

    def test_a_style_in_the_working_folder_is_left_alone(self):
        shutil.copytree(self.runs / "rest", self.folder / "rest")
        shutil.rmtree(self.folder / "rest/figures")
        self.write("matplotlibrc", "text.usetex: True\nsavefig.format: svg\nfigure.figsize: 1, 1\n")
        self.assert_done(self.run_app("isostat", "report", "rest"))
        self.assertEqual(contents(self.folder / "rest/figures"), contents(self.runs / "rest/figures"))

    def test_links_in_an_untrusted_folder_are_not_followed(self):
        shutil.copytree(self.runs / "rest", self.folder / "rest")
        shutil.copy(self.runs / "rest.toml", self.folder)
        figures = sorted((self.folder / "rest/figures").glob("*.png"))
        links = [figures[0], *(self.folder / "rest" / name for name in ("report.html", "figures.log"))]
        for link in links:
            link.unlink(missing_ok=True)
            link.symlink_to(self.write("thesis.txt", "precious"))
        self.assert_done(self.run_app("isostat", "report", "rest"))
        links[1].unlink()
        self.assert_done(self.run_app("element_test", "rest.toml", "-o", "rest", "-q", "--resume"))
        self.assertEqual((self.folder / "thesis.txt").read_text(encoding="utf-8"), "precious")
        self.assertFalse(any(link.is_symlink() for link in links))

    def test_a_folder_whose_name_looks_like_an_option(self):
        (self.folder / "dash").mkdir()
        shutil.copy(self.runs / "rest.toml", self.folder)
        self.assert_done(self.run_app("element_test", "rest.toml", "--output=-dash", "-q"))
        self.assertTrue((self.folder / "-dash/report.html").exists())

    def test_a_package_that_is_missing_is_named(self):
        self.write("matplotlib.py", "raise ModuleNotFoundError('No module', name='matplotlib')")
        for module in ("figures", "report"):
            result = subprocess.run(["/usr/bin/python3", "-m", module], cwd=self.folder, text=True, check=False,
                                    env={"PYTHONPATH": f"{self.folder}:{SCENES.parent}"}, capture_output=True)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn("no module matplotlib: install it, apt-get install python3-matplotlib", result.stderr)

    def test_damaged_files_are_named(self):
        shutil.copytree(self.runs / "rest", self.folder / "cut")
        for name in ("scene.toml", "summary.json"):
            path = self.folder / "cut" / name
            whole = path.read_text(encoding="utf-8")
            path.write_text("\n".join([*whole.splitlines()[:4], '"half = ']), encoding="utf-8")
            with self.assertRaisesRegex(NoResults, rf"cut/{name}:5: is damaged \(.*Restore it.*--resume"):
                find_results(self.folder / "cut")
            if name == "scene.toml":
                path.write_text(whole, encoding="utf-8")
        for arguments in (("report", "cut"), ("compare", self.runs / "rest", "cut")):
            self.assert_refused(self.run_app("isostat", *arguments), "cut/summary.json:5: is damaged (")

    @unittest.skipUnless(BROWSER, "chromium is not installed")
    def test_in_a_browser(self):
        """Nothing is wider than the page, and no figure is cut; the selected one answers to wheel and keys, and comes
        back."""
        page = self.write("page.html", self.report("cyclic").replace("</body>", PROBE + "</body>"))
        for width in (1280, 390):
            command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", f"--window-size={width},900",
                       f"--user-data-dir={self.folder / 'user'}"]
            dom = subprocess.run([*command, "--dump-dom", page.as_uri()], capture_output=True, text=True, check=True,
                                 timeout=TIME_LIMIT).stdout
            content, window, cut, before, *others = re.search(r'data-probe="([^"]*)"', dom)[1].split("|")
            alone, wheel, key, after = others
            self.assertLessEqual(int(content), int(window))
            self.assertEqual(cut, "0", f"figures that are cut in a window {width} wide")
            self.assertEqual([before, before], [alone, after])
            widths = [float(view.split()[2]) for view in (before, wheel, key)]
            self.assertEqual(widths, sorted(widths, reverse=True))
            self.assertGreater(widths[0], widths[1])
            image = self.folder / f"{width}.png"
            report = (self.runs / "rest/report.html").as_uri()
            subprocess.run([*command, f"--screenshot={image}", report], capture_output=True, check=True,
                           timeout=TIME_LIMIT)
            self.assertGreater(image.stat().st_size, 20000)


class DamagedTables(AppTest):
    def said(self, text, parse=json.loads):
        path = self.folder / "file"
        path.write_bytes(text)
        with self.assertRaises(Damaged) as caught:
            read_parsed(path, parse)
        return str(caught.exception).removeprefix(str(path))

    def test_place_and_reason(self):
        cut = b'{\n  "title": "one",\n  "grains": 20'
        self.assertRegex(self.said(cut), r"^:3: is damaged \(Expecting ',' delimiter\)\. Restore it")
        self.assertRegex(self.said(b""), r"^:1: is damaged \(it is empty\)\.")
        self.assertRegex(self.said(b'{\n"title": "\xff"}'), r"^:2: is damaged \(it holds bytes that are no text\)")
        self.assertRegex(self.said(b"[1, 2]"), r"^:1: is damaged \(it holds no table")
        self.assertRegex(self.said(b"[grading]\ngrains = \n", tomllib.loads), r"^:2: is damaged \(Invalid value\)\.")
        self.assertRegex(self.said(b'[grading]\ngrains = "2', tomllib.loads), r"^:2: is damaged \(Unterminated string")

    def test_whole(self):
        path = self.write("file", '{"grains": 200}')
        self.assertEqual(read_parsed(path), {"grains": 200})
        with self.assertRaises(FileNotFoundError):
            read_parsed(self.folder / "nowhere")


@unittest.skipUnless((BIN / "soil_column").exists(), "built without the continuum half")
class OtherPrograms(ReportTest):
    def test_consolidation(self):
        self.make("soil_column", "column", SCENES / "column/terzaghi.toml", "--set", "analysis.steps=40")
        words = self.assert_whole("column")
        self.assertIn("of the final settlement", words)
        self.assertNotIn("Liquefied:", words)

    def test_shaken(self):
        self.make("soil_column", "shaken", SCENES / "column/recorded_motion.toml", "--set", "analysis.duration=1 s")
        self.assertIn("iquefied:", self.assert_whole("shaken"))

    def test_a_layer_is_described_in_words(self):
        """Whatever its keys are, as words and not as Python has them; a dry one without its permeability."""
        table = {"thickness": "5 m", "material": "umat", "permeability": "1e-5 m/s", "k0": 0.5,
                 "umat": {"library": "sand.so", "props": [80e6, 0.3, 2], "statev": [0]}}
        column = SimpleNamespace(
            summary={"layers": []}, velocities=None, is_drawn=False, damping={"mass_damping": 0},
            scene={"layer": [table], "water": {"drainage": "dry"}},
            layers=[{"height": 5.0, "density": 2000.0, "velocity": None, "name": ""}], water={"gravity": 9.81})
        with mock.patch.object(column_tables.site_response, "site", lambda _: {}):
            text = column_tables.layers(column)
            self.assertIn("k0 0.5, umat library sand.so, umat props [8e+07, 0.3, 2], umat statev [0]<", text)
            self.assertNotIn("permeability", text)
            column.scene["water"]["drainage"] = "coupled"
            self.assertIn("permeability 1e-5 m/s", column_tables.layers(column))

    def test_block(self):
        self.make("soil_column", "block", SCENES / "biaxial/iwan.toml", "--set", "analysis.load_steps=4", "--set",
                  "analysis.axial_strain=0.002", "--set", "analysis.map_every=1")
        self.assertIn("Ended at its target, an axial strain of 0.2 %.", self.assert_whole("block"))
