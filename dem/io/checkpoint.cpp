// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/checkpoint.hpp"

#include "base/error.hpp"
#include "base/hdf5.hpp"
#include "dem/io/snapshot_file.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
const std::string format_name = "isostat-checkpoint";
constexpr std::uint64_t schema_version = 1;

Checkpoint read_file(const std::filesystem::path &path)
{
  const hdf5::File file = hdf5::File::open(path);
  const hdf5::Group root = file.root();
  if (!root.has_attribute("format") || root.attribute<std::string>("format") != format_name)
    throw InputError(
        fmt::format("{}: not a checkpoint of Isostat (no attribute format = \"{}\")", path.string(), format_name));
  const auto version = root.attribute<std::uint64_t>("schema_version");
  if (version != schema_version)
    throw InputError(
        fmt::format("{}: checkpoint schema {} was written by another version; this one reads {}. Finish the "
                    "run with the version that began it.",
                    path.string(), version, schema_version));
  Checkpoint checkpoint;
  checkpoint.scene = root.attribute<std::string>("scene");
  checkpoint.state = read_snapshot(root.group("state"));
  const hdf5::Group numbers = root.group("numbers");
  for (const std::string &name : numbers.attribute_names())
    checkpoint.numbers[name] = numbers.attribute<double>(name);
  return checkpoint;
}
} // namespace

void write_checkpoint(const std::filesystem::path &folder, const Checkpoint &checkpoint)
{
  std::filesystem::create_directories(folder);
  const std::filesystem::path last = folder / "last.h5", fresh = folder / "fresh.h5";
  hdf5::File file = hdf5::File::create(fresh);
  hdf5::Group root = file.root();
  root.set_attribute("format", format_name);
  root.set_attribute("schema_version", schema_version);
  root.set_attribute("scene", checkpoint.scene);
  write_snapshot(root.create_group("state"), checkpoint.state);
  hdf5::Group numbers = root.create_group("numbers");
  for (const auto &[name, value] : checkpoint.numbers)
    numbers.set_attribute(name, value);
  file.commit();
  // each rename is one step; between them previous.h5 and fresh.h5 are whole
  if (std::filesystem::exists(last))
    std::filesystem::rename(last, folder / "previous.h5");
  std::filesystem::rename(fresh, last);
}

Checkpoint read_checkpoint(const std::filesystem::path &folder)
{
  std::string problems;
  for (const char *name : {"fresh.h5", "last.h5", "previous.h5"})
    {
      const std::filesystem::path path = folder / name;
      if (!std::filesystem::exists(path))
        continue;
      try
        {
          return read_file(path);
        }
      catch (const InputError &error)
        {
          problems += std::string("\n  ") + error.what();
        }
    }
  throw InputError(fmt::format("{}: no checkpoint to resume from{}", folder.string(),
                               problems.empty() ? ": none was written. Start anew with --overwrite." : problems));
}
} // namespace isostat
