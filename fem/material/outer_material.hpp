// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/row_material.hpp"

#include <memory>

namespace isostat
{
/// A material around another, with numbers of its own at each point: the state of a point is these, and then that of
/// the inner material, which may be kept as a whole.   tested: tests/fem/material/material_test.cpp
class OuterMaterial : public RowMaterial
{
public:
  void set_time_step(double seconds) override { inner_->set_time_step(seconds); }
  void commit() override;
  void rollback() override;
  MaterialState pack() const override;
  void unpack(const MaterialState &state) override;

protected:
  /// @param row  numbers of a point, at first 0
  OuterMaterial(const std::string &kind, std::unique_ptr<Material> inner, std::vector<double> parameters,
                std::size_t row);

  std::unique_ptr<Material> inner_;
};
} // namespace isostat
