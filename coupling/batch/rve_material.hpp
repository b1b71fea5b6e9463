// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "coupling/batch/element_batch.hpp"
#include "coupling/batch/rve_material_settings.hpp"
#include "coupling/in_situ/in_situ_start.hpp"

namespace isostat
{
/// Where the time went; the same on all ranks except for `batch_seconds` and `wave_seconds`.
struct RveMaterialCost
{
  std::uint64_t trials = 0, steps = 0, moves = 0, stiffnesses = 0; ///< steps, moves: of all elements together
  double batch_seconds = 0;                                        ///< wall clock in trial()
  double rve_seconds = 0;                                          ///< in elements, summed over all of them
  double wave_seconds = 0;                                         ///< wall clock spent for stiffnesses of any kind
};

/// A soil whose every Gauss point is `realisations` packings of grains: representative volume elements under the
/// displacement gradient of the point, z upwards, see column_frame().
///
///   increments -> ElementBatch (ranks, threads, trial and commit) -> stresses of all elements -> Realisations -> means
///                      placed by CostMeter and BalanceRule             WaveModuliCache, committed
///
/// All calls are collective: every rank of the communicator calls them in the same order with the same arguments, and
/// gets the same answer, bitwise, for any number of ranks and threads and any placement. Placement
/// follows the measured cost of each element, known to all ranks.
///
/// An element that rejects an increment in all its parts stops all ranks with one and the same RunFailure; all elements
/// are back at the committed state then. A trial that is committed costs no copy of an element, see RveElement.
/// cost of trial() and commit(): besides the elements 0.3 us each, one MPI_Allgatherv, and every 500 time steps a copy
/// of an element: together some 1 % (docs/results/rve.md)
/// tested: tests/coupling/batch/rve_material_test.cpp, tests/mpi/rve_material_mpi.cpp
class RveMaterial : public Material
{
public:
  /// set_initial_stress() makes the elements, from a library of specimens, or one for each sand.
  RveMaterial(std::vector<SpecimenRequest> points, const RveMaterialSettings &settings, MPI_Comm comm);
  /// Elements as they are, one specimen each, by id; periodic, in their own axes (y vertical).
  RveMaterial(const std::vector<Snapshot> &specimens, const RveMaterialSettings &settings, MPI_Comm comm);

  std::string name() const override { return "rve"; }
  std::size_t n_points() const override { return points().n_points; }

  /// What messages call the points, such as "layer.0 (sand), depth 2.5 m".   @pre one for each point
  void name_points(std::vector<std::string> names) { batch_.name_points(std::move(names)); }

  /// Finds each element in the cache, or brings the nearest specimen of the library (or the element as it is) to the
  /// stress, several side by side; within 1 % of p' of the target. Where stresses have a shear, of each density the
  /// point with the largest shear over p' comes first: if one cannot be reached, it is that.
  /// @throws InputError  the library has no such specimens; p' too low     @throws RunFailure  not reached
  void set_initial_stress(std::span<const Stress> effective) override;

  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  void commit() override;
  void rollback() override;

  /// Mean of the elements' derivatives of stress by strain C in continued loading (Sliding::plastic), or undrained
  /// C (1 - m m^T/3), m = (1 1 1 0 0 0); not symmetric. Of the last trial, else of the committed state.
  /// cost some 0.3 s for each 1,000 grains; once for each state
  void stiffness(std::span<Stiffness> tangents) const override;
  /// From the elastic stiffness, see WaveModuliCache. cost when computed again about that of stiffness()
  void wave_moduli(std::span<WaveModuli> moduli) const override;

  /// The same bytes for any number of ranks and threads, on every rank.
  MaterialState pack() const override;
  void unpack(const MaterialState &state) override;

  /// Standard deviation of the stress over the realisations of each point, at the committed state; 0 for one. Pa
  void scatter(std::span<Stress> deviations) const { points().deviation(batch_.committed_stress(), deviations); }
  /// An element for micromechanics and figures, as the last trial left it, or as committed if there is none;
  /// null where it is on another rank.
  const Rve *element(std::size_t point, std::size_t realisation = 0) const;

  const RveMaterialSettings &settings() const { return settings_; }
  /// How its elements are run.
  const ElementSettings &element_settings() const { return batch_.settings(); }
  /// Displacement gradient of a point in the last trial.
  const Gradient &increment(std::size_t point) const { return increments_[point]; }
  /// Stress of an element at the committed state, on every rank.
  const Stress &stress(std::size_t point, std::size_t realisation = 0) const
  {
    return batch_.committed_stress()[points().id_of(point, realisation)];
  }
  /// Time steps that an element took in the last trial, on every rank.
  double steps_of(std::size_t point, std::size_t realisation = 0) const
  {
    return static_cast<double>(batch_.rows()[points().id_of(point, realisation)].steps);
  }

  /// Moves elements to given ranks, one for each id. Results do not change.   @pre no trial is pending
  void place(const Owners &owners) { cost_.moves += batch_.place(owners, meter_.means()); }
  const Owners &owners() const { return batch_.owners(); }
  const RveMaterialCost &cost() const { return cost_; }

private:
  RveMaterial(std::size_t n_points, const RveMaterialSettings &settings, MPI_Comm comm);
  const Realisations &points() const { return batch_.points(); }
  void make(const std::function<Rve(std::size_t id)> &maker);
  InSituStart in_situ_start(const InSituCache &cache, std::span<const Stress> effective) const;
  std::vector<bool> most_sheared(std::span<const Stress> effective) const;
  void count_trial();
  const std::vector<Stiffness> &element_tangents() const;
  void refresh_waves() const;

  RveMaterialSettings settings_;
  ElementBatch batch_;
  std::vector<SpecimenRequest> requests_; ///< empty: elements were given as they are
  std::vector<Gradient> increments_;      ///< of each point in the last trial
  CostMeter meter_;
  mutable WaveModuliCache waves_;
  mutable std::vector<Stiffness> tangents_; ///< of each element at the last trial; empty: not computed yet
  mutable RveMaterialCost cost_;
};
} // namespace isostat
