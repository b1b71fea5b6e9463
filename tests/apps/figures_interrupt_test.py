# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C while figures are drawn: the run has finished, and the next call draws what is missing."""
import os
import signal

from column_support import ColumnTest, settings
from support import MONOTONIC, contents, tiny_scene


class Interrupted(ColumnTest):
    def stop_drawing(self, *command, with_signal=signal.SIGINT, after=0.1, stop=os.killpg, begun="figures.log",
                     parts=("interrupted while its figures were drawn; all other results are complete",
                            "isostat report 'out'")):
        """Runs it in a terminal of its own, and stops all in it (os.killpg) or the program alone (os.kill) some seconds
        after it has written the file `begun`. Returns what it said on stderr."""
        file = self.folder / "out" / begun
        code, said = self.stop_when(file.exists, file, with_signal, self.command(*command, "-o", "out", "-q"), after,
                                    lambda process, number: stop(process.pid, number), start_new_session=True)
        self.assertEqual(code, 130, said)
        for part in parts:
            self.assertIn(part, said)
        self.assertFalse((self.folder / "out/report.html").exists())
        return said

    def numbers(self):
        return {name: data for name, data in contents(self.folder / "out").items()
                if not name.startswith("figures") and name != "report.html"}

    def assert_drawn_by_resume(self, *command):
        before = self.numbers()
        result = self.run_app(*command, "-o", "out", "--resume", "--no-figures")
        self.assert_done(result)
        self.assertFalse((self.folder / "out/report.html").exists())
        result = self.run_app(*command, "-o", "out", "--resume")
        self.assert_done(result)
        self.assertIn("this run has finished", result.stdout)
        self.assertIn("Its missing figures are drawn now", result.stdout)
        self.assertNotIn("--overwrite", result.stdout)
        self.assertTrue((self.folder / "out/report.html").exists())
        self.assertEqual(self.numbers(), before)
        again = self.run_app(*command, "-o", "out", "--resume")
        self.assertIn("Start it again with --overwrite", again.stdout)

    def test_column(self):
        column = ("soil_column", self.scene, *settings(analysis__duration="0.05 s"))
        moments = [(signal.SIGINT, after) for after in (0.0, 0.04)]  # as Python starts, and later
        for k, (with_signal, after) in enumerate([*moments, (signal.SIGTERM, 0.1)]):
            with self.subTest(with_signal=with_signal, after=after):
                self.stop_drawing(*column, *(["--overwrite"] if k else []), with_signal=with_signal, after=after)
            (self.folder / "out/figures.log").unlink()
        self.assert_drawn_by_resume(*column)

    def test_element_test(self):
        test = ("element_test", self.write("tiny.toml", tiny_scene(stages=MONOTONIC.format(steps=500))))
        self.stop_drawing(*test)
        self.assert_done(self.run_app("isostat", "report", "out"))  # the command it names
        self.assertTrue((self.folder / "out/report.html").exists())
        for with_signal in (signal.SIGINT, signal.SIGTERM):
            (self.folder / "out/figures.log").unlink()
            self.stop_drawing(*test, "--overwrite", with_signal=with_signal, stop=os.kill)

    def test_ensemble(self):
        """The same command draws them."""
        self.write("a.txt", "\n".join(f"{0.01 * k} {0.1 * (-1)**(k // 10)}" for k in range(100)))
        scene = self.write("shaken.toml", self.scene.read_text(encoding="utf-8").replace(
            'kind = "harmonic"\namplitude = "0.1 g"\nfrequency = "3 Hz"\nduration = "60 s"\nramp = "1 s"',
            'kind = "record"\nfile = "a.txt"\nunit = "m/s2"'))
        ensemble = ("isostat", "ensemble", scene, "--records", "a.txt", *settings(analysis__duration="0.05 s"))
        self.stop_drawing(*ensemble, begun="summary.txt", parts=("the same command continues",))
        self.assert_done(self.run_app(*ensemble, "-o", "out", "-q"))
        self.assertTrue((self.folder / "out/report.html").exists())
