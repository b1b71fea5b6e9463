# SPDX-License-Identifier: BSD-3-Clause
"""The figures of the soil column: their analysis against closed forms, and that a run gets those it has data for."""
import contextlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np

import column_fixture as fixture
from figures.column_analysis import (Terzaghi, exact_transfer, response_spectrum, smoothed,
                                     transfer_function)
from figures.column_consolidation import isochrones, settlement, unit_of
from figures.column_results import Column, quantity
from figures.column_grains import first, shade_index
from figures.column_soil import moving_shears, outline
from figures.common import BadInput, plt, use_style
from figures.soil_column import DRAWING
from element_figures_test import covered
from support import ROOT, TIME_LIMIT, ToleranceTest

PERIODS = np.array([0.02, 0.05, 0.2, 0.5, 1, 3, 10])


def step_peak(damping):
    """Peak of y = 1 - exp(-xi w t)(cos wd t - (xi w/wd) sin wd t), the answer to a sudden acceleration of 1."""
    x = np.pi - np.arctan2(2 * damping * np.sqrt(1 - damping**2), 1 - 2 * damping**2)
    ratio = damping / np.sqrt(1 - damping**2)
    return 1 - np.exp(-ratio * x) * (np.cos(x) - ratio * np.sin(x))


class ResponseSpectrum(ToleranceTest):
    def test_sudden_acceleration(self):
        for damping in (0.0, 0.05, 0.2):
            spectrum = response_spectrum(np.full(3001, 2.0), 0.01, PERIODS, damping)
            error = spectrum / (2 * step_peak(damping)) - 1
            print(f"step, damping {damping}: error {np.abs(error).max():.1e}")
            self.assert_below(error.max(), 1e-10, "round-off of 30 s in steps of T/64")
            self.assertGreater(error.min(), -1.3e-3)  # 1 - cos(pi/64)

    def test_resonance(self):
        """Steady state of a sine at the oscillator's own frequency: sqrt(1 + 4 xi^2)/(2 xi)."""
        t = 0.002 * np.arange(30001)
        value = response_spectrum(np.sin(2 * np.pi * t), 0.002, [1.0], 0.05)[0]
        self.assert_close(value * 0.1, np.sqrt(1.01), 2e-4,
                          "a crest between samples 0.002 s apart, and the straight line between them")

    def test_stiff_oscillator(self):
        a = fixture.ricker(0.005 * np.arange(400), 1.5, 4.0)
        self.assert_close(response_spectrum(a, 0.005, [0.01], 0.05)[0], 1.5, 2e-3,
                          "stiff: moves with the ground except for (T f)^2")

    def test_response_after_the_motion(self):
        """A short kick: the peak comes after it. Impulse a0 dt/2 of one step: velocity, then w v without damping."""
        value = response_spectrum(np.array([0.0, 1.0, 0.0]), 0.001, [1.0], 0.0)[0]
        self.assert_close(value, 2 * np.pi * 0.001, 2e-3, "1 - cos(pi/64): the crest between two steps of T/64")


class TransferFunction(ToleranceTest):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="isostat_column_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def largest_difference(self, rock):
        column = Column(fixture.elastic(self.folder / "run", rock))
        surface, dt = column.motion("surface_ax")
        f, ratio, strong = transfer_function(surface, column.motion("input_ax")[0], dt, 20.0)
        exact = exact_transfer(f, column.uniform_elastic(), column.base, **column.damping)
        self.assertLess(f[strong][0], 1.0)
        self.assertGreater(f[strong][-1], 10.0)
        return np.abs(ratio / exact - 1)[strong].max()

    def test_rigid_base(self):
        error = self.largest_difference(None)
        print(f"rigid base: largest difference {error:.1e}")
        self.assert_below(error, 1e-4, "the pulse is cut off where it is 1e-4 of its peak")

    def test_compliant_base(self):
        error = self.largest_difference(fixture.ROCK)
        print(f"compliant base: largest difference {error:.1e}")
        self.assert_below(error, 1e-4, "the pulse is cut off where it is 1e-4 of its peak")

    def test_without_damping(self):
        """1/cos(kH), and over rock as stiff as the soil 1."""
        layer = {"height": 20.0, "velocity": 200.0, "density": 1900.0}
        f = np.array([0.5, 2.0, 4.0, 6.0])
        expected = 1 / np.abs(np.cos(2 * np.pi * f * 0.1))
        self.assert_near(exact_transfer(f, layer, None, 0.0), expected, 1e-7 * expected,
                         "round-off near the poles of 1/cos")
        same = {"velocity": 200.0, "density": 1900.0}
        self.assert_near(exact_transfer(f, layer, same, 0.0), 1, 1e-12, "round-off of complex functions")

    def test_smoothing_keeps_a_constant(self):
        f = np.linspace(0, 50, 2001)
        self.assert_near(smoothed(f, np.full(2001, 3.0), np.geomspace(0.5, 20, 50)), 3, 3e-12, "round-off of means")
        coarse, fine = np.arange(0, 20, 0.05), np.linspace(0.05, 0.5, 400)
        line = smoothed(coarse, coarse, fine)  # no step from one frequency of the motion to the next
        self.assert_below(np.abs(np.diff(line)).max(), 0.01, "a tenth of the distance of 0.05 Hz, at most")


