// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/specimen_file.hpp"

#include "base/error.hpp"
#include "base/files/hdf5_fields.hpp"
#include "base/record/file_format.hpp"
#include "dem/io/snapshot_file.hpp"
#include "dem/state/state_fault.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
const std::string specimen_format = "isostat-specimen";
} // namespace

void expect_specimens(const hdf5::Group &root, const std::string &format, std::uint64_t version,
                      const std::string &remedy)
{
  const std::string file = root.file_path().string(), found = format_of(root);
  if (found != format)
    throw InputError(fmt::format("{}: {}, expected format = \"{}\"; give {}", file,
                                 found.empty() ? "HDF5, but without the attribute format; another program wrote it"
                                               : fmt::format("format = \"{}\"", found),
                                 format, remedy));
  refuse_newer(root, version);
  const auto found_version = root.attribute<std::uint64_t>("schema_version");
  if (found_version != version)
    throw InputError(
        fmt::format("{}: schema_version = {}, this program reads {}; prepare it again with this version, or "
                    "read it with the one that wrote it",
                    file, found_version, version));
}

void write_specimen(hdf5::Group group, const Specimen &specimen)
{
  if (const std::string found = state_fault(specimen.state); !found.empty())
    throw RunFailure(fmt::format("{}: the specimen is not written: {}", group.where(), found));
  hdf5::write_field(group, "provenance", specimen.provenance);
  hdf5::write_field(group, "numbers", specimen.numbers);
  write_snapshot(group.create_group("snapshot"), specimen.state);
}

void write_specimen(const std::filesystem::path &path, const Specimen &specimen)
{
  hdf5::File file = hdf5::File::create(path);
  hdf5::Group root = file.root();
  set_format(root, specimen_format, specimen_schema_version);
  write_specimen(root, specimen);
  file.commit();
}

Specimen read_specimen_description(const hdf5::Group &group)
{
  Specimen specimen;
  if (!group.has("provenance") && format_of(group) == snapshot_format) // of a run, without a story
    return specimen;
  hdf5::read_field(group, "provenance", specimen.provenance);
  hdf5::read_field(group, "numbers", specimen.numbers);
  return specimen;
}

Specimen read_specimen(const hdf5::Group &group)
{
  Specimen specimen = read_specimen_description(group);
  specimen.state = read_snapshot(group.group("snapshot"));
  if (const std::string found = state_fault(specimen.state); !found.empty())
    throw InputError(fmt::format("{}: {}. Prepare the specimen again", group.where(), found));
  return specimen;
}

Specimen read_specimen(const std::filesystem::path &path)
{
  const hdf5::File file = hdf5::File::open(path);
  expect_specimens(
      file.root(), specimen_format, specimen_schema_version,
      fmt::format("a specimen made by Isostat, of a library one of its entries ({}#s0001)", path.string()));
  return read_specimen(file.root());
}
} // namespace isostat
