// SPDX-License-Identifier: BSD-3-Clause
#include "apps/micromechanics/snapshot_series.hpp"

#include "base/error.hpp"
#include "base/files/hdf5.hpp"
#include "dem/io/snapshot_file.hpp"
#include "dem/io/specimen_file.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
constexpr const char *remedy = "Give a results folder of element_test, a snapshot_*.h5, or a specimen";

bool is_snapshot_name(const std::string &name) { return name.starts_with("snapshot_") && name.ends_with(".h5"); }
} // namespace

std::vector<fs::path> snapshot_files(const fs::path &results)
{
  std::error_code failure;
  if (!fs::exists(results, failure))
    throw InputError(fmt::format("{}: is not there. {}.", results.string(), remedy));
  if (!fs::is_directory(results))
    return {results};
  const fs::path folder = results / "snapshots";
  std::vector<fs::path> files;
  if (fs::is_directory(folder, failure))
    for (const fs::directory_entry &entry : fs::directory_iterator(folder))
      if (is_snapshot_name(entry.path().filename().string()))
        files.push_back(entry.path());
  if (files.empty())
    throw InputError(fmt::format("{}: no snapshots; expected {}. Run the test with output.snapshots = \"reversals\" or "
                                 "\"strain\". {}.",
                                 results.string(), (folder / "snapshot_*.h5").string(), remedy));
  std::sort(files.begin(), files.end(), [](const fs::path &a, const fs::path &b) {
    const std::string x = a.filename().string(), y = b.filename().string(); // 9999 before 10000
    return std::pair(x.size(), x) < std::pair(y.size(), y);
  });
  return files;
}

Snapshot read_stored_snapshot(const fs::path &path)
{
  const hdf5::File file = hdf5::File::open(path);
  const hdf5::Group root = file.root();
  const std::string format = root.has_attribute("format") ? root.attribute<std::string>("format") : "";
  if (format == "isostat-specimen")
    return read_specimen(path).state;
  if (format != "isostat-snapshot")
    throw InputError(fmt::format(
        "{}: {}, expected format = \"isostat-snapshot\" or \"isostat-specimen\". {}.", path.string(),
        format.empty() ? std::string("HDF5, but without the attribute format") : fmt::format("format = \"{}\"", format),
        remedy));
  return read_snapshot(root.group("snapshot"));
}
} // namespace isostat
