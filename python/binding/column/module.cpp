// SPDX-License-Identifier: BSD-3-Clause
// The soil column. A module of its own, because it needs deal.II and MPI, which `import isostat` does not load.
// tested: tests/python/column_test.py
#include "apps/common/interrupt.hpp"
#include "apps/deposit/inputs.hpp"
#include "apps/deposit/ranks.hpp"
#include "apps/soil_column/run.hpp"
#include "base/error.hpp"
#include "base/files/replace_file.hpp"
#include "fem/libraries.hpp"
#include "fem/material/wave_moduli.hpp"
#include "python/binding/column/python_material.hpp"
#include "python/binding/column/soil_point.hpp"
#include "python/binding/given.hpp"
#include "python/binding/warnings.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <fmt/format.h>
#include <mpi.h>
#include <mutex>

namespace isostat::python
{
namespace
{
/// Gives every signal the handler back that it had: those of the interpreter, which ignores SIGPIPE, and of faulthandler.
class HandlersKept
{
public:
  HandlersKept()
  {
    for (int signal = 1; signal < n_signals; ++signal)
      sigaction(signal, nullptr, &before_[signal]);
  }
  HandlersKept(const HandlersKept &) = delete;
  HandlersKept &operator=(const HandlersKept &) = delete;
  ~HandlersKept()
  {
    for (int signal = 1; signal < n_signals; ++signal)
      sigaction(signal, &before_[signal], nullptr);
  }

private:
  static constexpr int n_signals = 32; ///< without those of real time
  std::array<struct sigaction, n_signals> before_{};
};

/// Starts MPI, PETSc and p4est at the first run; they end with the interpreter.
void start_libraries()
{
  static bool started = false;
  if (std::exchange(started, true))
    return;
  int others = 0;
  MPI_Initialized(&others);
  if (others)
    throw RunFailure("MPI has been started already, by mpi4py perhaps; run the first column before that");
  const HandlersKept kept; // PETSc sets others, and then those of the system
  auto *libraries = new Libraries;
  py::module_::import("atexit").attr("register")(py::cpp_function([libraries] { delete libraries; }));
}

UserMaterials user_materials(const py::dict &laws)
{
  UserMaterials materials;
  for (const auto &[key, law] : laws)
    {
      const auto name = py::cast<std::string>(key);
      materials[name] = [name, law = law](std::size_t n_points) {
        const py::gil_scoped_acquire gil;
        return std::make_unique<PythonMaterial>(py::reinterpret_borrow<py::object>(law), name, n_points);
      };
    }
  return materials;
}

void run(const ColumnScene &scene, const std::string &output, const py::dict &materials,
         Given<bool, "overwrite"> overwrite, Given<bool, "resume"> resume, Threads threads, bool quiet,
         const py::list &warnings)
{
  const WarningsListed listed(warnings);
  static std::recursive_mutex columns; // PETSc, MPI and signals serve one thread at a time
  std::unique_lock turn(columns, std::defer_lock);
  {
    const py::gil_scoped_release free;
    turn.lock();
  }
  start_libraries();
  SceneOptions options;
  options.output = output;
  options.command_line = "isostat.column.run() in Python";
  options.overwrite = overwrite;
  options.resume = resume;
  options.threads = static_cast<int>(threads);
  options.quiet = quiet;
  ColumnRequest request(scene, options);
  request.materials = user_materials(materials);
  const py::gil_scoped_release free;
  const SignalsCaught signals;
  const RunResult result = run_column(request);
  if (!ranks().first())
    return;
  const std::string text = result.summary.text();
  write_replacing(request.folder / "summary.txt", text);
  if (!quiet)
    fmt::print("{}{}", text, to_text(result.times));
  if (!result.failure.empty())
    throw RunFailure(result.failure);
}

/// (n, 2) of (n, 6, 6).
py::array_t<double> wave_moduli(const Given<Doubles, "stiffness"> &given)
{
  const Doubles &stiffness = given;
  if (stiffness.ndim() != 3 || stiffness.shape(1) != 6 || stiffness.shape(2) != 6)
    throw InputError(fmt::format("stiffness: must be an array of shape (n, 6, 6), but is {}.", described(stiffness)));
  py::array_t<double> found({stiffness.shape(0), py::ssize_t(2)});
  WaveModuli moduli;
  for (py::ssize_t q = 0; q < stiffness.shape(0); ++q)
    {
      const double *of_point = stiffness.data() + 36 * q;
      if (q == 0 || !std::equal(of_point, of_point + 36, of_point - 36)) // else as the point before
        moduli = max_wave_moduli(Eigen::Map<const Stiffness>(of_point).transpose());
      found.mutable_at(q, 0) = moduli.p;
      found.mutable_at(q, 1) = moduli.s;
    }
  return found;
}
} // namespace
} // namespace isostat::python

PYBIND11_MODULE(_column, module)
{
  namespace py = pybind11;
  using namespace isostat;
  module.doc() = "The compiled part of isostat.column; use what the package itself offers.";
  py::class_<ColumnScene>(module, "ColumnScene")
      .def(py::init([](const std::string &text, const std::string &name, const std::vector<std::string> &overrides,
                       bool is_file) {
             return is_file ? read_column_scene(name, overrides) : parse_column_scene(text, name, overrides);
           }),
           py::arg("text"), py::arg("name"), py::arg("overrides"), py::arg("is_file") = false)
      .def_readonly("title", &ColumnScene::title, "What heads tables and figures.")
      .def_property_readonly(
          "folder", [](const ColumnScene &scene) { return scene.output.folder; },
          "Where run() leaves results unless a folder is given: results/<name of the scene file>.")
      .def_property_readonly(
          "text", [](const ColumnScene &scene) { return to_toml(scene); },
          "The whole scene as TOML: every key with its value and unit.")
      .def("check_inputs", &check_inputs,
           "Reads libraries and records. Raises InputError where they lack what the scene needs.")
      .def(
          "__eq__", [](const ColumnScene &one, const ColumnScene &other) { return one == other; }, py::is_operator())
      .def("__hash__", [](const ColumnScene &scene) { return py::hash(py::str(to_toml(scene))); })
      .def("__str__", [](const ColumnScene &scene) { return to_toml(scene); });
  python::add_soil_point(module);
  module.def("run", &python::run);
  module.def("wave_moduli", &python::wave_moduli);
}
