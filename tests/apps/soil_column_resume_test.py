# SPDX-License-Identifier: BSD-3-Clause
"""A column that is killed and resumed, or run on several ranks, leaves the same files."""
import contextlib
import os
import random
import re
import shutil
import signal
import time

import h5py
import numpy as np

from column_support import ColumnTest, SCENES, history, settings
from support import TIME_LIMIT, contents, wait_until


class Resume(ColumnTest):
    """A run that is killed and resumed leaves the same files."""

    OPTIONS = settings(analysis__duration="5 s", output__profile_interval="0.05 s", output__paraview_interval="1 s",
                       output__checkpoint="1e-9 min")

    def interrupt(self, with_signal, expected, *more):
        arguments = [self.scene, *self.OPTIONS, *more]
        begin = os.times().elapsed
        self.assert_done(self.run_column(*arguments, "-o", "whole"))
        seconds = os.times().elapsed - begin
        moments, codes = random.Random(20240229), []
        started = (self.folder / "parts/checkpoint/last.h5", True)
        for resume in ([], ["--resume"], ["--resume"]):
            codes.append(self.run_and_stop(moments.uniform(0.02, 0.25) * seconds, with_signal, started, *arguments,
                                           "-o", "parts", *resume, program="soil_column"))
        self.assertEqual(codes[0], expected)
        return arguments

    def finish(self, arguments):
        self.assert_done(self.run_column(*arguments, "-o", "parts", "--resume"))
        self.assert_same_files("whole", "parts")

    def test_sigterm(self):
        self.finish(self.interrupt(signal.SIGTERM, 130, *settings(water__drainage="undrained",
                                                                  water__lagged_compressibility="true")))

    def test_with_air_and_a_cap(self):
        self.finish(self.interrupt(signal.SIGTERM, 130, *settings(
            water__air="boyle", layer__1__saturation=0.99, layer__0__permeability="1e-8 m/s", motion__1__axis="z")))

    def test_implicit_steps(self):
        self.finish(self.interrupt(signal.SIGTERM, 130, *settings(
            analysis__scheme="implicit", analysis__time_step="5 ms", layer__0__contraction=0)))

    def test_sigkill_and_a_damaged_checkpoint(self):
        arguments = self.interrupt(signal.SIGKILL, -signal.SIGKILL)
        checkpoints = self.folder / "parts/checkpoint"
        for name in ("fresh.h5", "last.h5"):
            if (checkpoints / name).exists():
                (checkpoints / name).write_bytes((checkpoints / name).read_bytes()[:3000])
        self.finish(arguments)

    def refuse(self, change, *parts):
        """A run that was stopped before its summary cannot be resumed after `change` of its checkpoints."""
        if not (self.folder / "kept").exists():
            self.assert_done(self.run_column(self.scene, "-o", "kept"))
            (self.folder / "kept/summary.json").unlink()
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        shutil.copytree(self.folder / "kept", self.folder / "out")
        for path in (self.folder / "out/checkpoint").iterdir():
            with h5py.File(path, "r+") as file:
                change(file)
        self.assert_refused(self.run_column(self.scene, "-o", "out", "--resume"), *parts)

    def test_a_finished_run(self):
        arguments = [self.scene, "-o", "out"]
        self.assert_done(self.run_column(*arguments))
        before = contents(self.folder / "out")
        result = self.run_column(*arguments, "--resume")
        self.assert_done(result)
        self.assertIn("this run has finished; there is nothing to resume", result.stdout)
        self.assert_refused(self.run_column(*arguments, *settings(motion__0__amplitude="0.03 g"), "--resume"),
                            "another scene")
        self.assertEqual(contents(self.folder / "out"), before)

    def test_checkpoints_that_are_not_of_this_run(self):
        self.refuse(lambda file: file.attrs.modify("schema_version", np.uint64(2)), "out/checkpoint/last.h5",
                    "schema 2 was written by another version; this one reads 6", "Finish the run with the version")
        self.refuse(lambda file: file["vectors"].move("peak_gamma", "peak_strain"), "out/checkpoint/last.h5",
                    "holds no peak_gamma", "--overwrite")
        self.refuse(lambda file: file["numbers"].attrs.pop("peak_ru"), "out/checkpoint/last.h5",
                    "holds no peak_ru", "--overwrite")
        for wrong, said in ((0.5, "last.h5: rows = 0.5, expected a whole number"),
                            (np.nan, "last.h5:/numbers/@rows: is not a finite number")):
            self.refuse(lambda file, wrong=wrong: file["numbers"].attrs.modify("rows", wrong), said, "--overwrite")

    def test_consolidation(self):
        options = [SCENES / "terzaghi.toml", *settings(analysis__steps=60, output__checkpoint="1e-9 min")]
        self.assert_done(self.run_column(*options, "-o", "whole"))
        started = (self.folder / "parts/checkpoint/last.h5", True)
        code = self.run_and_stop(0.02, signal.SIGTERM, started, *options, "-o", "parts", program="soil_column")
        self.assertIn(code, {0, 130})
        self.finish(options)


