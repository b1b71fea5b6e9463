// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "coupling/batch/exchange.hpp"
#include "coupling/batch/rve_material_settings.hpp"
#include "coupling/element/rve_element.hpp"
#include "coupling/in_situ/in_situ.hpp"
#include "fem/material/material.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <memory>

namespace isostat
{
/// Where the time went; the same on all ranks but for `batch_seconds` and `wave_seconds`.
struct RveMaterialCost
{
  std::uint64_t trials = 0, steps = 0, moves = 0, stiffnesses = 0; ///< steps, moves: of all elements together
  double batch_seconds = 0;                                        ///< wall clock in trial()
  double rve_seconds = 0;                                          ///< in elements, summed over all of them
  double busiest_seconds = 0; ///< in elements of the rank with most, summed over trials
  double wave_seconds = 0;    ///< wall clock spent for stiffnesses of any kind
};

/// A soil whose every Gauss point is `realisations` packings of grains: representative volume elements under the
/// displacement gradient of the point, z upwards, see column_frame(). Elements are numbered point by point,
/// id = point * realisations + realisation.
///
///     trial:   H of every point -> [ rank 0: elements 0, 3, 4 ][ rank 1: 1, 2, 5 ]... -> stresses of all, by id
///
/// All calls are collective: every rank of the communicator calls them in the same order with the same arguments, and
/// gets the same answer to the bit, whatever the number of ranks and threads, and wherever elements live. Placement
/// follows the measured cost of each element (running mean of the last ten trials or so), known to all ranks.
///
/// An element that rejects an increment in all its parts stops all ranks with one and the same RunFailure; all elements
/// are back at the committed state then. A trial that is committed costs no copy of an element, see RveElement.
/// cost of trial() and commit(): beside the elements 0.3 us each, one MPI_Allgatherv, and every 500 time steps a copy
/// of an element: together some 1 % (docs/results/rve_material.md)
/// tested: tests/coupling/batch/rve_material_test.cpp, tests/mpi/rve_material_mpi.cpp
class RveMaterial : public Material
{
public:
  /// Elements come into being in set_initial_stress(), from a library of specimens.
  RveMaterial(std::vector<SpecimenRequest> points, const RveMaterialSettings &settings, MPI_Comm comm);
  /// Elements as they are, one specimen each, by id; periodic, in their own axes (y vertical).
  RveMaterial(const std::vector<Snapshot> &specimens, const RveMaterialSettings &settings, MPI_Comm comm);

  std::string name() const override { return "rve"; }
  std::size_t n_points() const override { return n_points_; }

  /// Finds each element in the cache, or brings the nearest specimen of the library (or the element as it is) to the
  /// stress, several side by side; within 1 % of p' of what is wanted.
  /// @throws InputError  the library has no such specimens; p' too low     @throws RunFailure  not reached
  void set_initial_stress(std::span<const Stress> effective) override;

  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  void commit() override;
  void rollback() override;

  /// Mean of the elements' derivatives of stress by strain from their condensed stiffness C (contacts that yield count
  /// as elastic): C, or undrained C (1 - m m^T/3), m = (1 1 1 0 0 0), which is not symmetric.
  /// cost some 0.15 s for each 1,000 grains; once for each state
  void stiffness(std::span<Stiffness> tangents) const override;
  /// C of the skeleton, whether undrained or not: symmetric.
  void skeleton_stiffness(std::span<Stiffness> stiffnesses) const;
  /// From C, found anew as RveMaterialSettings says: it falls with p' and hardly rises with it, so that an old one is
  /// rather too large. cost when found anew that of stiffness()
  void wave_moduli(std::span<WaveModuli> moduli) const override;

  /// The same bytes for any number of ranks and threads, on every rank.
  std::vector<std::byte> pack() const override;
  void unpack(std::span<const std::byte> bytes) override;

  /// Standard deviation of the stress over the realisations of each point, at the committed state; 0 for one. Pa
  void scatter(std::span<Stress> deviations) const;
  /// An element for micromechanics and figures, as the last trial left it, or as committed if there is none;
  /// null where it lives on another rank.
  const Rve *element(std::size_t point, std::size_t realisation = 0) const;

  /// How its elements are run.
  RveSettings element_settings() const;
  const RveMaterialSettings &settings() const { return settings_; }
  /// Displacement gradient of a point in the last trial.
  const Gradient &increment(std::size_t point) const { return increments_[point]; }
  /// Stress of an element at the committed state, on every rank.
  const Stress &stress(std::size_t point, std::size_t realisation = 0) const
  {
    return committed_[point * settings_.realisations + realisation];
  }

  /// Time steps that an element took in the last trial, on every rank.
  double steps_of(std::size_t point, std::size_t realisation = 0) const;

  /// Moves elements to given ranks, one for each id. Results do not change.   @pre no trial is pending
  void place(const Owners &owners);
  const Owners &owners() const { return owners_; }
  const RveMaterialCost &cost() const { return cost_; }

private:
  RveMaterial(std::size_t n_points, const RveMaterialSettings &settings, MPI_Comm comm);
  std::size_t n_elements() const { return owners_.size(); }
  std::size_t point_of(std::size_t id) const { return id / settings_.realisations; }
  bool is_mine(std::size_t id) const { return owners_[id] == exchange_.rank(); }
  std::string label(std::size_t id) const;
  std::unique_ptr<RveElement> make_element(Rve rve) const;
  std::unique_ptr<RveElement> unpack_element(std::span<const std::byte> bytes) const;
  std::optional<Exchange::Failure> for_mine(const std::function<void(std::size_t)> &work) const;
  void run_element(std::size_t id, const Gradient &increment);
  void stop_if_failed();
  void count_costs();
  void balance();
  void start();
  void check_ready() const;
  Stress mean(const std::vector<Stress> &stresses, std::size_t point) const;
  void mark_due();
  void find_stiffnesses() const;

  struct Jobs;
  Jobs jobs_for(std::span<const Stress> effective) const;
  void keep(const Jobs &jobs) const;

  RveMaterialSettings settings_;
  std::size_t n_points_;
  Exchange exchange_;
  std::vector<SpecimenRequest> requests_; ///< empty: elements were given as they are
  Owners owners_;
  std::vector<std::size_t> all_, order_;              ///< every id; mine, dearest first
  std::vector<double> costs_;                         ///< s per trial, of each element
  std::vector<std::unique_ptr<RveElement>> elements_; ///< null where it is not mine
  bool ready_ = false, has_trial_ = false;
  std::vector<Gradient> increments_;      ///< of each point in the last trial
  std::vector<Stress> committed_, trial_; ///< of each element
  std::vector<double> rows_;              ///< what a trial gave, shared between ranks
  std::map<std::size_t, std::string> reasons_;
  std::uint64_t commits_ = 0;

  /// Wave moduli of each element and what they were found at.
  struct Wave
  {
    double p = 0, s = 0, pressure = 0, commit = 0;
    bool due = true;
  };
  mutable std::vector<Wave> waves_;
  mutable std::vector<Stiffness> skeleton_; ///< of each element
  mutable bool skeleton_known_ = false;
  mutable RveMaterialCost cost_;
};
} // namespace isostat
