// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/grain_paths.hpp"

#include "apps/deposit/ranks.hpp"
#include "coupling/element/strain_record.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
std::filesystem::path path_folder(const std::filesystem::path &folder, std::size_t k)
{
  return folder / "paths" / fmt::format("d{}", k);
}
} // namespace

GrainPaths::GrainPaths(std::filesystem::path folder, const ColumnScene &scene, const SoilMaterial &soil,
                       const std::vector<double> &depths)
    : folder_(std::move(folder)), grains_(*soil.grains),
      points_(nearest_grains(soil, depths, scene.grain_output.path_depths))
{
  for (std::size_t point : points_)
    depths_.push_back(depths[soil.grains_places[point]]);
}

void GrainPaths::write_start(std::size_t k) const
{
  const Rve *element = grains_.element(points_[k]);
  if (!element)
    return;
  StrainRecord start;
  start.depth = depths_[k];
  start.packing = element->pack();
  start.settings = grains_.element_settings();
  write_strain_record_start(path_folder(folder_, k), start);
}

void GrainPaths::open(const ColumnCheckpoint *resumed)
{
  n_rows_ = resumed ? static_cast<std::size_t>(resumed->numbers.at("grain_paths")) : 0;
  on_first_rank([&] {
    for (std::size_t k = 0; k < points_.size(); ++k)
      {
        std::filesystem::create_directories(path_folder(folder_, k));
        rows_.push_back(std::make_unique<Recorder>(path_folder(folder_, k), strain_record_columns(), n_rows_));
      }
  });
  together([&] {
    for (std::size_t k = 0; !resumed && k < points_.size(); ++k)
      write_start(k);
  });
}

void GrainPaths::record(std::uint64_t step, double time)
{
  if (points_.empty())
    return;
  ++n_rows_;
  together([&] {
    for (std::size_t k = 0; k < rows_.size(); ++k)
      rows_[k]->append(strain_record_row(step, time, grains_.increment(points_[k]), grains_.stress(points_[k]),
                                         grains_.steps_of(points_[k])));
  });
}

void GrainPaths::flush()
{
  for (const auto &rows : rows_)
    rows->flush();
}
} // namespace isostat
