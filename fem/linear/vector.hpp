// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <memory>

namespace dealii::Utilities::MPI
{
class Partitioner;
}

namespace isostat
{
/// Which rank owns which unknown, and which unknowns of other ranks ("ghosts") the cells of this rank use.
using VectorPartition = std::shared_ptr<const dealii::Utilities::MPI::Partitioner>;

/// One value per unknown, shared out over ranks: the owned values come first in memory, the ghosts behind them. On
/// MPI_COMM_SELF every unknown is owned and nothing is ever exchanged.
///
/// A front for dealii::LinearAlgebra::distributed::Vector<double>, which does the work: deal.II's headers take seconds
/// to compile, and nothing that solves or writes needs to see them. Element access is inline; everything else is one
/// call of deal.II, so sums have its order.   tested: tests/fem/linear/vector_test.cpp
class Vector
{
public:
  Vector(); ///< without unknowns
  explicit Vector(const VectorPartition &partition);
  Vector(const Vector &other);
  Vector(Vector &&other) noexcept; ///< leaves a vector that may only be assigned to or destroyed
  Vector &operator=(const Vector &other);
  Vector &operator=(Vector &&other) noexcept;
  ~Vector();
  void swap(Vector &other) noexcept;

  bool belongs_to(const VectorPartition &partition) const; ///< was made with it
  std::size_t size() const;                                ///< of all ranks together
  std::size_t locally_owned_size() const { return n_owned_; }
  std::size_t n_local() const; ///< owned and ghosts
  /// Number over all ranks of a local unknown, owned or ghost; those of a rank are consecutive.
  std::size_t global_index(std::size_t local) const;
  std::size_t first_owned() const; ///< global number of the first owned one

  double *begin() { return values_; }
  double *end() { return values_ + n_owned_; }
  const double *begin() const { return values_; }
  const double *end() const { return values_ + n_owned_; }
  double &local_element(std::size_t i) { return values_[i]; } ///< owned or ghost
  double local_element(std::size_t i) const { return values_[i]; }

  Vector &operator=(double value);
  Vector &operator+=(const Vector &other);
  Vector &operator-=(const Vector &other);
  Vector &operator*=(double factor);
  Vector &operator/=(double divisor);
  double operator*(const Vector &other) const; ///< scalar product over all ranks
  double l1_norm() const;
  double l2_norm() const;
  double linfty_norm() const;

  /// Fetches the ghosts from their owners / sets them to 0 again, which must be before they are added to. Both are
  /// collective; allowed on a constant vector because the owned values stay.
  void update_ghost_values() const;
  void zero_out_ghost_values() const;
  /// Adds the ghosts to the values of their owners and sets them to 0. Collective.
  void add_ghosts_to_owners();

private:
  struct Values;
  void find_values();

  std::unique_ptr<Values> of_dealii_;
  double *values_ = nullptr;
  std::size_t n_owned_ = 0;
};
} // namespace isostat
