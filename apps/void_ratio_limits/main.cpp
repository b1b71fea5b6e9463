// SPDX-License-Identifier: BSD-3-Clause
// void_ratio_limits SCENE: the loosest and the densest state of a granular material, which define its relative density
// D_r = (e_max - e)/(e_max - e_min).
//
//        e_min                        e_max
//     ___v___   walls press with       o   o     the cloud, stretched upwards, rains down under gravity
//    >|oOoOo|<  specimen.pressure     | o o |    into a box with frictionless walls;
//    >|OoOoO|<  (10 kPa), contacts    |oO oO|    friction and rolling resistance of [contact]
//     -------   without friction,     |OoO o|    (a box whatever specimen.domain says)
//               then come to rest
//
//   void_ratio_limits apps/scenes/void_ratio_limits.toml --set grading.grains=2000
//   void_ratio_limits apps/scenes/void_ratio_limits.toml --fall 2 --output results/limits_fall2
//   void_ratio_limits apps/scenes/void_ratio_limits.toml --set grading.seed=2 --output results/limits_seed2
#include "apps/common/command_line.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/result_folder.hpp"
#include "apps/common/run_output.hpp"
#include "base/error.hpp"
#include "base/files/json.hpp"
#include "base/files/replace_file.hpp"
#include "dem/io/specimen_file.hpp"
#include "dem/measure/summary.hpp"
#include "dem/prepare/compact.hpp"
#include "dem/prepare/pluviate.hpp"
#include "dem/prepare/relative_density.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace
{
using namespace isostat;
namespace fs = std::filesystem;

struct Options
{
  std::string scene, output, command_line;
  std::vector<std::string> set;
  Pluviation pluviation; // damping comes from the scene
  bool overwrite = false, quiet = false;
};

/// Contact modulus over pressure of e_min, at most: grains overlap by some 1e-4 d then, which changes e by 1e-3 at
/// most. A frictionless packing under stiffer contacts comes to rest dozens of times more slowly (README.md).
constexpr double soft_enough = 1e4;
constexpr double wide_enough = 8; ///< of the space away from walls, in d50

/// The densest packing: frictionless, at rest, in the domain of the scene.
struct Dense
{
  Snapshot state;
  double void_ratio = 0, void_ratio_inside = 0; ///< of the domain; two d50 away from walls [-]
  double seconds = 0;
};

double friction_degrees(const Scene &scene) { return degrees(scene.contact->friction); }

double away_from_walls(const Snapshot &state)
{
  const double margin = 2 * state.grains.d50();
  RigidBox inside = state.box;
  inside.lower.array() += margin;
  inside.upper.array() -= margin;
  return void_ratio_inside(state.grains, inside);
}

/// Lowers young until the modulus of contacts is `soft_enough` times the pressure. It goes with a power of young.
void soften(Law &law, double pressure)
{
  const double modulus = law->modulus(pressure), aim = soft_enough * pressure;
  if (modulus <= aim)
    return;
  Law half = law;
  half->young *= 0.5;
  const double exponent = std::log2(modulus / half->modulus(pressure));
  law->young *= std::pow(aim / modulus, 1 / exponent);
}

Dense densest(const Cloud &cloud, const Scene &scene, RunObserver &observer)
{
  const Stopwatch watch;
  Dense dense;
  const Preparation how{scene.specimen, observer};
  Law law = scene.contact;
  soften(law, scene.specimen.pressure);
  const Snapshot compressed = compact(cloud, law, 0, how);
  dense.state = rebalance(compressed, compressed.law, how);
  dense.void_ratio = void_ratio(dense.state.volume(), dense.state.grains.solid_volume());
  dense.void_ratio_inside = dense.state.cell ? dense.void_ratio : away_from_walls(dense.state);
  dense.seconds = watch.seconds();
  return dense;
}

void keep(const fs::path &path, const Scene &scene, const Snapshot &state, const std::string &recipe,
          const std::map<std::string, double> &numbers)
{
  Specimen specimen;
  specimen.state = state;
  specimen.state.time = 0;
  specimen.state.step = 0;
  specimen.provenance = {{"title", scene.title}, {"recipe", recipe}};
  specimen.numbers = numbers;
  specimen.numbers["seed"] = static_cast<double>(scene.grading.seed);
  specimen.numbers["grains"] = static_cast<double>(state.grains.n_grains());
  specimen.numbers["d50_m"] = state.grains.d50();
  specimen.numbers["coordination"] = micromechanics(state).network.coordination_number();
  write_specimen(path, specimen);
}

struct Value
{
  const char *name, *unit;
  double value;
};

std::vector<Value> limits(const Scene &scene, const Dense &dense, const Deposit &loose, const Pluviation &how)
{
  const Snapshot &state = loose.state;
  return {{"e_min", "-", dense.void_ratio},
          {"e_min_inside", "-", dense.void_ratio_inside},
          {"e_max", "-", loose.void_ratio},
          {"e_max_inside", "-", loose.void_ratio_inside},
          {"grains", "-", static_cast<double>(state.grains.n_grains())},
          {"seed", "-", static_cast<double>(scene.grading.seed)},
          {"d50", "m", state.grains.d50()},
          {"pressure", "Pa", scene.specimen.pressure},
          {"young", "Pa", scene.contact->young},
          {"dense_young", "Pa", dense.state.law->young},
          {"friction", "deg", friction_degrees(scene)},
          {"coordination_dense", "-", micromechanics(dense.state).network.coordination_number()},
          {"dense_unbalanced", "-", micromechanics(dense.state).unbalanced},
          {"fall", "-", how.fall},
          {"fall_speed", "m/s", loose.fall_speed},
          {"deposition_damping", "-", how.damping},
          {"deposition_young", "Pa", loose.young},
          {"deposit_height", "m", loose.height},
          {"max_overlap", "d50", loose.max_overlap},
          {"resting_overlap", "d50", loose.resting_overlap},
          {"coordination_loose", "-", micromechanics(state).network.coordination_number()}};
}

void write_limits(const fs::path &folder, const std::vector<Value> &values)
{
  std::string names, numbers;
  Json json;
  for (const Value &v : values)
    {
      const std::string_view comma = names.empty() ? "" : ",";
      names += fmt::format("{}{} ({})", comma, v.name, v.unit);
      numbers += fmt::format("{}{}", comma, v.value);
      json[v.name] = {{"value", v.value}, {"unit", v.unit}};
    }
  write_replacing(folder / "limits.csv", names + "\n" + numbers + "\n");
  write_json(folder / "limits.json", json);
}

/// A few grains across have no void ratio of their own.
std::string narrow_inside(const Deposit &loose)
{
  const RigidBox &box = loose.state.box;
  const double edge = std::min((box.upper - box.lower).minCoeff(), loose.height);
  const double width = edge / loose.state.grains.d50() - 4;
  if (width >= wide_enough)
    return "";
  return fmt::format("warning: inside is {:.1f} d50 wide, less than {:g}: its void ratio means little. Take more\n",
                     std::max(0.0, width), wide_enough);
}

/// Whole vessel, inside, and for the paper's sand what paper and laboratory found.
std::string table(const Scene &scene, const Dense &dense, const Deposit &loose, double loose_seconds)
{
  const bool known = scene.grading.table.empty() && scene.grading.curve == "karlsruhe-fine-sand";
  std::string text = fmt::format("\n{}\n{:<8}{:>14}{:>10}", scene.title, "", "whole", "inside");
  text += known ? fmt::format("{:>10}{:>13}\n", "paper", "laboratory") : "\n";
  const auto row = [&](const char *name, double whole, double inside, double paper, double laboratory) {
    text += fmt::format("{:<8}{:>14.4f}{:>10.4f}", name, whole, inside);
    text += known ? fmt::format("{:>10.3f}{:>13.3f}\n", paper, laboratory) : "\n";
  };
  row("e_min", dense.void_ratio, dense.void_ratio_inside, 0.568, 0.677);
  row("e_max", loose.void_ratio, loose.void_ratio_inside, 0.841, 1.054);
  text += fmt::format("whole: of the {} and of the deposit; inside: two d50 ({:.3f} mm) away from walls and surface\n",
                      dense.state.cell ? "periodic cell" : "box", 2e3 * loose.state.grains.d50());
  text += narrow_inside(loose);
  text += fmt::format("e_min: {} grains, frictionless, {:g} kPa, E = {:.3g} Pa, unbalanced force {:.1e}; {:.0f} s\n",
                      dense.state.grains.n_grains(), scene.specimen.pressure / 1e3, dense.state.law->young,
                      micromechanics(dense.state).unbalanced, dense.seconds);
  text += fmt::format("e_max: {:.2f} deg, fastest impact about {:.2f} m/s, deposit {:.2f} mm high; {:.0f} s\n",
                      friction_degrees(scene), loose.fall_speed, 1e3 * loose.height, loose_seconds);
  text += fmt::format("       contact modulus {:.3g} Pa while falling: overlap/d50 at most {:.1e}, at rest {:.1e}\n",
                      loose.young, loose.max_overlap, loose.resting_overlap);
  return text;
}

Scene checked_scene(const Options &options)
{
  Scene scene = read_scene(options.scene, options.set);
  if (!scene.specimen.preparation_friction || *scene.specimen.preparation_friction != 0)
    throw InputError(fmt::format("{}: specimen.preparation_friction must be 0 deg here because e_min is the state that "
                                 "isotropic compression without friction gives. Give --set "
                                 "specimen.preparation_friction=\"0 deg\".",
                                 options.scene));
  if (!scene.stages.empty())
    throw InputError(fmt::format("{}: has {} stage(s), but void ratio limits need none and would not run them. Leave "
                                 "[[stage]] out.",
                                 options.scene, scene.stages.size()));
  return scene;
}

void find_limits(const Options &options)
{
  const Scene scene = checked_scene(options);
  Pluviation how = options.pluviation;
  how.damping = scene.motion.damping;
  check_pluviation(how);
  const fs::path folder = output_folder(options.output, scene.output.folder);
  const FolderUse use = folder_use(options.overwrite);
  check_result_folder(folder, use);
  catch_signals();
  PreparationOutput observer(options.quiet);
  const Cloud cloud = make_cloud(scene.grading);
  const Dense dense = densest(cloud, scene, observer);
  observer.event(fmt::format("e_min = {:.4f} after {:.0f} s", dense.void_ratio, dense.seconds));
  const FileLock lock = open_result_folder(folder, use);
  write_provenance(folder, scene, options.command_line);
  keep(folder / "densest.h5", scene, dense.state,
       fmt::format("isotropic compression to {:g} Pa without friction", scene.specimen.pressure),
       {{"void_ratio", dense.void_ratio}, {"void_ratio_inside", dense.void_ratio_inside}});

  const Stopwatch watch;
  const Deposit loose = pluviate(cloud, scene.contact, how, observer);
  keep(folder / "loosest.h5", scene, loose.state,
       fmt::format("deposition under gravity, fall {:g}, damping {:g}, contact modulus {:g} Pa; the box is open above",
                   how.fall, how.damping, loose.young),
       {{"void_ratio", loose.void_ratio}, {"void_ratio_inside", loose.void_ratio_inside}, {"height_m", loose.height}});
  write_limits(folder, limits(scene, dense, loose, how));
  leave_summary(folder, table(scene, dense, loose, watch.seconds()), "", "void_ratio_limits", false);
}
} // namespace

int main(int argc, char **argv)
{
  CLI::App line("Limits of the void ratio: frictionless compression (e_min) and deposition under gravity (e_max)");
  Options options;
  line.add_option("scene", options.scene, "scene file (TOML) without stages")->required()->transform(shipped_scene);
  line.add_option("-o,--output", options.output, "results folder (default: results/<scene name>)");
  line.add_option("--set", options.set, "override a key, e.g. --set grading.seed=2 (repeatable)");
  line.add_option("--fall", options.pluviation.fall, "stretch of the cloud from which grains fall, >= 1 (default 1)");
  line.add_flag("--overwrite", options.overwrite, "replace existing results");
  line.add_flag("-q,--quiet", options.quiet, "no progress on stderr");
  options.command_line = command_text(argc, argv);
  return run_command(line, argc, argv, [&] { find_limits(options); });
}
