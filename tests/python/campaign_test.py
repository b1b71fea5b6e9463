# SPDX-License-Identifier: BSD-3-Clause
"""Runs of a campaign and what is in their way: another process, a user's files, another scene, a damaged checkpoint,
a signal from outside; and the folder of a campaign."""
import concurrent.futures
import os
import signal
import threading

from package import SMALL_SCENE, FolderTest, isostat
from isostat import campaign
from isostat.campaign.locks import try_lock
from isostat.campaign.runs import CRASHED

SHORT = {"stage.0.strain": 2e-4}


class CampaignTest(FolderTest):
    def run_of(self, name, **keys):
        scene = isostat.Scene(SMALL_SCENE, set=SHORT | {"specimen.cache": str(self.cache)} | keys)
        return campaign.Run.below(self.folder / self.id().rpartition(".")[2], name, scene)

    def complete(self, *runs, executor=None):
        codes = {}
        with executor or campaign.engine("local", 2) as engine:
            campaign.complete(engine, runs, lambda run, code, seconds: codes.__setitem__(run.name, code))
        return codes

    def test_a_run_at_work_is_waited_for(self):
        """And not done again, nor is its folder removed."""
        one = self.run_of("one")
        codes = self.complete(one, one)
        self.assertEqual(codes, {"one": 0})
        self.assertEqual((one.results / "provenance.txt").read_text(encoding="utf-8").count("command "), 1)

    def test_files_of_users_stay(self):
        one = self.run_of("one")
        one.results.mkdir(parents=True)
        (one.results / "thesis.tex").write_text("precious", encoding="utf-8")
        self.assertEqual(self.complete(one), {"one": 2})
        self.assertIn("holds no results", one.reason)
        self.assertEqual((one.results / "thesis.tex").read_text(encoding="utf-8"), "precious")

    def test_another_scene_and_a_damaged_checkpoint_begin_again(self):
        one, other = self.run_of("one"), self.run_of("one", **{"motion.damping": 0.3})
        self.assertEqual(self.complete(one), {"one": 0})
        self.assertTrue(list((one.results / "checkpoint").glob("*.h5")))
        self.assertEqual(self.complete(other), {"one": 0})
        self.assertTrue(other.is_finished and not one.is_finished)
        (other.results / "summary.json").unlink()
        for file in (other.results / "checkpoint").glob("*.h5"):
            file.write_bytes(b"damaged")
        self.assertEqual(self.complete(other), {"one": 0})
        self.assertGreater(other.cpu_seconds, 0)

    def test_reason_of_a_failure(self):
        bad = self.run_of("bad", **{"specimen.void_ratio": 0.2})
        self.assertIn(self.complete(bad)["bad"], range(1, CRASHED))
        self.assertRegex(bad.reason, "^(failed|error): ")
        bad.log.write_text("10 %\nfailed: step 3\n  last good checkpoint: there is none\n", encoding="utf-8")
        self.assertEqual(bad.reason, "failed: step 3; last good checkpoint: there is none")

    def test_a_full_disk_is_no_result(self):
        class Full(campaign.Run):
            def command(self, _):
                return ["sh", "-c", "echo 'failed: history.h5: cannot be written: No space left on device'; exit 1"]
        full = Full(**vars(self.run_of("full")))
        with self.assertRaisesRegex(isostat.RunFailure, "full: .*No space left on device. Make room"):
            self.complete(full)

    def test_stopped_from_outside(self):
        long = self.run_of("long", **{"stage.0.strain": 0.9})

        def end():
            while not list(long.results.glob("history.csv")):
                pass
            for path in os.scandir("/proc"):
                if path.name.isdigit():
                    with open(f"/proc/{path.name}/cmdline", "rb") as file:
                        if str(long.scene).encode() in file.read():
                            os.kill(int(path.name), signal.SIGTERM)
        threading.Thread(target=end).start()
        with self.assertRaisesRegex(isostat.RunFailure, "1 runs were stopped by another process, the first .* long"):
            self.complete(long)

    def test_what_the_engine_has_lost(self):
        class Broken(concurrent.futures.ThreadPoolExecutor):
            def submit(self, *_):  # pylint: disable=arguments-differ
                future = concurrent.futures.Future()
                future.set_exception(concurrent.futures.BrokenExecutor())
                return future
        with self.assertRaisesRegex(isostat.RunFailure, "one: the engine has lost it"):
            self.complete(self.run_of("one"), executor=Broken(1))

    def test_folder(self):
        folder, kept = self.folder / "held", {"scene.toml": "a = 1\r\n", "lab.csv": "1,2\r\n"}
        campaign.CampaignFolder(folder, kept)
        campaign.CampaignFolder(folder, kept)  # the same process comes back, with the bytes that it left
        with self.assertRaisesRegex(isostat.InputError, "belongs to another scene"):
            campaign.CampaignFolder(folder, kept | {"lab.csv": "1,3\r\n"})
        with self.assertRaisesRegex(isostat.InputError, "no_such: is not in this installation"):
            campaign.CampaignFolder(folder, kept, overwrite=True, program="no_such")
        self.assertEqual((folder / "lab.csv").read_bytes(), b"1,2\r\n")  # nothing was removed
        with open(folder / ".lock", "rb+") as file:
            self.assertFalse(try_lock(file))

    def test_engines(self):
        for name, parts in (("nothere.json", "does not exist"), ("pigeons", "is not an engine")):
            with self.assertRaisesRegex(isostat.InputError, parts), campaign.engine(name):
                pass
