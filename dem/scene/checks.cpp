// SPDX-License-Identifier: BSD-3-Clause
// Rules that bind several keys of a scene.
#include "base/scene/reader.hpp"
#include "dem/scene/schema.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
/// Throws for what a rigid box cannot do.
void need_cell(const SceneDocument &document, const SpecimenSpec &specimen, const std::string &path,
               std::string_view otherwise)
{
  if (specimen.domain != "periodic-cell")
    document.refuse(path, fmt::format("needs the periodic cell, but specimen.domain is \"{}\" ({}). Give domain = "
                                      "\"periodic-cell\" in [specimen], or {}.",
                                      specimen.domain, document.where("specimen.domain"), otherwise));
}

/// The range of the tests that a sand was compared with.
void check_sand(const SceneDocument &document, const SandSpec &sand)
{
  const auto too_high = [&](const char *other) {
    return fmt::format("must not be above {} ({}). Correct one of them.", other, document.where(other));
  };
  if (sand.lowest_pressure && sand.highest_pressure && *sand.lowest_pressure > *sand.highest_pressure)
    document.refuse("sand.lowest_pressure", too_high("sand.highest_pressure"));
  if (sand.lowest_void_ratio && sand.highest_void_ratio && *sand.lowest_void_ratio > *sand.highest_void_ratio)
    document.refuse("sand.lowest_void_ratio", too_high("sand.highest_void_ratio"));
}

/// The limits of the void ratio.
void check_limits(const SceneDocument &document, const SpecimenSpec &specimen)
{
  const char *path = document.find("specimen.e_min") ? "specimen.e_min" : "specimen.e_max";
  if (specimen.e_min.has_value() != specimen.e_max.has_value())
    document.refuse(path,
                    "needs the other limit, too: those of Karlsruhe fine sand do not belong to this grading. Give "
                    "specimen.e_min and specimen.e_max, or neither.");
  if (specimen.has_limits() && *specimen.e_min >= *specimen.e_max)
    document.refuse(path, fmt::format("e_min must be below e_max, but they are {} and {}. Correct one of them.",
                                      number_text(*specimen.e_min), number_text(*specimen.e_max)));
  if (specimen.relative_density && !specimen.has_limits())
    document.refuse("specimen.relative_density", no_limits);
}

/// Keys of the preparation next to a packing that is prepared. Defaults, as the printed scene has them, do no harm.
void check_given(const SceneDocument &document, const SpecimenSpec &specimen)
{
  const SpecimenSpec usual;
  if (!specimen.file.empty())
    for (const auto &[path, differs] :
         {std::pair{"specimen.expansion", specimen.expansion != usual.expansion},
          {"specimen.density_tolerance", specimen.density_tolerance != usual.density_tolerance},
          {"specimen.damping", specimen.damping != usual.damping}})
      if (differs && document.find(path))
        document.refuse(path, fmt::format("has no effect with specimen.file ({}): that packing is prepared. Leave it "
                                          "out, or prepare a specimen with it.",
                                          document.where("specimen.file")));
}

void check_specimen(const SceneDocument &document, const SpecimenSpec &specimen)
{
  if (specimen.consolidation == "k0")
    {
      need_cell(document, specimen, "specimen.consolidation", "leave consolidation out");
      if (document.find("specimen.file"))
        document.refuse("specimen.consolidation",
                        fmt::format("excludes specimen.file ({}): the file says how it was consolidated. Leave "
                                    "consolidation out, or add a stage of kind \"k0-compress\".",
                                    document.where("specimen.file")));
    }
  check_limits(document, specimen);
  check_given(document, specimen);
  if (document.find("specimen.file") && specimen.file.empty())
    document.refuse("specimen.file", "must name a file. Give the path of a prepared specimen.");
  if (!specimen.file.empty() && !specimen_place(specimen.file).path.ends_with(".h5"))
    document.refuse(
        "specimen.file",
        fmt::format("must be a file of Isostat (.h5), or an entry of a library (\"library.h5#s0007\"). Convert a "
                    "packing of another program once: isostat convert {} packing.h5",
                    specimen.file));
}

void check_contact(const SceneDocument &document, const Scene &scene)
{
  for (const Key &key : scene.contact->keys())
    if (const std::string path = fmt::format("contact.{}", key.path);
        key.table && document.find(path) && !document.find("contact.friction"))
      document.refuse(path, "has no effect without friction. Give contact.friction, or 0 deg to say that it is meant.");
  for (std::size_t i = 0; i < scene.stages.size(); ++i)
    if (const auto *set = as<Friction>(scene.stages[i]); set && set->friction > 0 && !(scene.contact->friction > 0))
      document.refuse(fmt::format("stage.{}.friction", i),
                      "has no effect because [contact] leaves friction out. Give contact.friction an angle > 0 deg.");
}

