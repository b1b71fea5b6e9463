# SPDX-License-Identifier: BSD-3-Clause
"""Numbers that the campaign of the paper takes from a test: on histories made by hand, and on laboratory tests whose
peaks are in their description."""
import pathlib
import shutil
import tempfile
import types

import numpy as np

from studies.paper import claims, lab, plan, states, tables
from studies.tables import write_csv
from support import ToleranceTest


def cyclic_history():
    """Two reversals before the onset in row 40, three behind it; p' comes back in each half cycle."""
    rows = np.arange(101)
    reversals = np.searchsorted([10, 30, 50, 70, 90], rows, side="right").astype(float)
    direction = np.where(reversals % 2 == 0, 1.0, -1.0)
    p = np.where(rows < 40, 200e3, 1e3)
    for begin, end in ((50, 70), (70, 90)):
        p[begin + 15:end] = 20e3  # back above 1 % in the last quarter
    index = np.where(rows < 35, 2.0, 0.5)
    index[p == 20e3] = 1.2
    strain = np.cumsum(np.roll(direction, 1) * np.where(rows < 40, 1e-6, 1e-4))
    ends = [10, 30, 50, 70, 90]
    columns = dict.fromkeys(("f_S", "f_R", "f_SR", "f_NSR", "F_yx", "Fxx", "Fzz"), 0.1 * np.ones(101))
    return types.SimpleNamespace(p=p, p0=200e3, q=60e3 * np.roll(direction, 1), eps_y=strain, reversals=reversals,
                                 onset=40, reversal_rows=ends, IR=index, IR_no_twist=index - 0.2,
                                 IR_sliding=index - 0.6, IR_walls=index, **columns)


