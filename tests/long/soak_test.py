# SPDX-License-Identifier: BSD-3-Clause
"""A packing that liquefies and stiffens in each half of a cycle, and one that rests, for 1e7 steps each or as many as
asked for, in pieces that end by SIGTERM and continue by --resume: memory, volume, energy, momentum and the size of the
files stay what they are. Not part of the usual tests: ctest --preset long.

ISOSTAT_SOAK_STEPS    of time (1e7)       ISOSTAT_SOAK_FOLDER   keeps the runs, and continues with what is there
ISOSTAT_SOAK_MINUTES  of a piece (0.5)
"""
import json
import os
import pathlib
import signal
import subprocess
import time

import h5py
import numpy as np

from column_support import history
from support import AppTest

STEPS = int(float(os.environ.get("ISOSTAT_SOAK_STEPS", "1e7")))
MINUTES = float(os.environ.get("ISOSTAT_SOAK_MINUTES", "0.5"))
KEPT = os.environ.get("ISOSTAT_SOAK_FOLDER")
SCENE = pathlib.Path(__file__).resolve().with_name("soak.toml").read_text(encoding="utf-8")
AT_REST = '[[stage]]\nkind = "hold"\nbalance = 1e-30\n'  # which no packing meets


def memory(pid):
    """Resident, MB; 0 once it has ended."""
    try:
        text = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="ascii")
    except (FileNotFoundError, ProcessLookupError):
        return 0
    return next((int(line.split()[1]) / 1024 for line in text.splitlines() if line.startswith("VmRSS")), 0)


class Soak(AppTest):
    def run_all(self, name, text):
        """In pieces. Prints what they take."""
        place = pathlib.Path(KEPT) if KEPT else self.folder
        place.mkdir(exist_ok=True)
        self.scene, self.results = self.write("soak.toml", text), place / name
        self.table = place / f"{name}_memory.csv"  # of each piece: the largest, and history.h5, MB
        while not self.piece():
            pass
        pieces, histories = np.loadtxt(self.table, ndmin=2, delimiter=",").T
        size = sum(path.stat().st_size for path in self.results.rglob("*") if path.is_file()) / 1e6
        print(f"  {name}: {len(pieces)} pieces, {pieces[0]:.1f} MB at first, {pieces.max():.1f} MB at most; files "
              f"{size:.1f} MB", flush=True)
        own = (pieces - 6 * (histories - histories[0]))[1:]  # of those that continued, which read what there was
        self.assertGreater(len(own), 1, "too few pieces: give ISOSTAT_SOAK_MINUTES")
        early, late = np.array_split(own, 2)
        self.assert_below(late.max() / early.max(), 1.05, "rows are added to copies of history.h5; lists of pairs are "
                                                          "a little longer at times")
        summary = json.loads((self.results / "summary.json").read_text(encoding="utf-8"))
        self.assertGreaterEqual(summary["steps"], STEPS)
        rows = history(self.results)
        self.assertTrue((np.diff(rows["step"]) > 0).all())
        self.assertEqual(summary["steps"], rows["step"][-1] + 1)
        self.assertLess(1e6 * size, 1e7 + (8 + 12) * len(rows) * len(rows["step"]), "numbers of 8 bytes and as text")
        return rows

    def piece(self):
        """Runs on for some minutes. Returns whether it has finished."""
        begun = (self.results / "checkpoint").is_dir()
        command = self.command("element_test", self.scene, "-o", self.results, "-q", "--no-figures", "--threads", 1,
                               "--set", f"stage.0.max_steps={STEPS}", *(["--resume"] if begun else []))
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
            table.write(f"{largest:.1f},{(self.results / 'history.h5').stat().st_size / 1e6:.3f}\n")
        return process.returncode == 0

    def test_liquefied_again_and_again(self):
        rows = self.run_all("run", SCENE)
        sheared = rows["stage"] == 0
        step, p, e, residual, work = (rows[name][sheared] for name in ("step", "p", "e", "residual", "W_boundary"))
        with h5py.File(self.results / "checkpoint/last.h5") as file:
            velocity = np.asarray(file["state/grains/velocity"])
        mass = 1 / velocity[:, 3:]
        momentum = np.linalg.norm((mass * velocity[:, :3]).sum(axis=0)) / np.abs(mass * velocity[:, :3]).sum()
        volume = np.ptp(e) / (1 + e[0])
        print(f"  {step[-1]:.0f} steps, {rows['reversals'][-1]:.0f} reversals, p' {p.min():.1f} to {p.max():.0f} Pa\n"
              f"  volume within {volume:.1e}, residual {np.abs(residual).max():.2e} J of {np.abs(work).max():.2e} J of "
              f"work, momentum {momentum:.1e} of the sum of all", flush=True)
        halves = [p[rows["reversals"][sheared] == half] for half in range(int(rows["reversals"][-1]))]
        onset = next(k for k, half in enumerate(halves) if half.min() < 1e3)
        both = np.mean([half.min() < 1e3 and half.max() > 1e4 for half in halves[onset:]])
        print(f"  liquid from half cycle {onset} on; of {len(halves) - onset} since then {100 * both:.0f} % are liquid "
              "and stiff", flush=True)
        self.assertGreater(both, 0.9, "it is liquid and stiff in each half of a cycle")
        self.assert_below(volume, 1e-12, "it is set from the sum of strains, which is zero to round-off")
        self.assert_below(np.abs(residual).max() / np.abs(work).max(), 0.02, "first order where contacts slide")
        self.assert_below(momentum, 0.2, "local damping takes from each grain by itself, which adds up to no drift: of"
                                         " 500 grains at random it is 1/sqrt(500) = 0.04 of the sum")
        self.assertLess(len(step), STEPS / 20000 + 10 * rows["reversals"][-1] + 100)

    def test_at_rest(self):
        """Nothing moves but by round-off, no number becomes so small that the processor slows down."""
        rows = self.run_all("rest", SCENE[:SCENE.index("[[stage]]")] + AT_REST)
        with h5py.File(self.results / "checkpoint/last.h5") as file:
            numbers = {name: np.abs(np.asarray(file["state/" + name])) for name in (
                "grains/velocity", "grains/spin", "contacts/shear_force", "contacts/bending_moment")}
        print(f"  p' {rows['p'].min():.6g} to {rows['p'].max():.6g} Pa, fastest grain "
              f"{numbers['grains/velocity'][:, :3].max():.1e} m/s", flush=True)
        p, e = (rows[name][rows["step"] >= 100000] for name in ("p", "e"))  # until then it settles
        self.assert_below(np.ptp(p) / p[0], 1e-9, "round-off, by which grains wander: 2e-10 in 1e7 steps")
        self.assert_below(np.ptp(e), 1e-14, "round-off")
        for name, values in numbers.items():
            self.assertEqual(np.count_nonzero((values > 0) & (values < 1e-300)), 0, name)
