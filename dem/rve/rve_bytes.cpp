// SPDX-License-Identifier: BSD-3-Clause
// A representative volume element as bytes and back:
//
//     magic, version, checksum of the rest | [name of the law], its parameters, density | ids, radii, inverse masses
//     and inertias | grains, contacts, cell | driver's numbers | cost
#include "dem/rve/rve.hpp"

#include "base/fields.hpp"
#include "base/files/bytes.hpp"
#include "base/files/hash.hpp"
#include "dem/domain/lattice.hpp"
#include "dem/drive/rate_control.hpp"
#include "dem/law/parameters.hpp"
#include "dem/state/state_fault.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <type_traits>

namespace isostat
{
namespace
{
constexpr std::uint64_t magic = 0x4556525453495349;
constexpr std::uint64_t default_law = 5, named_law = 6; ///< version: does the law need its name?

std::uint64_t checksum(std::span<const std::byte> bytes) { return Hash().words(bytes).value(); }

/// Visits a field of a state: writes it, or reads it back.
template <typename Bytes>
struct Archive
{
  Bytes &bytes;

  template <typename T>
  void operator()(T &value)
  {
    bytes.value(value);
  }
  template <typename M>
  requires(std::is_same_v<std::remove_const_t<M>, Mat3> || std::is_same_v<std::remove_const_t<M>, Vec3>) void
  operator()(M &m)
  {
    for (auto &x : m.reshaped())
      bytes.value(x);
  }
  template <typename T, typename A>
  void operator()(std::vector<T, A> &values)
  {
    bytes.row(values);
  }
  template <typename T, typename A>
  void operator()(const std::vector<T, A> &values)
  {
    bytes.row(values);
  }
};

/// Sizes, masses and law: what never changes.
template <typename Visitor, typename Grains>
void fixed_part(Visitor &archive, Law &law, Grains &grains)
{
  for_each_parameter(*law.operator->(), [&](const std::string &, auto &value) { archive(value); });
  archive(grains.density), archive(grains.id);
  archive(grains.position), archive(grains.velocity), archive(grains.spin);
}

bool all_finite(std::span<const double> numbers)
{
  return std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); });
}

/// What makes this no state of an element that could have been packed; empty if nothing does.
std::string fault_of(const Snapshot &start, const RveState &whole)
{
  const AssemblyState &state = whole.grains;
  const std::size_t n = start.grains.n_grains(), numbers = 4 * (n + Packing::n_padding);
  for (const AlignedVector<double> *records : {&start.grains.position, &start.grains.velocity, &start.grains.spin})
    if (records->size() != numbers)
      return fmt::format("they have {} numbers where {} grains have {}", records->size(), n, numbers);
  for (std::size_t i = n; i < n + Packing::n_padding; ++i)
    if (start.grains.position[4 * i + 3] != 0)
      return "the padding behind their grains has a radius";
  if (std::string found = state_fault(start); !found.empty())
    return found;
  const auto joins = [&](const ContactList::Pair &pair) { return pair.first < pair.second && pair.second < n; };
  if (!std::ranges::all_of(state.pairs, joins) ||
      std::ranges::adjacent_find(state.pairs, std::greater_equal()) != state.pairs.end())
    return "their contacts join grains that there are not, or are in no order";
  if (state.grains.size() != 15 * n || state.history.size() != state.pairs.size() * start.law->history().n_components())
    return "their rows are not as long as grains and contacts are many";
  if (!all_finite(state.grains) || !all_finite(state.history) || !state.virial.allFinite())
    return "they hold a number that is not finite";
  for (std::size_t i = 0; i < n; ++i)
    if (!(edges_away(state.cell.edges, Vec3(&state.grains[15 * i])) <= max_edges_away))
      return fmt::format("grain {} is too far away from their periodic cell", i);
  if (!(state.time_step > 0 && std::isfinite(state.time_step) && std::isfinite(state.time)))
    return fmt::format("they have a time step of {} s", state.time_step);
  bool numbers_are = true;
  for_each_leaf(whole.drive, [&]<class T>(const T &value) {
    if constexpr (std::is_same_v<T, double>)
      numbers_are &= !std::isnan(value);
    else if constexpr (std::is_same_v<T, Vec3> || std::is_same_v<T, Mat3>)
      numbers_are &= !value.hasNaN();
  });
  return numbers_are ? "" : "what its driver keeps is not a number";
}
} // namespace

std::vector<std::byte> Rve::pack() const
{
  ByteWriter bytes;
  Archive<ByteWriter> body{bytes};
  RveState state = save();
  Law law = assembly_.law();
  const std::string_view name = law->name();
  const std::uint64_t version = is_default(law) ? default_law : named_law;
  if (version == named_law)
    body(std::vector<char>(name.begin(), name.end()));
  fixed_part(body, law, assembly_.packing());
  for_each_leaf(state.grains, body), for_each_leaf(state.drive, body);
  body(cost_);
  const std::vector<std::byte> content = bytes.take();
  ByteWriter packed;
  packed.value(magic), packed.value(version), packed.value(checksum(content));
  packed.append(content);
  return packed.take();
}

Rve Rve::unpack(std::span<const std::byte> packed, const RveSettings &settings)
{
  ByteReader bytes(packed, "a packed element", "pack it again");
  if (bytes.count() != magic)
    bytes.fail("these bytes are no representative volume element");
  const std::uint64_t version = bytes.count();
  if (version != default_law && version != named_law)
    bytes.fail(fmt::format("they are of version {}, this program reads {} and {}", version, default_law, named_law));
  const std::uint64_t stored_checksum = bytes.count();
  if (checksum(bytes.rest()) != stored_checksum)
    bytes.fail("they are cut short or damaged: the checksum is wrong");
  Archive<ByteReader> body{bytes};
  Snapshot start;
  RveState state;
  RveCost cost;
  if (std::vector<char> name; version == named_law)
    {
      body(name);
      start.law = law_named({name.data(), name.size()});
    }
  fixed_part(body, start.law, start.grains);
  for_each_leaf(state.grains, body), for_each_leaf(state.drive, body);
  body(cost);
  start.cell = state.grains.cell;
  if (const std::string found = fault_of(start, state); !found.empty())
    bytes.fail(found);
  Rve rve(start, settings);
  state.drive.pace.rate = strain_rate(settings.motion, rve.assembly_, state.drive.p0);
  state.specimen = rve.specimen_;
  rve.restore(state);
  rve.cost_ = cost;
  return rve;
}
} // namespace isostat
