// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/checkpoint.hpp"

#include "base/error.hpp"
#include "base/files/hdf5_fields.hpp"
#include "base/record/checkpoint_folder.hpp"
#include "base/record/file_format.hpp"
#include "base/record/instruction_set.hpp"
#include "dem/io/snapshot_file.hpp"
#include "dem/state/state_fault.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
const std::string checkpoint_format = "isostat-checkpoint";
// 8: no static drive; 7: only early ends, nothing about half cycles and pore pressure; 6: nothing about early ends,
// rows by any component; 5: nothing about control, repeats and paths;
// 4: no window of the slope; 3: no bound on the load rate; 2: no energy of rattlers; 1: every number as double
constexpr std::uint64_t checkpoint_schema_version = 9;

Checkpoint read_file(const std::filesystem::path &path)
{
  const hdf5::File file = hdf5::File::open(path);
  const hdf5::Group root = file.root();
  expect_format(root, checkpoint_format, checkpoint_schema_version);
  Checkpoint checkpoint;
  checkpoint.scene = root.attribute<std::string>("scene");
  if (root.has_attribute("instruction_set")) // else it is older
    checkpoint.instruction_set = root.attribute<std::string>("instruction_set");
  checkpoint.state = read_snapshot(root.group("state"));
  if (const std::string found = state_fault(checkpoint.state); !found.empty())
    throw InputError(fmt::format("{}: {}; the file is damaged", path.string(), found));
  hdf5::read_field(root, "drive", checkpoint.drive);
  hdf5::read_field(root, "written", checkpoint.written);
  hdf5::read_field(root, "assembly", checkpoint.assembly);
  hdf5::read_field(root, "specimen", checkpoint.specimen);
  return checkpoint;
}
} // namespace

void write_checkpoint(const std::filesystem::path &folder, const Checkpoint &checkpoint)
{
  write_newest(folder, [&](hdf5::Group root) {
    set_format(root, checkpoint_format, checkpoint_schema_version, checkpoint.scene);
    root.set_attribute("instruction_set", instruction_set());
    write_snapshot(root.create_group("state"), checkpoint.state);
    hdf5::write_field(root, "drive", checkpoint.drive);
    hdf5::write_field(root, "written", checkpoint.written);
    hdf5::write_field(root, "assembly", checkpoint.assembly);
    hdf5::write_field(root, "specimen", checkpoint.specimen);
  });
}

Checkpoint read_checkpoint(const std::filesystem::path &folder)
{
  Checkpoint checkpoint;
  read_newest(folder, [&](const std::filesystem::path &path) { checkpoint = read_file(path); });
  return checkpoint;
}
} // namespace isostat
