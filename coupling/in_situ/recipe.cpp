// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/in_situ/in_situ.hpp"

#include "base/files/hash.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr std::uint64_t recipe_version = 2;

std::uint64_t hash_of(const Snapshot &s)
{
  Hash hash;
  const auto add = [&](std::span<const double> numbers) { hash.words(numbers); };
  if (!is_default(s.law))
    for (const char *c = s.law->name(); *c; ++c)
      add(std::array{double(*c)});
  add(parameter_values(s.law));
  add(std::array{s.grains.density, s.time, double(s.step)});
  const std::size_t n = 4 * s.grains.n_grains();
  for (const auto *records : {&s.grains.position, &s.grains.velocity, &s.grains.spin})
    add(std::span(records->data(), n));
  if (s.cell)
    PeriodicCell::for_each(*s.cell, [&]<class T>(const char *, const T &field) {
      if constexpr (std::is_same_v<T, Mat3>)
        add({field.data(), 9});
      else
        add(std::array{static_cast<double>(field)});
    });
  for (const Contact &c : s.contacts)
    {
      add(std::array{double(c.first), double(c.second), c.overlap});
      for (const HistoryVector &v : history_vectors)
        add({(c.history.*v.place).data(), 3});
      add(c.history.own);
    }
  return hash.value();
}
} // namespace

std::string in_situ_recipe(const Snapshot &specimen, const Mat3 &target, const MotionSpec &motion,
                           const InSituSettings &s)
{
  return fmt::format("in situ {}; specimen {:016x}; stress {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}; path {}; "
                     "tolerance {:.17g}; steps {}; motion {}",
                     recipe_version, hash_of(specimen), target(0, 0), target(1, 1), target(2, 2), target(1, 2),
                     target(0, 2), target(0, 1), static_cast<int>(s.path), s.tolerance, s.max_steps,
                     recipe_text(motion));
}
} // namespace isostat
