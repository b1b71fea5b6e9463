# SPDX-License-Identifier: BSD-3-Clause
"""From a scene to a column of packings without leaving Python: libraries of specimens, and a single specimen as one."""
import pickle

import numpy as np

from package import CONTACT, FolderTest, isostat
from isostat import column

SPECIMEN = {"grading": {"grains": 150, "cloud_edge": "2.466 mm"}, "contact": {"young": "0.5 GPa", **CONTACT},
            "specimen": {"domain": "periodic-cell", "pressure": "30 kPa", "preparation_friction": "10 deg"},
            "stage": [{"kind": "undrained-monotonic", "strain": 1e-4}]}
COLUMN = {"mesh": {"degree": 1}, "water": {"drainage": "undrained"}, "load": {"surcharge": "20 kPa"},
          "layer": [{"thickness": "2 m", "cells": 2, "density": "1970 kg/m3", "porosity": 0.41, "material": "grains"}],
          "motion": [{"kind": "harmonic", "amplitude": "0.1 g", "frequency": "5 Hz", "duration": "0.1 s"}],
          "analysis": {"duration": "0.01 s"}}


class LibraryTest(FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.scene = isostat.Scene(SPECIMEN)
        cls.specimens = [isostat.prepare(cls.scene.with_(**{"grading.seed": seed}), cache=cls.cache,
                                         quiet=True) for seed in (1, 2)]

    def run_column(self, library, name, **grains):
        scene = column.ColumnScene({**COLUMN, "title": "grains", "grains": {"library": library, **grains}})
        self.assertEqual(pickle.loads(pickle.dumps(scene)), scene)
        with self.assertWarnsRegex(isostat.IsostatWarning, f"/{name}: the analysis ends at 0.01 s"):
            results = column.run(scene, self.folder / name)
        self.assertTrue(results.warnings[0].startswith("the analysis ends"))
        return results

    def test_a_library_is_written_and_read(self):
        library = self.folder / "library.h5"
        self.assertEqual(isostat.write_library(library, self.specimens[:1]), ["s0001"])
        with self.assertRaisesRegex(isostat.InputError, "library.h5: the file exists; give overwrite=True"):
            isostat.write_library(library, self.specimens)
        packing = self.specimens[1].snapshot
        added = [self.specimens[1], isostat.Specimen(packing)]
        self.assertEqual(isostat.write_library(library, added, append=True), ["s0002", "s0003"])
        entries = isostat.list_library(library)
        self.assertEqual([entries[name]["seed"] for name in ("s0001", "s0002", "s0003")], [1, 2, 3])
        self.assert_close(entries["s0003"]["vertical_stress_Pa"], -packing.stress()[1, 1], 1e-12, "the same sum")
        again = isostat.read_specimen(f"{library}#s0002")
        np.testing.assert_array_equal(again.snapshot.positions, packing.positions)
        self.assertEqual(again.numbers, self.specimens[1].numbers)
        with self.assertRaisesRegex(isostat.InputError, r"none of them is named. Name one of its 3 entries, for "
                                    r"example .*library.h5#s0001:\n.*\n +s0001 .*\n +s0002 .*\n +s0003 "):
            isostat.read_specimen(library)
        box = isostat.Specimen(isostat.Snapshot.from_spheres([[1e-3] * 3], [1e-3], box=[[0, 0, 0], [2e-3] * 3]))
        self.assertNotIn("K0", box.numbers)
        with self.assertRaisesRegex(isostat.InputError, "specimen 0: is between rigid walls.*periodic-cell"):
            isostat.write_library(self.folder / "box.h5", [box])
        with self.assertRaisesRegex(isostat.InputError, "library.txt: must end in .h5"):
            isostat.write_library(self.folder / "library.txt", [])

    def test_a_column_takes_a_library_and_a_single_specimen(self):
        library, single, bare = (self.folder / name for name in ("two.h5", "single.h5", "bare.h5"))
        isostat.write_library(library, self.specimens)
        isostat.write_specimen(single, self.specimens[0])
        isostat.write_specimen(bare, isostat.Specimen(self.specimens[0].snapshot))
        of_library = self.run_column(library, "of_library")
        for path in (single, bare):
            of_one = self.run_column(path, f"of_{path.stem}")
            for name, values in of_library.history.items():
                np.testing.assert_array_equal(of_one.history[name], values, err_msg=f"{path.name}: {name}")
        with self.assertRaisesRegex(isostat.InputError, "single.h5: the library has 1 realisations.*needs 2.*"
                                                        r"write_library\(\)"):
            column.run(column.ColumnScene({**COLUMN, "title": "two", "grains": {"library": single, "realisations": 2}}),
                       self.folder / "too_many")
        self.assertTrue(self.run_column(library, "two", realisations=2).finished)
