// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/sphere_table.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/units.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
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

constexpr double same_density = 0.01; // of itself: masses and radii are often written with three digits

/// A name of a column in small letters without its unit, quotes, blanks, dots and colons; and the unit in its brackets.
std::pair<std::string, std::string> name_and_unit(std::string_view text)
{
  std::pair<std::string, std::string> found;
  const std::size_t bracket = text.find_first_of("([");
  if (bracket != std::string_view::npos)
    {
      const std::size_t end = text.find_first_of(")]", bracket);
      found.second = text.substr(bracket + 1, end == std::string_view::npos ? end : end - bracket - 1);
    }
  for (const char c : text.substr(0, bracket))
    if (const auto letter = static_cast<unsigned char>(c); std::isalnum(letter) || c == '_')
      found.first += static_cast<char>(std::tolower(letter));
  return found;
}

/// Metres in a unit of length; 0 for what is none.
double metres_in(const std::string &unit)
{
  try
    {
      return parse_quantity("1 " + unit, Dimension::length).value;
    }
  catch (const InputError &)
    {
      return 0;
    }
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

double SphereTable::density(const fs::path &path, double assumed, double scale) const
{
  for (std::size_t i = 0; i < densities.size(); ++i)
    if (densities[i] != densities[0])
      refuse(path, line(i), i,
             fmt::format("density {} kg/m3, above it is {}; expected one density: Isostat has no packings of several",
                         densities[i], densities[0]));
  const auto volume = [&](double radius) { return 4.0 / 3 * std::numbers::pi * std::pow(scale * radius, 3); };
  double mass = 0, solid = 0;
  for (std::size_t i = 0; i < masses.size(); ++i)
    {
      if (!(masses[i] > 0 && std::isfinite(masses[i])))
        refuse(path, line(i), i, fmt::format("mass = {} kg; expected > 0", masses[i]));
      mass += masses[i];
      solid += volume(radii[i]);
    }
  if (masses.empty())
    return densities.empty() ? assumed : densities[0];
  const double one = densities.empty() ? mass / solid : densities[0];
  for (std::size_t i = 0; i < masses.size(); ++i)
    if (const double own = masses[i] / volume(radii[i]); !(std::abs(own / one - 1) <= same_density))
      refuse(path, line(i), i,
             fmt::format("mass = {:g} kg of a sphere of r = {:g} m is a density of {:g} kg/m3, that of the packing is "
                         "{:g}; expected one density within {:g} %: Isostat has no packings of several",
                         masses[i], scale * radii[i], own, one, 100 * same_density));
  return one;
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

SphereColumns::SphereColumns(const std::vector<std::string_view> &names, std::uint32_t first_id, bool open_ended)
    : first_id_(first_id), n_columns_(names.size()), open_ended_(open_ended)
{
  std::vector<std::pair<std::string, std::string>> known(names.size());
  std::ranges::transform(names, known.begin(), name_and_unit);
  const auto find = [&](const std::vector<std::string> &any, const char *unit) {
    const auto it = std::ranges::find_if(known, [&](const auto &name) { return std::ranges::count(any, name.first); });
    if (it == known.end())
      return -1;
    if (!it->second.empty())
      units_.push_back({it->first, it->second, unit});
    return static_cast<int>(it - known.begin());
  };
  id_ = find({"id", "ballid", "ball_id", "particleid", "particle_id"}, "");
  radius_ = find({"r", "radius", "rad", "radii", "ballradius", "ball_radius"}, "m");
  if (radius_ < 0 && (radius_ = find({"diameter", "diam", "dia", "d"}, "m")) >= 0)
    radius_factor_ = 0.5;
  density_ = find({"density", "rho"}, "kg/m3");
  mass_ = find({"mass"}, "kg");
  clump_ = find({"clumpid", "clump_id", "clump"}, "");
  for (int k = 0; k < 3; ++k)
    {
      const std::string a(1, "xyz"[k]), number = std::to_string(k);
      centre_[k] = find({a, a + "u", "pos" + a, "pos_" + a, a + "pos", a + "_pos", "position" + a, "position_" + a,
                         "ballpos" + a, "ball_pos_" + a, "points" + number, "points_" + number},
                        "m");
      velocity_[k] =
          find({"v" + a, "vel" + a, "vel_" + a, "velocity" + a, "velocity_" + a, "velocity" + number}, "m/s");
      spin_[k] = find({"w" + a, "omega" + a, "omega_" + a, "spin" + a, "spin_" + a, "spin" + number}, "rad/s");
    }
}

std::string SphereColumns::missing() const
{
  for (int k = 0; k < 3; ++k)
    if (centre_[k] < 0)
      return std::string("a column ") + "xyz"[k];
  return radius_ < 0 ? "a column radius, r or diameter" : "";
}

std::string SphereColumns::wrong_unit(double scale) const
{
  for (const Unit &u : units_)
    {
      const bool speed = u.expected == "m/s", length = u.expected == "m" || speed;
      const std::string unit = speed && u.unit.ends_with("/s") ? u.unit.substr(0, u.unit.size() - 2) : u.unit;
      if (length && !(std::abs(metres_in(unit) / scale - 1) < 1e-9))
        return fmt::format("the column {} is in {}, and is read in units of {:g} m; expected the same. Give isostat "
                           "convert --length-unit {}",
                           u.column, u.unit, scale, unit);
      if (!length && !u.expected.empty() && u.unit != u.expected)
        return fmt::format("the column {} is in {}; expected {}", u.column, u.unit, u.expected);
    }
  return "";
}

void SphereColumns::read(const fs::path &path, std::size_t line, std::string_view text, SphereTable &table) const
{
  std::vector<std::string_view> words = split_words(text);
  if (words.size() == n_columns_ + 1 && text.starts_with('"')) // the name of the row, as R writes it
    words.erase(words.begin());
  if (open_ended_ ? words.size() < n_columns_ : words.size() != n_columns_)
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
  const auto add_one = [&](int column, std::vector<double> &values) {
    if (column >= 0)
      values.push_back(number(column));
  };
  if (clump_ >= 0 && number(clump_) != -1)
    reject(path, line,
           fmt::format("clump id {}; expected -1, no clump: Isostat has spheres only. If column {} is something else, "
                       "name the columns in a first line, such as x y z r type",
                       words[clump_], clump_ + 1));
  add(centre_, table.centres);
  table.radii.push_back(number(radius_) * radius_factor_);
  table.line_of.push_back(line);
  if (id_ >= 0)
    table.ids.push_back(grain_id(path, line, number(id_), first_id_));
  add(velocity_, table.velocities);
  add(spin_, table.spins);
  add_one(density_, table.densities);
  add_one(mass_, table.masses);
}

std::uint32_t grain_id(const fs::path &path, std::size_t line, double value, std::uint32_t first_id)
{
  const double id = value - first_id;
  if (!is_count(id))
    reject(path, line, fmt::format("id = {}; expected a whole number from {}, below 2^32", value, first_id));
  return static_cast<std::uint32_t>(id);
}
} // namespace isostat
