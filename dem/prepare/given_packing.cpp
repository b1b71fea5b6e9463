// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/given_packing.hpp"

#include "base/error.hpp"
#include "dem/law/parameters.hpp"
#include "dem/measure/stress.hpp"
#include "dem/prepare/grading.hpp"
#include "dem/prepare/relative_density.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <map>

namespace isostat
{
namespace
{
void check_domain(const Scene &scene, const Snapshot &state, const std::string &name)
{
  const std::string is = state.cell ? "periodic-cell" : "rigid-box";
  if (scene.specimen.domain != is)
    throw InputError(fmt::format("{}: a specimen in a {}, but the scene has specimen.domain = \"{}\". Give the other "
                                 "domain or another specimen.",
                                 name, is, scene.specimen.domain));
}

/// Whether the first stage that takes steps brings the packing to a stress.
bool begins_with_consolidation(const Scene &scene)
{
  const auto first = std::ranges::find_if(scene.stages, [](const Stage &s) { return behaviour(s).takes_steps(); });
  return first != scene.stages.end() && as<ServoStage>(*first);
}

/// Sum of the differences of all normal forces under two laws, over their sum under the first.
double change_of_forces(const Snapshot &s, const ContactLaw &before, const ContactLaw &after)
{
  double change = 0, sum = 0;
  const auto add = [&](double one, double other) {
    change += std::abs(other - one);
    sum += one;
  };
  for (const Contact &c : s.contacts)
    {
      const double r1 = s.grains.radius(c.first), r2 = s.grains.radius(c.second);
      add(before.normal_force(r1, r2, c.overlap), after.normal_force(r1, r2, c.overlap));
    }
  return sum > 0 ? change / sum : 0;
}

std::string text_of(const Key &key, double value)
{
  return key.kind() == Kind::quantity ? format_quantity(value, key.unit.dimension, key.unit.name)
                                      : fmt::format("{:g}", value);
}

/// The parameters of the law to which the change of normal forces is due: "contact.young = 5 GPa (1 GPa)".
std::string stiffness_in_words(const Snapshot &state, const Law &law)
{
  if (std::string_view(law->name()) != state.law->name())
    return fmt::format("contact.law = \"{}\" (\"{}\")", law->name(), state.law->name());
  std::vector<std::string> words;
  for (const Key &key : law->keys())
    {
      Law own = state.law, scenes = law;
      const auto place = [&key](Law &of) { return key.field(*of.operator->()); };
      const Field to = place(own), from = place(scenes);
      if (!std::holds_alternative<double *>(to))
        continue;
      const double has = std::exchange(*std::get<double *>(to), *std::get<double *>(from));
      if (change_of_forces(state, state.law, own) > 0)
        words.push_back(
            fmt::format("contact.{} = {} ({})", key.path, text_of(key, *std::get<double *>(to)), text_of(key, has)));
    }
  return fmt::format("{}", fmt::join(words, ", "));
}

/// Contacts that take another normal force at the overlaps they have are not in balance.
void check_stiffness(const Scene &scene, const Snapshot &state, const std::string &name,
                     std::vector<std::string> &warnings)
{
  constexpr double unnoticed = 1e-3; // of the sum of forces
  const double change = change_of_forces(state, state.law, scene.contact);
  if (change < unnoticed)
    return;
  const std::string said = fmt::format(
      "{}: was made with another contact stiffness than {}: its normal forces would change by {:.3g} % at once", name,
      stiffness_in_words(state, scene.contact), 100 * change);
  if (!begins_with_consolidation(scene))
    throw InputError(said +
                     ", and it would not be in balance. Give the value in brackets, which it was made with, or let "
                     "the test begin with a stage `rebalance`.");
  warnings.push_back(said + "; the first stage brings it back to its stress, at another void ratio");
}

/// Whether a scene says a value, which is then held against the packing: one that it leaves out is not. Where a program
/// gives the packing, the scene has been through to_toml(), which writes all keys: there a default counts as left out.
/// Consolidation with a file can be its default only.
bool is_said(const Scene &scene, std::string_view key, bool is_default)
{
  return scene.specimen.file.empty() ? !is_default : scene.written.has(key);
}

/// Keys of a grading that would have made other sizes, in their words.
std::vector<std::string> other_sizes(const Scene &scene, const Packing &grains)
{
  constexpr double unnoticed = 0.01; // of diameters
  const GradingSpec &said = scene.grading, usual;
  std::vector<std::string> keys;
  std::vector<double> radii = grains.radii(), made = sample_diameters(grading_curve(said), radii.size());
  std::ranges::sort(radii, std::greater());
  const double solid = grains.solid_volume(), scale = upscaling_factor(made, solid);
  double apart = 0, sum = 0;
  for (std::size_t i = 0; i < radii.size(); ++i)
    {
      apart += std::abs(scale * made[i] - 2 * radii[i]);
      sum += 2 * radii[i];
    }
  if (apart > unnoticed * sum)
    {
      if (!said.table.empty())
        keys.push_back(fmt::format("grading.table = {} sizes", said.table.size()));
      else if (is_said(scene, "grading.curve", said.curve == usual.curve))
        keys.push_back(fmt::format("grading.curve = \"{}\"", said.curve));
      if (is_said(scene, "grading.truncate",
                  said.finest_percent == usual.finest_percent && said.coarsest_percent == usual.coarsest_percent))
        keys.push_back(fmt::format("grading.truncate = [{:g}, {:g}]", said.finest_percent, said.coarsest_percent));
    }
  if (!said.d50 && std::abs(said.solid_fraction * std::pow(said.cloud_edge, 3) / solid - 1) > 3 * unnoticed)
    {
      if (is_said(scene, "grading.cloud_edge", said.cloud_edge == usual_cloud_edge(said.grains)))
        keys.push_back(fmt::format("grading.cloud_edge = {:g} mm", 1e3 * said.cloud_edge));
      if (is_said(scene, "grading.solid_fraction", said.solid_fraction == usual.solid_fraction))
        keys.push_back(fmt::format("grading.solid_fraction = {:g}", said.solid_fraction));
    }
  return keys;
}

/// Values that are those of the packing, whatever the scene says.
void note_values(const Scene &scene, const Specimen &given, const std::string &name, std::vector<std::string> &warnings)
{
  std::vector<std::string> words;
  const auto note = [&](const char *key, const std::string &said, const std::string &has) {
    words.push_back(fmt::format("{} = {} ({})", key, said, has));
  };
  const GradingSpec &said = scene.grading, usual;
  const Packing &grains = given.state.grains;
  if (is_said(scene, "grading.grains", said.grains == usual.grains) && said.grains != grains.n_grains())
    note("grading.grains", std::to_string(said.grains), std::to_string(grains.n_grains()));
  if (said.d50 && std::abs(grains.d50() / *said.d50 - 1) > 0.01)
    note("grading.d50", fmt::format("{:.4g} mm", 1e3 * *said.d50), fmt::format("{:.4g} mm", 1e3 * grains.d50()));
  for (const std::string &key : other_sizes(scene, grains))
    words.push_back(
        fmt::format("{} (grains of {:.4g} to {:.4g} mm)", key, 2e3 * grains.min_radius(), 2e3 * grains.max_radius()));
  if (const auto seed = given.numbers.find("seed"); seed != given.numbers.end() &&
                                                    is_said(scene, "grading.seed", said.seed == usual.seed) &&
                                                    seed->second != static_cast<double>(said.seed))
    note("grading.seed", std::to_string(said.seed), fmt::format("{:g}", seed->second));
  if (is_said(scene, "grading.density", said.density == usual.density) &&
      std::abs(grains.density - said.density) > 1e-3 * said.density)
    note("grading.density", fmt::format("{:g} kg/m3", said.density), fmt::format("{:g} kg/m3", grains.density));
  const SpecimenSpec &spec = scene.specimen;
  const double e = void_ratio(given.state.volume(), grains.solid_volume());
  const double apart = spec.has_limits() ? *spec.e_max - *spec.e_min : 0.3;
  if (spec.void_ratio && std::abs(e - *spec.void_ratio) > spec.density_tolerance * apart)
    note("specimen.void_ratio", fmt::format("{:g}", *spec.void_ratio), fmt::format("{:.4f}", e));
  if (spec.relative_density)
    if (const double has = relative_density(e, *spec.e_min, *spec.e_max);
        std::abs(has - *spec.relative_density) > spec.density_tolerance)
      note("specimen.relative_density", fmt::format("{:g}", *spec.relative_density), fmt::format("{:.3f}", has));
  if (const auto made = given.numbers.find("preparation_friction_deg");
      spec.preparation_friction && made != given.numbers.end() &&
      std::abs(made->second - degrees(*spec.preparation_friction)) > 0.01)
    note("specimen.preparation_friction", fmt::format("{:.4g} deg", degrees(*spec.preparation_friction)),
         fmt::format("{:.4g} deg", made->second));
  if (const auto has = given.provenance.find("consolidation"); spec.consolidation != SpecimenSpec{}.consolidation &&
                                                               has != given.provenance.end() &&
                                                               has->second != spec.consolidation)
    note("specimen.consolidation", spec.consolidation, has->second);
  if (!spec.file.empty() && spec.file != name)
    note("specimen.file", spec.file, name);
  if (!words.empty())
    warnings.push_back(fmt::format("{}: is taken as it is; in brackets what it has, where the scene's values have no "
                                   "effect: {}",
                                   name, fmt::join(words, ", ")));
}

void note_pressure(const Scene &scene, const Snapshot &state, const std::string &name,
                   std::vector<std::string> &warnings)
{
  if (state.contacts.empty() || scene.stages.empty() || begins_with_consolidation(scene) ||
      scene.specimen.consolidation != "isotropic")
    return;
  const double p = invariants(contact_stress(state)).p;
  if (const double said = scene.specimen.pressure;
      is_said(scene, "specimen.pressure", said == SpecimenSpec{}.pressure) && std::abs(p - said) > 0.05 * said)
    warnings.push_back(fmt::format("{}: its mean effective stress is {:.4g} kPa, specimen.pressure = {:g} kPa; the "
                                   "test starts from what it has. Bring it there by a stage `compress`",
                                   name, p / 1e3, said / 1e3));
}

void note_friction(const Scene &scene, const Snapshot &state, const std::string &name,
                   std::vector<std::string> &warnings)
{
  const double is = scene.contact->friction, was = state.law->friction;
  if (!state.contacts.empty() && is < was * (1 - 1e-9))
    warnings.push_back(
        fmt::format("{}: is in balance with a friction of {:.4g} deg and tested with {:.4g} deg: contacts "
                    "slide at once, and it loses void ratio or pressure before it is sheared. Give "
                    "contact.friction = \"{:.4g} deg\", or prepare a specimen with this scene",
                    name, degrees(was), degrees(is), degrees(was)));
}
} // namespace

bool has_default_limits(const SpecimenSpec &spec)
{
  const SpecimenSpec usual;
  return spec.e_min == usual.e_min && spec.e_max == usual.e_max;
}

SpecimenSpec without_preparation(SpecimenSpec spec)
{
  spec.relative_density.reset();
  spec.void_ratio.reset();
  spec.preparation_friction.reset();
  spec.expansion = 0;
  spec.consolidation = SpecimenSpec{}.consolidation;
  if (has_default_limits(spec))
    {
      spec.e_min.reset();
      spec.e_max.reset();
    }
  return spec;
}

std::vector<std::string> check_given_packing(const Scene &scene, const Specimen &given, const std::string &name)
{
  std::vector<std::string> warnings;
  check_domain(scene, given.state, name);
  check_stiffness(scene, given.state, name, warnings);
  note_values(scene, given, name, warnings);
  note_pressure(scene, given.state, name, warnings);
  note_friction(scene, given.state, name, warnings);
  return warnings;
}

std::string foreign_to_default_limits(const Scene &scene)
{
  const auto parameters = [](Law law) {
    std::map<std::string, double> found;
    for_each_parameter(*law.operator->(),
                       [&](const std::string &name, auto value) { found[name] = static_cast<double>(value); });
    return found;
  };
  std::map<std::string, double> usual = parameters(Law()), own = parameters(scene.contact);
  std::vector<std::string> words;
  if (std::abs(own["friction"] - usual["friction"]) > 1e-6)
    words.push_back(fmt::format("contact.friction = {:.4g} deg", degrees(own["friction"])));
  if (own["feature_rolling"] == 0)
    words.emplace_back("no contact.rolling");
  else if (own["rolling_stiffness"] != usual["rolling_stiffness"] || own["rolling_limit"] != usual["rolling_limit"])
    words.push_back(fmt::format("contact.rolling = {{ stiffness = {:g}, limit = {:g} }}", own["rolling_stiffness"],
                                own["rolling_limit"]));
  if (const GradingSpec whole;
      scene.grading.finest_percent != whole.finest_percent || scene.grading.coarsest_percent != whole.coarsest_percent)
    words.push_back(
        fmt::format("grading.truncate = [{:g}, {:g}]", scene.grading.finest_percent, scene.grading.coarsest_percent));
  return fmt::format("{}", fmt::join(words, ", "));
}
} // namespace isostat
