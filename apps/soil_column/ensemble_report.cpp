// SPDX-License-Identifier: BSD-3-Clause
// Statistics over the members, and the files that hold them.
#include "apps/soil_column/ensemble_results.hpp"

#include "base/error.hpp"
#include "base/files/json.hpp"
#include "base/files/replace_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace isostat
{
namespace
{
/// @param sorted  not empty
double percentile(const std::vector<double> &sorted, double part)
{
  const double at = part * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

/// One value of every member.
std::vector<double> sample(const std::vector<MemberResults> &members, auto &&value)
{
  std::vector<double> all;
  for (const MemberResults &member : members)
    all.push_back(value(member));
  return all;
}

/// A table `x, then mean, 16, 50, 84 % of each curve`.
std::string bands_csv(const std::vector<MemberResults> &members, const std::string &kind)
{
  const Curves &first = members.front().curves.at(kind);
  for (const MemberResults &member : members)
    if (member.curves.at(kind).over.values != first.over.values)
      throw RunFailure(fmt::format("member {}: its {} are not those of member {}; start it anew", member.name, kind,
                                   members.front().name));
  std::string text = fmt::format("{} ({})", first.over.name, first.over.unit);
  for (const Measured &curve : first.curves)
    for (const char *what : {"mean", "p16", "p50", "p84"})
      text += fmt::format(",{}_{} ({})", curve.name, what, curve.unit);
  text += '\n';
  for (std::size_t i = 0; i < first.over.values.size(); ++i)
    {
      text += fmt::format("{:.10g}", first.over.values[i]);
      for (std::size_t c = 0; c < first.curves.size(); ++c)
        {
          const Statistics s(
              sample(members, [&](const MemberResults &m) { return m.curves.at(kind).curves[c].values[i]; }));
          text += fmt::format(",{:.10g},{:.10g},{:.10g},{:.10g}", s.mean, s.low, s.median, s.high);
        }
      text += '\n';
    }
  return text;
}

std::string members_csv(const std::vector<MemberResults> &members)
{
  std::string text = "member,packings,record,same_as";
  for (const Measured &number : members.front().numbers)
    text += fmt::format(",{} ({})", number.name, number.unit);
  text += '\n';
  for (const MemberResults &member : members)
    {
      text += fmt::format("{},{},{},{}", member.name, member.packings,
                          std::filesystem::path(member.record).filename().string(), member.same_as);
      for (const Measured &number : member.numbers)
        text += fmt::format(",{:.10g}", number.values.front());
      text += '\n';
    }
  return text;
}

Json to_json(const Statistics &s, const std::string &unit)
{
  return {{"unit", unit},    {"n", s.n},        {"mean", s.mean}, {"standard_error", s.standard_error},
          {"p16", s.low},    {"p50", s.median}, {"p84", s.high},  {"min", s.minimum},
          {"max", s.maximum}};
}

/// How a number of a member stands in the summary: as in that of a run of its own, where it is there.
struct Shown
{
  std::string label; ///< with its unit
  double factor = 1; ///< from SI
};

Shown shown_as(const Measured &number, const ColumnScene &scene)
{
  const std::map<std::string, Shown> as = {
      {"peak_surface", {"peak surface (m/s2)"}},
      {"peak_surface_below", {fmt::format("... below {:.4g} Hz (m/s2)", scene.analysis.highest_frequency)}},
      {"amplification", {"amplification (-)"}},
      {"arias_intensity", {"Arias intensity (m/s)"}},
      {"peak_gamma", {"peak shear strain (%)", 100}},
      {"max_ru", {"largest r_u (-)"}},
      {"liquefied_thickness", {"liquefied thickness (m)"}},
      {"settlement", {"settlement (mm)", 1000}},
      {"downslope", {"moved downslope (m)"}},
      {"surface_along_x", {"surface along x, at output.x (m)"}},
      {"surface_largest", {"... where it is most (m)"}},
      {"surface_settlement", {"surface sank (m)"}},
      {"surface_heave", {"surface rose (m)"}},
      {"min_redundancy", {"smallest I_R (-)"}},
      {"final_redundancy", {"I_R at the end, mean (-)"}}};
  if (const auto found = as.find(number.name); found != as.end())
    return found->second;
  constexpr std::string_view spectral = "surface_Sa_";
  if (number.name.starts_with(spectral)) // "0.3s"
    return {fmt::format("S_a({} s) of surface (m/s2)",
                        number.name.substr(spectral.size(), number.name.size() - spectral.size() - 1))};
  return {fmt::format("{} ({})", number.name, number.unit)};
}

std::string cell(double value, int digits)
{
  return std::isnan(value) ? fmt::format("{:>13}", "-") : fmt::format("{:>13.{}g}", value, digits);
}

std::string number_text(const Statistics &s, const Shown &shown)
{
  const double f = shown.factor;
  return fmt::format("  {:<30}", shown.label) + cell(f * s.mean, 4) + cell(f * s.standard_error, 2) +
         cell(f * s.low, 4) + cell(f * s.median, 4) + cell(f * s.high, 4) + fmt::format("{:>4}\n", s.n);
}

/// How many members there are and count, and the head of the table.
std::string head_text(const ColumnScene &scene, const std::vector<MemberResults> &members, std::size_t n_asked,
                      std::size_t n_differing)
{
  std::string text =
      fmt::format("\n{}\n  members                  {} of {} finished\n",
                  scene.title.empty() ? "Ensemble of a soil column" : scene.title, members.size(), n_asked);
  std::string same;
  for (const MemberResults &member : members)
    if (!member.same_as.empty())
      same += fmt::format("{}{} as {}", same.empty() ? "" : ", ", member.name, member.same_as);
  if (!same.empty())
    text += fmt::format("  the same packings        {}; they count once, n = {}. More seeds (mixed_realisations, and a "
                        "library that has them) give more that differ\n",
                        same, n_differing);
  if (n_differing < fewest_for_band)
    text += fmt::format("  no percentiles           of n = {}: figures have the members and their mean\n", n_differing);
  return text + fmt::format("\n  {:<30}{:>13}{:>13}{:>13}{:>13}{:>13}{:>4}\n", "", "mean", "+- s.e.", "16 %", "median",
                            "84 %", "n");
}
} // namespace

Statistics::Statistics(std::vector<double> sample)
{
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::erase_if(sample, [](double x) { return std::isnan(x); });
  std::ranges::sort(sample);
  n = sample.size();
  mean = standard_error = low = median = high = minimum = maximum = none;
  if (n == 0)
    return;
  double sum = 0, squares = 0;
  for (const double x : sample)
    sum += x;
  mean = sum / static_cast<double>(n);
  for (const double x : sample)
    squares += (x - mean) * (x - mean);
  if (n > 1)
    standard_error = std::sqrt(squares / static_cast<double>(n - 1) / static_cast<double>(n));
  median = percentile(sample, 0.5);
  if (n >= fewest_for_band)
    low = percentile(sample, 0.16), high = percentile(sample, 0.84);
  minimum = sample.front(), maximum = sample.back();
}

std::string write_ensemble(const std::filesystem::path &folder, const ColumnScene &scene,
                           const std::vector<MemberResults> &members, std::size_t n_asked,
                           const std::map<std::string, std::string> &failures)
{
  std::vector<MemberResults> differing = members;
  std::erase_if(differing, [](const MemberResults &member) { return !member.same_as.empty(); });
  std::string text = head_text(scene, members, n_asked, differing.size());
  Json numbers = Json::object();
  for (std::size_t k = 0; k < differing.front().numbers.size(); ++k)
    {
      const Measured &number = differing.front().numbers[k];
      const Statistics s(sample(differing, [&](const MemberResults &m) { return m.numbers[k].values.front(); }));
      numbers[number.name] = to_json(s, number.unit);
      text += number_text(s, shown_as(number, scene));
    }
  for (const auto &[name, why] : failures)
    text += fmt::format("  failed: {}: {}\n", name, why);
  for (const auto &[kind, curves] : differing.front().curves)
    write_replacing(folder / fmt::format("bands_{}.csv", kind), bands_csv(differing, kind));
  write_replacing(folder / "members.csv", members_csv(members));
  write_json(folder / "ensemble.json", {{"title", scene.title},
                                        {"members", members.size()},
                                        {"differing", differing.size()},
                                        {"asked", n_asked},
                                        {"liquefied_ru", liquefied_ru},
                                        {"depths", scene.output.depths},
                                        {"numbers", numbers}});
  return text;
}
} // namespace isostat
