# SPDX-License-Identifier: BSD-3-Clause
"""Arguments of a wrong type or shape are refused by name, with what was given; no signatures of C++ are listed."""

import numpy as np

from package import ToleranceTest, isostat

R = 1e-3
CENTRES = np.array([[1, 1, 1], [3, 1, 1], [1, 3, 1]]) * R
CELL = [5 * R] * 3
STAGE = {"kind": "hold", "max_steps": 50}


def spheres(**changed):
    given = {"centres": CENTRES, "radii": [R] * 3, "cell": CELL, **changed}
    return isostat.Snapshot.from_spheres(given.pop("centres"), given.pop("radii"), **given)


class ArgumentsTest(ToleranceTest):
    def expect(self, words, call, *arguments, **keywords):
        with self.subTest(words), self.assertRaisesRegex(isostat.InputError, "^" + words):
            call(*arguments, **keywords)

    def test_of_an_element(self):
        rve = isostat.Rve(spheres())
        zero, free = np.zeros((3, 3)), np.zeros((3, 3), bool)
        self.expect(r"gradient: must be an array of shape \(3, 3\), but is an array of shape \(2, 2\)\.", rve.advance,
                    np.zeros((2, 2)))
        self.expect("gradient: must be .*, but is None", rve.undrained, None)
        self.expect("gradient: must be .*, but is 'x'", rve.mixed, "x", zero, free)
        self.expect(r"stress: must be .* is an array of shape \(3,\)", rve.mixed, zero, np.zeros(3), free)
        self.expect("controlled: must be an array of True and False", rve.mixed, zero, zero, [True])
        self.expect("tolerance: must be a number, but is 'small'", rve.mixed, zero, zero, free, "small")
        for name, wrong, words in (("min_steps", -1, "a whole number, 0 or more, but is -1"),
                                   ("max_steps", 1.5, "a whole number, 0 or more, but is 1.5"),
                                   ("damping", "low", "a number, or None, but is 'low'"),
                                   ("max_increment", None, "a number, but is None"),
                                   ("frame", np.zeros(9), r"an array of shape \(3, 3\), or None, but")):
            self.expect(f"{name}: must be {words}", isostat.Rve, spheres(), **{name: wrong})
            self.expect(f"{name}: must be {words}", isostat.Rve.unpack, rve.pack(), **{name: wrong})
        for wrong, words in ((isostat.Specimen(spheres()), "of type Specimen"), (None, "None")):
            self.expect(f"specimen: must be an isostat.Snapshot, but is {words}", isostat.Rve, wrong)

    def test_of_spheres(self):
        for name, wrong, words in (("centres", "abc", "an array of numbers, but is 'abc'"),
                                   ("centres", CENTRES[:, :2], r"an array of shape \(n, 3\), but is .* \(3, 2\)"),
                                   ("radii", R, "an array of numbers .*, but is 0.001"),
                                   ("radii", [R] * 2, "as many as centres, .*; there are 2 radii, 3 centres"),
                                   ("radii", [[R] * 3], "an array of numbers .*, but is of type list"),
                                   ("cell", "wide", "an array of numbers, or None, but is 'wide'"),
                                   ("law", None, "an isostat.Law, but is None"),
                                   ("density", "heavy", "a number, but is 'heavy'")):
            self.expect(f"{name}: must be {words}", spheres, **{name: wrong})

    def test_of_files(self):
        for words, function, arguments, keywords in (
                ("path: must be a path, but is 5", isostat.read_packing, (5,), {}),
                ("length_unit: must be text, but is 5", isostat.read_packing, ("p.csv",), {"length_unit": 5}),
                ("length_unit: must be a length .*\"el\"", isostat.read_packing, ("p.csv",), {"length_unit": "el"}),
                ("path: must be a path, but is None", isostat.read_specimen, (None,), {}),
                ("specimen: must be an isostat.Specimen, but is of type Snapshot", isostat.write_specimen,
                 ("p.h5", spheres()), {}),
                ("snapshot: must be an isostat.Snapshot, but is of type Specimen", isostat.write_vtp,
                 ("p.vtp", isostat.Specimen(spheres())), {}),
                ("snapshot: must be an isostat.Snapshot, but is 5", isostat.Specimen, (5,), {}),
                ("target: must be a path, but is 7", isostat.convert, ("p.csv", 7), {}),
                ("path: must be a path, but is 5", isostat.list_library, (5,), {}),
                ("specimens: must be a list, each item an isostat.Specimen, but is 5", isostat.write_library,
                 ("l.h5", 5), {}),
                ("append: must be True or False, but is 'yes'", isostat.write_library, ("l.h5", []), {"append": "yes"}),
                ("folder: must be a path, but is 5", isostat.read, (5,), {}),
                ("folder: must be a path, but is 5", isostat.draw, (5, "fig_redundancy"), {})):
            self.expect(words, function, *arguments, **keywords)

    def test_of_runs(self):
        scene = isostat.Scene(contact={}, specimen={"domain": "periodic-cell", "void_ratio": 1}, stage=[STAGE])
        for name, wrong, words in (("every", -1, "a whole number, 0 or more, but is -1"),
                                   ("threads", "all", "a whole number, 0 or more, but is 'all'"),
                                   ("specimen", "p.h5", "a Specimen or a Snapshot, but is 'p.h5'. Read a file"),
                                   ("on_step", 5, "a function of a Moment, but is 5"),
                                   ("output", 5, "a path, but is 5"), ("cache", 3, "a path, but is 3"),
                                   ("overwrite", "yes", "True or False, but is 'yes'"),
                                   ("resume", "yes", "True or False, but is 'yes'")):
            output = "never" if name in ("overwrite", "resume") else None
            self.expect(f"{name}: must be {words}", isostat.run, scene,
                        **{"specimen": spheres(), "output": output, name: wrong})
        self.expect("threads: must be a whole number, 0 or more, but is -1", isostat.prepare, scene, threads=-1)
        self.expect("cache: must be a path, but is 3", isostat.prepare, scene, cache=3)
        self.expect("set: must be a dictionary of keys and values, but is 5", isostat.Scene, scene.text, set=5)
        for wrong in (None, 5):
            self.expect(f"scene: must be a.*, but is {wrong}", isostat.run, wrong)

    def test_wishes_that_contradict_each_other(self):
        scene = isostat.Scene(contact={}, specimen={"domain": "periodic-cell", "void_ratio": 1}, stage=[STAGE])
        self.expect("overwrite and resume exclude each other", isostat.run, scene, "never", overwrite=True, resume=True)
        self.expect("overwrite and append exclude each other", isostat.write_library, "l.h5", [], overwrite=True,
                    append=True)
