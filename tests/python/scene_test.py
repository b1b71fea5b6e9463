# SPDX-License-Identifier: BSD-3-Clause
"""Scenes in Python: file, text, dictionary and keywords are the same scene, and wrong ones are refused in words."""
import copy
import pathlib
import pickle
import tempfile

import numpy as np

from package import ToleranceTest, isostat
from isostat.scene import value_text

STAGE = {"kind": "undrained-cyclic", "deviator_amplitude": "40 kPa", "until": {"cycles": 3}}
TEXT = """title = "t"
[specimen]
preparation_friction = "9 deg"
[[stage]]
kind = "undrained-cyclic"
deviator_amplitude = "40 kPa"
until = { cycles = 3 }
"""


class SceneTest(ToleranceTest):
    def test_all_ways_give_the_same_scene(self):
        of_text = isostat.Scene(TEXT)
        sections = {"title": "t", "specimen": {"preparation_friction": "9 deg"}, "stage": [STAGE]}
        self.assertEqual(isostat.Scene(sections), of_text)
        self.assertEqual(isostat.Scene(**sections), of_text)
        self.assertEqual(isostat.Scene(of_text.to_dict()), of_text)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "t.toml"
            path.write_text(TEXT, encoding="utf-8")
            self.assertEqual(isostat.Scene(path).to_dict()["stage"], of_text.to_dict()["stage"])
            self.assertEqual(isostat.Scene(path).folder, "results/t")

    def test_scenes_are_values(self):
        scene = isostat.Scene(TEXT)
        self.assertFalse(scene == None or scene in [1, "x"])  # noqa: E711  (an operator that must not raise)
        for twin in (copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
            self.assertEqual((twin, hash(twin), type(twin)), (scene, hash(scene), isostat.Scene))
        self.assertEqual(value_text(float("-inf"), "a"), "-inf")

    def test_single_keys_go_over_it(self):
        scene = isostat.Scene(TEXT, set={"motion.damping": np.float64(0.05), "specimen.pressure": "100 kPa"})
        self.assertEqual(scene.to_dict()["motion"]["damping"], 0.05)
        other = scene.with_(**{"motion.damping": 0.1, "stage.0.until.cycles": 7})
        self.assertEqual(other.to_dict()["specimen"]["pressure"], "100 kPa")
        self.assertEqual(other.to_dict()["stage"][0]["until"]["cycles"], 7)

    def test_the_size_of_grains_is_given_once(self):
        scene = isostat.Scene(TEXT, set={"grading.d50": "0.45 mm"})
        self.assertEqual(scene.to_dict()["grading"]["d50"], "0.45 mm")
        self.assertNotIn("cloud_edge", scene.to_dict()["grading"])
        with self.assertRaisesRegex(isostat.InputError, "excludes grading.cloud_edge"):
            isostat.Scene(grading={"cloud_edge": "5 mm", "d50": "0.45 mm"})

    def test_wrong_scenes_are_refused_in_words(self):
        for scene, words in (({"motion": {"dampingg": 0.1}}, "Did you mean"),
                             ({"specimen": {"pressure": "100 m"}}, "pressure"),
                             ({"grading": {"grains": -3}}, "grains"),
                             ({"grading": {"grains": {1, 2}}}, "^grading.grains = {1, 2}: must be text, a number"),
                             ({"stage": [STAGE, {"kind": None}]}, "^stage.1.kind = None: .* Leave the key out"),
                             ({"contact": {"rolling": {"limit": None}}}, "^contact.rolling.limit = None: must be"),
                             ({"grading": None}, "^grading = None: must be"),
                             ({"grading": {3: 4}}, "^grading: 3: names of keys are text"),
                             ({"grading": {"gra ins": 4}}, "^scene: grading.gra ins = 4; is an unknown key"),
                             ({"grading": {"grains": -3}, "title": "t"}, "^scene: grading.grains = -3; must be"),
                             ({"specimen": {"relative_density": 0.5, "void_ratio": 0.6}},
                              r"^scene: specimen.void_ratio = 0.6; excludes specimen.relative_density \(scene\)")):
            with self.subTest(words), self.assertRaisesRegex(isostat.InputError, words):
                isostat.Scene(scene)
        with self.assertRaisesRegex(isostat.InputError, "^scene:2: grading.grains = -3"):  # lines of the user's text
            isostat.Scene("[grading]\ngrains = -3\n")
        with self.assertRaisesRegex(isostat.InputError, "^motion.damping = None: must be"):
            isostat.Scene(TEXT, set={"motion.damping": None})
        with self.assertRaisesRegex(isostat.InputError, 'contact.stiffness_ratio = .* of law "hertz-mindlin", only to '
                                    'linear-rolling.*Keys of "hertz-mindlin": law, young, poisson, exponent, asperity, '
                                    'friction'):
            isostat.Scene(TEXT).with_(**{"contact.law": "hertz-mindlin"})
        other = isostat.Scene({**isostat.Scene(TEXT).to_dict(), "contact": {"law": "hertz-mindlin"}})
        self.assertEqual(other.law.name, "hertz-mindlin")
        with self.assertRaisesRegex(isostat.InputError, "nowhere.toml: does not exist"):
            isostat.Scene("nowhere.toml")
        self.assertTrue(issubclass(isostat.InputError, ValueError))

    def test_laws_give_their_parameters(self):
        law = isostat.Scene(TEXT).law
        self.assertEqual(law.parameters["young"], 1e10)
        self.assertIn("friction", law.parameters)