class States(ToleranceTest):
    def test_a_contractive_test_has_an_instability_and_a_dense_one_has_none(self):
        strain = np.linspace(0, 0.05, 11)
        p = np.array([200, 180, 150, 120, 100, 90, 95, 110, 140, 180, 220.0])
        soft = np.array([0, 60, 80, 70, 62, 60, 70, 90, 130, 180, 240.0])
        self.assertEqual(states.undrained_states(strain, p, soft), {"instability": 2, "least p'": 5, "end": 10})
        hard = np.linspace(0, 240, 11)
        self.assertIsNone(states.undrained_states(strain, p, hard)["instability"])

    def test_the_friction_of_a_drained_test(self):
        self.assert_near(states.friction_angle(3.0, 1.0), 30, 1e-9, "round-off")
        found = {test.name: states.drained_numbers(test.strain, test.volume_strain, test.axial, test.radial)
                 for test in lab.drained_tests()}
        self.assertEqual(len(found), 8)
        dense, loose = found["TMD23"], found["TMD3"]
        self.assert_near(dense["strain at peak (%)"], 6, 1e-9, "round-off of a share")
        self.assert_near(dense["eps_v at the end (%)"], -10.4459, 1e-9, "round-off of a share")
        at_10 = np.interp(10, *np.loadtxt(lab.FOLDER / "drained/TMD23.csv", delimiter=",", skiprows=1).T[:2])
        self.assert_near(dense["eps_v at 10 % (%)"], at_10, 1e-9, "round-off of a share")
        peak = np.degrees(np.arcsin(842.98 / (842.98 + 400)))  # largest q at a cell pressure of some 200 kPa
        self.assert_near(dense["peak friction (deg)"], peak, 0.2, "the cell pressure drifts by a few kPa")
        self.assert_near(dense["dilatancy"], 0.8, 0.1, "read off the curve between 2 and 5 %")
        self.assert_near(loose["dilatancy"], 0.05, 0.05, "eps_v hardly falls behind 10 %")

    def test_walls_count_as_constraints(self):
        history = types.SimpleNamespace(N0=np.array([20]), N_floating=np.array([10]), IR=np.array([1.5]),
                                        C_wall=np.array([60]))  # 720 + 60 constraints of 90 grains
        self.assert_near(states.redundancy_with_walls(history, 100)[0], 780 / 540, 1e-12, "round-off")

    def test_crossings_are_those_upwards(self):
        self.assertEqual(list(states.crossings(np.array([0, 2, 0, 0, 3, 3, 0.0]), 1)), [1, 4])

    def test_what_happens_around_liquefaction(self):
        history = cyclic_history()
        numbers = states.cyclic_numbers(history)
        self.assertEqual(numbers["cycles"], 1.0)
        self.assertEqual(numbers["I_R at onset, Eq. 2"], 0.5)
        self.assertEqual(numbers["p'/p0' where I_R falls below 1, Eq. 2"], 1.0)
        halves = states.half_cycles(history)
        self.assertEqual([row["direction"] for row in halves], ["extension", "compression"])
        self.assertEqual(halves[0]["I_R as p'/p0' first passes 0.01"], 1.2)
        self.assert_near(halves[0]["strain travelled (%)"], 0.2, 1e-9, "round-off of 20 additions")

    def test_a_test_that_ends_at_the_onset_has_nothing_behind_it(self):
        history = cyclic_history()
        self.assertGreater(states.cyclic_numbers(history)["largest strain after, extension (%)"], 0)
        history.reversals = np.minimum(history.reversals, history.reversals[history.onset])
        numbers = states.cyclic_numbers(history)
        for name in ("largest strain after, extension (%)", "largest |F_yx| after", "f_S after"):
            self.assertTrue(np.isnan(numbers[name]), name)

    def test_half_cycles_of_all_seeds_begin_towards_compression(self):
        history = cyclic_history()
        axis = states.phases(history, 4)
        x, rows = zip(*axis)
        self.assertEqual((x[0], rows[0].start, len(axis)), (0.125, 0, 12))
        self.assertEqual([part.start < part.stop for part in rows], [True] * 12)
        self.assertEqual((rows[3].stop, rows[4].start), (41, 40), "up to the onset, and on from it")
        self.assertLess(history.p[rows[3].stop - 1] / history.p0, states.LIQUEFIED)
        self.assertEqual((rows[7].stop, rows[8].start, rows[-1].stop), (51, 70, 91), "half a cycle is left out")

    def test_verdicts(self):
        number = claims.Claim("a number", None, 17)
        for values, verdict in (([], "not tested"), ([16.9, 17.0, 17.1], "the same within 20 %"),
                                ([28.0, 28.1, 28.2], "ours is higher"), ([9.0, 9.1, 9.2], "ours is lower"),
                                ([10.0, 30.0, 16.5], "undecided"), ([17.0], "undecided")):
            self.assertEqual(claims.verdict(number, values), verdict, values)
        sentence = claims.Claim("a sentence", None)
        for values, verdict in (([1.0] * 9 + [0.5], "holds"), ([0.0, 0.1], "does not hold"), ([1, 0], "in some tests")):
            self.assertEqual(claims.verdict(sentence, values), verdict, values)

    def test_claims_take_the_tests_they_speak_of(self):
        halves = [{"specimen": "9 deg, 200 kPa", "pace": pace, "seed": 1, "half cycle": k,
                   "least I_R": least, "strain travelled (%)": k, "F_yx at its end": -0.1 * k}
                  for pace in ("default",) for k, least in ((1, 0.2), (2, 0.4), (3, np.nan), (4, np.nan), (5, np.nan))]
        tests = claims.Tests({"half_cycles": halves})
        self.assertEqual(len(tests.halves()), 1, "one test")
        self.assert_near(claims.of_halves(lambda row: row["least I_R"])(tests)[0], 0.3, 1e-12, "round-off of a mean")
        self.assertEqual(claims.correlated("half cycle", "F_yx at its end", 0)(tests), [1.0])
        halves[0]["F_yx at its end"] = -0.9
        self.assertEqual(claims.correlated("half cycle", "F_yx at its end", 0)(tests), [0.0])
        slow = [{**row, "pace": plan.SLOW, "least I_R": 0.5} for row in halves]
        both = claims.Tests({"half_cycles": halves + slow})
        self.assertEqual(claims.of_halves(lambda row: row["least I_R"])(both), [0.5], "of slow tests where there are")

    def test_every_claim_says_what_it_says_of(self):
        rows = [{"claim": claim.text, "expected": 1.0, "by": claim.source, "unit": "kPa", "ours": 2.0,
                 "standard error": 0.1, "n": 3,
                 "verdict": "ours is higher"} for claim in claims.CLAIMS]
        page = claims.markdown({"2,000 grains": rows, "none": []})
        lines = [line for line in page.splitlines() if line.startswith("| ")][1:]
        self.assertEqual(len(lines), len(claims.CLAIMS))
        self.assertEqual({line.count("|") for line in lines}, {8}, "no cell has a bar of its own")
        self.assertIn("|  | 1 kPa | 2 ± 0.1 kPa | 3 | ours is higher |", lines[1])
        self.assertEqual(len({claim.text for claim in claims.CLAIMS}), len(claims.CLAIMS))

    def test_a_run_has_one_scene(self):
        for whole in (False, True):
            for grains in (2000, 10000):
                scenes = {}
                for run in plan.runs_of(grains, 3, whole, tuple(plan.PARTS)):
                    self.assertEqual(scenes.setdefault(run.name, run.scene()), run.scene(), run.name)

    def test_rows_of_other_tests_stay_in_a_table(self):
        def row(seed, cycles, pace="default"):
            return {"specimen": "9 deg, 200 kPa", "grains": 10000, "seed": seed, "pace": pace,
                    "cycles": cycles}
        path = pathlib.Path(tempfile.mkdtemp()) / "cyclic_tests.csv"
        self.addCleanup(shutil.rmtree, path.parent)
        self.assertEqual(tables.merged(path, [row(1, 20.0)]), [row(1, 20.0)], "there is no table yet")
        write_csv(path, [row(1, 20.0), row(2, np.nan)])
        found = tables.merged(path, [row(2, 21.5), row(1, 22.0, "tenth")])
        self.assertEqual(found, [row(1, 20.0), row(2, 21.5), row(1, 22.0, "tenth")])
