// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/checkpoint.hpp"

#include "base/error.hpp"
#include "base/files/hdf5.hpp"
#include "base/record/checkpoint_folder.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
const std::string format_name = "isostat-column-checkpoint";
constexpr std::uint64_t schema_version = 1;

void put(hdf5::Group group, const std::map<std::string, double> &numbers)
{
  for (const auto &[name, value] : numbers)
    group.set_attribute(name, value);
}

void put(hdf5::Group group, const std::map<std::string, std::vector<double>> &vectors)
{
  for (const auto &[name, values] : vectors)
    group.write(name, std::span<const double>(values), "-");
}

void get(const hdf5::Group &group, std::map<std::string, double> &numbers)
{
  for (const std::string &name : group.attribute_names())
    numbers[name] = group.attribute<double>(name);
}

void get(const hdf5::Group &group, std::map<std::string, std::vector<double>> &vectors)
{
  for (const std::string &name : group.names())
    vectors[name] = group.read<double>(name);
}

ColumnCheckpoint read_file(const std::filesystem::path &path)
{
  const hdf5::File file = hdf5::File::open(path);
  const hdf5::Group root = file.root();
  expect_format(root, format_name, schema_version);
  ColumnCheckpoint checkpoint;
  checkpoint.scene = root.attribute<std::string>("scene");
  checkpoint.state.step = root.attribute<std::uint64_t>("step");
  checkpoint.state.material = hdf5::read_bytes(root, "material");
  get(root.group("state_vectors"), checkpoint.state.vectors);
  get(root.group("state_numbers"), checkpoint.state.numbers);
  get(root.group("vectors"), checkpoint.vectors);
  get(root.group("numbers"), checkpoint.numbers);
  return checkpoint;
}
} // namespace

void write_column_checkpoint(const std::filesystem::path &folder, const ColumnCheckpoint &checkpoint)
{
  write_newest(folder, [&](hdf5::Group root) {
    set_format(root, format_name, schema_version);
    root.set_attribute("scene", checkpoint.scene);
    root.set_attribute("step", checkpoint.state.step);
    hdf5::write_bytes(root, "material", checkpoint.state.material);
    put(root.create_group("state_vectors"), checkpoint.state.vectors);
    put(root.create_group("state_numbers"), checkpoint.state.numbers);
    put(root.create_group("vectors"), checkpoint.vectors);
    put(root.create_group("numbers"), checkpoint.numbers);
  });
}

ColumnCheckpoint read_column_checkpoint(const std::filesystem::path &folder)
{
  ColumnCheckpoint checkpoint;
  read_newest(folder, [&](const std::filesystem::path &path) { checkpoint = read_file(path); });
  return checkpoint;
}
} // namespace isostat
