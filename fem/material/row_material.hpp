// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material.hpp"

namespace isostat
{
/// A material whose points are rows of numbers: the committed ones, and those of the last trial. Its state is these,
/// its name, and its parameters, which a state that is unpacked must have, too.
/// tested: tests/fem/material/material_test.cpp
class RowMaterial : public Material
{
public:
  std::string name() const override { return name_; }
  std::size_t n_points() const override { return n_points_; }
  void commit() override;
  void rollback() override { has_trial_ = false; }
  MaterialState pack() const override;
  void unpack(const MaterialState &state) override;

protected:
  /// @param row  numbers of a point, at first 0
  RowMaterial(std::string name, std::vector<double> parameters, std::size_t n_points, std::size_t row);
  std::string at_point(std::size_t point) const; ///< "iwan: point 3: ", where messages begin

  std::vector<double> committed_, trial_;
  bool has_trial_ = false;

private:
  std::string name_;
  std::vector<double> parameters_; ///< as numbers
  std::size_t n_points_;
};
} // namespace isostat
