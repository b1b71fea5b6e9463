# SPDX-License-Identifier: BSD-3-Clause
"""Studies of soil columns: scenes of all runs, what they share, reports of studies that are cut short."""
import argparse
import contextlib
import importlib
import io
import sys
import types

from isostat.campaign import engines, study
from support import BIN, AppTest

sys.argv[0] = str(BIN / "isostat")  # next to the programs

LIBRARIES = {"column_ensemble": (300,), "grain_column": (1000,)}
OTHERS = "canyon", "column_dissipation", "column_fitted", "column_others", "column_phenomena", "slopes_and_plates"


class StudiesOfColumns(AppTest):
    def loaded(self, name):
        """A study and its options, in a folder that has been made ready without any run."""
        module, output = importlib.import_module(f"studies.{name}"), self.folder.resolve() / name
        output.mkdir()
        for grains in LIBRARIES.get(name, ()):
            (output / f"library_{grains}.h5").touch()
        options = argparse.Namespace(output=output, quick=False, name=name, dry_run=False, overwrite=False, quiet=True,
                                     jobs=1, tables=None, seeds=None, **{})
        vars(options).update(module.DEFAULTS)
        if name not in (*LIBRARIES, "column_fitted"):
            getattr(module, "prepare", lambda *_: None)(options, None)
        return module, options

    def test_scenes(self):
        for name in (*LIBRARIES, *OTHERS):
            with self.subTest(name):
                module, options = self.loaded(name)
                runs = module.runs(options)
                self.assertEqual(len({run.name for run in runs}), len(runs))
                self.assertGreater(min(run.estimated_seconds() for run in runs), 0)
                self.assertEqual({run.program for run in runs}, {"soil_column"})
                scenes = [run.scene() for run in runs]
                self.assertEqual(None in scenes, name == "column_fitted", "known once packings have been sheared")

    def test_report_of_nothing(self):
        """A study that is stopped before its first run ends says so, and nothing else."""
        for name in (*LIBRARIES, *OTHERS):
            with self.subTest(name), contextlib.redirect_stdout(io.StringIO()):
                module, options = self.loaded(name)
                runs, tables = module.runs(options), options.output / "tables"
                tables.mkdir()
                module.report(study.Store(options.output), runs, tables)

    def test_prepare_comes_first(self):
        """And not at all with --dry-run; `--quick` leaves out long runs, and what needs a specimen that takes long."""
        called = []

        def planned(name, kind="column", specimen=None, seconds=1):
            return types.SimpleNamespace(name=name, kind=kind, specimen=specimen, scene=lambda: None,
                                         estimated_seconds=lambda: seconds)

        def runs(_):
            called.append("runs")
            return [planned("long", seconds=100), planned("made", "prepare", 1, 100), planned("of it", specimen=1)]

        module = types.SimpleNamespace(runs=runs, prepare=lambda *_: called.append("prepare"),
                                       report=lambda store, runs, folder: called.append(runs))
        options = self.loaded("column_dissipation")[1]
        options.quick = options.dry_run = True
        options.tables = self.folder / "tables"
        with engines.engine("local") as executor, contextlib.redirect_stdout(io.StringIO()) as said:
            study.do_runs(module, options, executor)
            self.assertIn("0 runs, 0 to do", said.getvalue())
            options.dry_run = False
            study.do_runs(module, options, executor)
        self.assertEqual(called, ["runs", "prepare", "runs", []])

    def test_interrupted_runs_are_estimated_by_what_is_missing(self):
        runs = [types.SimpleNamespace(spent=spent, estimated_seconds=lambda: 10) for spent in (20, 15, 0)]
        store = types.SimpleNamespace(is_done=lambda run: run is runs[0], cpu_seconds=lambda run: run.spent)
        self.assertEqual(study.what_is_left(store, runs), (runs[1:], 5 + 20), "at the speed of the first")

    def test_a_study(self):
        module, options = self.loaded("column_phenomena")
        options.output = self.folder.resolve() / "study"
        options.tables = options.output / "tables"  # else those of the page
        few = [run for run in module.runs(options) if run.case[0] in ("dilation", "wave speed")]
        with engines.engine("local") as executor, contextlib.redirect_stdout(io.StringIO()) as said:
            study.do_runs(types.SimpleNamespace(runs=lambda _: few, report=module.report), options, executor)
        self.assertIn("4 runs, 4 to do", said.getvalue())
        self.assertTrue(all(map(study.Store(options.output).is_done, few)), "nothing is left to do")
        rows = (options.tables / "dilation.csv").read_text(encoding="utf-8").splitlines()
        self.assertEqual(len(rows), 4)
        self.assertRegex(rows[1], r"elastic,0\.00e\+00 m/s2,1\.\d\de\+00 m/s2")
