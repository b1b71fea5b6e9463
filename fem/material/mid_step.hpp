// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material.hpp"

#include <memory>

namespace isostat
{
/// A law of small strain in soil that is strained far: what it gets of an increment H, which refers to the soil at the
/// start of the step, is that in the middle of the step (Hughes & Winget 1980, doi:10.1002/nme.1620151210),
///
///     H_m = H (I + H/2)^-1
///
/// so that strains add up to the logarithmic one to second order: a cycle leaves none. Everything else is the law's
/// own; its stress does not turn with the soil.   tested: tests/fem/solve/dynamics_geometry_test.cpp
class MidStep : public Material
{
public:
  explicit MidStep(std::unique_ptr<Material> law) : law_(std::move(law)), increments_(law_->n_points()) {}

  std::string name() const override { return law_->name(); }
  std::size_t n_points() const override { return law_->n_points(); }
  void set_initial_stress(std::span<const Stress> effective) override { law_->set_initial_stress(effective); }
  void set_time_step(double seconds) override { law_->set_time_step(seconds); }
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  void commit() override { law_->commit(); }
  void rollback() override { law_->rollback(); }
  void stiffness(std::span<Stiffness> tangents) const override { law_->stiffness(tangents); }
  void wave_moduli(std::span<WaveModuli> moduli) const override { law_->wave_moduli(moduli); }
  MaterialState pack() const override { return law_->pack(); }
  void unpack(const MaterialState &state) override { law_->unpack(state); }

private:
  std::unique_ptr<Material> law_;
  std::vector<Gradient> increments_;
};
} // namespace isostat
