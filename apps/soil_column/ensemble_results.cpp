// SPDX-License-Identifier: BSD-3-Clause
// From the files of a member to what its ensemble compares.
#include "apps/soil_column/ensemble_results.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/hdf5.hpp"
#include "base/files/json.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double gravity = 9.80665;

/// A table with a head of `name (unit)`, column by column; what is no number is nan.
class Table
{
public:
  explicit Table(const fs::path &path) : path_(path)
  {
    const std::string text = read_text(path);
    const std::vector<std::string_view> lines = split_lines(text);
    for (const std::string_view cell : split_commas(lines.empty() ? std::string_view() : lines[0]))
      names_.emplace_back(cell.substr(0, cell.find(" (")));
    columns_.resize(names_.size());
    for (std::size_t k = 1; k < lines.size(); ++k)
      {
        const auto cells = split_commas(lines[k]);
        if (cells.size() != names_.size())
          reject(path, k + 1, fmt::format("{} fields, the head has {}", cells.size(), names_.size()));
        for (std::size_t c = 0; c < cells.size(); ++c)
          if (double &x = columns_[c].emplace_back(); !parse(cells[c], x))
            x = none;
      }
  }

  bool has(const std::string &name) const { return std::ranges::find(names_, name) != names_.end(); }
  const std::vector<double> &operator[](const std::string &name) const
  {
    const auto found = std::ranges::find(names_, name);
    if (found == names_.end())
      reject(path_, 1, fmt::format("has no column `{}`", name));
    return columns_[static_cast<std::size_t>(found - names_.begin())];
  }

private:
  fs::path path_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> columns_;
};

/// Straight between rows, at 0, interval, 2 interval ... up to the last of them before `end`.
std::vector<double> resampled(const std::vector<double> &t, const std::vector<double> &x, const std::vector<double> &at)
{
  std::vector<double> values;
  for (const double time : at)
    {
      const auto after = std::ranges::upper_bound(t, time);
      const auto k = static_cast<std::size_t>(
          std::clamp<std::ptrdiff_t>(after - t.begin(), 1, static_cast<std::ptrdiff_t>(t.size()) - 1));
      const double part = std::clamp((time - t[k - 1]) / (t[k] - t[k - 1]), 0.0, 1.0);
      values.push_back(x[k - 1] + part * (x[k] - x[k - 1]));
    }
  return values;
}

std::vector<char> horizontal_axes(const ColumnScene &scene)
{
  std::vector<char> axes;
  for (const ColumnMotion &motion : scene.motions)
    if (motion.axis != Axis::z)
      axes.push_back(motion.axis == Axis::x ? 'x' : 'y');
  std::ranges::sort(axes);
  return axes;
}

/// I_A = pi / (2 g) times the integral of the squared acceleration, of both axes together, m/s.
double arias_intensity(const Table &history, const std::vector<char> &axes)
{
  const std::vector<double> &t = history["time"];
  double sum = 0;
  for (const char axis : axes)
    {
      const std::vector<double> &a = history[fmt::format("surface_a{}", axis)];
      for (std::size_t k = 1; k < t.size(); ++k)
        sum += 0.5 * (t[k] - t[k - 1]) * (a[k] * a[k] + a[k - 1] * a[k - 1]);
    }
  return std::numbers::pi / (2 * gravity) * sum;
}

/// Smallest and last I_R of each packing (of the first, where a point has several).
Curves grain_curves(const fs::path &path)
{
  const Table table(path);
  Curves all{{"depth", "m", {}}, {{"min_I_R", "-", {}}, {"final_I_R", "-", {}}}};
  for (std::size_t k = 0; table.has(fmt::format("p{}_depth", k)); ++k)
    {
      const std::vector<double> &depth = table[fmt::format("p{}_depth", k)], &index = table[fmt::format("p{}_IR", k)];
      if (depth.empty())
        break;
      double least = none;
      for (const double x : index)
        least = std::isnan(x) ? least : std::fmin(least, x);
      all.over.values.push_back(depth.front());
      all.curves[0].values.push_back(least);
      all.curves[1].values.push_back(index.back());
    }
  return all;
}

double mean(const std::vector<double> &x) { return Statistics(x).mean; }

/// What the profiles tell: largest strain, r_u and acceleration of each depth.
void read_profiles(const fs::path &path, MemberResults &member)
{
  const hdf5::File file = hdf5::File::open(path);
  const hdf5::Group root = file.root();
  const auto values = [&](const char *name) { return root.read<double>(name); };
  member.curves["points"] = {{"depth", "m", values("depth")},
                             {{"max_ru", "-", values("peak_ru")}, {"max_gamma", "-", values("peak_gamma")}}};
  member.curves["nodes"] = {{"depth", "m", values("node_depth")},
                            {{"max_acceleration", "m/s2", values("peak_acceleration")}}};
}

