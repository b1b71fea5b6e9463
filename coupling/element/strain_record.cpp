// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/element/strain_record.hpp"

#include "base/error.hpp"
#include "base/files/hdf5_fields.hpp"
#include "base/record/file_format.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
const std::string format_name = "isostat-strain-record";
constexpr std::uint64_t schema_version = 5; // 4: no static drive; 3: no load_per_wave; 2: a tolerance of the rate
constexpr const char *gradient_names[] = {"H_xx", "H_xy", "H_xz", "H_yx", "H_yy", "H_yz", "H_zx", "H_zy", "H_zz"};
constexpr const char *stress_names[] = {"sigma_xx", "sigma_yy", "sigma_zz", "sigma_yz", "sigma_xz", "sigma_xy"};

void write_settings(hdf5::Group root, const RveSettings &settings)
{
  MotionSpec::for_each(settings.motion,
                       [&](const char *name, const auto &value) { hdf5::write_field(root, name, value); });
  root.set_attribute("min_steps", settings.min_steps);
  const StaticStepping stepping = settings.stepping.value_or(StaticStepping{.increment = 0});
  root.set_attribute("increment", stepping.increment); // 0: dynamic
  root.set_attribute("balance", stepping.balance.tolerance);
  root.set_attribute("left_out", stepping.balance.left_out);
  root.write("frame", std::span<const double>(settings.frame.data(), 9), "-", 3); // columns, one after the other
}

RveSettings read_settings(const hdf5::Group &root)
{
  RveSettings settings;
  MotionSpec::for_each(settings.motion, [&](const char *name, auto &value) { hdf5::read_field(root, name, value); });
  settings.min_steps = root.attribute<std::uint64_t>("min_steps");
  if (const double increment = root.attribute<double>("increment"); increment > 0)
    settings.stepping = {increment, {root.attribute<double>("balance"), root.attribute<double>("left_out")}};
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

template <typename Row, std::size_t n>
std::vector<Row> read_rows(const hdf5::Group &history, const char *const (&names)[n], std::size_t n_rows)
{
  std::vector<Row> rows(n_rows);
  for (std::size_t c = 0; c < n; ++c)
    {
      const auto values = history.read<double>(names[c], {n_rows});
      for (std::size_t k = 0; k < n_rows; ++k)
        rows[k][c] = values[k];
    }
  return rows;
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
    expect_format(root, format_name, schema_version, "strain record",
                  "Repeat it with the version that wrote it, or run the column again.");
    record.depth = root.attribute<double>("depth");
    record.settings.undrained = root.attribute<std::uint64_t>("undrained") != 0;
    record.settings.halvings = static_cast<unsigned>(root.attribute<std::uint64_t>("halvings"));
    record.settings.rve = read_settings(root);
    record.packing = hdf5::read_bytes(root, "packing");
  }
  check_packing(folder / "packing.h5", record);
  const hdf5::File file = hdf5::File::open(folder / "history.h5");
  const hdf5::Group history = file.root().group("history");
  record.time = history.read<double>("time");
  record.increments = read_rows<Gradient>(history, gradient_names, record.time.size());
  record.stresses = read_rows<Stress>(history, stress_names, record.time.size());
  return record;
}
} // namespace isostat
