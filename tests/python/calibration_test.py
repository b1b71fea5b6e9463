# SPDX-License-Identifier: BSD-3-Clause
"""The parts of isostat calibrate: plans, parameters and scenes of trials, search. Laboratory files and the misfit are
in calibration_curves_test.py."""
import math
import pathlib
import random
import tomllib
from types import SimpleNamespace
from unittest import mock

import numpy as np

from package import ROOT, FolderTest, isostat
from isostat.campaign import folder
from isostat.campaign.calibrate import (ALGORITHMS, BudgetUsed, Folder, keys, plan as plans, search,
                                        sobol_design)
from isostat.campaign.calibrate.scenes import SceneMaker

APPS = ROOT / "apps"
SAND = APPS / "scenes/calibrate/sand.toml"
CURVE = '[[curve]]\nfile = "TMD3.csv"\ntest = "drained"\n'
FRICTION = '[[parameter]]\nkey = "contact.friction"\nbounds = ["10 deg", "35 deg"]\n'
LIMIT = '[[parameter]]\nkey = "contact.rolling.limit"\nbounds = [0.1, 0.9]\n'
ROUND_OFF = "round-off of some ten operations"


def plan_text(second="\n"):
    """Title and scene on lines 1 and 2, two parameters from line 3 on, what is added to the second, and one curve."""
    return f'title = "two"\nscene = "sand.toml"\n{FRICTION}{LIMIT}{second}{CURVE}'


def read(text):
    plan = plans.checked_plan(plans.Document(text, "plan.toml"))
    plan.scene_path = str(SAND)
    return plan


class CalibrationTest(FolderTest):
    def refuse(self, parts, call, *arguments):
        with self.assertRaises(isostat.InputError) as caught:
            call(*arguments)
        for part in parts:
            self.assertIn(part, str(caught.exception))


