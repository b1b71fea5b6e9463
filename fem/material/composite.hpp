// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material.hpp"

namespace isostat
{
/// Materials whose points lie anywhere among those of the mesh, as one: part k has the points `places[k]`, in that
/// order. A part whose points are shared out over processes can so have all of its points in one batch, whatever layers
/// lie between them. A failure says which points of the mesh those of its part are.   cost: a copy of increments and
/// stresses   tested: tests/fem/material/material_test.cpp
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
  void set_initial_stress(std::span<const Stress> effective) override;
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  void commit() override;
  void rollback() override;
  void stiffness(std::span<Stiffness> tangents) const override;
  void wave_moduli(std::span<WaveModuli> moduli) const override;
  std::vector<std::byte> pack() const override;
  void unpack(std::span<const std::byte> bytes) override;

private:
  std::vector<Part> parts_;
  std::size_t n_points_ = 0;
};
} // namespace isostat
