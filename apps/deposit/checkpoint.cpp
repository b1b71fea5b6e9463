// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/checkpoint.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/hdf5_fields.hpp"
#include "base/record/checkpoint_folder.hpp"
#include "base/record/file_format.hpp"
#include "base/record/instruction_set.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
const std::string checkpoint_format = "isostat-column-checkpoint";
// 2: unknowns in the order of their numbers, the soil as one row of bytes; 3: without viscosity; 4: without peak_tau
constexpr std::uint64_t checkpoint_schema_version = 5;

/// Numbers and vectors of a checkpoint or of the solver's state in it.
template <class Part>
void put(hdf5::Group root, const std::string &prefix, const Part &part)
{
  hdf5::Group vectors = root.create_group(prefix + "vectors"), numbers = root.create_group(prefix + "numbers");
  for (const auto &[name, values] : part.vectors)
    vectors.write(name, std::span<const double>(values), "-");
  for (const auto &[name, value] : part.numbers)
    numbers.set_attribute(name, value);
}

template <class Part>
void get(const hdf5::Group &root, const std::string &prefix, Part &part)
{
  const hdf5::Group vectors = root.group(prefix + "vectors");
  for (const std::string &name : vectors.names())
    {
      const std::vector<double> &values = part.vectors[name] = vectors.read<double>(name);
      if (std::ranges::any_of(values, [](double x) { return !std::isfinite(x); }))
        throw InputError(fmt::format("{}/{}: holds a value that is not a finite number; the file is damaged",
                                     vectors.where(), name));
    }
  hdf5::read_field(root, prefix + "numbers", part.numbers);
}

/// What names of a part of the solver's state begin with.
std::string part(std::size_t k) { return fmt::format("part_{}_", k); }

template <class Fields>
const auto &field(const ColumnCheckpoint &checkpoint, const Fields &fields, const std::string &name)
{
  const auto found = fields.find(name);
  if (found == fields.end())
    throw InputError(fmt::format("{}: holds no {}; a run cannot continue from it. Start again with --overwrite.",
                                 checkpoint.file, name));
  return found->second;
}

ColumnCheckpoint read_file(const std::filesystem::path &path)
{
  const hdf5::File file = hdf5::File::open(path);
  const hdf5::Group root = file.root();
  expect_format(root, checkpoint_format, checkpoint_schema_version);
  ColumnCheckpoint checkpoint;
  checkpoint.file = path.string();
  checkpoint.scene = root.attribute<std::string>("scene");
  if (root.has_attribute("instruction_set")) // else it is older
    checkpoint.instruction_set = root.attribute<std::string>("instruction_set");
  checkpoint.state.step = root.attribute<std::uint64_t>("step");
  checkpoint.state.material = MaterialState::from_bytes(hdf5::read_bytes(root, "material"));
  get(root, "state_", checkpoint.state);
  for (std::uint64_t k = 0; root.has_attribute("parts") && k < root.attribute<std::uint64_t>("parts"); ++k)
    {
      SolverState &state = checkpoint.state.parts.emplace_back();
      state.step = checkpoint.state.step;
      state.material = MaterialState::from_bytes(hdf5::read_bytes(root, part(k) + "material"));
      get(root, part(k), state);
    }
  get(root, "", checkpoint);
  return checkpoint;
}
} // namespace

double ColumnCheckpoint::number(const std::string &name) const { return field(*this, numbers, name); }

std::size_t ColumnCheckpoint::count(const std::string &name) const
{
  const double value = number(name);
  if (!is_count(value, 0x1p53))
    throw InputError(fmt::format("{}: {} = {}, expected a whole number from 0: the file is damaged. Start again with "
                                 "--overwrite.",
                                 file, name, value));
  return static_cast<std::size_t>(value);
}

const std::vector<double> &ColumnCheckpoint::vector(const std::string &name) const
{
  return field(*this, vectors, name);
}

const std::vector<double> &ColumnCheckpoint::vector(const std::string &name, std::size_t size) const
{
  const std::vector<double> &values = vector(name);
  if (values.size() != size)
    throw InputError(fmt::format("{}: {} are {} numbers, not {}: the file is damaged. Start again with --overwrite.",
                                 file, name, values.size(), size));
  return values;
}

void write_column_checkpoint(const std::filesystem::path &folder, const ColumnCheckpoint &checkpoint)
{
  write_newest(folder, [&](hdf5::Group root) {
    set_format(root, checkpoint_format, checkpoint_schema_version, checkpoint.scene);
    root.set_attribute("instruction_set", instruction_set());
    root.set_attribute("step", checkpoint.state.step);
    hdf5::write_bytes(root, "material", checkpoint.state.material.bytes());
    put(root, "state_", checkpoint.state);
    if (!checkpoint.state.parts.empty())
      root.set_attribute("parts", std::uint64_t{checkpoint.state.parts.size()});
    for (std::size_t k = 0; k < checkpoint.state.parts.size(); ++k)
      {
        put(root, part(k), checkpoint.state.parts[k]);
        hdf5::write_bytes(root, part(k) + "material", checkpoint.state.parts[k].material.bytes());
      }
    put(root, "", checkpoint);
  });
}

ColumnCheckpoint read_column_checkpoint(const std::filesystem::path &folder)
{
  ColumnCheckpoint checkpoint;
  read_newest(folder, [&](const std::filesystem::path &path) { checkpoint = read_file(path); });
  return checkpoint;
}
} // namespace isostat
