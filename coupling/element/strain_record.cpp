// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/element/strain_record.hpp"

#include "base/error.hpp"
#include "base/files/hdf5_bytes.hpp"
#include "base/record/checkpoint_folder.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
const std::string format_name = "isostat-strain-record";
constexpr std::uint64_t schema_version = 1;
constexpr const char *gradient_names[] = {"H_xx", "H_xy", "H_xz", "H_yx", "H_yy", "H_yz", "H_zx", "H_zy", "H_zz"};
constexpr const char *stress_names[] = {"sigma_xx", "sigma_yy", "sigma_zz", "sigma_yz", "sigma_xz", "sigma_xy"};

void write_settings(hdf5::Group root, const RveSettings &settings)
{
  root.set_attribute("damping", settings.motion.damping);
  root.set_attribute("quasi_static_tolerance", settings.motion.quasi_static_tolerance);
  root.set_attribute("rate_floor", settings.motion.rate_floor);
  root.set_attribute("rate_ceiling", settings.motion.rate_ceiling);
  root.set_attribute("time_step_safety", settings.motion.time_step_safety);
  root.set_attribute("min_steps", settings.min_steps);
  root.write("frame", std::span<const double>(settings.frame.data(), 9), "-", 3); // columns, one after the other
}

RveSettings read_settings(const hdf5::Group &root)
{
  RveSettings settings;
  settings.motion.damping = root.attribute<double>("damping");
  settings.motion.quasi_static_tolerance = root.attribute<double>("quasi_static_tolerance");
  settings.motion.rate_floor = root.attribute<double>("rate_floor");
  settings.motion.rate_ceiling = root.attribute<double>("rate_ceiling");
  settings.motion.time_step_safety = root.attribute<double>("time_step_safety");
  settings.min_steps = root.attribute<std::uint64_t>("min_steps");
  std::ranges::copy(root.read<double>("frame", {3, 3}), settings.frame.data());
  return settings;
}

void check_packing(const std::filesystem::path &path, const StrainRecord &record)
{
  try
    {
      (void)Rve::unpack(record.packing, record.settings.rve);
    }
  catch (const InputError &error)
    {
      throw InputError(fmt::format("{}: {}", path.string(), error.what()));
    }
}

void read_rows(const std::filesystem::path &path, StrainRecord &record)
{
  const hdf5::File file = hdf5::File::open(path);
  const hdf5::Group rows = file.root().group("history");
  record.time = rows.read<double>("time");
  const std::size_t n = record.time.size();
  record.increments.resize(n);
  record.stresses.resize(n);
  for (std::size_t c = 0; c < std::size(gradient_names); ++c)
    {
      const auto values = rows.read<double>(gradient_names[c], {n});
      for (std::size_t k = 0; k < n; ++k)
        record.increments[k][c] = values[k];
    }
  for (std::size_t c = 0; c < std::size(stress_names); ++c)
    {
      const auto values = rows.read<double>(stress_names[c], {n});
      for (std::size_t k = 0; k < n; ++k)
        record.stresses[k][c] = values[k];
    }
}
} // namespace

std::vector<RecordColumn> strain_record_columns()
{
  std::vector<RecordColumn> columns = {{"step", "-"}, {"time", "s"}};
  for (const char *name : gradient_names)
    columns.push_back({name, "-"});
  for (const char *name : stress_names)
    columns.push_back({name, "Pa"});
  columns.push_back({"packing_steps", "-"});
  return columns;
}

std::vector<double> strain_record_row(std::uint64_t step, double time, const Gradient &h, const Stress &stress,
                                      double steps_of_packing)
{
  std::vector<double> row = {static_cast<double>(step), time};
  row.insert(row.end(), h.begin(), h.end());
  row.insert(row.end(), stress.begin(), stress.end());
  row.push_back(steps_of_packing);
  return row;
}

void write_strain_record_start(const std::filesystem::path &folder, const StrainRecord &record)
{
  hdf5::File file = hdf5::File::create(folder / "packing.h5");
  hdf5::Group root = file.root();
  set_format(root, format_name, schema_version);
  root.set_attribute("depth", record.depth);
  root.set_attribute("undrained", std::uint64_t{record.settings.undrained});
  root.set_attribute("halvings", std::uint64_t{record.settings.halvings});
  write_settings(root, record.settings.rve);
  hdf5::write_bytes(root, "packing", record.packing);
  file.commit();
}

StrainRecord read_strain_record(const std::filesystem::path &folder)
{
  if (!std::filesystem::exists(folder / "packing.h5"))
    throw InputError(fmt::format("{}: holds no packing.h5, so it is not the record of a packing. A run of soil_column "
                                 "leaves such folders, paths/d0 and so on, if its scene has grains.path_depths.",
                                 folder.string()));
  StrainRecord record;
  {
    const hdf5::File file = hdf5::File::open(folder / "packing.h5");
    const hdf5::Group root = file.root();
    expect_format(root, format_name, schema_version);
    record.depth = root.attribute<double>("depth");
    record.settings.undrained = root.attribute<std::uint64_t>("undrained") != 0;
    record.settings.halvings = static_cast<unsigned>(root.attribute<std::uint64_t>("halvings"));
    record.settings.rve = read_settings(root);
    record.packing = hdf5::read_bytes(root, "packing");
  }
  check_packing(folder / "packing.h5", record);
  read_rows(folder / "history.h5", record);
  return record;
}
} // namespace isostat