class Plans(CalibrationTest):
    def test_defaults(self):
        plan = read(plan_text())
        self.assertEqual((plan.specimens.grains, plan.optimiser.method, plan.budget.time), (1000, "bobyqa", None))
        self.assertEqual([p.bounds for p in plan.parameter], [["10 deg", "35 deg"], [0.1, 0.9]])
        self.assertEqual((plan.parameter[1].start, plan.parameter[1].where), (None, "plan.toml:7"))
        self.assertEqual((plan.curve[0].name, plan.curve[0].where), ("TMD3", "plan.toml:11"))
        self.assertEqual(vars(plan.curve[0])["columns.axial"], "sigma_v[kPa]")

    def test_reads_back_from_its_text(self):
        more = ('[[curve]]\nfile = "u.csv"\ntest = "undrained"\nblind = true\nvoid_ratio = 0.7\npressure = "0.1 MPa"\n'
                'direction = "extension"\nstrains = "logarithmic"\ncolumns = { p = "p\' (kPa)" }\n')
        text = keys.plan_text(read(plan_text('start = 0.3\nscale = "log"\n') + more + '[budget]\ntime = "90 min"\n'))
        self.assertEqual(keys.plan_text(read(text)), text)
        plan = read(text)
        self.assertEqual((plan.parameter[1].start, plan.parameter[1].scale, plan.budget.time), (0.3, "log", "90 min"))
        self.assertEqual((plan.curve[1].direction, plan.curve[1].pressure), ("extension", "100 kPa"))
        self.assertEqual(vars(plan.curve[1])["columns.p"], "p' (kPa)")

    def test_defaults_are_printed_for_every_key(self):
        text = keys.default_plan()
        self.assertEqual(read(text + LIMIT).misfit.points, 40)
        for key in keys.KEYS:
            self.assertIn(key.name, text)
        self.assertIn("Allowed: in [0, 1]. No default.\n# relative_density = 0.64", text)

    def test_refusals(self):
        one = f'scene = "s"\n{FRICTION}{CURVE}'
        blind = '[[curve]]\nfile = "b.csv"\ntest = "drained"\nblind = true\n'
        for text, *parts in (
                (plan_text() + "wieght = 2\n", "plan.toml:13", "wieght", "Did you mean curve.weight?"),
                (plan_text() + "[budget]\ntrials = 0\n", "plan.toml:14: budget.trials = 0", "in [1, 1000000]"),
                (plan_text() + '[optimiser]\nmethod = "bobby"\n', "plan.toml:14", "bobby", '"sbplx" or "crs2"'),
                (plan_text('scale = "square"\n'), "plan.toml:9", "square", '"linear" or "log"'),
                (plan_text("start = [1, 2]\n"), "plan.toml:9: parameter.1.start = [1, 2]", "a finite number"),
                (one.replace('["10 deg", "35 deg"]', "1"), "plan.toml:4: parameter.0.bounds = 1", "two values"),
                (one.replace('"10 deg"', "-inf"), "plan.toml:4", "a finite number"),
                (one.replace('"10 deg"', '""'), "plan.toml:4", "a finite number"),
                (plan_text() + 'pressure = "5 bar"\n', "plan.toml:13: curve.0.pressure = 5 bar", "a pressure in Pa"),
                (plan_text() + "weight = 1e300\n", "plan.toml:13: curve.0.weight = 1e300", "1e30"),
                (plan_text() + "weight = nan\n", "plan.toml:13: curve.0.weight = nan", "must be > 0"),
                (plan_text() + "blind = 1\n", "plan.toml:13", "true or false"),
                (plan_text() + "[specimens]\ngrains = 1e3\n", "plan.toml:14", "a whole number"),
                (f'scene = "s"\n{CURVE}', "plan.toml", "at least one parameter", "[[parameter]]"),
                (f'scene = "s"\n{FRICTION}', "plan.toml", "at least one curve", "[[curve]]"),
                (plan_text() + "blind = true\n", "plan.toml:13: curve.0.blind = true", "no curve to fit"),
                (one + '[optimiser]\nmethod = "bobyqa"\n', "plan.toml:9", "needs two parameters", '"sbplx"'),
                (plan_text() + CURVE, "plan.toml:14", 'names two curves "TMD3"', "plan.toml:11"),
                (plan_text() + "relative_density = 0.6\nvoid_ratio = 0.7\n", "plan.toml:14: curve.0.void_ratio",
                 "excludes curve.0.relative_density (plan.toml:13)"),
                (plan_text() + FRICTION, "plan.toml:14: parameter.2.key = contact.friction", "twice", "plan.toml:4"),
                (plan_text() + 'name = "a/b"\n', "plan.toml:13: curve.0.name = a/b", "name a folder"),
                (plan_text('curve = "dense"\n'), "plan.toml:9: parameter.1.curve = dense", "no curve that is fitted"),
                (plan_text('curve = "b"\n') + blind, "plan.toml:9: parameter.1.curve = b", "no curve that is fitted"),
                (plan_text('curve = "loose"\n') + 'group = "loose"\n' + LIMIT + 'curve = "TMD3"\n', "parameter.2.key",
                 "a parameter twice"),
                (plan_text() + 'columns = { p = "p[kPa]" }\n', "plan.toml:13: curve.0.columns.p", "only to undrained"),
                (plan_text().replace("[[curve]]", "[curve]"), "plan.toml", "at least one curve"),
                ("budget = 3\n" + plan_text(), "plan.toml:1: budget", "must be a table. Write [budget]"),
                (plan_text() + "blind = \n", "plan.toml:13: is not valid TOML"), ("title = ", "plan.toml:1")):
            with self.subTest(text=text):
                self.refuse(parts, read, text)
        self.assertEqual(read(one).optimiser.method, "sbplx")

    def test_parameters_belong_to_curves_or_groups(self):
        more = f'{CURVE}name = "c"\n{LIMIT}curve = "c"\n'
        plan = read(plan_text('curve = "loose"\n') + 'group = "loose"\n' + more)
        self.assertEqual([[plans.concerns(p, c) for c in plan.curve] for p in plan.parameter],
                         [[True, True], [True, False], [False, True]])

    def test_random_texts(self):
        """A text is refused in words, or a plan that reads back from its own text."""
        draw, taken = random.Random(1), 0
        seeds = [plan_text(), *(path.read_text(encoding="utf-8") for path in APPS.glob("scenes/calibrate/*d*.toml"))]
        pieces = ("\n", '"', "[[", "]", "= ", "-0.0", "9223372036854775807", '"9223372036854775807"', "1e308", "-inf",
                  "true", '"a \\"b\\" \\u007f"', "é", "{ p = 1 }", "\n[[curve]]\n", "\ufeff", "1979-05-27", '"1_0"')
        for _ in range(1500):
            text = draw.choice(seeds)
            for _ in range(draw.randint(1, 3)):
                at = draw.randrange(len(text))
                text = text[:at] + draw.choice(pieces) * draw.randint(0, 1) + text[at + draw.choice((0, 0, 1, 9)):]
            with self.subTest(text=text):
                try:
                    again = keys.plan_text(read(text))
                except isostat.InputError as error:
                    self.assertTrue(str(error).startswith("plan.toml"), error)
                    continue
                self.assertEqual(keys.plan_text(read(again)), again)
                taken += 1
        self.assertGreater(taken, 100)

    def test_numbers_as_scenes_write_them(self):
        for value, shift, text in ((0.1, 0, "0.1"), (1e-4, 0, "1e-4"), (1.25e9, 0, "1.25e9"),
                                   (123456789, 0, "123456789"), (5e8, 9, "0.5"), (2.7e-3, -3, "2.7"),
                                   (0, 3, "0"), (-20, 0, "-20")):
            self.assertEqual(keys.number_text(value, shift), text)


