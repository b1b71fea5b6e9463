// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material.hpp"

namespace isostat
{
/// Several materials as one: part k has the points `places[k]` of the mesh, in that order. Points that lie side by side
/// (a layer of a column) are handed on in place; others are copied, so a part whose points are shared out over
/// processes can have all of its points in one batch, whatever layers lie between them. A failure says which points of
/// the mesh those of its part are.   tested: tests/fem/material/material_test.cpp
class CompositeMaterial : public Material
{
public:
  struct Part
  {
    std::unique_ptr<Material> material;
    std::vector<std::size_t> places; ///< material->n_points() numbers
  };

  /// @throws InputError  a point that has no part, or two
  explicit CompositeMaterial(std::vector<Part> parts);

  std::string name() const override { return "composite"; }
  std::size_t n_points() const override { return n_points_; }
  void set_time_step(double seconds) override;
  void set_initial_stress(std::span<const Stress> effective) override;
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  void commit() override;
  void rollback() override;
  void stiffness(std::span<Stiffness> tangents) const override;
  void wave_moduli(std::span<WaveModuli> moduli) const override;
  MaterialState pack() const override;
  void unpack(const MaterialState &state) override;

private:
  struct Member : Part
  {
    bool side_by_side; ///< places are first, first + 1, ...
  };
  std::vector<Member> parts_;
  std::size_t n_points_ = 0;
};

/// Materials one after another: the points of the first come first. Layers of a profile from the base up.
/// @throws InputError  a part is missing
std::unique_ptr<Material> stacked(std::vector<std::unique_ptr<Material>> parts);
} // namespace isostat
