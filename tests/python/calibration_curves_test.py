# SPDX-License-Identifier: BSD-3-Clause
"""Laboratory files that isostat calibrate takes and refuses, and the misfit of curves."""
import math
import pathlib
import random
from types import SimpleNamespace

import numpy as np

from calibration_test import ROUND_OFF, CalibrationTest, plan_text, read
from package import isostat
from isostat.campaign.calibrate.curves import Curve, compare, compared_strains, read_laboratory, total_misfit

HEADER = "eps_a[%],eps_v[%],sigma_v[kPa],sigma_r[kPa]\n"
ROWS = "0,0,100,100\n1,0.2,200,100\n2,0.1,250,100\n4,-0.5,300,100\n"
UNDRAINED = "eps_a[%],p[kPa],q[kPa]\n"


class Laboratory(CalibrationTest):
    def curve(self, text, more="", pressure=100e3):
        """Of a file; `more`: keys of its curve."""
        plan = read(plan_text().replace('test = "drained"\n', "") + "strain_end = 0.04\n" +
                    (more if "test =" in more else f'test = "drained"\n{more}')).curve[0]
        plan.path = str(self.folder / "lab.csv")
        pathlib.Path(plan.path).write_text(text, encoding="utf-8")
        return read_laboratory(plan, pressure)

    def test_units(self):
        curve = self.curve(HEADER + ROWS)
        self.assertEqual((curve.strain.tolist(), curve.q.tolist()), ([0, 0.01, 0.02, 0.04], [0, 100e3, 150e3, 200e3]))
        self.assert_near(curve.other[3], -0.005, 1e-12, ROUND_OFF)
        names = 'columns = { strain = "e1 (-)", volume = "ev (-)", axial = "s1 (MPa)", radial = "s3 (Pa)" }\n'
        other = self.curve("s3 (Pa),s1 (MPa),e1 (-),ev (-)\n1e5,0.1,0,0\n1e5,0.3,0.05,0.001\n", names)
        self.assert_near(other.q[1], 200e3, 1e-9, "round-off of numbers of 1e5")
        header = "eps_a (-),eps_v[%],sigma_v[MPa],sigma_r[Pa]\n"  # units that are not those of the plan
        third = self.curve(header + "0,0,0.1,1e5\n0.01,0.2,0.2,1e5\n0.04,0.1,0.25,1e5\n")
        self.assertEqual(third.strain.tolist(), [0, 0.01, 0.04])
        self.assert_near(third.q[2], 150e3, 1e-9, "round-off of numbers of 1e5")

    def test_extension_grows_in_its_direction(self):
        curve = self.curve(UNDRAINED + "0,100,0\n-1,80,-50\n-5,60,-70\n",
                           'test = "undrained"\ndirection = "extension"\n')
        self.assertEqual([column.tolist() for column in curve],
                         [[0, 0.01, 0.05], [0, -50e3, -70e3], [100e3, 80e3, 60e3]])

    def test_refusals(self):
        wet = 'test = "undrained"\n'
        for text, *parts in (
                ("eps_a[%],eps_v[%],sigma_v[kPa]\n1,2,3\n", 'lab.csv:1: no column "sigma_r[kPa]"'),
                (HEADER.replace("eps_a[%]", "eps_a") + ROWS, 'lab.csv:1: column "eps_a": no unit', "a strain must be "
                 "in one of [%], [-]", "plan.toml:11"),
                (HEADER.replace("v[kPa]", "v[bar]") + ROWS, 'column "sigma_v[bar]": the unit is bar', "[Pa], [kPa]"),
                (HEADER.replace(",", ";") + "1;2;3;4\n", "lab.csv:1", "expected commas"),
                (HEADER.replace("eps_a[%]", "eps_a[-]") + ROWS, "lab.csv:3: eps_a[-] = 1", "in percent?"),
                (HEADER + "0,0,100,100\n0.01,0,200,100\n0.04,0,200,100\n", "lab.csv:4: eps_a[%] = 0.04",
                 "before strain_end = 0.04 (4 %) of plan.toml:11"),
                (HEADER.replace("eps_v[%]", "eps_v[-]") + "0,0,100,100\n4,-2,300,100\n", "lab.csv:3: eps_v[-] = -2",
                 "not a volumetric strain"),
                (HEADER + "0,0,100,100\n2,0,200,100\n1.5,0,150,100\n5,0,200,100\n",
                 "lab.csv:4: eps_a[%] = 1.5; goes back from 2", "compression", "Remove unloading", "plan.toml:11"),
                (HEADER + "0,0,100,100\n", "lab.csv:1", "fewer than two rows"),
                (HEADER + "0,0,100,100\n1,0,x,100\n", 'lab.csv:3: sigma_v[kPa] = "x"', "finite number"),
                (HEADER + "0,0,100,100\n1,0,200\n", "lab.csv:3: 3 values; the header names 4 columns"),
                (HEADER + "0,0,100,100\n1,0,200e300,100\n", "lab.csv:3: sigma_v[kPa] = 2e+302", "not a stress of soil"),
                (HEADER + "3,0,100,100\n4,0,100,100\n", "lab.csv:2: eps_a[%] = 3", "has no beginning"),
                ("eps_a[%],eps_v[%],sigma_r[kPa],sigma_v[kPa]\n" + ROWS, "lab.csv:3: sigma_r[kPa] = 200",
                 "a lateral stress of 100 kPa", "25 %"),
                (HEADER + "0,0,100,100\n1,0.2,80,100\n4,0.5,60,100\n", "lab.csv:4: sigma_v[kPa] = 60; makes q = -40",
                 "must be > 0 in compression", "swapped"),
                (HEADER + "0,0,100,100\n1,0.2,2000,100\n4,0.5,3000,100\n", "lab.csv:3: sigma_v[kPa] = 2000", "no sand"),
                (HEADER + "0,0,100,100\n1,0.2,100.1,100\n4,0.5,100.2,100\n", "lab.csv:4: sigma_v[kPa] = 100.2",
                 "a ratio of 1.2"),
                (HEADER + "0,0,200,100\n4,0.5,300,100\n", "lab.csv:2: sigma_v[kPa] = 200", "begin isotropic"),
                (HEADER + "0,0,100,100\n0.2,-0.1,200,100\n4,0.5,300,100\n",
                 "lab.csv:3: eps_v[%] = -0.1; at an axial strain of 0.2 %", "contracts at first", "change the sign"),
                (HEADER + "0,0,100,100\n1,0.002,200,100\n4,-0.005,300,100\n", "lab.csv:4: eps_v[%] = -0.005",
                 "strain_end = 0.04", "fraction under a header in percent")):
            with self.subTest(text=text):
                self.refuse(parts, self.curve, text)
        self.refuse(("lab.csv:2: sigma_r[kPa] = 100", "a lateral stress of 200 kPa", "plan.toml:11"), self.curve,
                    HEADER + ROWS, "", 200e3)
        self.refuse(("lab.csv:3: eps_a[%] = 1; goes back from 0", "extension"), self.curve, HEADER + ROWS,
                    'direction = "extension"\n')
        self.refuse(("lab.csv:4: q[kPa] = -70", "must be > 0 in compression", "sign of q"), self.curve,
                    UNDRAINED + "0,100,0\n1,80,-50\n5,60,-70\n", wet)
        self.refuse(("lab.csv:3", "no sand bears"), self.curve, UNDRAINED + "0,100,0\n1,80,50000\n5,60,70000\n", wet)
        self.curve(UNDRAINED + "0,100,0\n1,80,50\n2,1,-2\n5,0,0.1\n", wet)  # liquefied: ratios mean nothing
        self.curve(HEADER + "0,0,100,100\n-0.2,-0.1,70,100\n-4,0.5,40,100\n", 'direction = "extension"\n')

    def test_random_files(self):
        """A file is refused with its place, or gives rows of finite numbers."""
        draw, taken = random.Random(1), 0
        for _ in range(1000):
            text = HEADER + ROWS
            for _ in range(draw.randint(1, 2)):
                at = draw.randrange(len(text))
                piece = draw.choice(("", "9", "-", ",", "\n", "e300", ".", '"', "nan", "\0", "["))
                text = text[:at] + piece + text[at + 1:]
            with self.subTest(text=text):
                try:
                    curve = self.curve(text)
                except isostat.InputError as error:
                    self.assertIn("lab.csv", str(error))
                    continue
                self.assertTrue(np.isfinite(np.array(curve)).all())
                taken += 1
        self.assertGreater(taken, 20)


