// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/linear/vector.hpp"
#include "fem/material/material.hpp"

#include <cstdint>
#include <map>

namespace isostat
{
/// All that a solver needs to go on to the same bits: what a checkpoint stores, whatever the solver is.
struct SolverState
{
  std::uint64_t step = 0;
  std::map<std::string, std::vector<double>> vectors; ///< owned values of unknowns; stresses point by point
  std::map<std::string, double> numbers;
  std::vector<std::byte> material; ///< Material::pack()
};

/// A solver names the fields of its state once, in
///
///     template <typename Self, typename Visit>
///     static void for_each_field(Self &self, Visit &&visit) { visit("displacement", self.u_); ... }
///
/// and saves and restores by the two visitors below: for_each_field(*this, FieldWriter), for_each_field(*this,
/// FieldReader).   tested: tests/fem/solve/statics_state_test.cpp, tests/fem/solve/dynamics_test.cpp
class FieldWriter
{
public:
  /// @throws InputError  the mesh is shared out over ranks: no rank has all values
  FieldWriter(std::uint64_t step, const Material &material, bool shared_out);

  void operator()(const char *name, double value);
  void operator()(const char *name, const Vector &values);
  void operator()(const char *name, const std::vector<Stress> &stresses);
  void operator()(const char *name, const std::vector<double> &values);
  /// A number that a run that goes on must share.
  void constant(const char *name, double value) { (*this)(name, value); }

  SolverState state;
};

/// Takes the fields from a state; with `only_check` it changes nothing, so that a state that does not fit leaves the
/// solver as it was.
/// @throws InputError  a field that is not there, has another number of values, or a constant with another value
class FieldReader
{
public:
  explicit FieldReader(const SolverState &state, bool only_check = false) : state_(state), only_check_(only_check) {}

  void operator()(const char *name, double &value) const;
  void operator()(const char *name, Vector &values) const;
  void operator()(const char *name, std::vector<Stress> &stresses) const;
  void operator()(const char *name, std::vector<double> &values) const;
  void constant(const char *name, double value) const;

private:
  double number(const char *name) const;
  const std::vector<double> &stored(const char *name, std::size_t size) const;

  const SolverState &state_;
  bool only_check_;
};
} // namespace isostat