class MPIRanks(ColumnTest):
    DISTRIBUTED = settings(mesh__dimension=2, mesh__distributed="true", mesh__width="4 m", mesh__cells_across=3)

    def ranks(self, n, *more):
        """The command of a run into out/. Each rank leaves its process number in pid0, pid1 ..."""
        return ["mpirun", "--oversubscribe", "-n", str(n), "sh", "-c",
                'echo $$ > pid$OMPI_COMM_WORLD_RANK; exec "$0" "$@"',
                *self.command("soil_column", self.scene, "-o", "out", "--no-figures", *more)]

    def pid(self, rank):
        return int((self.folder / f"pid{rank}").read_text(encoding="utf-8"))

    def message_of(self, process):
        message = process.communicate(timeout=TIME_LIMIT)[1]
        self.assertNotEqual(process.returncode, 0)
        for name in ("out", "away"):
            shutil.rmtree(self.folder / name, ignore_errors=True)
        return message

    def test_signals_at_different_times(self):
        for more in settings(output__checkpoint="1e-9 min"), self.DISTRIBUTED:
            with self.subTest(more):
                history_file = self.folder / "out/history.csv"
                with self.started(self.ranks(2, *settings(analysis__duration="100000 s"), *more)) as process:
                    wait_until(history_file.exists, history_file, process)
                    for rank in (1, 0):
                        with contextlib.suppress(ProcessLookupError):  # all have stopped already
                            os.kill(self.pid(rank), signal.SIGINT)
                        time.sleep(0.3)
                    message = self.message_of(process)
                self.assertIn("interrupted at step", message)
                self.assertIn("continue with --resume", message)

    def test_a_rank_is_killed(self):
        """In the midst of a step, which waits for all ranks: the others end too, and the run continues."""
        options = settings(analysis__duration="3 s", output__checkpoint="1e-9 min")
        self.assert_done(self.run_on_ranks(3, self.scene, "-o", "whole", *options))
        checkpoint = self.folder / "out/checkpoint/previous.h5"
        for more in self.DISTRIBUTED + settings(analysis__duration="100000 s"), options:
            with self.subTest(more):
                code, message = self.stop_when(
                    checkpoint.exists, checkpoint, signal.SIGKILL,
                    self.ranks(3, *more, *settings(output__checkpoint="1e-9 min")),
                    send=lambda _, number: os.kill(self.pid(1), number))
                self.assertNotEqual(code, 0)
                self.assertIn("signal 9", message)
                if more is not options:
                    shutil.rmtree(self.folder / "out")
        self.assert_done(self.run_on_ranks(3, self.scene, "-o", "out", *options, "--resume"))
        self.assert_same_files("whole", "out")

    def test_first_rank_cannot_write_its_last_rows(self):
        for last_file, more in (
                ("profiles.h5", settings(analysis__duration="200 s", output__history_interval="10 s")),
                ("history.h5", self.DISTRIBUTED + settings(analysis__duration="10 s", output__history_interval="1 s"))):
            with self.subTest(more), self.started(self.ranks(2, *more)) as process:
                wait_until((self.folder / "out" / last_file).exists, last_file, process)
                time.sleep(0.3)  # it has begun
                (self.folder / "out").rename(self.folder / "away")
                self.assertRegex(self.message_of(process), r"failed: step \d+ \(t = [\d.]+ s\): out/history")

    def test_replicated_bit_for_bit(self):
        options = settings(output__profile_interval="0.05 s", output__paraview_interval="0.5 s")
        results = [self.run_on_ranks(n, self.scene, "-o", f"on{n}", *options) for n in (1, 3)]
        for n, result in zip((1, 3), results):
            self.assert_done(result)
            self.assertEqual(result.stdout.count("peak shear strain"), 1)
            self.assert_same_files("on1", f"on{n}")
            self.assertEqual(len(re.findall("time step .* stable up to", result.stderr)), 1)

    def test_distributed(self):
        options = self.DISTRIBUTED + settings(analysis__duration="0.3 s")
        rows = {}
        for n in (1, 3):
            self.assert_done(self.run_on_ranks(n, self.scene, "-o", f"on{n}", *options))
            rows[n] = history(self.folder / f"on{n}")
            self.assertFalse((self.folder / f"on{n}/profiles.h5").exists())
            for name in ("surface_ax", "surface_ay", "surface_vx", "surface_ux", "surface_uz", "d0_tau_xz", "d0_u",
                         "max_ru", "min_p_ratio", "external"):
                scale = np.abs(rows[1][name]).max()
                self.assertGreater(scale, 0, name)
                self.assert_near(rows[n][name], rows[1][name], 1e-10 * scale,
                                 f"round-off of sums over the ranks ({name})")

    def test_distributed_continues_from_a_checkpoint(self):
        """Interrupted on two ranks in the midst of the motion, resumed on others."""
        block = settings(mesh__dimension=3, mesh__distributed="true", mesh__width="4 m", mesh__cells_across=2)
        cap = settings(layer__0__permeability="1e-8 m/s")  # its expansion is of a whole mesh alone
        plane = self.DISTRIBUTED + cap + settings(analysis__large_strain="true")
        for shape, duration, ranks in (plane, "0.4 s", (2, 3)), (block, "0.3 s", (1,)):
            with self.subTest(shape):
                self.go_on_from_a_checkpoint(ranks, shape + settings(analysis__duration=duration,
                                                                     output__checkpoint="1e-9 min"))
            for path in list(self.folder.glob("o*")) + [self.folder / "whole"]:
                shutil.rmtree(path)

    def go_on_from_a_checkpoint(self, ranks, options):
        self.assert_done(self.run_on_ranks(2, self.scene, "-o", "whole", *options))
        checkpoint = self.folder / "out/checkpoint/last.h5"
        _, said = self.stop_when(checkpoint.exists, checkpoint, signal.SIGTERM, self.ranks(2, *options),
                                 send=lambda _, number: os.kill(self.pid(0), number))
        self.assertIn("continue with --resume", said)
        whole = history(self.folder / "whole")
        with h5py.File(checkpoint) as file:
            self.assertGreaterEqual(file.attrs["step"], 256)
            self.assertLess(file.attrs["step"], whole["step"][-1])
        for n in ranks:
            shutil.copytree(self.folder / "out", self.folder / f"on{n}")
            self.assert_done(self.run_on_ranks(n, self.scene, "-o", f"on{n}", "--resume", *options))
            resumed = history(self.folder / f"on{n}")
            for name, values in whole.items():
                if n == 2 and name not in ("internal", "external", "residual"):  # sums over the ranks
                    np.testing.assert_array_equal(resumed[name], values, name)
                elif name not in ("residual", "max_ru_depth"):  # round-off chooses between points that are alike
                    self.assert_near(resumed[name], values, 1e-10 * np.abs(values).max() + 1e-15,
                                     f"round-off of sums over the ranks ({name})")

    def test_distributed_refuses_a_damaged_point(self):
        """One rank cannot take its part: all say so, and none waits."""
        options = self.DISTRIBUTED + settings(analysis__duration="0.05 s")
        self.assert_done(self.run_on_ranks(2, self.scene, "-o", "out", *options))
        (self.folder / "out/summary.json").unlink()
        for path in (self.folder / "out/checkpoint").iterdir():
            with h5py.File(path, "r+") as file:
                data, n = file["material"], int(file["material"].attrs["bytes"])
                packed = bytearray(data[:].tobytes())
                count = next(k for k in range(1, 1000) if packed[n - 8 * k - 8:n - 8 * k] == k.to_bytes(8, "little"))
                packed[n - 8 * count - 8:n - 8 * count] = (count - 1).to_bytes(8, "little")  # numbers of the last point
                data[:] = np.frombuffer(bytes(packed), np.uint64)
        result = self.run_on_ranks(2, self.scene, "-o", "out", "--resume", *options)
        self.assertEqual(result.returncode, 2)
        self.assertIn("cannot unpack the state", result.stderr)

    def test_more_ranks_than_cells(self):
        few = settings(mesh__dimension=2, mesh__distributed="true", layer__0__cells=1, layer__1__cells=1)
        result = self.run_on_ranks(3, self.scene, "-o", "out", *few)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stderr.count("2 cells on 3 ranks"), 1)
        self.assertIn("mpirun -n 2", result.stderr)
        self.assert_done(self.run_on_ranks(2, self.scene, "-o", "out", *few, *settings(analysis__duration="0.05 s")))

    def test_failure_on_all_ranks(self):
        shutil.copy(self.scene, self.folder / "out")  # a file
        result = self.run_on_ranks(2, self.scene, "-o", "out")
        self.assertEqual(result.stderr.count("error: "), 1)
        self.assertIn("not a folder", result.stderr)
        self.assertEqual(result.returncode, 2)
