// SPDX-License-Identifier: BSD-3-Clause
// A representative volume element as bytes and back:
//
//     magic, version, checksum of the rest | law, density | ids, radii, inverse masses and inertias | grains, contacts,
//     cell | driver's numbers | cost
#include "dem/rve/rve.hpp"

#include "base/error.hpp"

#include <cstring>
#include <fmt/format.h>
#include <type_traits>

namespace isostat
{
namespace
{
constexpr std::uint64_t magic = 0x4556525453495349, version = 1;
constexpr std::size_t header_bytes = 3 * sizeof(std::uint64_t);

/// FNV-1a over eight bytes at a time.
std::uint64_t checksum(std::span<const std::byte> bytes)
{
  std::uint64_t hash = 14695981039346656037ull;
  for (std::size_t at = 0; at < bytes.size(); at += 8)
    {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data() + at, std::min<std::size_t>(8, bytes.size() - at));
      hash = (hash ^ word) * 1099511628211ull;
      hash ^= hash >> 29;
    }
  return hash;
}

class Writer
{
public:
  template <typename T>
  void operator()(const T &value)
  {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    const auto *from = reinterpret_cast<const std::byte *>(&value);
    bytes.insert(bytes.end(), from, from + sizeof(T));
  }
  void operator()(const Mat3 &m)
  {
    for (double x : m.reshaped())
      (*this)(x);
  }
  template <typename T, typename A>
  void operator()(const std::vector<T, A> &values)
  {
    (*this)(static_cast<std::uint64_t>(values.size()));
    const auto *from = reinterpret_cast<const std::byte *>(values.data());
    bytes.insert(bytes.end(), from, from + sizeof(T) * values.size());
  }
  std::vector<std::byte> bytes;
};

class Reader
{
public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <typename T>
  void operator()(T &value)
  {
    std::memcpy(static_cast<void *>(&value), take(sizeof(T)), sizeof(T));
  }
  void operator()(Mat3 &m)
  {
    for (double &x : m.reshaped())
      (*this)(x);
  }
  template <typename T, typename A>
  void operator()(std::vector<T, A> &values)
  {
    std::uint64_t n = 0;
    (*this)(n);
    if (n > bytes_.size() / sizeof(T))
      throw InputError("a packed element is damaged: it holds fewer numbers than it says. Pack it again.");
    values.resize(n);
    std::memcpy(static_cast<void *>(values.data()), take(sizeof(T) * n), sizeof(T) * n);
  }
  bool at_end() const { return bytes_.empty(); }

private:
  const std::byte *take(std::size_t n)
  {
    if (n > bytes_.size())
      throw InputError(
          fmt::format("a packed element is cut short: {} more bytes were expected. Pack it again.", n - bytes_.size()));
    const std::byte *from = bytes_.data();
    bytes_ = bytes_.subspan(n);
    return from;
  }
  std::span<const std::byte> bytes_;
};

/// Sizes, masses and law: what never changes.
template <typename Archive, typename Law, typename Grains>
void fixed_part(Archive &archive, Law &law, Grains &grains)
{
  archive(law.young), archive(law.stiffness_ratio), archive(law.friction), archive(law.rolling_stiffness);
  archive(law.rolling_limit), archive(law.twisting_stiffness);
  archive(law.features.friction), archive(law.features.rolling), archive(law.features.twisting);
  archive(grains.density), archive(grains.id);
  archive(grains.position), archive(grains.velocity), archive(grains.spin);
}

template <typename Archive, typename State>
void moving_part(Archive &archive, State &state)
{
  auto &g = state.grains;
  archive(g.grains), archive(g.pairs), archive(g.history), archive(g.virial);
  archive(g.cell.edges), archive(g.cell.deformation), archive(g.cell.rotation), archive(g.cell.strain_step);
  archive(g.cell.volume_strain), archive(g.cell.reference_volume), archive(g.cell.flips);
  archive(g.time), archive(g.time_step), archive(g.step);
}
} // namespace

std::vector<std::byte> Rve::pack() const
{
  Writer body;
  RveState state = save();
  fixed_part(body, assembly_.law(), assembly_.packing());
  moving_part(body, state);
  state.drive.for_each([&](const std::string &, double &value) { body(value); });
  body(cost_);
  Writer packed;
  packed(magic), packed(version), packed(checksum(body.bytes));
  packed.bytes.insert(packed.bytes.end(), body.bytes.begin(), body.bytes.end());
  return std::move(packed.bytes);
}

Rve Rve::unpack(std::span<const std::byte> bytes, const RveSettings &settings)
{
  Reader header(bytes);
  std::uint64_t found_magic = 0, found_version = 0, found_checksum = 0;
  header(found_magic), header(found_version), header(found_checksum);
  if (found_magic != magic)
    throw InputError("these bytes are no packed representative volume element");
  if (found_version != version)
    throw InputError(fmt::format("a packed element of version {}, this program reads {}. Pack it with this program.",
                                 found_version, version));
  if (checksum(bytes.subspan(header_bytes)) != found_checksum)
    throw InputError("a packed element is cut short or damaged: its checksum is wrong. Pack it again.");
  Reader body(bytes.subspan(header_bytes));
  Snapshot start;
  RveState state;
  RveCost cost;
  fixed_part(body, start.law, start.grains);
  moving_part(body, state);
  state.drive.for_each([&](const std::string &, double &value) { body(value); });
  body(cost);
  start.cell = state.grains.cell;
  Rve rve(start, settings);
  rve.restore(state);
  rve.cost_ = cost;
  return rve;
}
} // namespace isostat
