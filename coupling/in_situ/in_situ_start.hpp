// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "coupling/in_situ/in_situ.hpp"
#include "coupling/in_situ/in_situ_cache.hpp"
#include "coupling/in_situ/specimen_request.hpp"

#include <map>
#include <memory>
#include <optional>

namespace isostat
{
/// Brings the specimens of many elements to their stresses in situ. Elements with the same recipe share one specimen,
/// and what the cache holds is not prepared again:
///
///     add() every element  ->  prepare() each, side by side  ->  prepared() to the cache,  specimen() for each element
///
/// tested: tests/coupling/in_situ/in_situ_start_test.cpp
class InSituStart
{
public:
  /// @param cache  stays valid as long as this
  InSituStart(const MotionSpec &motion, const InSituSettings &settings, const InSituCache &cache)
      : motion_(motion), settings_(settings), cache_(cache)
  {}

  /// @param id  number of the element     @param target  in the specimen's axes, Pa, tension positive
  void add(std::size_t id, std::shared_ptr<const StartingSpecimen> start, const Mat3 &target);

  /// Does the work of an element, if it has any: the first of those with the same recipe has it all. Calls for
  /// different elements may run at the same time.   @throws  as bring_to_stress()
  void prepare(std::size_t id);

  /// What prepare() made, by rising number of the element.
  std::vector<InSituState> prepared() const;

  /// @pre every element was prepared
  const Snapshot &specimen(std::size_t id) const;

private:
  struct Job
  {
    std::shared_ptr<const StartingSpecimen> start;
    Mat3 target;
    std::string recipe;
  };
  struct Result
  {
    std::size_t first = 0; ///< the element that prepares it
    std::optional<Snapshot> specimen;
    std::vector<std::byte> packed; ///< empty: it came from the cache
  };

  MotionSpec motion_;
  InSituSettings settings_;
  const InSituCache &cache_;
  std::map<std::size_t, Job> jobs_;       ///< by number of the element
  std::map<std::string, Result> results_; ///< by recipe
};
} // namespace isostat
