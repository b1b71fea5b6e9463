// SPDX-License-Identifier: BSD-3-Clause
// whole_step PACKING: time per step of constant-volume shear, everything included: contact forces, walls, integration,
// list upkeep, wall stress and the driver's strain path.
//
//   whole_step results/specimens/specimen-....h5 --rate 5 --time-step 4.8e-8 --steps 1500
//   whole_step packing.txt                       spheres as lines x y z r, box in a comment, as --export writes them
//   whole_step tests/reference/n1000/medium      a folder of tables with contact history
//   whole_step specimen.h5 --export packing.txt  writes such a file, for other codes to run the same packing
//   whole_step specimen.h5 --copies 10           ten copies in a row in one box
//   whole_step specimen.h5 --times times.json    the figures as a list, one object for each repeat, for scripts
#include "apps/common/command_line.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/json.hpp"
#include "base/files/replace_file.hpp"
#include "base/record/instruction_set.hpp"
#include "base/stopwatch.hpp"
#include "dem/assembly/assembly.hpp"
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/io/specimen_file.hpp"
#include "dem/io/text_tables.hpp"
#include "dem/measure/stress.hpp"
#include "dem/prepare/space_filling.hpp"
#include "tests/support/specimens.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace
{
using namespace isostat;
namespace fs = std::filesystem;

struct Options
{
  std::string packing, exported, times;
  double rate = 5, time_step = 4.8e-8, friction_degrees = 18, damping = 0.2, contact_damping = 0,
         free_grain_damping = 0;
  std::size_t copies = 1;
  bool carry_grains = false, fixed_threads = false, no_twisting = false;
  int steps = 1500, warm_up = 500, repeats = 1, threads = 1;
};

/// What export_text() writes.
Snapshot read_exported(const fs::path &path, const Law &law)
{
  const std::string text = read_text(path);
  const std::vector<std::string_view> lines = split_lines(text);
  Snapshot s;
  s.law = law;
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (std::size_t l = 0; l < lines.size(); ++l)
    {
      std::vector<double> v;
      for (const std::string_view word : split_words(lines[l]))
        if (word != "#" && word != "box")
          v.push_back(finite_number(path, l + 1, word));
      if (v.size() != (l == 0 ? 6 : 4))
        reject(path, l + 1, "expected # box xlo xhi ylo yhi zlo zhi in the first line, x y z r in the others");
      if (l == 0)
        s.box = {Vec3(v[0], v[2], v[4]), Vec3(v[1], v[3], v[5])};
      else
        {
          centres.emplace_back(v[0], v[1], v[2]);
          radii.push_back(v[3]);
        }
    }
  s.grains = make_packing(centres, radii, 2650);
  return s;
}

Snapshot load(const Options &options)
{
  LinearRolling law;
  law.friction = std::tan(options.friction_degrees * M_PI / 180);
  law.twisting = !options.no_twisting;
  const fs::path path = options.packing;
  if (path.extension() == ".h5")
    {
      Snapshot state = read_specimen(path).state;
      state.law = law;
      return state;
    }
  return sorted_along_curve(fs::is_directory(path) ? import_tables(path, law, 2650) : read_exported(path, law));
}

void export_text(const Snapshot &s, const std::string &path)
{
  std::string text = fmt::format("# box {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", s.box.lower[0],
                                 s.box.upper[0], s.box.lower[1], s.box.upper[1], s.box.lower[2], s.box.upper[2]);
  for (std::size_t i = 0; i < s.grains.n_grains(); ++i)
    {
      const Vec3 x = s.grains.centre(i);
      text += fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}\n", x[0], x[1], x[2], s.grains.radius(i));
    }
  write_replacing(path, text);
}

std::size_t n_contacts(const Assembly &assembly)
{
  const Snapshot s = assembly.snapshot();
  return s.contacts.size() + s.wall_contacts.size();
}

/// For the terminal.
std::string text(const Json &value)
{
  return value.is_string()         ? value.get<std::string>()
         : value.is_number_float() ? fmt::format("{:.6g}", value.get<double>())
                                   : value.dump();
}

