// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/in_situ/specimen_request.hpp"

#include "base/error.hpp"
#include "dem/io/stored_packing.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace isostat
{
namespace
{
constexpr double density_reach = 0.05;
constexpr std::size_t lines_in_message = 40;
} // namespace

const LibraryEntry &nearest_entry(const std::vector<LibraryEntry> &entries, const SpecimenRequest &request,
                                  double vertical, double horizontal)
{
  const bool any = !request.relative_density;
  const auto offset = [&](const LibraryEntry &e) {
    return any ? 0.0 : std::abs(e.number("relative_density") - *request.relative_density);
  };
  std::vector<const LibraryEntry *> fits;
  std::vector<double> seeds;
  for (const LibraryEntry &e : entries)
    if (offset(e) <= density_reach && e.number("vertical_stress_Pa") > 0 && e.number("K0") > 0 && e.number("seed") >= 0)
      {
        fits.push_back(&e);
        seeds.push_back(e.number("seed"));
      }
  std::sort(seeds.begin(), seeds.end());
  seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
  if (request.realisation >= seeds.size())
    throw InputError(fmt::format(
        "the library has {} realisations {}, the soil needs {}. Add some with isostat library --append, or in Python "
        "with isostat.write_library(). It has:\n{}",
        seeds.size(), any ? "" : fmt::format("of D_r within {:g} of {:g}", density_reach, *request.relative_density),
        request.realisation + 1, library_table(entries, lines_in_message)));
  const auto distance = [&](const LibraryEntry *e) {
    const double v = e->number("vertical_stress_Pa"), h = v * e->number("K0");
    return 100 * std::round(100 * offset(*e)) + std::abs(std::log(v / vertical)) + std::abs(std::log(h / horizontal));
  };
  std::erase_if(fits, [&](const LibraryEntry *e) { return e->number("seed") != seeds[request.realisation]; });
  return **std::min_element(fits.begin(), fits.end(), [&](auto *a, auto *b) { return distance(a) < distance(b); });
}

std::vector<LibraryEntry> list_specimens(const std::filesystem::path &path)
{
  if (is_specimen_library(path))
    return list_library(path);
  Specimen specimen = read_stored_packing(path, {});
  if (!specimen.state.cell)
    throw InputError(
        fmt::format("{}: a specimen between rigid walls, but a point of a column is a periodic cell. Prepare "
                    "it with specimen.domain = \"periodic-cell\".",
                    path.string()));
  add_figures(specimen);
  specimen.numbers.try_emplace("seed", 0);
  return {{"specimen", specimen.provenance, specimen.numbers}};
}

void check_seeds(const std::filesystem::path &library, SpecimenRequest request, std::size_t per_point,
                 const std::string &section, const std::string &packings)
{
  constexpr double any_stress = 1e5;
  std::string what = fmt::format("{}.realisation = {}", section, request.realisation);
  if (request.mixed > 1)
    what += fmt::format(", {}.mixed_realisations = {}", section, request.mixed);
  else if (per_point > 1)
    what += fmt::format(", {}.realisations = {}", packings, per_point);
  request.realisation = request.n_seeds(per_point) - 1;
  try
    {
      nearest_entry(list_specimens(library), request, any_stress, any_stress);
    }
  catch (const InputError &error)
    {
      throw InputError(fmt::format("{}: {}: {}", what, library.string(), error.what()));
    }
}

NearestSpecimens::NearestSpecimens(std::filesystem::path library)
    : library_(std::move(library)), entries_(list_specimens(library_))
{}

std::shared_ptr<const StartingSpecimen> NearestSpecimens::find(const SpecimenRequest &request, double vertical,
                                                               double horizontal)
{
  const std::string &name = nearest_entry(entries_, request, vertical, horizontal).name;
  auto &specimen = read_[name];
  if (!specimen)
    specimen = std::make_shared<StartingSpecimen>(
        StartingSpecimen{read_stored_packing(library_, is_specimen_library(library_) ? name : "").state, name});
  return specimen;
}
} // namespace isostat