class Folders(CalibrationTest):
    def test_a_call_that_was_killed_between_the_first_files(self):
        """Whatever of them is there: the same command takes its folder again."""
        kept = {"plan.toml": keys.plan_text(read(plan_text())), "laboratory/TMD3.csv": "1,2\n", "scene.toml": "\n"}
        for n in range(4):
            written, write = [], folder.write_replacing

            def killed(path, text):
                if len(written) == n:
                    raise KeyboardInterrupt
                written.append(path)
                write(path, text)
            out = self.folder / f"killed{n}"
            with mock.patch.object(folder, "write_replacing", killed), self.assertRaises(KeyboardInterrupt):
                Folder(out, kept, owner="calibration")
            Folder(out, kept, owner="calibration", only_check=True)

    def test_another_budget_is_no_other_calibration(self):
        plan = read(plan_text())
        kept = {"plan.toml": keys.plan_text(plan), "scene.toml": "title = ''\n"}
        Folder(self.folder / "budget", kept, owner="calibration")
        plan.budget.trials, plan.budget.time = 99, "5 min"
        Folder(self.folder / "budget", kept | {"plan.toml": keys.plan_text(plan)}, owner="calibration", only_check=True)
        plan.misfit.points = 41
        self.refuse(("points = 40", "points = 41", "--overwrite"), lambda: Folder(
            self.folder / "budget", kept | {"plan.toml": keys.plan_text(plan)}, owner="calibration", only_check=True))


