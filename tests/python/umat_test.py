# SPDX-License-Identifier: BSD-3-Clause
"""The packing as a user subroutine UMAT, libisostat_umat.so: in a small driver, and as the law of a layer."""
import ctypes
import os
import subprocess
import sys

import numpy as np

from package import BINARIES, CONTACT, FolderTest, isostat
from isostat import column

LIBRARY = BINARIES.parent / "lib/libisostat_umat.so"
NSTATV = 20_000
ORDER = [0, 1, 2, 5, 4, 3]  # xx, yy, zz, yz, xz, xy in 11, 22, 33, 12, 13, 23; and back
VOIGT = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)]


def six(stress):
    return np.array([stress[k] for k in VOIGT])


def gradient(dstran):
    """Symmetric, of strain in UMAT's order."""
    e = np.asarray(dstran)[ORDER]
    return np.array([[e[0], e[5] / 2, e[4] / 2], [e[5] / 2, e[1], e[3] / 2], [e[4] / 2, e[3] / 2, e[2]]])


class Host:
    """A finite-element program with one point: it keeps STRESS and STATEV, and calls UMAT."""

    def __init__(self, stress, nstatv=NSTATV, props=(0.0,), name="SAND"):
        self.umat = ctypes.CDLL(str(LIBRARY)).umat_
        self.stress, self.statev = np.array(stress, float), np.zeros(nstatv)
        self.props, self.name = np.array(props, float), name.ljust(80).encode()

    def call(self, dstran):
        """STRESS, STATEV, DDSDDE and PNEWDT after an increment; nothing is kept."""
        stress, statev, ddsdde, pnewdt = self.stress.copy(), self.statev.copy(), np.zeros((6, 6)), ctypes.c_double(1)
        dstran, zeros = np.array(dstran, float), np.zeros(36)
        number, three, ntens, nstatv, nprops = (ctypes.c_int(n) for n in (1, 3, 6, len(statev), len(self.props)))
        array = np.ctypeslib.as_ctypes
        refer = ctypes.byref
        free = array(zeros)
        self.umat(array(stress), array(statev), array(ddsdde), *[free] * 7, free, array(dstran), *[free] * 6,
                  ctypes.c_char_p(self.name), refer(three), refer(three), refer(ntens), refer(nstatv),
                  array(self.props), refer(nprops), free, free, refer(pnewdt), free, free, free,
                  *[refer(number)] * 5, refer(number), ctypes.c_size_t(80))
        return stress, statev, ddsdde.T, pnewdt.value

    def advance(self, dstran):
        self.stress, self.statev, ddsdde, pnewdt = self.call(dstran)
        assert pnewdt >= 1
        return ddsdde


