// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/mesh_check.hpp"

#include "apps/deposit/ranks.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/replace_file.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
/// Of S_a of the surface, the values of half the mesh over those of the whole, less 1.
struct SpectrumDifference
{
  double largest = 0, period = 0; ///< at periods from 0.1 s on [-], s
  double from = 0;                ///< the lowest frequency at which it exceeds 5 %, Hz; 0: none
};

SpectrumDifference spectrum_difference(const ColumnScene &scene, const std::filesystem::path &whole,
                                       const std::filesystem::path &half)
{
  constexpr double shortest = 0.1, notable = 0.05;
  std::vector<std::string> columns = {"period (s)"};
  for (const ColumnMotion &motion : scene.motions)
    columns.push_back(fmt::format("surface_{}_SA (m/s2)", "xyz"[static_cast<std::size_t>(motion.axis)]));
  const CsvTable one(whole / "spectra.csv", columns), other(half / "spectra.csv", columns);
  SpectrumDifference found;
  for (std::size_t row = one.n_rows(); row-- > 0;) // from the longest period
    for (std::size_t c = 1; c < columns.size(); ++c)
      {
        const double period = one(row, 0), difference = one(row, c) > 0 ? other(row, c) / one(row, c) - 1 : 0;
        if (period >= shortest * (1 - 1e-9) && std::abs(difference) > std::abs(found.largest))
          found.largest = difference, found.period = period;
        if (found.from == 0 && std::abs(difference) > notable)
          found.from = 1 / period;
      }
  return found;
}
} // namespace

ColumnScene with_half_the_cells(ColumnScene scene)
{
  double top = 0; // depth
  for (ColumnLayer &layer : scene.layers)
    {
      const unsigned all = layer.n_cells(), half = (all + 1) / 2;
      const double at = (scene.water.table - top) / layer.thickness * half; // the table, in elements
      const bool within = at > 0 && at < half && std::abs(at - std::round(at)) > 1e-6;
      layer.cells = within ? all : half;
      layer.cell_size = 0;
      top += layer.thickness;
    }
  return scene;
}

void check_mesh(const ColumnRequest &request, RunResult &result)
{
  ColumnRequest half = request;
  half.scene = with_half_the_cells(request.scene);
  half.folder = request.folder / "half_mesh";
  half.use = FolderUse::overwrite;
  half.warns = false;
  const RunResult coarse = run_column(half);
  if (!ranks().first())
    return;
  write_replacing(half.folder / "summary.txt", coarse.summary.text());
  const Json one = result.summary.json(), other = coarse.summary.json();
  const auto difference = [&](const char *key) {
    const double whole = one.at(key).get<double>();
    return Value{fmt::format("mesh_check.{}", key), whole > 0 ? other.at(key).get<double>() / whole - 1 : 0, percent};
  };
  Summary &summary = result.summary;
  summary.row("half the elements",
              "{} in half_mesh: peak surface {:+.1f} %, below {:.4g} Hz {:+.1f} %, peak strain {:+.1f} %",
              Value{"mesh_check.elements", other.at("elements").get<std::size_t>()}, difference("peak_surface"),
              request.scene.analysis.highest_frequency, difference("peak_surface_below"), difference("peak_gamma"));
  summary["mesh_check.frequency"] = nullptr;
  if (!request.scene.motions.empty())
    {
      const auto [largest, period, from] = spectrum_difference(request.scene, request.folder, half.folder);
      summary.row(
          " ",
          "S_a of the surface differs by {:+.1f} % at most at periods from 0.1 s on ({:.3g} s), by more than 5 % {}",
          Value{"mesh_check.spectrum", largest, percent}, Value{"mesh_check.spectrum_period", period},
          from > 0 ? summary.text("from {:.3g} Hz on", Value{"mesh_check.frequency", from}) : "nowhere");
    }
  write_json(request.folder / "summary.json", summary.json());
}
} // namespace isostat
