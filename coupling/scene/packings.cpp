// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/scene/packings.hpp"

#include "base/scene/document.hpp"
#include "base/scene/ranges.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
using namespace ranges;
constexpr const char *in_situ_choices[] = {"all-stresses", "no-lateral-strain"};

// clang-format off
constexpr Key packings[] = {
  {.path = "library", .field = member<&RveMaterialSettings::library>, .presence = Presence::optional,
   .value = "library.h5",
   .text = "Specimens, made by `isostat library`; counts from the folder of the scene file or else from the working "
           "directory. Needed by soil of grains."},
  {.path = "sand", .field = member<&RveMaterialSettings::sand>, .presence = Presence::optional,
   .value = "karlsruhe-fine-sand",
   .text = "Name of the sand of which all specimens must be: `sand` of the scene from which `isostat library` made them. "
           "Left out: any. With or without it a warning names layers whose p' in situ is outside of the range of the "
           "sand that the specimens are of."},
  {.path = "cache", .field = member<&RveMaterialSettings::cache>, .presence = Presence::optional,
   .value = "results/in_situ.h5",
   .text = "File in which packings brought to their stress in situ are kept for the next start; counts from the "
           "working directory. Left out: none are kept."},
  {.path = "in_situ", .field = member<&RveMaterialSettings::in_situ, &InSituSettings::path>, .value = "all-stresses",
   .choices = in_situ_choices,
   .text = "Packings start at the vertical and horizontal stress of the soil in situ (in a column from weight and "
           "`layer.k0`), or, without lateral strain, at the horizontal stress that results."},
  {.path = "realisations", .field = member<&RveMaterialSettings::realisations>, .value = "1", .range = {1, 1000},
   .reason = "because a point has at least one packing, and a thousand run a thousand times as long",
   .text = "Packings at a Gauss point, each from another seed; its stress is their mean."},
  {.path = "min_steps", .field = member<&RveMaterialSettings::min_steps>, .value = "20", .range = {1, 1e6},
   .reason = one_or_more,
   .text = "Least number of time steps of the grains in each increment of an element: small increments would "
           "otherwise end after one or two, before the grains find their places."},
};

constexpr Key specimens[] = {
  {.path = "relative_density", .field = member<&SpecimenRequest::relative_density>, .presence = Presence::optional,
   .value = "0.5", .range = {-1, 2},
   .reason = "because D_r is 0 at e_max and 1 at e_min, and no packing is as far beyond",
   .text = "D_r of the packings: the nearest of the library within 0.05; left out: the library has one density only."},
  {.path = "realisation", .field = member<&SpecimenRequest::realisation>, .value = "0",
   .text = "Which seed of the library, counted from 0; with several realisations the first of them."},
};

constexpr Key lots[] = {
  {.path = "mixed_realisations", .field = member<&SpecimenRequest::mixed>, .value = "1", .range = counts,
   .reason = one_or_more,
   .text = "Each Gauss point draws one of this many seeds at random, from `realisation` on (with several "
           "`realisations` as many different ones). 1: all points have the same packing, brought to the stress of "
           "their depth. 1, or at least `realisations`."},
  {.path = "lot", .field = member<&SpecimenRequest::lot>, .value = "0",
   .text = "Number of the draw: another one draws other seeds. Only with `mixed_realisations` above 1, like "
           "`lot_length`."},
  {.path = "lot_length", .field = member<&SpecimenRequest::lot_length>, .unit = unit::m, .value = "0 m",
   .range = not_negative,
   .text = "Points in one block of this length and width, counted from the base, share a draw: the soil varies over "
           "this length, whatever the mesh. 0 m: each point draws for itself."},
};
// clang-format on
} // namespace

SceneFragment<RveMaterialSettings> packing_keys()
{
  static const KeyTable table{packings, splice<&RveMaterialSettings::motion>("", controlled_motion_keys()),
                              splice<&RveMaterialSettings::drive>("", static_drive_keys())};
  return {table.keys()};
}

SceneFragment<SpecimenRequest> specimen_keys() { return {specimens}; }
SceneFragment<SpecimenRequest> lot_keys() { return {lots}; }

void check_packings(const SceneDocument &document, const std::string &section, const RveMaterialSettings &packings)
{
  if (packings.library.empty())
    document.refuse(section + ".library", "is missing; soil of grains is made of its specimens. Give library = "
                                          "\"library.h5\", made by isostat library.");
  for (const char *key : {".increment", ".balance", ".left_out"})
    if (!packings.drive.on && packings.drive != StaticDrive{} && document.find(section + key))
      document.refuse(section + key,
                      "has no effect with drive = \"dynamic\". Leave it out, or set drive = \"static\".");
}

void check_lot(const SceneDocument &document, const std::string &section, const SpecimenRequest &request,
               std::size_t per_point, const std::string &realisations)
{
  const auto refuse = [&](const char *key, const std::string &why) { document.refuse(section + "." + key, why); };
  if (request.mixed > 1 && request.mixed < per_point)
    refuse("mixed_realisations",
           fmt::format("must be 1 or at least {}, {}, because the packings of a point differ. Give more seeds.",
                       realisations, per_point));
  constexpr const char *no_lot = "has no effect if mixed_realisations is 1, as all points have the same seed. Give "
                                 "mixed_realisations, or remove it.";
  if (request.mixed == 1 && request.lot != 0)
    refuse("lot", no_lot);
  if (request.mixed == 1 && request.lot_length > 0)
    refuse("lot_length", no_lot);
}
} // namespace isostat
