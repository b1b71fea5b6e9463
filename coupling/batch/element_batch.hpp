// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "coupling/batch/exchange.hpp"
#include "coupling/batch/realisations.hpp"
#include "coupling/element/rve_element.hpp"

#include <functional>
#include <memory>

namespace isostat
{
/// What a trial of an element gave, as it travels between ranks.
struct ElementRow
{
  Stress stress{};         ///< effective, Pa, tension positive
  double seconds = 0;      ///< wall clock
  std::uint64_t steps = 0; ///< time steps of the grains
  bool failed = false;     ///< the rank of the element knows why
};

/// Elements on the ranks of a communicator and the threads of each rank.
///
///     trial:   H of every point -> [ rank 0: elements 0, 3, 4 ][ rank 1: 1, 2, 5 ]... -> rows of all, by id
///
/// Calls are collective unless they are const getters: every rank makes them in the same order with the same arguments,
/// and gets the same answer, bitwise, wherever elements are. A failure of an element is the same exception on every
/// rank.
/// tested: tests/coupling/batch/rve_material_test.cpp, tests/mpi/rve_material_mpi.cpp
class ElementBatch
{
public:
  /// Places for elements; make() fills them.     @param threads  of a rank; 0: as many as the process may use
  ElementBatch(const Realisations &points, const ElementSettings &settings, int threads, MPI_Comm comm);

  const Realisations &points() const { return points_; }
  /// @pre one for each point
  void name_points(std::vector<std::string> names) { points_.names = std::move(names); }
  const ElementSettings &settings() const { return settings_; }
  std::size_t size() const { return owners_.size(); }
  const Owners &owners() const { return owners_; }
  bool is_mine(std::size_t id) const { return owners_[id] == exchange_.rank(); }
  const Exchange &exchange() const { return exchange_; }

  /// Makes every element again, on its rank; none if one fails. They are committed as they are.
  void make(const std::function<Rve(std::size_t id)> &maker);
  /// @throws RunFailure  make() was not called yet
  void check_made() const;

  /// Strains every element from its committed state by the increment of its point.     @pre n_points increments
  /// @throws RunFailure  an element that cannot take it; all are back at the committed state
  void trial(std::span<const Gradient> of_points);
  /// @return whether there was a trial to commit
  bool commit();
  /// Elements go back when they are needed next.
  void rollback() { has_trial_ = false; }
  bool has_trial() const { return has_trial_; }

  /// Of the last trial, by id.
  std::span<const ElementRow> rows() const { return rows_; }
  std::span<const Stress> trial_stress() const { return trial_; }
  std::span<const Stress> committed_stress() const { return committed_; }

  /// An element as the last trial left it, or as committed if there is none; null where it is on another rank.
  RveElement *element(std::size_t id) const;

  /// Rows by id: each rank has filled in those of its elements, afterwards all have all, or those of `ids` (rising).
  template <typename Row>
  void share(std::span<Row> rows) const
  {
    exchange_.share(all_, owners_, rows);
  }
  template <typename Row>
  void share(std::span<const std::size_t> ids, std::span<Row> rows) const
  {
    exchange_.share(ids, owners_, rows);
  }

  /// Does work for each element of this rank; threads take the costliest first.
  /// @throws InputError, RunFailure  that of the lowest element, the same on all ranks
  void for_each(const std::function<void(std::size_t id)> &work) const;
  /// The same for work that a rank does as a whole.
  void together(const std::function<void()> &work) const;

  /// Bytes of every committed element in turn, by id, on every rank.
  void pack(const std::function<void(std::size_t id, const Bytes &)> &take) const;

  /// Moves elements to given ranks, and orders those of a rank by falling cost.   @return number of moves
  /// @throws RunFailure  a trial is pending; owners do not fit
  std::size_t place(const Owners &owners, std::span<const double> costs);

private:
  std::optional<RankFailure> run_mine(const std::function<void(std::size_t id)> &work) const;
  void run(std::size_t id, const Gradient &increment);
  void check_owners(const Owners &owners) const;

  Realisations points_;
  ElementSettings settings_;
  int threads_;
  Exchange exchange_;
  Owners owners_;
  std::vector<std::size_t> all_, order_;              ///< every id; those of this rank by falling cost
  std::vector<std::unique_ptr<RveElement>> elements_; ///< null where it is on another rank
  bool made_ = false, has_trial_ = false;
  std::vector<ElementRow> rows_;
  std::vector<Stress> trial_, committed_;
};
} // namespace isostat
