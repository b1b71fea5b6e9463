// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/io/specimen_library.hpp"

#include <map>
#include <memory>
#include <optional>

namespace isostat
{
/// Which specimens of a library a point is made of.
struct SpecimenRequest
{
  /// D_r of the soil [-]; left out: the library holds one density only. The library's nearest one is taken.
  std::optional<double> relative_density;
  std::size_t realisation = 0; ///< counts the seeds that the library has of this density, rising
  std::string library = {};    ///< file with the specimens of this sand; empty: that of RveMaterialSettings
  std::size_t mixed = 1;       ///< seeds, from `realisation` on, of which a point draws some at random; 1: none drawn
  std::size_t lot = 0;         ///< another number, another draw
  double lot_length = 0;       ///< points of the same block, so long and wide, share a draw; 0: each draws alone, m
  std::size_t drawn = 0;       ///< result of the draw, below `mixed`

  /// Which seed, as `realisation` counts, the k-th packing of the point has: after the last of the mixed ones the first
  /// follows, so that up to `mixed` packings of a point differ.
  std::size_t seed_of(std::size_t k) const { return realisation + (mixed > 1 ? (drawn + k) % mixed : k); }

  /// Seeds that the library must have for points of this many packings.
  std::size_t n_seeds(std::size_t per_point) const { return realisation + (mixed > 1 ? mixed : per_point); }

  bool operator==(const SpecimenRequest &) const = default;
};

/// The library entry of that density and seed with the nearest stress: smallest |ln(sigma_v/vertical)| +
/// |ln(sigma_h/horizontal)|, the first by name among equals.
/// @param vertical, horizontal  target effective stress, compression positive, Pa
/// @throws InputError  no density within 0.05, fewer seeds, entries that do not say seed or stress: shows the library
/// tested: tests/coupling/in_situ/specimen_request_test.cpp
const LibraryEntry &nearest_entry(const std::vector<LibraryEntry> &entries, const SpecimenRequest &request,
                                  double vertical, double horizontal);

/// What a column may take packings from: the entries of a library or, of a file with one specimen, that one as the
/// entry "specimen" of seed 0, unless it says another one.
/// @throws InputError  as list_library(); a specimen between rigid walls
/// tested: tests/python/library_test.py
std::vector<LibraryEntry> list_specimens(const std::filesystem::path &path);

/// Before any work: whether a library has the seeds of a request, for points of this many packings.
/// @param section, packings  where a scene says the request and the number, for the message
/// @throws InputError  as nearest_entry(), naming the library
/// tested: tests/coupling/in_situ/specimen_request_test.cpp
void check_seeds(const std::filesystem::path &library, SpecimenRequest request, std::size_t per_point,
                 const std::string &section, const std::string &packings);

/// The packing from which a specimen is brought to its stress in situ.
struct StartingSpecimen
{
  Snapshot state;
  std::string source; ///< entry of the library it came from; empty: it came from none
};

/// Specimens of a library, each read once.
/// tested: tests/coupling/in_situ/specimen_request_test.cpp
class NearestSpecimens
{
public:
  /// @throws InputError  as list_specimens()
  explicit NearestSpecimens(std::filesystem::path library);

  /// That of nearest_entry().
  std::shared_ptr<const StartingSpecimen> find(const SpecimenRequest &request, double vertical, double horizontal);

private:
  std::filesystem::path library_;
  std::vector<LibraryEntry> entries_;
  std::map<std::string, std::shared_ptr<const StartingSpecimen>> read_; ///< by name of the entry
};
} // namespace isostat
