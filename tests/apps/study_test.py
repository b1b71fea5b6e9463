# SPDX-License-Identifier: BSD-3-Clause
"""isostat study: every study says what it would run; a tiny one runs, is stopped, continues, fails, reports."""
import contextlib
import io
import json
import signal

from isostat.campaign import study
from support import ROOT, TIME_LIMIT, AppTest, tiny_scene, wait_until

TINY = '''"""A tiny study."""
import dataclasses
import time

DEFAULTS, QUICK = {"seeds": 2}, {"seeds": 1}
SCENE = """@SCENE"""


def count(results, number):
    (results.parent / "begun").touch()
    while (results.parents[2] / "wait").exists():
        time.sleep(0.01)
    if (results.parents[2] / "fail").exists():
        raise ValueError("on purpose")
    return {"counted": number}


@dataclasses.dataclass(frozen=True)
class Test:
    seed: int
    kind = "test"
    name = property(lambda self: f"test{self.seed}")

    def scene(self):
        return SCENE.replace("grains = 200", f"grains = 200\\nseed = {self.seed}")

    def estimated_seconds(self):
        return 1


@dataclasses.dataclass(frozen=True)
class Call(Test):
    function = staticmethod(count)
    name = property(lambda self: f"call{self.seed}")

    def arguments(self):
        return {"number": 3}


def runs(options):
    return [run(seed) for run in (Test, Call) for seed in range(1, options.seeds + 1)]


def report(store, planned, folder):
    done = [run.name for run in planned if store.is_done(run)]
    counted = [store.run(run).result["counted"] for run in planned if run.name in done and hasattr(run, "function")]
    (folder / "report.txt").write_text(f"{' '.join(done)} {sum(counted)}")
'''


class Studies(AppTest):
    def study(self, *words):
        return self.run_command(self.command("isostat", "study", *words))

    def tiny(self, steps=2000):
        (self.folder / "studies/tiny").mkdir(parents=True)
        self.write("studies/__init__.py", "")
        self.write("studies/tiny/__init__.py",
                   TINY.replace("@SCENE", tiny_scene(stages=f'[[stage]]\nkind = "hold"\nmax_steps = {steps}\n'
                                                     "balance = 1e-30")))

    def report(self, folder="out"):
        return (self.folder / folder / "tables/report.txt").read_text(encoding="utf-8")

    def test_every_study_says_what_it_would_run(self):
        (self.folder / "studies").symlink_to(ROOT / "studies")
        names = sorted(path.parent.name for path in ROOT.glob("studies/*/__init__.py"))
        self.assertIn("paper", names)
        for name in names:
            with self.subTest(name):
                with contextlib.redirect_stdout(io.StringIO()) as said:
                    self.assertEqual(study.main([name, "--dry-run", "--quick"]), 0)
                self.assertRegex(said.getvalue(), r"^[1-9]\d* runs, (\d+) to do, some \d+ CPU minutes\n$")
        result = self.study("paper", "--dry-run", "--quick")
        self.assert_done(result)
        self.assertRegex(result.stdout, "^[1-9].* runs, ")
        self.assertFalse((self.folder / "results").exists())
        listed = self.study("--list")
        self.assert_done(listed)
        self.assertEqual(listed.stdout, self.study().stdout)
        rows = [line.split(maxsplit=2) for line in listed.stdout.splitlines()[3:-1]]
        self.assertEqual([row[0] for row in rows], names)
        stamps = json.loads((ROOT / "studies/stamps.json").read_text(encoding="utf-8"))
        self.assertEqual({row[0]: row[1] for row in rows if row[0] in stamps},
                         {name: str(of["minutes"]) for name, of in stamps.items()})
        self.assertIn("--dry-run", self.study("--help").stdout)

    def test_it_runs_what_is_missing(self):
        self.tiny()
        result = self.study("tiny", "--quick", "-o", "out")
        self.assert_done(result)
        self.assertEqual(self.report(), "test1 call1 3")
        self.assertIn("2 runs, 2 to do", result.stdout)
        result = self.study("tiny", "-o", "out")
        self.assert_done(result)
        self.assertIn("4 runs, 2 to do", result.stdout)
        self.assertEqual(self.report(), "test1 test2 call1 call2 6")
        self.assert_done(again := self.study("tiny", "-o", "out"))
        self.assertIn("4 runs, 0 to do", again.stdout)

    def test_it_is_stopped_and_continues(self):
        """In a run of a program, then in that of a function."""
        self.tiny(steps=200_000)
        self.write("wait", "")
        for begun in ("runs/test1/history.csv", "runs/begun"):
            with self.started(self.command("isostat", "study", "tiny", "--quick", "-o", "out")) as process:
                wait_until((self.folder / "out" / begun).exists, begun, process)
                process.send_signal(signal.SIGTERM)
                _, err = process.communicate(timeout=TIME_LIMIT)
            self.assertEqual(process.returncode, 130, err)
            self.assertIn("the same command continues", err)
        log = (self.folder / "out/logs/test1.log").read_text(encoding="utf-8")
        self.assertIn(" steps, the last ", log, "it was resumed")
        self.assertEqual(self.report(), "test1 0")
        (self.folder / "wait").unlink()
        self.assert_done(self.study("tiny", "--quick", "-o", "out"))
        self.assertEqual(self.report(), "test1 call1 3")

    def test_a_run_fails(self):
        self.tiny()
        self.assert_done(self.study("tiny", "--quick", "-o", "out"))
        self.write("fail", "")
        result = self.study("tiny", "-o", "out")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("failed: 1 of 4 runs failed, the first of them call2: ValueError: on purpose", result.stderr)
        self.assertEqual(self.report(), "test1 test2 call1 3", "the others are kept and reported")
        (self.folder / "fail").unlink()
        self.assert_done(self.study("tiny", "-o", "out"))

    def test_refusals(self):
        self.tiny()
        self.assert_refused(self.study("nothing"), "nothing", "tiny")
        self.assert_refused(self.study("../tiny"), "../tiny", "tiny")
        self.assertEqual(self.study("tiny", "--seeds", "0").returncode, 2)
        (self.folder / "mine").mkdir()
        self.write("mine/notes.txt", "")
        self.assert_refused(self.study("tiny", "-o", "mine"), "mine", "not overwritten")
