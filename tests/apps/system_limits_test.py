# SPDX-License-Identifier: BSD-3-Clause
"""What a system may put in the way of a run: quotas, limits of the size of files, folders that cannot be written, a
calendar that jumps, and a program that draws figures and is killed."""
import contextlib
import errno
import os
import resource
import signal
import subprocess
import time

from failing_runs import OUTPUT, SAVED, SHORT_TEST, FailingRuns
from support import TIME_LIMIT, children, contents, results, wait_until


class SystemLimits(FailingRuns):
    def setUp(self):
        super().setUp()
        self.scene = self.write("scene.toml", SHORT_TEST)
        self.arguments = (self.scene, *SAVED)

    def test_every_reason_is_reported(self):
        command = self.command("element_test", *self.arguments, *OUTPUT)
        _, n = self.run_failing(command, "write")
        for code in (errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EROFS, errno.EACCES):
            with self.subTest(errno.errorcode[code]):
                self.empty()
                result, _ = self.run_failing(command, "write", n // 2, code=code)
                self.assertEqual(result.returncode, 1)
                self.assertIn(os.strerror(code), result.stderr)
        for code in (errno.EROFS, errno.EACCES, errno.ENAMETOOLONG):
            with self.subTest(errno.errorcode[code]):
                self.empty()
                result, _ = self.run_failing(command, "mkdir", 1, code=code)
                self.assert_refused(result, os.strerror(code), "--output")

    def test_largest_file(self):
        """ulimit -f: whatever the limit is, files are whole, and the run continues without it to the same results.
        (Open MPI has files of its own, and ends a column by itself.)"""
        self.assert_done(self.run_app("element_test", *self.arguments, *OUTPUT))
        whole = results(self.folder / "out")
        largest = max(path.stat().st_size for path in (self.folder / "out").rglob("*") if path.is_file())
        for share in (0.02, 0.3, 0.95):
            with self.subTest(share=share):
                self.empty()
                limit = int(share * largest)
                result = self.run_command(
                    self.command("element_test", *self.arguments, *OUTPUT),
                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
                self.assertIn(result.returncode, (1, 2), result.stderr)
                self.assertIn(os.strerror(errno.EFBIG), result.stderr)
                self.resumed("element_test", self.arguments, OUTPUT)
                self.assertEqual(results(self.folder / "out"), whole)

    def test_a_calendar_that_jumps(self):
        self.assert_done(self.run_app("element_test", *self.arguments, *OUTPUT))
        whole = results(self.folder / "out")
        self.empty()
        result, n = self.run_failing(self.command("element_test", *self.arguments, *OUTPUT), "clock", 1)
        self.assert_done(result)
        self.assertGreater(n, 0)
        self.assertEqual(results(self.folder / "out"), whole)

    def test_no_one_can_read_what_is_reported(self):
        """A log on a full disk, a pipe whose end is gone, or standard files that are closed: results are all there."""
        command = self.command("element_test", *self.arguments, *OUTPUT)
        self.assert_done(self.run_app("element_test", *self.arguments, *OUTPUT))
        whole = results(self.folder / "out")
        reader, gone = os.pipe()
        os.close(reader)
        with open("/dev/full", "wb") as full:
            for stdout, stderr, code in ((subprocess.DEVNULL, full, 0), (full, subprocess.DEVNULL, 1),
                                         (subprocess.DEVNULL, gone, 0), (gone, gone, 1)):
                with self.subTest(stdout=stdout, stderr=stderr):
                    self.empty()
                    done = subprocess.run(command[:-1], cwd=self.folder, stdout=stdout, stderr=stderr, check=False)
                    self.assertEqual(done.returncode, code)
                    self.assertEqual(results(self.folder / "out"), whole)
                    self.assertTrue((self.folder / "out/summary.txt").exists())
        os.close(gone)
        self.empty()
        closed = subprocess.run(["sh", "-c", '"$0" "$@" <&- >&- 2>&-', *command[:-1]], cwd=self.folder, check=False)
        self.assertEqual(closed.returncode, 0)
        self.assertEqual(results(self.folder / "out"), whole)
        self.assertEqual((self.folder / "out/.lock").read_bytes(), b"", "it does not take the messages")

    def test_a_closed_terminal_and_the_limit_of_a_queue(self):
        for number in (signal.SIGHUP, signal.SIGXCPU):
            with self.subTest(number):
                code = self.run_and_stop(0.05, number, (self.folder / "out/checkpoint/last.h5", False), self.scene,
                                         "--set", "stage.0.max_steps=1000000", *SAVED, "-o", "out")
                self.assertEqual(code, 130)
                self.empty()
        with subprocess.Popen(self.command("element_test", *self.arguments, *OUTPUT), cwd=self.folder,
                              preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)) as process:
            while process.poll() is None:
                process.send_signal(signal.SIGHUP)
                time.sleep(0.01)
        self.assertEqual(process.returncode, 0, "what is ignored, as by nohup, stays so")

    def test_drawing_is_killed(self):
        log = self.folder / "out/figures.log"
        with self.started(self.command("element_test", self.scene, "-o", "out"), stdout=subprocess.PIPE) as process:
            wait_until(log.exists, log, process)
            time.sleep(0.2)
            for child in children(process):
                with contextlib.suppress(ProcessLookupError):
                    os.kill(child, signal.SIGKILL)
            said = process.communicate(timeout=TIME_LIMIT)[0]
        self.assertEqual(process.returncode, 0, "the run itself has finished")
        self.assertIn("figures were not drawn: the program that draws them was ended by signal 9. Draw them with: "
                      "isostat report 'out'", said)
        self.assertEqual(list((self.folder / "out").rglob("*.tmp")), [])
        numbers = contents(self.folder / "out")
        self.assert_done(self.run_app("element_test", self.scene, "-o", "out", "--resume"))
        self.assertTrue((self.folder / "out/report.html").exists())
        after = contents(self.folder / "out")
        self.assertEqual({name: after[name] for name in numbers if not name.startswith("figures")},
                         {name: data for name, data in numbers.items() if not name.startswith("figures")})
