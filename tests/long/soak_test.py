#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A packing that liquefies and stiffens twice in each cycle, for 1e7 steps or as many as asked for, in pieces that end
by SIGTERM and go on by --resume: memory, volume, energy, momentum and the size of the files stay what they are. Not
part of the usual tests: ctest --preset long.

ISOSTAT_SOAK_STEPS    of time (1e7)       ISOSTAT_SOAK_FOLDER   keeps the run, and goes on with what is there
ISOSTAT_SOAK_MINUTES  of a piece (1)
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import time

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "apps"))
from support import AppTest, main  # noqa: E402  (the path comes first)

STEPS = int(float(os.environ.get("ISOSTAT_SOAK_STEPS", "1e7")))
MINUTES = float(os.environ.get("ISOSTAT_SOAK_MINUTES", "1"))
KEPT = os.environ.get("ISOSTAT_SOAK_FOLDER")
SCENE = pathlib.Path(__file__).resolve().with_name("soak.toml")


def memory(pid):
    """Resident, MB; 0 once it has ended."""
    try:
        text = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="ascii")
    except (FileNotFoundError, ProcessLookupError):
        return 0
    return next((int(line.split()[1]) / 1024 for line in text.splitlines() if line.startswith("VmRSS")), 0)


class Soak(AppTest):
    def setUp(self):
        super().setUp()
        self.results = pathlib.Path(KEPT) if KEPT else self.folder / "out"
        self.table = self.results.with_name(self.results.name + "_memory.csv")  # largest of each piece, MB

    def piece(self):
        """Runs on for some minutes. Returns whether it has finished."""
        begun = (self.results / "checkpoint").is_dir()
        command = self.command("element_test", SCENE, "-o", self.results, "-q", "--no-figures", "--threads", 1, "--set",
                               f"stage.0.max_steps={STEPS}", *(["--resume"] if begun else []))
        end, largest = time.monotonic() + 60 * MINUTES, 0
        with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE, text=True,
                              stdout=subprocess.DEVNULL) as process:
            while process.poll() is None and time.monotonic() < end:
                time.sleep(0.5)
                largest = max(largest, memory(process.pid))
            process.send_signal(signal.SIGTERM)
            said = process.communicate()[1]
        self.assertIn(process.returncode, (0, 130), said)
        with open(self.table, "a", encoding="ascii") as table:
            table.write(f"{largest:.1f}\n")
        return process.returncode == 0

    def test_nothing_grows(self):
        while not self.piece():
            pass
        with h5py.File(self.results / "history.h5") as file:
            rows = {name: np.asarray(values) for name, values in file["history"].items()}
        sheared = rows["stage"] == 0
        step, p, e, residual, work = (rows[name][sheared] for name in ("step", "p", "e", "residual", "W_boundary"))
        pieces = np.loadtxt(self.table, ndmin=1)
        size = sum(path.stat().st_size for path in self.results.rglob("*") if path.is_file()) / 1e6
        with h5py.File(self.results / "checkpoint/last.h5") as file:
            velocity = np.asarray(file["state/grains/velocity"])
        mass = 1 / velocity[:, 3:]
        momentum = np.linalg.norm((mass * velocity[:, :3]).sum(axis=0)) / np.abs(mass * velocity[:, :3]).sum()
        volume = np.ptp(e) / (1 + e[0])
        summary = json.loads((self.results / "summary.json").read_text(encoding="utf-8"))
        print(f"  {step[-1]:.0f} steps in {len(pieces)} pieces, {rows['reversals'][-1]:.0f} reversals, "
              f"p' {p.min():.1f} to {p.max():.0f} Pa\n"
              f"  volume within {volume:.1e}, residual {np.abs(residual).max():.2e} J of {np.abs(work).max():.2e} J of "
              f"work, momentum {momentum:.1e} of the sum of all\n"
              f"  memory {pieces[0]:.1f} MB at first, {pieces.max():.1f} MB at most; files {size:.1f} MB", flush=True)
        self.assertEqual(summary["steps"], step[-1] + 1)
        self.assertGreaterEqual(summary["steps"], STEPS)
        self.assertTrue((np.diff(step) > 0).all())
        self.assertLess(p.min(), 1e3)
        self.assertGreater(p.max(), 1e5)
        self.assert_below(volume, 1e-12, "it is set from the sum of strains, which is zero to round-off")
        self.assert_below(np.abs(residual).max() / np.abs(work).max(), 0.02, "first order where contacts slide")
        self.assert_below(momentum, 0.5, "local damping takes from each grain by itself; it does not add up to a drift")
        self.assert_below(pieces.max() / pieces[0], 1.05, "lists of pairs are a little longer at times")
        self.assertLess(1e6 * size, 1e7 + 8 * 60 * len(rows["step"]))
        self.assertLess(len(rows["step"]), STEPS / 20000 + 10 * rows["reversals"][-1] + 100)


if __name__ == "__main__":
    main()