void measure(const Options &options)
{
  const Snapshot initial = options.copies > 1 ? test::row_of_copies(load(options), options.copies) : load(options);
  if (!options.exported.empty())
    return export_text(initial, options.exported);
  Assembly assembly(initial);
  assembly.settings.time_step = options.time_step;
  assembly.settings.threads = options.threads;
  assembly.settings.fixed_threads = options.fixed_threads;
  assembly.settings.damping = options.damping;
  assembly.settings.contact_damping = options.contact_damping;
  assembly.settings.free_grain_damping = options.free_grain_damping;
  assembly.settings.carry_grains = options.carry_grains;
  const RigidBox reference = assembly.box();
  double axial = 0, stress = 0;
  const auto run = [&](int steps) {
    for (int k = 0; k < steps; ++k)
      {
        assembly.compute_forces();
        stress += invariants(assembly.wall_stress()).q; // what a driver looks at every step
        axial += options.rate * options.time_step;
        assembly.move(reference.strained(isochoric(axial)));
      }
  };
  run(options.warm_up);
  Json times;
  for (int r = 0; r < options.repeats; ++r)
    {
      const Stopwatch watch;
      run(options.steps);
      const double seconds = watch.seconds();
      assembly.compute_forces();
      const std::size_t contacts = n_contacts(assembly);
      const double grains = static_cast<double>(assembly.packing().n_grains());
      const MemoryUse memory = assembly.memory();
      const StressInvariants s = invariants(assembly.wall_stress());
      assembly.move(assembly.box());
      times.push_back({{"steps_per_s", options.steps / seconds},
                       {"ms_per_step", 1e3 * seconds / options.steps},
                       {"contacts", contacts},
                       {"ns_per_contact_step", 1e9 * seconds / options.steps / static_cast<double>(contacts)},
                       {"p_kPa", s.p / 1e3},
                       {"q_kPa", s.q / 1e3},
                       {"grains", assembly.packing().n_grains()},
                       {"threads", options.threads},
                       {"state_bytes_per_grain", memory.state / grains},
                       {"working_bytes_per_grain", memory.working / grains},
                       {"list_rebuilds", assembly.verlet_list().n_rebuilds()},
                       {"instruction_set", instruction_set()}});
      fmt::print("isostat");
      for (const auto &[name, value] : times.back().items())
        fmt::print(" {} {}", name, text(value));
      fmt::print("\n");
    }
  if (!options.times.empty())
    write_json(options.times, times);
}
} // namespace

int main(int argc, char **argv)
{
  CLI::App line("Time per step of constant-volume shear");
  Options options;
  line.add_option("packing", options.packing, "specimen (.h5), folder of tables, or text of spheres")->required();
  line.add_option("--export", options.exported, "write the packing as text and stop");
  line.add_option("--copies", options.copies,
                  "run this many copies of the packing, side by side, without contact history")
      ->check(CLI::PositiveNumber);
  line.add_option("--rate", options.rate, "axial strain rate, 1/s");
  line.add_option("--time-step", options.time_step, "s");
  line.add_option("--friction", options.friction_degrees, "degrees");
  line.add_flag("--no-twisting", options.no_twisting, "leave twisting moments out of the law");
  line.add_option("--damping", options.damping, "local damping");
  line.add_option("--contact-damping", options.contact_damping, "share of critical damping of dashpots in contacts");
  line.add_option("--free-grain-damping", options.free_grain_damping, "share that rattlers lose");
  line.add_flag("--carry-grains", options.carry_grains, "grains share the homogeneous motion of the walls");
  line.add_option("--steps", options.steps, "timed steps per repeat");
  line.add_option("--warm-up", options.warm_up, "steps before");
  line.add_option("--threads", options.threads, "threads that share a step");
  line.add_flag("--fixed-threads", options.fixed_threads, "this many, even where one is faster");
  line.add_option("--repeats", options.repeats, "timed blocks");
  line.add_option("--times", options.times, "write the figures of each timed block to this file, as JSON");
  return run_command(line, argc, argv, [&] { measure(options); });
}
