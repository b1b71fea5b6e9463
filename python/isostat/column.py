# SPDX-License-Identifier: BSD-3-Clause
"""The soil column, with your own materials. Needs the compiled part that is built with deal.II.

tested: tests/python/column_test.py
"""
import abc
import importlib
import io
import pathlib

import numpy as np

from isostat import _core
from isostat.calls import check_use, path_text, warned
from isostat.results import Results, read_table
from isostat.scene import Scene, scene_source

try:
    from isostat import _column
except ImportError as error:
    raise ImportError(f"the soil column is not in this installation ({error}). Build Isostat with deal.II "
                      "(-DISOSTAT_FEM=ON, the default of its CMake) and take the package from there; the wheel of "
                      "`pip install` has the grains alone.") from error


class ColumnScene(_column.ColumnScene):
    """A column of soil: mesh, water, layers, base, motions, load, analysis, output; given as an isostat.Scene is.

    ColumnScene("apps/scenes/column/uniform_layer.toml", set={"analysis.duration": "2 s"})
    Raises InputError with the place, the value, the allowed range and a remedy.
    """

    def __init__(self, source=None, /, *, set=None, **sections):
        super().__init__(*scene_source(source, set, sections))

    def member(self, k):
        """The k-th member of an ensemble, as `isostat ensemble` runs it. Layers of grains have the seeds of their library
        that follow those of the members before, or, where seeds are drawn at random, `lot` is k more. Member 0 is the
        scene itself.

        runs = [column.run(scene.member(k), f"results/member_{k}") for k in range(8)]
        """
        sections = self.to_dict()
        for layer in sections["layer"]:
            if layer["material"] == "grains" and layer["mixed_realisations"] > 1:
                layer["lot"] += k
            elif layer["material"] == "grains":
                layer["realisation"] += k * sections["grains"]["realisations"]
        return type(self)(sections)

    with_ = Scene.with_
    __reduce__ = Scene.__reduce__
    to_dict = Scene.to_dict

    def __repr__(self):
        return f"<isostat.column.ColumnScene {self.title!r}>"


class Material(abc.ABC):
    """The law of a layer whose scene says material = "user", for all its n Gauss points at once.

    The state is a dictionary of arrays that the class chooses; the solver keeps the committed one and that of the last
    trial, writes it to checkpoints, and asks for a step as often as it needs. So update() must not change the state that
    it is given: its arrays are read-only. Order of components: xx, yy, zz, yz, xz, xy; tension positive; effective stress in Pa; shear strain as
    gamma = 2 eps. Arrays that are given are read-only copies.
    """

    @abc.abstractmethod
    def initial(self, stress):
        """The state in situ.   stress: effective, (n, 6)   returns the state"""

    @abc.abstractmethod
    def update(self, state, gradient):
        """A step from a state.   gradient: increment of d u_i / d x_j, (n, 3, 3)   returns (stress (n, 6), new state)"""

    @abc.abstractmethod
    def stiffness(self, state):
        """d stress / d strain, (n, 6, 6), Pa: the tangent of an implicit step, and what waves meet."""

    def wave_moduli(self, state):
        """rho V_p^2 and rho V_s^2, the largest over all directions, (n, 2), Pa: they bound the time step of waves.

        Asked at every step. This one has the formula of an isotropic stiffness() and searches the directions of any
        other; your own formula is faster.
        """
        return _column.wave_moduli(self.stiffness(state))

    def pack(self, state):
        """The state as bytes, for a checkpoint."""
        file = io.BytesIO()
        np.savez(file, **state)
        return file.getvalue()

    def unpack(self, packed):
        """The state of pack()."""
        with np.load(io.BytesIO(packed), allow_pickle=False) as arrays:
            return dict(arrays)


def strain(gradient):
    """eps_xx, eps_yy, eps_zz, gamma_yz, gamma_xz, gamma_xy of displacement gradients: (n, 6) of (n, 3, 3)."""
    both = gradient + np.swapaxes(gradient, 1, 2)
    return np.stack([both[:, 0, 0] / 2, both[:, 1, 1] / 2, both[:, 2, 2] / 2, both[:, 1, 2], both[:, 0, 2], both[:, 0, 1]],
                    axis=1)


