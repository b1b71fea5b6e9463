// SPDX-License-Identifier: BSD-3-Clause
// A specimen, a library and a checkpoint of HDF5 with damaged members: what is taken can be written and read again.
// Bytes that were changed after they were sealed do not come to HDF5 at all.
#include "base/files/csv_table.hpp"
#include "dem/io/checkpoint.hpp"
#include "dem/io/specimen_library.hpp"
#include "tests/fuzz/damaged_hdf5.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/lattice.hpp"

#include <fstream>

namespace
{
using namespace isostat;
namespace fs = std::filesystem;

/// Whole files, and a folder for the damaged ones.
struct Files
{
  fs::path folder = fs::temp_directory_path() / ("isostat_fuzz_" + std::to_string(getpid()));
  std::optional<fuzz::WholeHdf5> specimen, library, checkpoint;
  std::string sealed_specimen;

  Files()
  {
    fs::create_directories(folder / "checkpoint");
    const Specimen lattice{fuzz::sheared_lattice(), {{"title", "a lattice"}}, {{"void_ratio", 0.9}, {"seed", 1}}};
    write_specimen(folder / "specimen.h5", lattice);
    sealed_specimen = read_text(folder / "specimen.h5");
    specimen.emplace(sealed_specimen);
    LibraryWriter writer = LibraryWriter::create(folder / "library.h5");
    writer.add("s0001", lattice), writer.add("s0002", lattice);
    writer.commit();
    library.emplace(read_text(folder / "library.h5"));
    Checkpoint state;
    state.state = lattice.state, state.scene = "# of a lattice\n";
    write_checkpoint(folder / "checkpoint", state);
    checkpoint.emplace(read_text(folder / "checkpoint/last.h5"));
  }
  ~Files() { fs::remove_all(folder); }

  fs::path leave(const char *name, const std::string &bytes) const
  {
    std::ofstream(folder / name, std::ios::binary) << bytes;
    return folder / name;
  }
};

void try_specimen(const Files &files, const Specimen &specimen)
{
  write_specimen(files.folder / "again.h5", specimen);
  const Specimen again = read_specimen(files.folder / "again.h5");
  fuzz::require(again.state.grains.position == specimen.state.grains.position &&
                    again.provenance == specimen.provenance,
                "a specimen that was read is written and read again");
}

/// Some bytes changed, or the end cut off.
void try_raw_bytes(const Files &files, fuzz::Choices &choices)
{
  std::string bytes = files.sealed_specimen;
  const std::size_t sealed = bytes.size() - 32;
  if (choices.below(4) == 0)
    bytes.resize(choices.below(sealed));
  else
    do
      bytes[choices.below(sealed)] ^= static_cast<char>(1 + choices.below(255));
    while (!choices.used_up());
  if (bytes == files.sealed_specimen) // changed twice
    return;
  const fs::path path = files.leave("raw.h5", bytes);
  fuzz::require(!fuzz::accepted([&] { return read_specimen(path); }), "changed bytes are noticed");
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  static const Files files;
  fuzz::Choices choices(data, size);
  switch (choices.below(4))
    {
    case 0:
      {
        const fs::path path = files.leave("specimen.h5", files.specimen->damaged(choices));
        if (const auto specimen = fuzz::accepted([&] { return read_specimen(path); }))
          try_specimen(files, *specimen);
        break;
      }
    case 1:
      {
        const fs::path path = files.leave("library.h5", files.library->damaged(choices));
        if (const auto entries = fuzz::accepted([&] { return list_library(path); }))
          for (const LibraryEntry &entry : *entries)
            if (const auto specimen = fuzz::accepted([&] { return read_library_entry(path, entry.name); }))
              try_specimen(files, *specimen);
        break;
      }
    case 2:
      try_raw_bytes(files, choices);
      break;
    default:
      files.leave("checkpoint/last.h5", files.checkpoint->damaged(choices));
      fs::remove(files.folder / "checkpoint/previous.h5");
      if (const auto checkpoint = fuzz::accepted([&] { return read_checkpoint(files.folder / "checkpoint"); }))
        write_checkpoint(files.folder / "checkpoint", *checkpoint);
    }
  return 0;
}