class Misfit(CalibrationTest):
    def setUp(self):
        self.plan = read(plan_text()).curve[0]
        self.plan.path = "lab.csv"
        self.settings = SimpleNamespace(points=40, spacing="even")

    @staticmethod
    def curve(*columns):
        return Curve(*map(np.array, columns))

    def compare(self, laboratory, *models):
        return compare(laboratory, list(models), self.plan, self.settings)

    def test_compared_strains_begin_with_the_laboratory(self):
        self.plan.strain_end, self.settings.points = 0.04, 4
        curve = self.curve([0.011, 0.04], [1, 2], [1, 2])
        for spacing, strains in (("even", [0.02, 0.03, 0.04]), ("quadratic", [0.0225, 0.04])):
            self.settings.spacing = spacing
            self.assertEqual(compared_strains(curve, self.plan, self.settings).tolist(), strains)

    def test_of_equal_curves_is_zero(self):
        curve = self.curve([0, 0.05, 0.1], [0, 3, 4], [0, -0.01, -0.03])
        same = self.compare(curve, curve, curve)
        self.assertEqual((same.misfit, same.scatter, self.compare(curve, curve).scatter), (0, 0, None))

    def test_is_the_share_of_the_largest_value(self):
        """q is off by a tenth of its scale throughout, the volumetric strain by nothing: sqrt((0.01 + 0)/2)."""
        laboratory, model = (self.curve([0, 0.1], q, [0.01, 0.04]) for q in ([10, 20], [12, 22]))
        self.assert_near(self.compare(laboratory, model).misfit, 0.1 / math.sqrt(2), 1e-12, ROUND_OFF)

    def test_takes_the_mean_over_seeds(self):
        """Two models one scale above and below: their mean is the laboratory's curve, its standard error the scale."""
        level, above, below = (self.curve([0, 0.1], [x, x], [x, x]) for x in (1, 2, 0))
        result = self.compare(level, above, below)
        self.assert_near([result.misfit, result.scatter, result.deviation.q[0]], [0, 1, math.sqrt(2)], 1e-12, ROUND_OFF)

    def test_refusals(self):
        flat, good, short = (self.curve(*c) for c in (([0, 0.1], [0, 0], [1, 1]), ([0, 0.1], [1, 2], [1, 1]),
                                                      ([0, 0.05], [1, 2], [1, 1])))
        self.refuse(("lab.csv", "q is zero throughout"), self.compare, flat, good)
        self.refuse(("ended at a strain of 0.05", "0.1"), self.compare, good, short)

    def test_of_a_trial_is_weighted_and_leaves_out_blind_curves(self):
        curves = [SimpleNamespace(weight=w, blind=b) for w, b in ((3, False), (1, False), (1, True))]
        plan = SimpleNamespace(curve=curves)
        self.assert_near(total_misfit([0.1, 0.2, 9], plan), math.sqrt((3 * 0.01 + 0.04) / 4), 1e-12, ROUND_OFF)