def run(scene, output=None, *, materials=None, overwrite=False, resume=False, threads=1, quiet=None):
    """Runs a column to its end, to the same bits as the program soil_column does, and leaves the same files.

    scene       ColumnScene                                output      folder; None: the scene's, results/<its name>
    materials   {name of a layer: Material} for the layers whose material is "user"
    overwrite   replaces existing results            resume      continues from the checkpoint of `output`
    threads     that share packings of grains; changes no bit of the result
    quiet       None: warns, as IsostatWarning; True: only keeps the warnings; False: progress and summary as well

    Returns Results. Ctrl-C and SIGTERM write a checkpoint and raise KeyboardInterrupt. Raises InputError, and RunFailure with the
    step, the time and the last checkpoint; what a Material raises passes through.
    """
    if not isinstance(scene, ColumnScene):
        raise _core.InputError(f"scene: must be an isostat.column.ColumnScene, but is {scene!r}.")
    check_use(overwrite, resume)
    folder = path_text("output", output) if output is not None else scene.folder
    if not folder:
        raise _core.InputError("output: is missing, and the scene names no folder. Give one.")
    if not isinstance(materials, dict | None):
        raise _core.InputError(f"materials: must be a dictionary of names of layers, but is {materials!r}.")
    for name, law in (materials or {}).items():
        if not isinstance(law, Material):
            raise _core.InputError(f"materials[{name!r}]: must be an isostat.column.Material, but is {law!r}.")
    with warned(folder, quiet) as listed:
        _column.run(scene, folder, materials or {}, overwrite, resume, threads, quiet is not False, listed)
        results = ColumnResults(folder)
        results.warnings = listed + results.warnings
        return results


class SoilPoint(_column.SoilPoint):
    """One Gauss point of the material of a layer (elastic, iwan, mohr_coulomb or umat), in an element test.

    SoilPoint(scene, layer=None, vertical_stress=None)

    scene            ColumnScene      layer  its name; None: the first of such a material
    vertical_stress  effective, compression positive, Pa, with the k0 of the layer; None: that in the middle of the layer

    Simple shear is along xz without lateral strain. Raises InputError, and RunFailure where no strain gives a stress.
    isostat.campaign.soil_test.soil_test() makes a whole set of tests.

    point = column.SoilPoint(scene, "sand")
    cycles, path = point.cyclic_shear(0.2 * 100e3, 50)
    point.shear_to(0)
    settled = point.compress_to(100e3)[-1, 4]
    """


class ColumnResults(Results):
    """A results folder of soil_column or run(): as Results, with draw() for its figures, and what is taken out of a site
    response: each method is the function of this name in isostat.figures.site_response, which says what it returns.

    profile     History of profile.csv: largest values of all steps over the depth, CSR
    where       "surface", "input", "within" (at the base) or one of output.depths, m
    Needs matplotlib and h5py. Raises InputError (a motion that was not recorded)
    """

    @property
    def profile(self):
        return read_table(self.folder / "profile.csv")

    def motion(self, where="surface", axis="x"):
        """Accelerations (m/s2) and their interval (s)."""
        return self._response("motion", where, axis)

    def spectrum(self, where="surface", axis="x", periods=None, damping=None):
        """Periods (s), absolute and pseudo spectral acceleration SA and PSA (m/s2)."""
        return self._response("spectrum", where, axis, periods, damping)

    def intensity(self, where="surface", axis="x"):
        """{PGA, arias, D5_95, CAV}."""
        return self._response("intensity_at", where, axis)

    def site(self):
        """{height, travel_time, mean_velocity, V_s30, period}."""
        return self._response("site")

    def transfer(self, axis="x", over=None, f=None):
        """Frequencies (Hz) and Fourier ratio of the surface over the motion "within" or "outcrop"."""
        return self._response("transfer", axis, over, f)

    def first_frequency(self, axis="x"):
        """f1 of the transfer function, Hz; None also where sand liquefies."""
        return self._response("first_frequency", axis)

    def resistance(self):
        """Depth, CSR, CRR and factor of safety, or None without a layer that has a resistance. CRR is of magnitude 7.5:
        multiply CRR by MSF for another."""
        return self._response("resistance")

    def write_at2(self, path, where="surface", axis="x"):
        """Leaves a motion as a record of PEER's format AT2, which motion.file of a scene reads."""
        self._response("write_at2", pathlib.Path(path), where, axis)

    def _response(self, name, *arguments):
        results, response, common = (importlib.import_module(f"isostat.figures.{module}")
                                     for module in ("column_results", "site_response", "common"))
        try:
            return getattr(response, name)(results.Column(self.folder), *arguments)
        except common.BadInput as error:
            raise _core.InputError(f"{error}.") from error

    @property
    def program(self):
        """Whose figures it has."""
        return "biaxial" if self.scene.to_dict()["analysis"]["kind"] == "biaxial" else "soil_column"

    @property
    def scene(self):
        """The ColumnScene that was run, with every key resolved."""
        return ColumnScene(self._text("scene.toml"))
