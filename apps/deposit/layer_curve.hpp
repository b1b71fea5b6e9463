// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/fragment.hpp"
#include "fem/material/material.hpp"
#include "fem/material/soil_curve.hpp"

#include <optional>

namespace isostat
{
class SceneDocument;
struct ColumnLayer;
struct ColumnScene;

enum class Unloading
{
  masing,
  mrdf ///< LoopReduction of fem/material/iwan_curve.hpp
};

/// The modulus reduction and damping of a layer, and what its family asks for.
struct LayerCurve
{
  std::string source;                            ///< a family, or the path of a table (read_soil_curve); empty: none
  std::optional<double> plasticity_index;        ///< per cent
  std::optional<double> overconsolidation_ratio; ///< [-]
  std::optional<double> uniformity, d50;         ///< [-], m
  Unloading unloading = Unloading::masing;

  bool is_given() const { return !source.empty(); }
  bool is_file() const; ///< not a family
  bool operator==(const LayerCurve &) const = default;
};

SceneFragment<LayerCurve> curve_keys();

/// What its family and unloading need is there, and nothing else. A curve without contraction and dilation: shear does
/// not change p' (both become 0).   @param layer  number
/// @throws InputError   tested: tests/apps/deposit/layer_curve_test.cpp
void check_curve(const SceneDocument &document, ColumnScene &scene, std::size_t layer);
/// Paths become absolute, and the tables are read once to find mistakes.   @throws InputError
void find_curves(const SceneDocument &document, const std::string &scene_path, ColumnScene &scene);

/// At the mean effective stress, or the depth, of the middle of the layer.   @pre it has a curve   @throws InputError
SoilCurve curve_of(const ColumnLayer &layer);
/// Damping at small strain: that of the key, else of the smallest strain of the curve, else 0. Of critical
double small_strain_damping(const ColumnLayer &layer);
/// Where the strength keeps the backbone from following its curve: the strain from which on. None: nowhere below 1 %.
std::optional<double> strain_of_strength(const ColumnLayer &layer);

/// Iwan with the layer's hyperbola or curve, or Hooke's law, with its damping; shear_velocity and shear_modulus are
/// those at 1 Hz, so that slow loading finds moduli lower by ZenerBody::at_one_hertz().   @pre elastic or iwan
std::unique_ptr<Material> damped_material(const ColumnLayer &layer, std::size_t n_points);

/// Modulus at 1 Hz, for which V_s and G of a layer are given, over that of wave_moduli(), which is that of the highest
/// frequencies (ZenerBody); 1 without damping.   tested: tests/python/soil_point_test.py
double one_hertz_share(const ColumnLayer &layer);
} // namespace isostat