class Parameters(CalibrationTest):
    def maker(self, parameter, curve=""):
        return SceneMaker(read(f'scene = "s"\n\n\n[[parameter]]\n{parameter}{CURVE}{curve}'))

    def test_go_between_their_bounds(self):
        friction = SceneMaker(read(plan_text())).parameters[0]
        self.assertEqual((friction.label, friction.value(0), friction.value(1)), ("contact.friction (deg)", 10, 35))
        self.assertEqual([friction.text(friction.value(share)) for share in (0.5, 1 / 3, friction.start)],
                         ["22.5 deg", "18.33333 deg", "18 deg"])

    def test_go_along_the_logarithm(self):
        young = self.maker('key = "contact.young"\nbounds = ["100 MPa", "10 GPa"]\nscale = "log"\nstart = "0.2 GPa"\n'
                           ).parameters[0]
        self.assertEqual((young.text(young.value(0.5)), young.number(young.value(0))), ("1 GPa", "0.1"))
        self.assert_near(young.start, math.log(2) / math.log(100), 1e-12, ROUND_OFF)

    def test_refusals(self):
        key = 'key = "contact.friction"\n'
        for parameter, *parts in (
                ('key = "contact.frction"\nbounds = [0, 1]\n', "plan.toml:5", "Did you mean contact.friction?"),
                ('key = "nothing.alike"\nbounds = [0, 1]\n', "element_test --print-defaults"),
                ('key = "grading.curve"\nbounds = [0, 1]\n', "plan.toml:5", "is not a number"),
                ('key = "stage.0.strain"\nbounds = [0.1, 0.2]\n', "plan.toml:5", "is set by [[curve]]"),
                ('key = "specimen.pressure"\nbounds = ["1 kPa", "2 kPa"]\n', "is set by [[curve]]"),
                ('key = "grading.cloud_edge"\nbounds = ["1 mm", "2 mm"]\n', "grading.cloud_edge", "Give another key"),
                ('key = "grading.d50"\nbounds = ["1 mm", "2 mm"]\n', "grading.d50", "Give another key"),
                (key + 'bounds = ["95 deg", "99 deg"]\n',
                 "plan.toml:5: parameter.key = contact.friction; bounds[0] = 95 deg; must be in [0 deg, 90 deg)"),
                (key + 'bounds = ["30 deg", "20 deg"]\n', "[30 deg, 20 deg] leave nothing between them"),
                (key + "bounds = [10, 20]\n", "bounds[0] = 10", "an angle with its unit"),
                (key + 'bounds = ["10 kPa", "20 kPa"]\n', "bounds[0] = 10 kPa", "an angle in deg, rad or tan"),
                (key + 'bounds = ["10 deg", "20 deg"]\nstart = "25 deg"\n', "start = 25 deg; must be within bounds"),
                (key + 'bounds = ["0 deg", "20 deg"]\nscale = "log"\n', "bounds[0] = 0 deg", "scale is log")):
            with self.subTest(parameter=parameter):
                self.refuse(parts, self.maker, parameter)
        self.refuse(("plan.toml:5", 'curve "TMD3" (plan.toml:8)', "Remove one"), self.maker,
                    'key = "specimen.relative_density"\nbounds = [0.2, 0.6]\n', "void_ratio = 0.7\n")


