// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/in_situ/in_situ_cache.hpp"

#include "base/error.hpp"
#include "base/files/bytes.hpp"
#include "base/files/hash.hpp"
#include "base/record/file_format.hpp"
#include "base/tell.hpp"
#include "coupling/in_situ/in_situ.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <set>
#include <string_view>
#include <utility>

namespace isostat
{
namespace
{
std::string name_of(const std::string &recipe) { return fmt::format("i{:016x}", Hash().text(recipe).value()); }

Specimen described(const InSituState &state)
{
  const Rve rve = Rve::unpack(state.packed, {});
  const Mat3 stress = -rve.stress();
  Specimen specimen;
  specimen.state = specimen_of(state.packed);
  specimen.provenance = {{"recipe", state.recipe}, {"consolidation", "in situ"}};
  if (!state.source.empty())
    specimen.provenance["source"] = state.source;
  specimen.numbers = {{"grains", static_cast<double>(specimen.state.grains.n_grains())},
                      {"void_ratio", rve.void_ratio()},
                      {"pressure_Pa", stress.trace() / 3},
                      {"vertical_stress_Pa", stress(1, 1)},
                      {"K0", 0.5 * (stress(0, 0) + stress(2, 2)) / stress(1, 1)}};
  return specimen;
}

/// Whether a file of HDF5 that may have been a library cannot be opened, or lacks entries in part.
bool is_damaged(const std::filesystem::path &path)
{
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  std::string start(signature.size(), ' ');
  std::ifstream(path, std::ios::binary).read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start != signature)
    return false;
  try
    {
      if (!is_specimen_library(path))
        return false;
    }
  catch (const InputError &)
    {
      return true;
    }
  refuse_newer(hdf5::File::open(path).root(), library_schema_version);
  try
    {
      list_library(path);
      return false;
    }
  catch (const InputError &)
    {
      return true;
    }
}
} // namespace

std::vector<std::byte> to_bytes(const std::vector<InSituState> &states)
{
  ByteWriter out;
  out.count(states.size());
  for (const InSituState &state : states)
    {
      out.text(state.recipe), out.text(state.source);
      out.block(state.packed);
    }
  return out.take();
}

void append_states(std::vector<InSituState> &states, std::span<const std::byte> bytes)
{
  ByteReader in(bytes, "in situ");
  for (std::uint64_t n = in.count(); n > 0; --n)
    {
      InSituState &state = states.emplace_back();
      state.recipe = in.text(), state.source = in.text();
      const auto block = in.block();
      state.packed.assign(block.begin(), block.end());
    }
}

InSituCache::InSituCache(std::filesystem::path path) : path_(std::move(path))
{
  if (!path_.empty() && std::filesystem::exists(path_) && !is_damaged(path_))
    entries_ = list_library(path_);
}

std::optional<Snapshot> InSituCache::find(const std::string &recipe) const
{
  const std::string name = name_of(recipe);
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const LibraryEntry &e) { return e.name == name; });
  if (found == entries_.end() || found->text("recipe") != recipe)
    return std::nullopt;
  try
    {
      return read_library_entry(path_, name).state;
    }
  catch (const InputError &) // another program has replaced the cache meanwhile
    {
      return std::nullopt;
    }
}

void InSituCache::add(const std::vector<InSituState> &states) const
{
  if (path_.empty() || states.empty())
    return;
  try
    {
      write(states);
    }
  catch (const std::exception &error) // the run has its states
    {
      warn(fmt::format("states in situ are not kept, and will be made again next time: {}", error.what()));
    }
}

void InSituCache::write(const std::vector<InSituState> &states) const
{
  if (std::filesystem::exists(path_) && is_damaged(path_))
    {
      const std::string aside = path_.string() + ".damaged";
      std::filesystem::rename(path_, aside);
      warn(fmt::format("states in situ were made again, because their cache was damaged; it is kept as {}", aside));
    }
  std::set<std::string> taken;
  if (std::filesystem::exists(path_)) // as it is now, another program may have added something
    for (const LibraryEntry &e : list_library(path_))
      taken.insert(e.name);
  LibraryWriter writer = std::filesystem::exists(path_) ? LibraryWriter::append(path_) : LibraryWriter::create(path_);
  for (const InSituState &state : states)
    if (taken.insert(name_of(state.recipe)).second)
      writer.add(name_of(state.recipe), described(state));
  writer.commit();
}
} // namespace isostat
