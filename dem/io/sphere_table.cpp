// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/sphere_table.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <unordered_set>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path &path, std::size_t line, std::size_t sphere, const std::string &what)
{
  if (line > 0)
    reject(path, line, what);
  throw InputError(fmt::format("{}: sphere {}: {}", path.string(), sphere, what));
}
} // namespace

std::string sphere_fault(const Vec3 &centre, double radius)
{
  constexpr double smallest = 1e-9, largest = 1e6, farthest = 1e9; // m
  if (!(radius >= smallest && radius <= largest))
    return fmt::format("radius r = {} m; expected {} to {} (m)", radius, smallest, largest);
  for (int k = 0; k < 3; ++k)
    if (!(std::abs(centre[k]) <= farthest))
      return fmt::format("centre {} = {} m; expected a number within {} (m)", "xyz"[k], centre[k], farthest);
    else if (!(centre[k] - radius < centre[k] && centre[k] < centre[k] + radius))
      return fmt::format("radius r = {} m is less than what a number as large as its centre {} = {} m can tell apart; "
                         "expected coordinates from an origin near the grains",
                         radius, "xyz"[k], centre[k]);
  return "";
}

void SphereTable::check(const fs::path &path) const
{
  if (centres.empty())
    throw InputError(fmt::format("{}: no spheres; expected lines x y z r (m)", path.string()));
  for (std::size_t i = 0; i < centres.size(); ++i)
    {
      if (const std::string fault = sphere_fault(centres[i], radii[i]); !fault.empty())
        refuse(path, line(i), i, fault);
      if ((!velocities.empty() && !velocities[i].allFinite()) || (!spins.empty() && !spins[i].allFinite()))
        refuse(path, line(i), i, "velocity or spin is not finite; expected numbers (m/s, rad/s)");
    }
  std::unordered_set<std::uint32_t> seen;
  for (std::size_t i = 0; i < ids.size(); ++i)
    if (!seen.insert(ids[i]).second)
      refuse(path, line(i), i, "its id is that of another sphere; expected each once");
}

void SphereTable::check_inside(const fs::path &path, const RigidBox &box) const
{
  for (std::size_t i = 0; i < centres.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (!(centres[i][k] >= box.lower[k] && centres[i][k] <= box.upper[k]))
        refuse(path, line(i), i,
               fmt::format("centre {} = {} m lies outside the box, [{}, {}] m; are the units m, and is it the box "
                           "of this packing?",
                           "xyz"[k], centres[i][k], box.lower[k], box.upper[k]));
}

RigidBox SphereTable::bounding_box() const
{
  RigidBox box{centres[0], centres[0]};
  for (std::size_t i = 0; i < centres.size(); ++i)
    {
      box.lower = box.lower.cwiseMin(centres[i] - Vec3::Constant(radii[i]));
      box.upper = box.upper.cwiseMax(centres[i] + Vec3::Constant(radii[i]));
    }
  return box;
}

Packing SphereTable::packing(double density) const
{
  Packing grains = make_packing(centres, radii, density);
  if (!ids.empty())
    grains.id = ids;
  for (std::size_t i = 0; i < velocities.size(); ++i)
    grains.set_linear_velocity(i, velocities[i]);
  for (std::size_t i = 0; i < spins.size(); ++i)
    grains.set_angular_velocity(i, spins[i]);
  return grains;
}

SphereColumns::SphereColumns(const std::vector<std::string_view> &names, std::uint32_t first_id)
    : first_id_(first_id), n_columns_(names.size())
{
  const auto find = [&](std::initializer_list<std::string_view> any) {
    const auto it = std::ranges::find_first_of(names, any);
    return it == names.end() ? -1 : static_cast<int>(it - names.begin());
  };
  id_ = find({"id"});
  radius_ = find({"r", "radius"});
  if (radius_ < 0 && (radius_ = find({"diameter"})) >= 0)
    radius_factor_ = 0.5;
  for (int k = 0; k < 3; ++k)
    {
      const std::string axis(1, "xyz"[k]);
      centre_[k] = find({axis, axis + "u"});
      velocity_[k] = find({"v" + axis});
      spin_[k] = find({"w" + axis, "omega" + axis});
    }
}

std::string SphereColumns::missing() const
{
  for (int k = 0; k < 3; ++k)
    if (centre_[k] < 0)
      return std::string("a column ") + "xyz"[k];
  return radius_ < 0 ? "a column radius, r or diameter" : "";
}

void SphereColumns::read(const fs::path &path, std::size_t line, std::string_view text, SphereTable &table) const
{
  std::vector<std::string_view> words = split_words(text);
  if (words.size() == n_columns_ + 1 && text.starts_with('"')) // the name of the row, as R writes it
    words.erase(words.begin());
  if (words.size() != n_columns_)
    reject(path, line, fmt::format("\"{}\"; expected {} columns, as many as have a name", text, n_columns_));
  const auto number = [&](int column) {
    double value = 0;
    if (!parse(words[column], value))
      reject(path, line, fmt::format("\"{}\" is no number; expected one in column {}", words[column], column + 1));
    return value;
  };
  const auto add = [&](const int(&columns)[3], std::vector<Vec3> &vectors) {
    if (columns[0] >= 0 && columns[1] >= 0 && columns[2] >= 0)
      vectors.emplace_back(number(columns[0]), number(columns[1]), number(columns[2]));
  };
  add(centre_, table.centres);
  table.radii.push_back(number(radius_) * radius_factor_);
  table.line_of.push_back(line);
  if (id_ >= 0)
    table.ids.push_back(grain_id(path, line, number(id_), first_id_));
  add(velocity_, table.velocities);
  add(spin_, table.spins);
}

std::uint32_t grain_id(const fs::path &path, std::size_t line, double value, std::uint32_t first_id)
{
  const double id = value - first_id;
  if (!is_count(id))
    reject(path, line, fmt::format("id = {}; expected a whole number from {}, below 2^32", value, first_id));
  return static_cast<std::uint32_t>(id);
}
} // namespace isostat
