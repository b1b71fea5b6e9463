// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/run_output.hpp"

#include "apps/common/interrupt.hpp"
#include "base/error.hpp"
#include "base/files/replace_file.hpp"
#include "base/tell.hpp"
#include "dem/io/snapshot_file.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
constexpr std::uint64_t steps_between_looks = 256; ///< at the clock
constexpr std::uint64_t steps_kept = 2000; ///< between two states that are kept in memory; a copy costs some steps

/// The state of a test for the progress line.
std::string in_words(const Assembly &assembly, const Observation &seen, double redundancy)
{
  const std::string path = seen.gamma != 0 ? fmt::format("gamma {:9.5f} %  p' {:8.2f} kPa  tau {:8.2f} kPa",
                                                         100 * seen.gamma, seen.p / 1e3, seen.tau / 1e3)
                                           : fmt::format("eps_y {:9.5f} %  p' {:8.2f} kPa  q {:8.2f} kPa",
                                                         100 * seen.axial, seen.p / 1e3, seen.q / 1e3);
  const double e = void_ratio(assembly.volume(), assembly.solid_volume());
  return path + fmt::format("  e {:.4f}", e) + (redundancy > 0 ? fmt::format("  I_R {:.3f}", redundancy) : "");
}

} // namespace

bool PreparationOutput::after_step(const Assembly &assembly, const DriveState &, const Observation &seen)
{
  if (progress_.due(assembly.step(), -1))
    progress_.say(progress_.line(in_words(assembly, seen, 0)));
  return !stop_requested();
}

RunOutput::RunOutput(fs::path folder, const Scene &scene, const std::map<std::string, double> &specimen, bool quiet,
                     const Checkpoint *resumed)
    : folder_(std::move(folder)), scene_(scene), scene_text_(to_toml(scene)), specimen_(specimen),
      written_(resumed ? resumed->written : WrittenSoFar{}),
      recorder_(folder_, history_columns(scene), written_.rows, scene_text_),
      grains_(folder_ / "grains.pvd", scene.output.paraview ? written_.snapshots : 0),
      chains_(folder_ / "force_chains.pvd", scene.output.paraview ? written_.snapshots : 0), progress_(quiet)
{
  if (scene.output.snapshots != "none")
    make_folder(folder_ / "snapshots");
  if (scene.output.paraview)
    make_folder(folder_ / "paraview");
  std::error_code ignored;
  std::uint64_t n_missing = 0;
  for (std::uint64_t k = 0; k < written_.snapshots; ++k)
    n_missing += !fs::exists(snapshot_file(k), ignored);
  if (n_missing > 0)
    warn(fmt::format("{}: {} of {} snapshots no longer exist; the run continues without them",
                     (folder_ / "snapshots").string(), n_missing, written_.snapshots));
}

fs::path RunOutput::snapshot_file(std::uint64_t k) const
{
  return folder_ / "snapshots" / fmt::format("snapshot_{:04d}.h5", k);
}

void RunOutput::record(const Assembly &assembly, const DriveState &state, const Observation &seen, bool snapshot)
{
  Snapshot now = assembly.snapshot();
  const Micromechanics m = micromechanics(now, scene_.output.yield_margin);
  written_.redundancy = m.network.redundancy_index();
  recorder_.append(history_row(scene_, assembly, state, seen, m));
  if (!snapshot)
    return;
  now.strain = strain_since_start(assembly, state.path);
  store_snapshot(now);
}

void RunOutput::store_snapshot(const Snapshot &snapshot)
{
  const std::string name = fmt::format("{:04d}", written_.snapshots);
  write_snapshot_file(snapshot_file(written_.snapshots), snapshot);
  if (scene_.output.paraview)
    {
      write_grains_vtp(folder_ / "paraview" / ("grains_" + name + ".vtp"), snapshot);
      write_force_chains_vtp(folder_ / "paraview" / ("force_chains_" + name + ".vtp"), snapshot);
      grains_.append(snapshot.time, "paraview/grains_" + name + ".vtp");
      chains_.append(snapshot.time, "paraview/force_chains_" + name + ".vtp");
    }
  ++written_.snapshots;
}

void RunOutput::event(const std::string &line) { progress_.say(line); }

bool RunOutput::after_step(const Assembly &assembly, const DriveState &state, const Observation &seen)
{
  const StageBehaviour &stage = behaviour(scene_.stages[state.place.stage]);
  if (progress_.due(assembly.step(), stage.fraction_done(state).value_or(-1)))
    progress_.say(progress_.line(in_words(assembly, seen, written_.redundancy)));
  if (stop_requested())
    {
      save_checkpoint(assembly, state);
      return false;
    }
  const std::uint64_t step = assembly.step(); // by one, or by all force evaluations of an increment
  if (step >= looked_ + steps_between_looks)
    {
      looked_ = step;
      if (since_checkpoint_.seconds() > 60 * scene_.output.checkpoint_minutes)
        save_checkpoint(assembly, state);
    }
  if (!kept_ || step >= kept_->state.step + steps_kept)
    kept_ = checkpoint_of(assembly, state);
  return true;
}

Checkpoint RunOutput::checkpoint_of(const Assembly &assembly, const DriveState &state) const
{
  WrittenSoFar written = written_;
  written.rows = recorder_.n_rows();
  Checkpoint checkpoint{assembly.checkpoint(), state, written, {}, specimen_, scene_text_};
  EnergyMemory::for_each(assembly.energy_memory(),
                         [&](const std::string &name, double value) { checkpoint.assembly[name] = value; });
  return checkpoint;
}

void RunOutput::save_checkpoint(const Assembly &assembly, const DriveState &state)
{
  recorder_.flush();
  write_checkpoint(folder_ / "checkpoint", checkpoint_of(assembly, state));
  since_checkpoint_.restart();
}

void RunOutput::finish()
{
  recorder_.flush();
  if (kept_)
    write_checkpoint(folder_ / "checkpoint", *kept_);
}

void restore(const Checkpoint &checkpoint, Assembly &assembly)
{
  EnergyMemory memory;
  EnergyMemory::for_each(memory, [&](const std::string &name, auto &value) {
    const auto found = checkpoint.assembly.find(name);
    if (found == checkpoint.assembly.end())
      throw InputError(
          fmt::format("the checkpoint holds no assembly/@{}; it is damaged. Start again with --overwrite.", name));
    value = found->second;
  });
  assembly.set_energy_memory(memory);
}
} // namespace isostat
