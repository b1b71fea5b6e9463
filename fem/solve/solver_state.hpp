// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/linear/vector.hpp"
#include "fem/material/material.hpp"
#include "fem/space/mesh_order.hpp"

#include <cstdint>
#include <map>

namespace isostat
{
/// All that a solver needs to continue to the same bits: what a checkpoint stores, whatever the solver is. Of a mesh
/// that is shared out over ranks it is complete on the first rank alone, and in the order of MeshOrder, so that any
/// number of ranks can continue from it.
struct SolverState
{
  std::uint64_t step = 0;
  std::map<std::string, std::vector<double>> vectors; ///< unknowns cell by cell; stresses point by point
  std::map<std::string, double> numbers;
  MaterialState material;         ///< Material::pack()
  std::vector<SolverState> parts; ///< of solvers that this one steps: columns of free fields
};

/// A solver names the fields of its state once, in
///
///     template <typename Self, typename Visit>
///     static void for_each_field(Self &self, Visit &&visit) { visit("displacement", self.u_); ... }
///
/// and saves and restores by the two visitors below: for_each_field(*this, FieldWriter), for_each_field(*this,
/// FieldReader).   tested: tests/fem/solve/statics_state_test.cpp, tests/fem/solve/dynamics_test.cpp,
/// tests/apps/soil_column_resume_test.py (other numbers of ranks)
class FieldWriter
{
public:
  /// Collective.
  /// @throws InputError  on all ranks: the mesh is shared out, and the material keeps its points as a whole
  FieldWriter(std::uint64_t step, const Material &material, const FiniteElementSpace &space);

  void operator()(const char *name, double value) { state.numbers[name] = value; }
  void operator()(const char *name, const Vector &values);
  void operator()(const char *name, const std::vector<Stress> &stresses);
  /// A value for each point, or no values.
  void operator()(const char *name, const std::vector<double> &of_points);
  /// A number that a run that continues must share.
  void constant(const char *name, double value) { (*this)(name, value); }
  /// A number of which every rank has a part.
  void sum(const char *name, double part);

  SolverState state;

private:
  const FiniteElementSpace &space_;
  MeshOrder order_;
};

/// Takes the fields from a state. Until take() is called it only checks and changes nothing, so that a state that does
/// not fit leaves the solver as it was.
/// @throws InputError  a field that does not exist, has another number of values, or a constant with another value
class FieldReader
{
public:
  FieldReader(const SolverState &state, const FiniteElementSpace &space); ///< collective
  void take() { only_check_ = false; }

  void operator()(const char *name, double &value) const;
  void operator()(const char *name, Vector &values) const;
  void operator()(const char *name, std::vector<Stress> &stresses) const;
  void operator()(const char *name, std::vector<double> &of_points) const;
  /// A number found again may differ in its last digits, by sums over another number of ranks: the stored one counts.
  void constant(const char *name, double &value) const;
  void sum(const char *name, double &part) const; ///< all of it on the first rank
  /// Unpacks what belongs to the points of this rank.   Collective.
  /// @throws InputError  on all ranks: what unpack() threw on the lowest rank where it did
  void unpack(Material &material) const;

private:
  MaterialState own_points() const;
  double number(const char *name) const;
  const std::vector<double> &stored(const char *name, std::size_t size) const;

  const SolverState &state_;
  const FiniteElementSpace &space_;
  MeshOrder order_;
  bool only_check_ = true;
};
} // namespace isostat
