// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/linear/vector.hpp"

namespace isostat
{
/// Values of other ranks that a vector's cells use are there while this lives. Collective.
/// tested: tests/fem/solve/statics_ranks_test.cpp, tests/apps/soil_column_resume_test.py (distributed)
class WithGhosts
{
public:
  explicit WithGhosts(const Vector &vector) : vector_(vector) { vector_.update_ghost_values(); }
  ~WithGhosts() { vector_.zero_out_ghost_values(); }
  WithGhosts(const WithGhosts &) = delete;
  WithGhosts &operator=(const WithGhosts &) = delete;

private:
  const Vector &vector_;
};
} // namespace isostat
