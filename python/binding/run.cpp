// SPDX-License-Identifier: BSD-3-Clause
// Running a scene, with a look at the packing on the way.   tested: tests/python/run_test.py
#include "apps/common/run_output.hpp"
#include "apps/common/stage_report.hpp"
#include "apps/common/test_run.hpp"
#include "base/error.hpp"
#include "base/files/replace_file.hpp"
#include "base/stopwatch.hpp"
#include "dem/io/specimen_file.hpp"
#include "dem/prepare/given_packing.hpp"
#include "dem/prepare/specimen.hpp"
#include "dem/scene/schema.hpp"
#include "python/binding/binding.hpp"
#include "python/binding/given.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace isostat::python
{
namespace
{
namespace fs = std::filesystem;

/// What a callback may look at. It holds on to the assembly, so that arrays stay valid; numbers are those of the call.
struct Moment
{
  std::shared_ptr<const Assembly> assembly;
  Observation seen;
  std::size_t stage;
  std::uint64_t step;
  double time, void_ratio;
  Vec3 strain;

  Moment(std::shared_ptr<const Assembly> assembly_, const DriveState &state, const Observation &seen_)
      : assembly(std::move(assembly_)), seen(seen_), stage(state.place.stage), step(assembly->step()),
        time(assembly->time()), void_ratio(isostat::void_ratio(assembly->volume(), assembly->solid_volume())),
        strain(strain_since_start(*assembly, state.path))
  {}

  /// The packing as it is, with the strain of the call.
  std::shared_ptr<Snapshot> snapshot() const
  {
    auto now = std::make_shared<Snapshot>(assembly->snapshot());
    now->strain = strain;
    return now;
  }
};

/// Calls back, keeps rows of a run that leaves no files, and looks for Ctrl-C.
class Watcher : public RunObserver
{
public:
  py::object on_record = py::none(), on_step = py::none();
  std::uint64_t every = 1000;
  bool keep_rows = false;
  std::vector<std::vector<double>> rows;
  const Scene *scene = nullptr;
  std::shared_ptr<const Assembly> assembly;
  SignalWatch signals;
  bool stopped = false;

  void record(const Assembly &live, const DriveState &state, const Observation &seen, bool) override
  {
    if (keep_rows)
      rows.push_back(
          history_row(*scene, live, state, seen, micromechanics(live.snapshot(), scene->output.yield_margin)));
    call(on_record, state, seen);
  }
  bool after_step(const Assembly &live, const DriveState &state, const Observation &seen) override
  {
    if (live.step() % every == 0)
      call(on_step, state, seen);
    return signals.go_on() && !stopped;
  }

private:
  void call(const py::object &function, const DriveState &state, const Observation &seen)
  {
    if (function.is_none() || stopped)
      return;
    const py::gil_scoped_acquire gil;
    try
      {
        ask(function, {assembly, state, seen});
      }
    catch (const py::error_already_set &error)
      {
        if (!error.matches(PyExc_KeyboardInterrupt)) // Ctrl-C while Python was at work stops the run as any other does
          throw;
        signals.interrupt();
      }
  }
  void ask(const py::object &function, const Moment &moment)
  {
    const py::object answer = function(moment);
    stopped = !answer.is_none() && PyObject_IsTrue(answer.ptr()) == 0; // also a false of NumPy
  }
};

/// Preparation that Ctrl-C can stop.
class WatchedPreparation : public PreparationOutput
{
public:
  using PreparationOutput::PreparationOutput;
  bool after_step(const Assembly &assembly, const DriveState &state, const Observation &seen) override
  {
    return signals_.go_on() && PreparationOutput::after_step(assembly, state, seen);
  }

private:
  SignalWatch signals_;
};

/// Without the GIL.
Specimen prepared(const Scene &scene, const std::string &cache, int threads, bool quiet)
{
  WatchedPreparation preparation(quiet);
  return obtain_specimen(scene, cache, preparation, threads);
}

/// What run() gives back.
struct Result
{
  bool finished = false;
  std::string summary; ///< as summary.json, of a run without files that came to its end
  std::shared_ptr<Snapshot> snapshot;
  std::vector<RecordColumn> columns; ///< of a run without files
  std::vector<std::vector<double>> rows;
};

py::dict history_of(const Result &result)
{
  py::dict history;
  for (std::size_t k = 0; k < result.columns.size(); ++k)
    history[result.columns[k].name.c_str()] =
        computed<double>(result.rows.size(), [&](std::size_t i) { return result.rows[i][k]; });
  return history;
}

py::dict units_of(const Result &result)
{
  py::dict units;
  for (const RecordColumn &column : result.columns)
    units[column.name.c_str()] = column.unit;
  return units;
}

struct Request
{
  Scene scene;
  std::string output, cache;
  FolderUse use;
  int threads;
  bool quiet;
  const Specimen *specimen;
};

constexpr const char *kept_specimen = "specimen.h5"; ///< in the results folder, of a run that was given one

/// The scene names the specimen that is kept next to it instead of what it says of preparation.
void name_kept_specimen(Scene &scene)
{
  scene.specimen = without_preparation(scene.specimen);
  scene.specimen.file = kept_specimen;
  scene.written = {}; // of the former scene's text, which had all keys
  if (!takes_pressure(scene))
    scene.specimen.pressure = SpecimenSpec{}.pressure;
}

/// From a specimen that is given. It is kept with the results, so that their scene can be run again.
TestRun begin_from(const Specimen &given, Request &request, const StepSettings &how)
{
  const Specimen specimen = given_specimen(request.scene, given);
  std::optional<FileLock> folder;
  if (!request.output.empty())
    {
      folder = open_result_folder(request.output, request.use);
      write_specimen(fs::path(request.output) / kept_specimen, specimen);
      name_kept_specimen(request.scene);
    }
  TestRun test = start_test(request.scene, specimen, how);
  test.folder = std::move(folder);
  return test;
}

TestRun begin(Request &request)
{
  const StepSettings how{.measure_energy = request.scene.output.energy, .threads = request.threads};
  if (request.use == FolderUse::resume)
    {
      if (fs::exists(fs::path(request.output) / kept_specimen))
        name_kept_specimen(request.scene);
      return resume_test(request.scene, request.output, how);
    }
  if (request.specimen)
    return begin_from(*request.specimen, request, how);
  return start_test(request.scene, prepared(request.scene, request.cache, request.threads, request.quiet), how);
}

/// Without a folder: stages and watcher only.
void run_in_memory(const Request &request, TestRun &run, Watcher &watcher, Result &result)
{
  watcher.keep_rows = true;
  const Stopwatch watch;
  const Scene &scene = request.scene;
  result.finished = run_programme(scene.programme(), *run.assembly, run.state, watcher) == RunOutcome::finished;
  result.columns = history_columns(scene);
  result.rows = std::move(watcher.rows);
  if (!result.finished)
    return;
  for (const std::string &line : stage_warnings(run.state, scene))
    warn(line);
  const std::uint64_t steps = run.assembly->step();
  result.summary =
      summarise({result.columns, result.rows}, scene, run.specimen, run.state, {steps, steps, watch.seconds()})
          .json()
          .dump();
}

void run_with_files(const Request &request, TestRun &run, Watcher &watcher, Result &result)
{
  SceneOptions options;
  options.output = request.output;
  options.command_line = "isostat.run() in Python";
  options.quiet = request.quiet;
  options.threads = request.threads;
  options.overwrite = request.use == FolderUse::overwrite;
  options.resume = request.use == FolderUse::resume;
  const RunRequest<Scene> asked(request.scene, options);
  try
    {
      write_replacing(asked.folder / "summary.txt", run_test(asked, run, &watcher).text());
      result.finished = true;
    }
  catch (const Interrupted &)
    {
      if (!watcher.stopped)
        throw;
    }
}

Result run(Request request, const py::list &warnings, const py::object &on_record, const py::object &on_step,
           std::uint64_t every)
{
  const WarningsListed listed(warnings);
  Result result;
  Watcher watcher;
  watcher.on_record = on_record;
  watcher.on_step = on_step;
  watcher.every = std::max<std::uint64_t>(every, 1);
  watcher.scene = &request.scene;
  const py::gil_scoped_release free;
  if (!request.output.empty())
    check_result_folder(request.output, request.use);
  TestRun test = begin(request);
  watcher.assembly = test.assembly;
  if (request.output.empty())
    run_in_memory(request, test, watcher, result);
  else
    run_with_files(request, test, watcher, result);
  if (watcher.signals.interrupted())
    throw Interrupted("interrupted");
  test.assembly->compute_forces();
  result.snapshot = std::make_shared<Snapshot>(test.assembly->snapshot());
  result.snapshot->strain = strain_since_start(*test.assembly, test.state.path);
  return result;
}

template <auto values>
py::array running(const py::object &self)
{
  const Packing &grains = self.cast<const Moment &>().assembly->packing();
  return records(grains.*values, grains.n_grains(), self);
}

void bind_moment(py::module_ &module)
{
  py::class_<Moment>(module, "Moment", "What a callback of run() sees, at the end of a force evaluation or a step.")
      .def_property_readonly(
          "step", [](const Moment &m) { return m.step; }, "Time steps since the run began.")
      .def_readonly("time", &Moment::time, "s.")
      .def_readonly("stage", &Moment::stage, "Number of the stage, from 0.")
      .def_property_readonly(
          "p", [](const Moment &m) { return m.seen.p; },
          "Mean effective stress of the walls or of the cell, Pa, compression positive.")
      .def_property_readonly(
          "q", [](const Moment &m) { return m.seen.q; },
          "Deviatoric stress of the same, Pa, positive where y is compressed most.")
      .def_property_readonly(
          "axial_strain", [](const Moment &m) { return m.seen.axial; },
          "Logarithmic, since shearing began, compression positive.")
      .def_property_readonly(
          "tau", [](const Moment &m) { return m.seen.tau; },
          "Shear stress xy of a cell, Pa: stress()[0, 1] of its snapshot.")
      .def_property_readonly(
          "gamma", [](const Moment &m) { return m.seen.gamma; },
          "Shear strain xy of a cell, positive where x moves with y.")
      .def_readonly("void_ratio", &Moment::void_ratio, "e.")
      .def_property_readonly("positions", &running<&Packing::position>,
                             "Centres of the running packing, (n, 3), m: a view that changes with the run. "
                             "A sheared cell is kept\nupright, so the axes turn with it; snapshot() has those of the "
                             "laboratory.")
      .def_property_readonly("velocities", &running<&Packing::velocity>,
                             "(n, 3), m/s: a view, as positions. In a cell without the part of its homogeneous motion.")
      .def("snapshot", &Moment::snapshot,
           "A copy of the packing with its contacts, to keep or to measure. In on_step, where grains have moved since "
           "forces were\nevaluated, shear forces and moments are those of before the step: measure within on_record.");
}
} // namespace

void bind_run(py::module_ &module)
{
  bind_moment(module);
  module.def("prepare",
             [](const Scene &scene, const std::string &cache, Threads threads, bool quiet, const py::list &warnings) {
               const WarningsListed listed(warnings);
               const py::gil_scoped_release free;
               return prepared(scene, cache, static_cast<int>(threads), quiet);
             });
  module.def("_cached_specimen", &cached_specimen);
  py::class_<Result>(module, "Result")
      .def_readonly("finished", &Result::finished)
      .def_readonly("summary", &Result::summary)
      .def_readonly("snapshot", &Result::snapshot)
      .def_property_readonly("history", &history_of)
      .def_property_readonly("units", &units_of);
  module.def("run", [](const Scene &scene, const std::string &output, const std::string &cache,
                       const Specimen *specimen, Given<bool, "overwrite"> overwrite, Given<bool, "resume"> resume,
                       Threads threads, bool quiet, const py::list &warnings, const py::object &on_record,
                       const py::object &on_step, Given<std::uint64_t, "every"> every) {
    const FolderUse use = resume ? FolderUse::resume : folder_use(overwrite);
    return run({scene, output, cache, use, static_cast<int>(threads), quiet, specimen}, warnings, on_record, on_step,
               every);
  });
}
} // namespace isostat::python