/// Pressure over the modulus of contacts is about a quarter of the overlap of a contact over its radius.
void check_pressure(const SceneDocument &document, const Scene &scene)
{
  double most = scene.specimen.pressure;
  for (int i = 0; i < 50; ++i) // converges at once where the modulus is constant, else by its small exponent
    most = 0.05 * scene.contact->modulus(most);
  if (takes_pressure(scene) && scene.specimen.pressure > most)
    document.refuse("specimen.pressure",
                    fmt::format("must be at most {:g} kPa, a twentieth of the modulus of contacts with contact.young = "
                                "{:g} GPa, because spheres that overlap by more are no contacts. Lower it, or give "
                                "stiffer contacts.",
                                most / 1e3, scene.contact->young / 1e9));
}

/// The pressure of the isotropic consolidation after which a stage begins for the first time, Pa; none: it begins after
/// something else, or the scene does not say.
std::optional<double> isotropic_before(const Scene &scene, std::size_t stage)
{
  while (stage-- > 0)
    if (const auto *servo = as<ServoStage>(scene.stages[stage]))
      return servo->isotropic_pressure(scene.specimen.pressure);
    else if (behaviour(scene.stages[stage]).takes_steps()) // a repeat ends with what comes before it
      return std::nullopt;
  const bool prepared = scene.specimen.file.empty() && scene.specimen.consolidation == "isotropic";
  return prepared ? std::optional(scene.specimen.pressure) : std::nullopt;
}

/// Refuses loads that do not hold q = 0 and tau = 0, where these are known before the run.
void check_static_bias(const SceneDocument &document, const Scene &scene, std::size_t i)
{
  const auto *shear = as<ShearStage>(scene.stages[i]);
  const std::optional<double> pressure = shear ? isotropic_before(scene, i) : std::nullopt;
  if (!pressure)
    return;
  const std::string why = shear->refusal(0, *pressure, *pressure);
  if (why.empty())
    return;
  const char *turn = shear->required_loads(*pressure)->low > 0 ? "turn.low" : "turn.high";
  for (const char *blamed : {"deviator_average", "static_stress_ratio", turn})
    if (const std::string path = fmt::format("stage.{}.{}", i, blamed); document.find(path))
      document.refuse(
          path, fmt::format("cannot be held after isotropic consolidation to {:g} kPa: {}", *pressure / 1e3, why));
}

void check_stages(const SceneDocument &document, const Scene &scene)
{
  for (std::size_t i = 0; i < scene.stages.size(); ++i)
    {
      const std::string kind = fmt::format("stage.{}.kind", i);
      if (const auto *path = as<Path>(scene.stages[i]))
        if (const std::string problem = path->contradiction(); !problem.empty())
          document.refuse(kind, problem + ".");
      if (const auto *repeat = as<Repeat>(scene.stages[i]); repeat && repeat->stages > i)
        document.refuse(fmt::format("stage.{}.stages", i),
                        fmt::format("there are {} stages before this one. Give as many or fewer.", i));
      if (behaviour(scene.stages[i]).needs_cell())
        need_cell(document, scene.specimen, kind, "change the kind");
      check_static_bias(document, scene, i);
    }
}

/// Keys that the drive leaves without a part.
void check_drive(const SceneDocument &document, const Scene &scene)
{
  std::vector<std::string> idle;
  if (scene.drive != StaticDrive{}) // defaults of the printed scene do no harm
    idle = {"motion.increment", "motion.balance", "motion.left_out"};
  if (scene.drive.on)
    {
      idle = {"motion.inertial_number", "motion.strain_rate", "motion.load_per_wave"};
      for (std::size_t i = 0; i < scene.stages.size(); ++i)
        for (const char *key : {"strain_rate", "stress_rate"})
          idle.push_back(fmt::format("stage.{}.{}", i, key));
    }
  for (const std::string &path : idle)
    if (document.find(path))
      document.refuse(path, fmt::format("has no effect with motion.drive = \"{}\". Leave it out, or give the other "
                                        "drive.",
                                        scene.drive.on ? "static" : "dynamic"));
  if (scene.drive.on && std::none_of(scene.stages.begin(), scene.stages.end(),
                                     [](const Stage &stage) { return behaviour(stage).drives(); }))
    document.refuse("motion.drive", "has no effect, because no stage shears. Leave it out, or add a stage that does.");
}
} // namespace

void check_scene(const SceneDocument &document, Scene &scene)
{
  check_groups(document, scene);
  check_sand(document, scene.sand);
  check_specimen(document, scene.specimen);
  check_contact(document, scene);
  check_pressure(document, scene);
  check_drive(document, scene);
  check_stages(document, scene);
}
} // namespace isostat
