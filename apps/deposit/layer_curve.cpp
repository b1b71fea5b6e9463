// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/layer_curve.hpp"

#include "apps/deposit/scene.hpp"
#include "base/scene/ranges.hpp"
#include "base/scene/reader.hpp"
#include "fem/material/elastic.hpp"
#include "fem/material/iwan_curve.hpp"
#include "fem/material/viscoelastic.hpp"

#include <cmath>
#include <fmt/format.h>
#include <tuple>

namespace isostat
{
namespace
{
using namespace ranges;

constexpr const char *unloading_choices[] = {"masing", "mrdf"};

// clang-format off
constexpr Key in_layer[] = {
  {.path = "curve", .field = member<&LayerCurve::source>, .presence = Presence::optional, .value = "darendeli",
   .text = "Modulus reduction and damping that the slip elements follow up to a strain of 1 %, instead of a hyperbola: "
           "\"darendeli\" (2001), \"menq\" (2003), \"vucetic-dobry\" (1991) or \"epri\" (1993, sand), at the mean effective "
           "stress or depth of the middle of the layer; or a CSV file with the columns `strain (-)`, `G/G_max (-)` and, if "
           "known, `damping (-)`, whose path is like that of `motion.file`. Without `contraction`, `dilation` "
           "and a density both are 0 then."},
  {.path = "plasticity_index", .field = member<&LayerCurve::plasticity_index>, .presence = Presence::optional,
   .value = "20", .range = {0, 200}, .reason = "because no clay in the data is more plastic",
   .text = "Of the curves darendeli and vucetic-dobry, per cent; left out: 0."},
  {.path = "overconsolidation_ratio", .field = member<&LayerCurve::overconsolidation_ratio>,
   .presence = Presence::optional, .value = "2", .range = {1, 100},
   .reason = "because the largest past stress is at least that of today, and at most a hundred times as large",
   .text = "Of the curve darendeli; left out: 1."},
  {.path = "uniformity", .field = member<&LayerCurve::uniformity>, .presence = Presence::optional, .value = "2",
   .range = {1, 1000}, .reason = "because d60 is not below d10", .text = "d60/d10; of the curve menq, which needs it."},
  {.path = "d50", .field = member<&LayerCurve::d50>, .unit = unit::mm, .presence = Presence::optional,
   .value = "0.3 mm", .range = {1e-6, 1}, .reason = "because soil is made of grains",
   .text = "Median grain size; of the curve menq, which needs it."},
  {.path = "unloading", .field = member<&LayerCurve::unloading>, .value = "masing", .choices = unloading_choices,
   .text = "masing: loops of the backbone twice as large (Masing's rules), whose damping exceeds that of the curve at "
           "large strains; mrdf: loops as thin as the damping of the curve has them (Phillips and Hashash 2009)."},
};
// clang-format on

struct Family
{
  const char *name;
  bool plasticity_index, overconsolidation_ratio, sizes; ///< what it takes; sizes it needs
};
constexpr Family families[] = {{"darendeli", true, true, false},
                               {"menq", false, false, true},
                               {"vucetic-dobry", true, false, false},
                               {"epri", false, false, false}};

Family family_of(const std::string &source)
{
  for (const Family &family : families)
    if (source == family.name)
      return family;
  return {"", false, false, false};
}

/// G, with this damping, of slow loading over that at 1 Hz.
double slow_share(double damping) { return damping > 0 ? 1 / ZenerBody(damping).at_one_hertz() : 1; }

/// tau_max/G in the middle of the layer.
double reference_strain(const ColumnLayer &layer, const IwanParameters &sand)
{
  return sand.strength_ratio * layer.in_situ_pressure /
         (sand.shear_modulus * std::pow(layer.in_situ_pressure / sand.reference_pressure, sand.exponent));
}

std::unique_ptr<Material> undamped_material(const ColumnLayer &layer, double share, std::size_t n_points)
{
  if (layer.material == LayerMaterial::elastic)
    return std::make_unique<Elastic>(ElasticParameters{share * layer.small_strain_modulus(), layer.poisson_ratio},
                                     n_points);
  IwanParameters sand = layer.sand();
  sand.shear_modulus *= share;
  if (!layer.curve.is_given())
    return std::make_unique<Iwan>(sand, n_points);
  const SoilCurve curve = curve_of(layer);
  const double strain = reference_strain(layer, sand);
  const Backbone backbone = fit_curve(curve, strain, sand.elements);
  std::optional<LoopReduction> reduction;
  if (layer.curve.unloading == Unloading::mrdf)
    reduction = fit_loop_reduction(curve, backbone, strain);
  return std::make_unique<IwanOfCurve>(sand, backbone, reduction, n_points);
}
} // namespace

bool LayerCurve::is_file() const { return is_given() && !*family_of(source).name; }

SceneFragment<LayerCurve> curve_keys() { return {in_layer}; }

void check_curve(const SceneDocument &document, ColumnScene &scene, std::size_t i)
{
  ColumnLayer &layer = scene.layers[i];
  const LayerCurve &curve = layer.curve;
  const std::string prefix = fmt::format("layer.{}.", i);
  const Family family = family_of(curve.source);
  if (curve.is_file() && curve.source.find('.') == std::string::npos)
    document.refuse(prefix + "curve",
                    "is no known family. Give \"darendeli\", \"menq\", \"vucetic-dobry\", \"epri\" or the "
                    "path of a CSV file (with its ending).");
  for (const auto &[key, given, taken] :
       {std::tuple("plasticity_index", curve.plasticity_index.has_value(), family.plasticity_index),
        {"overconsolidation_ratio", curve.overconsolidation_ratio.has_value(), family.overconsolidation_ratio},
        {"uniformity", curve.uniformity.has_value(), family.sizes},
        {"d50", curve.d50.has_value(), family.sizes}})
    if (given && !taken)
      document.refuse(prefix + key, curve.is_given()
                                        ? fmt::format("has no effect on the curve \"{}\". Remove it.", curve.source)
                                        : "has no effect without a curve. Give one, or remove it.");
  if (family.sizes && (!curve.uniformity || !curve.d50))
    document.refuse(prefix + "curve",
                    "needs uniformity and d50. Give for example uniformity = 2 and d50 = \"0.3 mm\".");
  if (curve.unloading == Unloading::mrdf && !curve.is_given())
    document.refuse(prefix + "unloading", "needs the damping of a curve. Give one, or unloading = \"masing\".");
  if (layer.shear_strength && layer.iwan.strength_ratio != IwanParameters().strength_ratio)
    document.refuse(prefix + "shear_strength", "excludes strength_ratio, which follows from it. Keep one of them.");
  if (curve.is_given() && !layer.sand_density.given() && !document.find(prefix + "contraction") &&
      !document.find(prefix + "dilation"))
    layer.iwan.contraction = layer.iwan.dilation = 0;
}

void find_curves(const SceneDocument &document, const std::string &scene_path, ColumnScene &scene)
{
  for (std::size_t i = 0; i < scene.layers.size(); ++i)
    if (LayerCurve &curve = scene.layers[i].curve; curve.is_file())
      {
        curve.source = found_file(document, fmt::format("layer.{}.curve", i), scene_path, curve.source);
        if (read_soil_curve(curve.source).damping.empty() && curve.unloading == Unloading::mrdf)
          document.refuse(fmt::format("layer.{}.unloading", i),
                          fmt::format("needs the damping of the curve, but {} has no column `damping (-)`. Add it, or "
                                      "give unloading = \"masing\".",
                                      curve.source));
      }
}

SoilCurve curve_of(const ColumnLayer &layer)
{
  const LayerCurve &curve = layer.curve;
  if (curve.source == "darendeli")
    return darendeli_curve(layer.in_situ_pressure, curve.plasticity_index.value_or(0),
                           curve.overconsolidation_ratio.value_or(1));
  if (curve.source == "menq")
    return menq_curve(layer.in_situ_pressure, curve.uniformity.value(), curve.d50.value());
  if (curve.source == "vucetic-dobry")
    return vucetic_dobry_curve(curve.plasticity_index.value_or(0));
  if (curve.source == "epri")
    return epri_curve(layer.in_situ_depth);
  return read_soil_curve(curve.source);
}

double small_strain_damping(const ColumnLayer &layer)
{
  if (layer.damping || !layer.curve.is_given())
    return layer.damping.value_or(0);
  const SoilCurve curve = curve_of(layer);
  return curve.damping.empty() ? 0 : curve.damping.front();
}

std::optional<double> strain_of_strength(const ColumnLayer &layer)
{
  const SoilCurve curve = curve_of(layer);
  const double reference = reference_strain(layer, layer.sand()), strain = followed_strain(curve, reference);
  constexpr double step = 1.02; // a little beyond it the stress of the curve
  if (strain * step > std::min(0.01, curve.strains.back()) ||
      strain * step * curve.reduction_at(strain * step) < 0.9 * reference)
    return std::nullopt;
  return strain;
}

double one_hertz_share(const ColumnLayer &layer)
{
  const ZenerBody body(small_strain_damping(layer));
  return body.at_one_hertz() / body.unrelaxed();
}

std::unique_ptr<Material> damped_material(const ColumnLayer &layer, std::size_t n_points)
{
  const double damping = small_strain_damping(layer);
  std::unique_ptr<Material> soil = undamped_material(layer, slow_share(damping), n_points);
  return damping > 0 ? std::make_unique<Viscoelastic>(std::move(soil), damping) : std::move(soil);
}
} // namespace isostat