class PackingAsUmat(FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        scene = isostat.Scene(grading={"grains": 250, "cloud_edge": "2.9 mm"}, contact=CONTACT,
                              specimen={"domain": "periodic-cell", "preparation_friction": "10 deg"})
        cls.packing = isostat.prepare(scene, cache=cls.cache).snapshot
        (specimen,) = cls.cache.glob("*.h5")
        specimen.rename(cls.folder / "sand.h5")
        os.environ["ISOSTAT_UMAT_FOLDER"] = str(cls.folder)
        cls.addClassCleanup(os.environ.pop, "ISOSTAT_UMAT_FOLDER")

    def test_it_is_the_packing_bit_for_bit(self):
        rve = isostat.Rve(self.packing)
        host = Host(np.zeros(6))
        host.advance(np.zeros(6))
        np.testing.assert_array_equal(host.stress[ORDER], six(rve.stress))
        path = np.random.default_rng(5).uniform(-2e-5, 2e-5, (6, 6))
        for k, dstran in enumerate(path):
            host.call(-3 * dstran)  # a trial that the host rejects
            ddsdde = host.advance(dstran)
            rve.advance(gradient(dstran))
            np.testing.assert_array_equal(host.stress[ORDER], six(rve.stress), f"increment {k}")
        still = host.advance(np.zeros(6))
        np.testing.assert_array_equal(still, rve.stiffness()[np.ix_(ORDER, ORDER)])
        self.assertFalse(np.array_equal(still, ddsdde))  # which was that of the start

    def test_it_begins_at_the_stress_of_its_host(self):
        target = np.array([-120e3, -120e3, -200e3, 0, 10e3, 0])
        host = Host(target)
        host.advance(np.zeros(6))
        self.assert_near(host.stress, target, 1e-3 * 150e3, "the tolerance of the servo, of p'")

    def test_mistakes_are_named(self):
        program = ("import sys; sys.path[:0] = eval(sys.argv[2]); import umat_test as u; "
                   "print(u.Host([0] * 6, int(sys.argv[3]), name=sys.argv[4]).call([0] * 6)[3])")
        for nstatv, name, *parts in ((100, "SAND", "NSTATV = 100; must be at least ", "Give for example"),
                                     (10, "SAND", "NSTATV = 10; must hold the packing"),
                                     (NSTATV, "GRAVEL", "material GRAVEL, element 1, point 1: ", "gravel.h5")):
            result = subprocess.run([sys.executable, "-c", program, str(BINARIES), repr(sys.path), str(nstatv), name],
                                    check=True, capture_output=True, text=True)
            self.assertEqual(result.stdout, "0.5\n")
            for part in ("isostat_umat: material ", *parts):
                self.assertIn(part, result.stderr)

    def scene(self):
        return column.ColumnScene({
            "title": "a packing behind the door of UMAT", "mesh": {"degree": 1}, "water": {"drainage": "dry"},
            "layer": [{"name": "sand", "thickness": "4 m", "cells": 2, "k0": 0.6, "material": "umat",
                       "umat": {"library": str(LIBRARY), "props": [0, 1e-3], "nstatv": NSTATV}}],
            "motion": [{"kind": "ricker", "amplitude": "3 m/s2", "frequency": "40 Hz"}],
            "load": {"surcharge": "100 kPa"}, "output": {"depths": ["1 m"], "history_interval": "1e-6 s"},
            "analysis": {"duration": "0.06 s"}})

    def brought_to(self, stress):
        rve = isostat.Rve(self.packing, inertial_number=1e-3)
        rve.mixed(np.zeros((3, 3)), stress, np.ones((3, 3), bool), tolerance=1e-3)
        return rve

    def test_a_point_of_a_layer_is_the_packing_bit_for_bit(self):
        point = column.SoilPoint(self.scene(), "sand")
        rve = self.brought_to(np.diag(point.stress[:3]))
        for dstran in np.random.default_rng(7).uniform(-2e-5, 2e-5, (4, 6)):
            strained = gradient(dstran)
            np.testing.assert_array_equal(point.deform(strained), six(rve.advance(strained).stress))

    def test_a_column_is_what_its_packings_are(self):
        """The strain of one point, replayed with the packing alone."""
        results = column.run(self.scene(), self.folder / "column", quiet=True)
        self.assertEqual(results.summary["layers"][0]["material"], "umat")
        rows = {name: results.history[f"d0_{name}"]
                for name in ("gamma_xz", "gamma_yz", "eps_zz", "tau_xz", "tau_yz", "sigma_v")}
        vertical = 100e3 + 2000 * 9.81 * results.history["d0_depth"][0]
        rve = self.brought_to(-np.diag([0.6, 0.6, 1]) * vertical)
        strains = np.column_stack([rows["eps_zz"], rows["gamma_xz"], rows["gamma_yz"]])
        stresses = [six(rve.stress)]
        for vertical_strain, *gamma in np.diff(strains, axis=0):
            if vertical_strain or any(gamma):  # not a first step of none
                rve.advance(gradient([0, 0, -vertical_strain, 0, *gamma]))
            stresses.append(six(rve.stress))
        expected = np.array(stresses)
        self.assertGreater(np.ptp(rows["tau_xz"]), 5e3)
        for name, values in (("tau_xz", expected[:, 4]), ("tau_yz", expected[:, 3]), ("sigma_v", -expected[:, 2])):
            self.assert_near(rows[name], values, 1e-3, "strains are differences of rows: round-off, of 1e5 Pa")
