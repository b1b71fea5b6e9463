# SPDX-License-Identifier: BSD-3-Clause
"""Recipe of Spack: put this folder into a repository of your own as packages/isostat and `spack dev-build isostat@main`
in a clone. Versions are the oldest that the build asks for; Debian 12 has what is tested (scripts/setup.sh).

Not tried with Spack itself: the build looks for the pkg-config modules `hdf5-openmpi` and `ompi` of Debian, so the
recipe writes files of these names that point to Spack's HDF5 and Open MPI."""
import pathlib

from spack.package import CMakePackage, depends_on, extends, license, run_before, variant, version


class Isostat(CMakePackage):
    """Liquefaction of sand, grain by grain and as the soil of a deposit: coupled DEM and FEM in C++20."""

    license("BSD-3-Clause")
    version("main", branch="main")
    variant("fem", default=True, description="Soil columns and blocks of finite elements (deal.II, PETSc)")
    variant("python", default=True, description="The Python package and the figures")

    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("boost")
    depends_on("cli11")
    depends_on("eigen@3.4:3")
    depends_on("fmt")
    depends_on("hdf5@1.10:+mpi")
    depends_on("highway@1:")
    depends_on("nlohmann-json@3.10:")
    depends_on("openmpi")
    depends_on("pugixml")
    depends_on("random123")
    depends_on("tomlplusplus")
    depends_on("zlib-api")
    depends_on("dealii@9.4:+mpi+petsc+p4est", when="+fem")
    depends_on("petsc+mpi", when="+fem")
    depends_on("python@3.11:", type=("build", "link", "run"), when="+python")
    depends_on("py-pybind11@2.10:", type="build", when="+python")
    extends("python", when="+python")
    for package in ("py-numpy", "py-matplotlib", "py-h5py", "py-scipy", "py-mpi4py", "nlopt+python"):
        depends_on(package, type="run", when="+python")

    @run_before("cmake")
    def name_modules_as_debian_does(self):
        folder = pathlib.Path(self.stage.path) / "pkgconfig"
        folder.mkdir(exist_ok=True)
        for name, package, library in (("hdf5-openmpi", "hdf5", "hdf5"), ("ompi", "openmpi", "mpi")):
            prefix = self.spec[package].prefix
            (folder / f"{name}.pc").write_text(
                f"Name: {name}\nDescription: {package} of Spack\nVersion: {self.spec[package].version}\n"
                f"Cflags: -I{prefix.include}\nLibs: -L{prefix.lib} -l{library}\n", encoding="utf-8")

    def setup_build_environment(self, env):
        env.prepend_path("PKG_CONFIG_PATH", str(pathlib.Path(self.stage.path) / "pkgconfig"))

    def cmake_args(self):
        args = [self.define_from_variant("ISOSTAT_FEM", "fem"), self.define_from_variant("ISOSTAT_PYTHON", "python"),
                self.define("ISOSTAT_TESTS", False), self.define("ISOSTAT_BENCHMARKS", False)]
        if "+python" in self.spec:
            python = self.spec["python"]
            args += [self.define("Python_EXECUTABLE", python.command.path),
                     self.define("ISOSTAT_PYTHON_FOLDER", f"lib/python{python.version.up_to(2)}/site-packages")]
        return args
