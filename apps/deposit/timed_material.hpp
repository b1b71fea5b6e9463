// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/grain_column_test.py
#pragma once
#include "base/stopwatch.hpp"
#include "fem/material/material.hpp"

namespace isostat
{
/// A material that knows how long it was at work.
class TimedMaterial : public Material
{
public:
  explicit TimedMaterial(std::unique_ptr<Material> material) : material_(std::move(material)) {}

  double seconds = 0; ///< since the start, or since it was set to 0

  std::string name() const override { return material_->name(); }
  std::size_t n_points() const override { return material_->n_points(); }
  void set_initial_stress(std::span<const Stress> effective) override { material_->set_initial_stress(effective); }
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override
  {
    const TimedScope timed(seconds);
    material_->trial(increments, stresses);
  }
  void commit() override
  {
    const TimedScope timed(seconds);
    material_->commit();
  }
  void rollback() override { material_->rollback(); }
  void stiffness(std::span<Stiffness> tangents) const override { material_->stiffness(tangents); }
  void wave_moduli(std::span<WaveModuli> moduli) const override { material_->wave_moduli(moduli); }
  std::vector<std::byte> pack() const override { return material_->pack(); }
  void unpack(std::span<const std::byte> bytes) override { material_->unpack(bytes); }

private:
  std::unique_ptr<Material> material_;
};
} // namespace isostat