class Consolidation(ToleranceTest):
    def test_tabulated_degrees(self):
        """U = 50 % at T = 0.197, 90 % at T = 0.848 (Terzaghi 1943), water much stiffer than the soil."""
        layer = {"height": 10.0, "density": 2000.0, "velocity": 100.0, "poisson_ratio": 0.2, "porosity": 0.3,
                 "permeability": 1e-6}
        water = {"density": 1000.0, "gravity": 9.81, "bulk_modulus": 1e18}
        exact = Terzaghi(layer, water, 50e3)
        modulus = 2 * 2000 * 100**2 * 0.8 / 0.6
        for factor, degree in ((0.197, 0.5), (0.848, 0.9)):
            t = factor * 100 / (1e-6 / 9810 * modulus)
            self.assert_near(exact.settlement([t])[0] / (10 * 50e3 / modulus), degree, 1e-3,
                             "three digits in the table")
        self.assert_near(exact.pressure(np.array([0.0]), 1.0)[0], 0, 5e-8,
                         "round-off of a series of sines of multiples of pi")


class Figures(ToleranceTest):
    laid_out = set()  # names of figures, each of them once

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="isostat_column_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def draw(self, folder, *arguments):
        return subprocess.run([sys.executable, "-m", "figures", "soil_column", str(folder), *arguments],
                              env={**os.environ, "PYTHONPATH": str(ROOT / "apps")}, capture_output=True, text=True,
                              timeout=TIME_LIMIT, check=False)

    def expect(self, folder, *names):
        """Those figures are made that there is data for, without a note, no legend over a curve.   Returns what is
        printed"""
        use_style()
        with contextlib.redirect_stdout(io.StringIO()) as said, contextlib.redirect_stderr(io.StringIO()) as notes:
            column = DRAWING.results(folder)
            figures = {name: draw(column) for name, draw in DRAWING.figures.items()}
        self.assertEqual(notes.getvalue(), "")
        self.assertEqual({name for name, figure in figures.items() if figure}, {"fig_" + name for name in names})
        for name, figure in figures.items():
            if figure and name not in self.laid_out:
                self.assertEqual(covered(figure), [], name)
                self.laid_out.add(name)
        plt.close("all")
        return said.getvalue()

    def test_elastic_layer(self):
        text = self.expect(fixture.elastic(self.folder / "run"), "motions", "spectra", "transfer", "profiles", "loops")
        said = re.search(r"difference from the exact curve (\S+) of its value", text)
        self.assert_below(float(said[1]), 1e-4, "the pulse is cut off where it is 1e-4 of its peak")

    def test_short_run_is_noted(self):
        """A layer that still swings when the run ends has no clean transfer function, and a message says so."""
        column = DRAWING.results(fixture.elastic(self.folder / "run", end=3.0))
        with contextlib.redirect_stderr(io.StringIO()) as notes:
            plt.close(DRAWING.figures["fig_transfer"](column))
            self.assertIn("surface still moves", notes.getvalue())
            half = int(np.argmax(np.abs(column["input_ax"]))) + 3  # amid the pulse
            column.columns = {name: values[:half] for name, values in column.columns.items()}
            self.assertIsNone(DRAWING.figures["fig_transfer"](column))
        self.assertIn("fig_transfer: the run ends while the input along x still moves", notes.getvalue())

    def test_shear_that_is_noise_is_not_drawn(self):
        """Next to a change of the vertical stress, as under a load on all of a box."""
        column = DRAWING.results(fixture.elastic(self.folder / "run"))
        self.assertEqual(moving_shears(column), ["x"])
        strongest = max(column.peak(f"{prefix}_tau_xz") for _, prefix in column.points)
        for _, prefix in column.points:
            column.columns[f"{prefix}_sigma_v"] = np.linspace(0, 2e3 * strongest, len(column.time))
        self.assertEqual(moving_shears(column), [])

    def test_consolidation(self):
        text = self.expect(fixture.consolidation(self.folder / "run"), "isochrones", "settlement")
        for what in ("pore pressure", "settlement"):
            said = re.search(what + r": largest difference from Terzaghi's series (\S+)", text)
            self.assert_below(float(said[1]), 1e-3, "the fixture is the series with fewer terms")

    def test_one_that_fails_costs_no_other(self):
        """A history whose settlement has another length than its time."""
        column = DRAWING.results(fixture.consolidation(self.folder / "run"))
        column.columns["settlement"] = column["settlement"][1:]
        with contextlib.redirect_stdout(io.StringIO()) as drawn, contextlib.redirect_stderr(io.StringIO()), \
                self.assertRaisesRegex(BadInput, r"^not drawn: fig_settlement \(IndexError: .*\)$"):
            DRAWING.draw(column, self.folder)
        self.assertEqual([path.name for path in self.folder.glob("*.png")], ["fig_isochrones.png"])
        self.assertIn("fig_isochrones.png", drawn.getvalue())

    def test_isochrones_of_late_times_alone(self):
        """A logarithm of time has no 0, though it is nearest to the first round time factors."""
        column = Column(fixture.consolidation(self.folder / "run"))
        for name in ("time", "u"):
            column.profiles[name] = column.profiles[name][[0, -1]]
        self.assertEqual(len(isochrones(column).axes), 2)

    def test_the_series_is_smooth_where_rows_are_few(self):
        column = Column(fixture.consolidation(self.folder / "run", rows=4))
        (axes,) = settlement(column).axes
        computed, series = (line.get_xydata() for line in axes.lines)
        self.assertEqual(len(computed), 4)
        self.assert_below(np.abs(np.diff(series[:, 1])).max(), 0.02 * np.ptp(series[:, 1]), "no corners are seen")

    def test_units_of_long_times(self):
        for last, unit in ((100, "s"), (1800, "minutes"), (7200, "hours"), (3e5, "days"), (1e8, "years")):
            self.assertEqual(unit_of(last)[0], unit)

    def test_expansion_under_a_cap(self):
        folder = fixture.capped(self.folder / "run")
        self.assertEqual(Column(folder).capped_boundaries(), [2.0])
        self.expect(folder, "motions", "spectra", "transfer", "profiles", "velocity", "ru_map",
                    "histories", "loops", "expansion")

    def test_grains(self):
        self.expect(fixture.grains(self.folder / "run"), "motions", "spectra", "transfer", "profiles", "velocity",
                    "ru_map", "histories", "loops", "grains_profiles", "grains_map", "grains_history")

    def test_packings(self):
        """A line along each half of a contact, as wide as its force; none where the network is gone."""
        folder = fixture.packings(self.folder / "run")
        self.expect(folder, "motions", "spectra", "transfer", "profiles", "velocity", "ru_map", "histories", "loops",
                    "grains_profiles", "grains_map", "grains_history", "picture")
        figure = DRAWING.figures["fig_picture"](Column(folder))
        start, *_, end = [axes.collections[-1] for axes in figure.axes if not axes.axison]
        self.assertEqual(end.get_segments(), [])
        halves = sorted((round(1e3 * a[0], 9), round(1e3 * b[0], 9)) for a, b in start.get_segments())
        self.assertEqual(halves, [(0, -0.5), (0, 0.5), (1, 0.5), (2, 2.5)])
        narrow, wide = sorted(set(start.get_linewidths()))
        self.assert_near(wide / narrow, 2, 1e-12, "of the forces")
        plt.close(figure)

    def test_grains_without_profiles(self):
        """What remains of a run is drawn: here the history at the output depths, and no r_u in profiles.h5."""
        folder = fixture.grains(self.folder / "run")
        shutil.rmtree(folder / "grain_profiles")
        (folder / "profiles.h5").unlink()
        self.expect(folder, "motions", "spectra", "transfer", "histories", "loops", "grains_history")

    def test_sine_has_no_transfer_function(self):
        folder = fixture.elastic(self.folder / "run", motion=fixture.sine)
        self.expect(folder, "motions", "spectra", "profiles", "loops")

    def test_history_alone(self):
        """No scene, no profiles, no summary: notes, and the figures that history.csv is enough for."""
        folder = fixture.elastic(self.folder / "run")
        for name in ("scene.toml", "profiles.h5", "summary.json", "spectra.csv"):
            (folder / name).unlink()
        result = self.draw(folder, "--out", str(self.folder / "it's here"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("scene.toml", result.stderr)
        self.assertIn("no spectra.csv", result.stderr)
        figures = sorted((self.folder / "it's here").iterdir())
        self.assertEqual([path.stem for path in figures], ["fig_loops", "fig_motions", "fig_spectra", "fig_transfer"])
        for path in figures:
            self.assertGreater(path.stat().st_size, 10000)

    def test_missing_results(self):
        result = self.draw(self.folder)
        self.assertEqual(result.returncode, 2)
        self.assertIn("history.csv", result.stderr)

    def test_quantities(self):
        for text, value in (("5 m", 5), ("2.3 g/cm3", 2300), ("0.1 g", 0.980665), (7, 7), ("37.5 MPa", 37.5e6)):
            self.assert_close(quantity(text), value, 1e-12, "round-off of one product")


class Grains(ToleranceTest):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="isostat_column_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def test_read(self):
        """From the surface down, p10 after p9; times by depths; no velocity, which the scene does not have."""
        column = Column(fixture.grains(self.folder / "run"))
        grains = column.grains.profiles
        self.assert_close(grains["depth"], column.profiles["depth"], 1e-12, "the same numbers, written and read")
        self.assertEqual(grains["IR"].shape, (len(grains["time"]), len(grains["depth"])))
        ru = column.profiles["ru"]
        self.assert_close(grains["IR"], 2.1 - 1.1 * (ru / 0.9) ** 4, 1e-9,
                          "the same numbers, written with twelve digits")
        self.assertEqual([prefix for _, prefix in column.grains.points], ["d0", "d1", "d2", "d3"])
        self.assertIsNone(column.layers[0]["velocity"])
        self.assertIsNone(column.uniform_elastic())

    def test_no_colour_where_there_are_no_grains(self):
        """Neither over layers of another material, between others or at an end, nor before the first and after the last
        time; lines break between layers."""
        column = Column(fixture.grains(self.folder / "run"))
        whole, (time, depth) = column.grains.profiles, (column.grains.profiles[name] for name in ("time", "depth"))
        for lies, painted in (((depth > 2) & (depth < 8), [(2, 8)]), ((depth < 2) | (depth > 8), [(0, 2), (8, 15)]),
                              (depth > 8, [(8, 15)])):
            kept = slice(1, -1)
            column.grains.profiles = {"time": time[kept], "depth": depth[lies],
                                      **{name: values[kept][:, lies] for name, values in whole.items()
                                         if name not in ("time", "depth")}}
            figure, axes = plt.subplots()
            x, y, _ = shade_index(column, figure, axes, 20)
            cells = axes.collections[0].get_array().reshape(len(y) - 1, len(x) - 1)
            self.assertEqual((x[0], x[-1]), (time[1], time[-2]))
            coloured = np.isfinite(np.ma.filled(cells, np.nan)).all(axis=1)
            for top, bottom, colour in zip(y[:-1], y[1:], coloured):
                self.assertEqual(colour, any(a <= top and bottom <= b for a, b in painted), (top, bottom))
            self.assert_near((y[0], y[-1]), (painted[0][0], painted[-1][1]), 1e-12, "boundaries of the scene")
            z, _ = column.broken(depth[lies], depth[lies])
            self.assertEqual(np.isnan(z).sum(), len(painted) - 1)
            plt.close(figure)

    def test_none(self):
        grains = Column(fixture.liquefaction(self.folder / "run")).grains
        self.assertEqual((grains.points, grains.profiles), ([], {}))

    def test_onset(self):
        time = np.array([0.0, 0.5, 1.0])
        self.assertEqual(first(time, np.array([False, True, False])), 0.5)
        self.assertIsNone(first(time, np.zeros(3, dtype=bool)))

    def test_outline(self):
        """Of one cell its four sides, of a row along the edge of the map the side within."""
        class Canvas:
            def add_collection(self, lines):
                self.sides = {tuple(sorted(map(tuple, side.tolist()))) for side in lines.get_segments()}
        x, y, inside, canvas = np.arange(4.0), np.arange(4.0), np.zeros((3, 3), dtype=bool), Canvas()
        inside[1, 1] = True
        outline(canvas, x, y, inside)
        self.assertEqual(canvas.sides, {((1, 1), (2, 1)), ((1, 2), (2, 2)), ((1, 1), (1, 2)), ((2, 1), (2, 2))})
        inside[:] = [[True] * 3, [False] * 3, [False] * 3]
        outline(canvas, x, y, inside)
        self.assertEqual(canvas.sides, {((k, 1), (k + 1, 1)) for k in range(3)})


class SimulatedMotion(ToleranceTest):
    def test_files_are_what_the_script_makes(self):
        import make_motion
        for component, axis in enumerate("xy"):
            path = fixture.SCENES / f"motions/simulated_m6.5_20km_{axis}.at2"
            lines = path.read_text(encoding="ascii").splitlines()
            self.assertIn("SIMULATED", lines[0])
            said = lines[1].split("make_motion.py ")[1].split()
            p = make_motion.parameters([*said, "--check"])
            a = make_motion.simulate(p, component, p.seed)
            self.assertIn(f"NPTS= {len(a)}, DT= {p.interval:.4f} SEC", lines[3])
            self.assert_near(fixture.record(axis), a, 1e-7 * np.abs(a) + 2e-5,
                             "1e-6 g and the other machine's round-off")

    def test_check(self):
        import make_motion
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            good = make_motion.check(make_motion.parameters(["--check"]))
        print(said.getvalue())
        self.assertEqual(good, 0)
