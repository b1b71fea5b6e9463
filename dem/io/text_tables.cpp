// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/text_tables.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <unordered_map>
#include <utility>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;

fs::path find_table(const fs::path &folder, const std::string &what)
{
  const std::string name = fmt::format("comp_{}_step0.csv", what);
  for (const char *ending : {"", ".gz"})
    if (std::error_code ignored; fs::exists(folder / (name + ending), ignored))
      return folder / (name + ending);
  throw InputError(fmt::format("{}: neither {} nor {}.gz exists; check the folder", folder.string(), name, name));
}

RigidBox read_box(const fs::path &path)
{
  const CsvTable table(path, {"wall", "pos"});
  RigidBox box;
  std::array<bool, 6> seen{};
  for (std::size_t i = 0; i < table.n_rows(); ++i)
    {
      const std::int64_t wall = table.integer(i, 0, "wall");
      if (wall < 0 || wall > 5 || std::exchange(seen[wall], true))
        reject(path, table.line(i), fmt::format("wall = {}; expected 0..5 (x-,x+,y-,y+,z-,z+), each once", wall));
      (wall % 2 == 0 ? box.lower : box.upper)[wall / 2] = table(i, 1);
    }
  if (!std::all_of(seen.begin(), seen.end(), [](bool s) { return s; }))
    throw InputError(fmt::format("{}: {} walls; expected six", path.string(), table.n_rows()));
  if (!(box.edges().array() > 0).all())
    throw InputError(fmt::format("{}: edges {} x {} x {} m; expected pos of the + walls above that of the - walls",
                                 path.string(), box.edges().x(), box.edges().y(), box.edges().z()));
  return box;
}

/// What is wrong with a sphere, as text; empty if nothing.
std::string sphere_fault(const Vec3 &centre, double radius)
{
  constexpr double smallest = 1e-9, largest = 1e6, farthest = 1e9; // m
  if (!(radius >= smallest && radius <= largest))
    return fmt::format("radius r = {} m; expected {} to {} (m)", radius, smallest, largest);
  for (int k = 0; k < 3; ++k)
    if (!(std::abs(centre[k]) <= farthest && centre[k] - radius < centre[k] && centre[k] < centre[k] + radius))
      return fmt::format("centre {} = {} m; expected a number within {} (m), near enough to 0 that the radius is not "
                         "lost in its rounding",
                         "xyz"[k], centre[k], farthest);
  return "";
}

void check_inside(const fs::path &path, std::size_t line, const Vec3 &centre, const RigidBox &box)
{
  for (int k = 0; k < 3; ++k)
    if (!(centre[k] >= box.lower[k] && centre[k] <= box.upper[k]))
      reject(path, line,
             fmt::format("centre {} = {} m lies outside the box, [{}, {}] m; are the units m, and is it the box "
                         "of this packing?",
                         "xyz"[k], centre[k], box.lower[k], box.upper[k]));
}

using IndexOfId = std::unordered_map<std::int64_t, std::uint32_t>;

Packing read_particles(const fs::path &path, const RigidBox &box, double density, IndexOfId &index_of_id)
{
  const CsvTable table(path, {"id", "x", "y", "z", "r", "vx", "vy", "vz", "wx", "wy", "wz"});
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (std::size_t i = 0; i < table.n_rows(); ++i)
    {
      const std::int64_t id = table.integer(i, 0, "id");
      if (id < 0 || !index_of_id.emplace(id, static_cast<std::uint32_t>(i)).second)
        reject(path, table.line(i), fmt::format("id = {}; expected a number >= 0 that no other grain has", id));
      if (const std::string fault = sphere_fault(table.vector(i, 1), table(i, 4)); !fault.empty())
        reject(path, table.line(i), fault);
      check_inside(path, table.line(i), table.vector(i, 1), box);
      centres.push_back(table.vector(i, 1));
      radii.push_back(table(i, 4));
    }
  if (centres.empty())
    throw InputError(fmt::format("{}: no grains; expected one line each below the header", path.string()));
  Packing grains = make_packing(centres, radii, density);
  for (const auto &[id, i] : index_of_id)
    grains.id[i] = static_cast<std::uint32_t>(id);
  for (std::size_t i = 0; i < table.n_rows(); ++i)
    {
      grains.set_linear_velocity(i, table.vector(i, 5));
      grains.set_angular_velocity(i, table.vector(i, 8));
    }
  return grains;
}