class Scenes(CalibrationTest):
    def test_of_a_trial(self):
        plan = read(plan_text() + 'pressure = "100 kPa"\nvoid_ratio = 0.71\n[specimens]\ninertial_number = 1e-3\n')
        text = SceneMaker(plan).trial([20, 0.25], plan.curve[0], 7).text
        scene = tomllib.loads(text)
        self.assertEqual(scene["contact"]["friction"], "20 deg")
        self.assertEqual((scene["grading"]["grains"], scene["grading"]["seed"]), (1000, 7))
        self.assertEqual((scene["specimen"]["pressure"], scene["specimen"]["void_ratio"]), ("100 kPa", 0.71))
        self.assertNotIn("preparation_friction", scene["specimen"])
        self.assertEqual(scene["motion"]["inertial_number"], 1e-3)
        edge = float(scene["grading"]["cloud_edge"].split()[0])
        self.assert_near(edge, 10 * 0.1 ** (1 / 3), 1e-12, "round-off of a length")
        stages = [(stage["kind"], stage["strain"]) for stage in scene["stage"]]
        self.assertEqual(stages, [("drained", -math.log1p(-0.1))])
        self.assertEqual(isostat.Scene(text).text, text)

    def test_keep_the_median_diameter(self):
        plan = read(plan_text())
        plan.scene_path = str(self.folder / "sand.toml")
        sand = isostat.Scene(SAND, set={"grading.d50": "0.45 mm"})
        pathlib.Path(plan.scene_path).write_text(sand.text, encoding="utf-8")
        for scene in (SceneMaker(plan).trial([20, 0.25], plan.curve[0], 7), SceneMaker(plan).full_scene([20, 0.25])):
            self.assertEqual(scene.to_dict()["grading"]["d50"], "0.45 mm")
            self.assertNotIn("cloud_edge", scene.to_dict()["grading"])

    def test_have_the_parameters_of_their_group(self):
        group = 'group = "loose"\n'
        plan = read(plan_text('curve = "loose"\n') + f'{group}{CURVE}name = "b"\n{group}{CURVE}name = "c"\n')
        maker = SceneMaker(plan)
        scenes = [maker.trial([20, 0.25], curve, 1).to_dict() for curve in plan.curve]
        self.assertEqual([scene["contact"]["rolling"]["limit"] for scene in scenes], [0.25, 0.25, 0.5])

    def test_of_full_size_keep_the_motion(self):
        plan = read(plan_text('curve = "TMD3"\n') + "[specimens]\ninertial_number = 1e-3\n")
        maker = SceneMaker(plan)
        whole, test = maker.full_scene([20, 0.25]).to_dict(), maker.full_test([20, 0.25], plan.curve[0]).to_dict()
        self.assertEqual(whole["grading"]["grains"], 10000)
        self.assertTrue(whole["motion"] == test["motion"] == isostat.Scene(SAND).to_dict()["motion"])
        self.assertEqual(test["contact"]["rolling"]["limit"], 0.25)
        self.assertEqual(whole["contact"]["rolling"]["limit"], 0.5)  # that value belongs to one curve alone


def valley(x):
    """A long one between (0, 0.3) and (1, 0.7), lowest at (0.6, 0.54)."""
    return (x[0] - 0.6) ** 2 + 25 * (x[1] - 0.3 - 0.4 * x[0]) ** 2


class Search(CalibrationTest):
    def asked(self, method, tolerance):
        points = []

        def objective(x):
            if len(points) == 3000:
                raise BudgetUsed("3000")
            points.append(x)
            return valley(x)
        search(SimpleNamespace(method=method, tolerance=tolerance, first_step=0.15), [0.2, 0.8], objective)
        return points

    def test_finds_the_lowest_point_of_a_valley(self):
        for method in ALGORITHMS:
            points = self.asked(method, 1e-3)
            self.assert_near(min(points, key=valley), [0.6, 0.54], 5e-3, "some of the last steps, along the valley")
            self.assertTrue((np.abs(np.array(points) - 0.5) <= 0.5).all())
            self.assertEqual(self.asked(method, 1e-2), self.asked(method, 1e-2))
        few = len(self.asked("bobyqa", 1e-3))
        self.assertLess(few, 60)  # it builds a parabola, and finds one soon

    def test_ends_with_its_budget_and_passes_on_what_is_raised(self):
        for method in ALGORITHMS:
            for error in (BudgetUsed, KeyboardInterrupt, OSError):
                for most in (0, 1, 4, 20):
                    asked = []

                    def objective(x):
                        asked.append(x)
                        if len(asked) > most:
                            raise error("used up")
                        return float(len(asked))
                    settings = SimpleNamespace(method=method, tolerance=1e-9, first_step=0.15)
                    if error is BudgetUsed:
                        self.assertEqual(search(settings, [0.5, 0.5], objective), "used up")
                    else:
                        self.assertRaises(error, search, settings, [0.5, 0.5], objective)
                    self.assertEqual(len(asked), most + 1)

    def test_design_fills_the_bounds(self):
        """The points that the first calibrations had, of boost::random::sobol."""
        self.assertEqual(sobol_design(3, 4), [[0.5, 0.5, 0.5], [0.75, 0.25, 0.25], [0.25, 0.75, 0.75],
                                              [0.375, 0.375, 0.625]])
        self.assertEqual(sobol_design(2, 0), [])