/// S_a of the surface, of two axes the larger.
std::vector<double> larger_spectrum(const Table &spectra, const std::vector<char> &axes)
{
  std::vector<double> larger(spectra["period"].size(), 0);
  for (const char axis : axes)
    for (std::size_t k = 0; k < larger.size(); ++k)
      larger[k] = std::max(larger[k], spectra[fmt::format("surface_{}", axis)][k]);
  return larger;
}

void read_motion(const fs::path &folder, const ColumnScene &scene, MemberResults &member)
{
  const std::vector<char> axes = horizontal_axes(scene);
  const Table history(folder / "history.csv");
  member.numbers.push_back({"arias_intensity", "m/s", {arias_intensity(history, axes)}});
  if (!axes.empty())
    {
      const Table spectra(folder / "spectra.csv");
      const std::vector<double> &period = spectra["period"], larger = larger_spectrum(spectra, axes);
      member.curves["spectra"] = {{"period", "s", period}, {{"surface_Sa", "m/s2", larger}}};
      for (const double at : {0.1, 0.3, 1.0})
        member.numbers.push_back(
            {fmt::format("surface_Sa_{:g}s", at), "m/s2", {resampled(period, larger, {at}).front()}});
    }
  Curves &rows = member.curves["history"] = {{"time", "s", {}}, {}};
  const double interval = scene.output.history_interval;
  for (std::size_t k = 0; static_cast<double>(k) * interval <= scene.analysis.duration * (1 + 1e-12); ++k)
    rows.over.values.push_back(static_cast<double>(k) * interval);
  const auto add = [&](const std::string &name, const char *unit) {
    rows.curves.push_back({name, unit, resampled(history["time"], history[name], rows.over.values)});
  };
  for (const char axis : axes)
    add(fmt::format("surface_a{}", axis), "m/s2");
  add("settlement", "m"), add("max_ru", "-");
  if (scene.slope.tangent > 0 || scene.mesh.sides == Sides::walls)
    add("surface_ux", "m");
  if (scene.water.drainage != Drainage::dry)
    for (std::size_t k = 0; k < scene.output.depths.size(); ++k)
      add(fmt::format("d{}_ru", k), "-");
}

/// How the surface of a box has moved.
void add_surface_motion(const Json &summary, MemberResults &member)
{
  const auto found = summary.find("surface_motion");
  if (found == summary.end())
    return;
  for (const char *key : {"along_x", "largest", "settlement", "heave"})
    member.numbers.push_back({fmt::format("surface_{}", key), "m", {found->at(key).get<double>()}});
}
} // namespace

double liquefied_thickness(std::span<const double> depths, std::span<const double> max_ru, double height)
{
  double sum = 0;
  for (std::size_t k = 0; k < depths.size(); ++k)
    if (max_ru[k] > liquefied_ru)
      {
        const double top = k > 0 ? 0.5 * (depths[k - 1] + depths[k]) : 0;
        const double bottom = k + 1 < depths.size() ? 0.5 * (depths[k] + depths[k + 1]) : height;
        sum += bottom - top;
      }
  return sum;
}

MemberResults read_member(const EnsembleMember &of, const fs::path &folder)
{
  const ColumnScene &scene = of.scene;
  MemberResults member{of.name, of.record, of.packings, {}, {}, {}, {}};
  const Json summary = read_json(folder / "summary.json");
  if (const auto seeds = summary.find("seeds"); seeds != summary.end())
    member.seeds = seeds->get<std::vector<std::vector<std::size_t>>>();
  for (std::vector<std::size_t> &of_point : member.seeds)
    std::ranges::sort(of_point);
  const auto number = [&](const char *key, const char *unit) {
    const Json &value = summary.at(key);
    member.numbers.push_back({key, unit, {value.is_number() ? value.get<double>() : none}});
  };
  number("peak_surface", "m/s2"), number("peak_surface_below", "m/s2"), number("amplification", "-");
  read_motion(folder, scene, member);
  read_profiles(folder / "profiles.h5", member);
  number("peak_gamma", "-");
  if (scene.water.drainage != Drainage::dry)
    {
      number("max_ru", "-");
      const Curves &points = member.curves.at("points");
      member.numbers.push_back({"liquefied_thickness",
                                "m",
                                {liquefied_thickness(points.over.values, points.curves[0].values, scene.height())}});
    }
  number("settlement", "m");
  if (scene.slope.tangent > 0)
    number("downslope", "m");
  add_surface_motion(summary, member);
  if (const fs::path grains = folder / "grain_profiles/history.csv"; fs::exists(grains))
    {
      const Curves &curves = member.curves["grains"] = grain_curves(grains);
      number("min_redundancy", "-");
      member.numbers.push_back({"final_redundancy", "-", {mean(curves.curves[1].values)}});
    }
  return member;
}

void find_same_packings(std::vector<MemberResults> &members)
{
  std::map<std::pair<std::string, std::vector<std::vector<std::size_t>>>, std::string> first;
  for (MemberResults &member : members)
    if (!member.seeds.empty())
      if (const auto [found, is_new] = first.try_emplace({member.record, member.seeds}, member.name); !is_new)
        member.same_as = found->second;
}
} // namespace isostat