enum ContactColumn
{
  id1,
  id2,
  un,
  nx,
  kn = nx + 3,
  fn,
  fsx,
  mbx = fsx + 3,
  mtx = mbx + 3
};

/// u, or fn/kn where the table has none (tables written before the first force evaluation).
double overlap_of(const CsvTable &table, std::size_t row)
{
  if (!std::isnan(table(row, un)))
    return table(row, un);
  if (!(table(row, kn) > 0))
    reject(table.path(), table.line(row), fmt::format("kn = {}; expected > 0 where un is nan", table(row, kn)));
  return table(row, fn) / table(row, kn);
}

WallContact wall_row(const CsvTable &table, std::size_t row, std::uint32_t grain, std::int64_t wall_id)
{
  return {grain, static_cast<std::uint8_t>(-wall_id - 1), overlap_of(table, row), table(row, fn)};
}

Contact grain_row(const CsvTable &table, std::size_t row, std::uint32_t first, std::uint32_t second)
{
  if (std::abs(table.vector(row, nx).squaredNorm() - 1) > 1e-6)
    reject(table.path(), table.line(row), "(nx, ny, nz) is not a unit vector; expected length 1 within 1e-6");
  ContactHistory h{table.vector(row, nx), table.vector(row, fsx), table.vector(row, mbx), table.vector(row, mtx)};
  if (first > second) // seen from the other grain everything is opposite
    h = h.from_the_other_side();
  return {std::min(first, second), std::max(first, second), overlap_of(table, row), table(row, fn), h};
}

void read_contacts(const fs::path &path, const IndexOfId &index_of_id, Snapshot &snapshot)
{
  const CsvTable table(
      path,
      {"id1", "id2", "un", "nx", "ny", "nz", "kn", "fn", "fsx", "fsy", "fsz", "mbx", "mby", "mbz", "mtx", "mty", "mtz"},
      "un");
  for (std::size_t row = 0; row < table.n_rows(); ++row)
    {
      const std::int64_t a = table.integer(row, id1, "id1"), b = table.integer(row, id2, "id2");
      const auto is_wall = [](std::int64_t id) { return id < 0 && id >= -6; };
      const auto is_grain = [&](std::int64_t id) { return index_of_id.contains(id); };
      if (a == b || !((is_grain(a) && is_grain(b)) || (is_wall(a) && is_grain(b)) || (is_grain(a) && is_wall(b))))
        reject(path, table.line(row),
               fmt::format("contact of {} and {}; expected two different ids of the grain table, or one "
                           "of the walls -1..-6 and a grain",
                           a, b));
      if (table(row, fn) < 0)
        reject(path, table.line(row), fmt::format("fn = {}; expected >= 0 (N, repulsion)", table(row, fn)));
      if (table(row, fn) == 0)
        continue;
      if (is_wall(a) || is_wall(b))
        snapshot.wall_contacts.push_back(wall_row(table, row, index_of_id.at(std::max(a, b)), std::min(a, b)));
      else
        snapshot.contacts.push_back(grain_row(table, row, index_of_id.at(a), index_of_id.at(b)));
    }
  const auto by_pair = [](const Contact &c) { return std::pair(c.first, c.second); };
  const auto by_wall = [](const WallContact &c) { return std::pair(std::uint32_t{c.wall}, c.grain); };
  std::ranges::sort(snapshot.contacts, {}, by_pair);
  std::ranges::sort(snapshot.wall_contacts, {}, by_wall);
  if (std::ranges::adjacent_find(snapshot.contacts, {}, by_pair) != snapshot.contacts.end() ||
      std::ranges::adjacent_find(snapshot.wall_contacts, {}, by_wall) != snapshot.wall_contacts.end())
    throw InputError(fmt::format("{}: a contact is listed twice; expected each once", path.string()));
}

} // namespace

Snapshot import_tables(const fs::path &folder, const Law &law, double density)
{
  if (!(density > 0 && std::isfinite(density)))
    throw InputError(fmt::format("grain density = {} kg/m3; expected > 0, such as 2650 for quartz", density));
  Snapshot snapshot;
  snapshot.law = law;
  snapshot.box = read_box(find_table(folder, "walls"));
  IndexOfId index_of_id;
  snapshot.grains = read_particles(find_table(folder, "particles"), snapshot.box, density, index_of_id);
  read_contacts(find_table(folder, "contacts"), index_of_id, snapshot);
  return snapshot;
}
} // namespace isostat
