// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material.hpp"

#include <chrono>

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
    const auto begin = Clock::now();
    material_->trial(increments, stresses);
    seconds += since(begin);
  }
  void commit() override
  {
    const auto begin = Clock::now();
    material_->commit();
    seconds += since(begin);
  }
  void rollback() override { material_->rollback(); }
  void stiffness(std::span<Stiffness> tangents) const override { material_->stiffness(tangents); }
  void wave_moduli(std::span<WaveModuli> moduli) const override { material_->wave_moduli(moduli); }
  std::vector<std::byte> pack() const override { return material_->pack(); }
  void unpack(std::span<const std::byte> bytes) override { material_->unpack(bytes); }

private:
  using Clock = std::chrono::steady_clock;
  static double since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }
  std::unique_ptr<Material> material_;
};
} // namespace isostat
