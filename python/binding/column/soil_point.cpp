// SPDX-License-Identifier: BSD-3-Clause
#include "python/binding/column/soil_point.hpp"

#include "apps/deposit/layer_curve.hpp"
#include "apps/deposit/resistance.hpp"
#include "apps/deposit/soil_material.hpp"
#include "fem/material/soil_point.hpp"
#include "python/binding/given.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace isostat::python
{
namespace
{
void check(double value, const char *name, double most)
{
  if (!(value > 0 && value <= most))
    throw InputError(fmt::format("{} = {}; must be in (0, {}]. Give a number in that range.", name, value, most));
}

/// A point with what another one starts from.
struct LayerPoint
{
  ColumnLayer soil;
  Stress in_situ;
  std::optional<double> resistance; ///< that of its scene
  SoilPoint point;

  LayerPoint(const ColumnLayer &layer, const Stress &stress, std::optional<double> ratio)
      : soil(layer), in_situ(stress), resistance(ratio), point(layer_material(layer, 1, {}), stress)
  {}
};

std::size_t layer_of(const ColumnScene &scene, const std::optional<std::string> &name)
{
  std::vector<std::string> names;
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    {
      const ColumnLayer &layer = scene.layers[k];
      const bool is_tested = layer.from_formula() || layer.material == LayerMaterial::umat;
      if (name ? layer.name == *name || fmt::format("layer.{}", k) == *name : is_tested)
        {
          const auto alike = [&](const ColumnLayer &other) { return name && other.name == *name; };
          if (std::ranges::count_if(scene.layers, alike) > 1)
            throw InputError(fmt::format("layer \"{}\": the scene has several of this name. Give one by its number, "
                                         "\"layer.{}\" for the first.",
                                         *name, k));
          if (is_tested)
            return k;
          throw InputError(
              fmt::format("layer \"{}\": its material is \"{}\", but must be elastic, iwan, mohr_coulomb or umat. "
                          "Packings of grains are tested by element_test.",
                          layer.name, material_names[static_cast<int>(layer.material)]));
        }
      names.push_back("\"" + layer.name + "\"");
    }
  throw InputError(name ? fmt::format("layer \"{}\": the scene has no layer of this name. Give one of {}.", *name,
                                      fmt::join(names, ", "))
                        : "scene: no layer is elastic, iwan, mohr_coulomb or umat. Packings of grains are tested by "
                          "element_test.");
}

LayerPoint point_of(const ColumnScene &scene, const Given<std::optional<std::string>, "layer"> &name,
                    const Given<std::optional<double>, "vertical_stress"> &vertical)
{
  const std::size_t layer = layer_of(scene, name);
  Stress stress = middle_stress(scene, layer);
  if (const std::optional<double> &asked = vertical)
    {
      check(*asked, "vertical_stress", 1e12);
      for (const double scale = -*asked / stress[2]; double &component : stress)
        component *= scale;
    }
  return {resisting_layer(scene, layer), stress, layer_resistance(scene, layer)};
}

py::array_t<double> rows(const std::vector<SoilPoint::Row> &path)
{
  py::array_t<double> array({static_cast<py::ssize_t>(path.size()), py::ssize_t(5)});
  std::copy(path.begin(), path.end(), reinterpret_cast<SoilPoint::Row *>(array.mutable_data()));
  return array;
}

py::array_t<double> six_of(const Stress &values) { return py::array_t<double>(6, values.data()); }

py::array_t<double> deform(LayerPoint &self, const Given<Mat3, "gradient"> &gradient)
{
  const Mat3 &h = gradient;
  self.point.deform({h(0, 0), h(0, 1), h(0, 2), h(1, 0), h(1, 1), h(1, 2), h(2, 0), h(2, 1), h(2, 2)});
  return six_of(self.point.stress());
}

py::array_t<double> shear(LayerPoint &self, Given<double, "gamma"> gamma, Given<std::uint64_t, "steps"> steps,
                          Given<bool, "drained"> drained)
{
  check(static_cast<double>(steps.value), "steps", 1e6);
  std::vector<SoilPoint::Row> path;
  self.point.shear(gamma, static_cast<unsigned>(steps.value), drained, &path);
  return rows(path);
}

py::array_t<double> shear_to(LayerPoint &self, Given<double, "tau"> tau, Given<bool, "drained"> drained,
                             Given<double, "limit"> limit)
{
  check(limit, "limit", 1);
  std::vector<SoilPoint::Row> path;
  self.point.shear_to(tau, drained, limit, &path);
  return rows(path);
}

py::array_t<double> compress_to(LayerPoint &self, Given<double, "vertical_stress"> vertical)
{
  check(vertical, "vertical_stress", 1e12);
  std::vector<SoilPoint::Row> path;
  self.point.compress_to(vertical, &path);
  return rows(path);
}

py::tuple cyclic_shear(LayerPoint &self, Given<double, "tau"> tau, Given<double, "cycles"> cycles,
                       Given<double, "more"> more)
{
  check(cycles, "cycles", 1e4);
  std::vector<SoilPoint::Row> path;
  const SoilPoint::Cycles found = self.point.cyclic_shear(tau, cycles, more, &path);
  return py::make_tuple(found.to_liquefaction, rows(path));
}
} // namespace

void add_soil_point(py::module_ &module)
{
  py::class_<LayerPoint>(module, "SoilPoint")
      .def(py::init(&point_of), py::arg("scene"), py::arg("layer") = py::none(),
           py::arg("vertical_stress") = py::none())
      .def(
          "fresh", [](const LayerPoint &self) { return LayerPoint(self.soil, self.in_situ, self.resistance); },
          "A new point of the same soil at the stress with which this one began.")
      .def_property_readonly(
          "layer", [](const LayerPoint &self) { return self.soil.name; }, "Its name.")
      .def_property_readonly(
          "material", [](const LayerPoint &self) { return material_names[static_cast<int>(self.soil.material)]; },
          "elastic, iwan, mohr_coulomb or umat.")
      .def_property_readonly(
          "crr", [](const LayerPoint &self) { return self.resistance; },
          "CRR at 15 cycles that the scene gives the layer in its middle; None: it gives none.")
      .def_property_readonly(
          "stress", [](const LayerPoint &self) { return six_of(self.point.stress()); },
          "Effective stress xx, yy, zz, yz, xz, xy, tension positive, Pa.")
      .def_property_readonly(
          "strain", [](const LayerPoint &self) { return six_of(self.point.strain()); },
          "Strain since the start in that order, shear as gamma.")
      .def_property_readonly(
          "shear_modulus",
          [](const LayerPoint &self) { return one_hertz_share(self.soil) * self.point.shear_modulus(); },
          "That of waves of 1 Hz now, Pa.")
      .def("deform", &deform, py::arg("gradient"),
           "Applies an increment of d u_i / d x_j, (3, 3).   Returns the stress (6)")
      .def(
          "shear", &shear, py::arg("gamma"), py::arg("steps") = 100, py::arg("drained") = false,
          "Simple shear by gamma in steps of a sine of 1 Hz, without lateral strain: at constant volume, or drained, "
          "at constant "
          "vertical stress.   Returns the path (steps, 5): gamma, tau, sigma'_v, p', eps_v; the last three positive in "
          "compression, Pa")
      .def("shear_to", &shear_to, py::arg("tau"), py::arg("drained") = false, py::arg("limit") = 0.2,
           "Simple shear to a shear stress, or until |gamma| comes to the limit.   Returns the path")
      .def("compress_to", &compress_to, py::arg("vertical_stress"),
           "One-dimensional compression or expansion to a vertical stress.   Returns the path")
      .def("cyclic_shear", &cyclic_shear, py::arg("tau"), py::arg("cycles"), py::arg("more") = 0.0,
           "Undrained cycles between +-tau until r_u = 1 - sigma'_v/sigma'_v0 = 0.95 or |gamma| = 0.03, and some more. "
           "  "
           "Returns (cycles until then, inf if it did not liquefy; path)");
}
} // namespace isostat::python
