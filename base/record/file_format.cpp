// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/file_format.hpp"

#include "base/error.hpp"
#include "base/record/installation.hpp"

#include <cerrno>
#include <fmt/format.h>

namespace isostat
{
namespace
{
const std::string units =
    "SI. The attribute unit of a dataset is the unit of its numbers, \"-\" if they have none; names that end in _Pa or "
    "_deg carry theirs; other attributes are in kg, m, s, N, Pa, rad.";

std::string written_by(const hdf5::Group &root)
{
  if (!root.has_attribute("program") || !root.has_attribute("program_version"))
    return {};
  return fmt::format(", written by {} {}", root.attribute<std::string>("program"),
                     root.attribute<std::string>("program_version"));
}
} // namespace

void set_format(hdf5::Group root, const std::string &format, std::uint64_t version, const std::string &scene)
{
  root.set_attribute("format", format);
  root.set_attribute("schema_version", version);
  root.set_attribute("units", units);
  root.set_attribute("program", std::string(program_invocation_short_name));
  root.set_attribute("program_version", isostat::version());
  if (!scene.empty())
    root.set_attribute("scene", scene);
}

std::string format_of(const hdf5::Group &root)
{
  return root.has_attribute("format") ? root.attribute<std::string>("format") : "";
}

void refuse_newer(const hdf5::Group &root, std::uint64_t version)
{
  const auto found =
      root.has_attribute("schema_version") ? root.attribute<std::uint64_t>("schema_version") : std::uint64_t{0};
  if (found > version)
    throw InputError(
        fmt::format("{}: schema_version = {}, this program reads {}: the file is newer than the program{}; "
                    "use the version that wrote it, or a later one (this is {})",
                    root.file_path().string(), found, version, written_by(root), isostat::version()));
}

void expect_format(const hdf5::Group &root, const std::string &format, std::uint64_t version, const std::string &kind,
                   const std::string &remedy)
{
  const std::string path = root.file_path().string();
  if (format_of(root) != format)
    throw InputError(fmt::format("{}: not a {} of Isostat (no attribute format = \"{}\")", path, kind, format));
  refuse_newer(root, version);
  const auto found = root.attribute<std::uint64_t>("schema_version");
  if (found != version)
    throw InputError(fmt::format("{}: {} schema {} was written by another version; this one reads {}. {}", path, kind,
                                 found, version, remedy));
}
} // namespace isostat
