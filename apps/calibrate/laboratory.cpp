// SPDX-License-Identifier: BSD-3-Clause
#include "apps/calibrate/laboratory.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr double pressure_tolerance =
    0.25; ///< of the lateral stress or p': wrong units and wrong tests are further off
constexpr double isotropy_tolerance = 0.25; ///< |q| / p' of the first row
constexpr double greatest_ratio = 14;       ///< of principal stresses: an angle of friction of 60 deg
constexpr double least_ratio = 1.2;         ///< at the largest |q|: what any sand reaches within half a percent
constexpr double short_curve = 0.005;       ///< strain_end below which the last is not asked
constexpr double greatest_stress = 1e12;    ///< Pa
constexpr double first_strain = 0.003;      ///< up to here volumes change as an elastic body's
constexpr double least_volume = 0.006;      ///< largest |eps_v| / strain_end

struct UnitFactor
{
  const char *unit;
  double factor;
};
constexpr UnitFactor strain_units[] = {{"%", 0.01}, {"-", 1}};
constexpr UnitFactor stress_units[] = {{"Pa", 1}, {"kPa", 1e3}, {"MPa", 1e6}};

/// "sigma_r (kPa)" -> {"sigma_r", "kPa"}; no unit: "".
struct ColumnName
{
  std::string name, unit;

  explicit ColumnName(std::string_view column)
  {
    const bool closed = column.ends_with(']') || column.ends_with(')');
    const std::size_t open = closed ? column.find_last_of("[(") : std::string_view::npos;
    name = column.substr(0, open);
    name.erase(name.find_last_not_of(' ') + 1);
    if (open != std::string_view::npos)
      unit = column.substr(open + 1, column.size() - open - 2);
  }
};

/// What the numbers of a column are multiplied with.
template <std::size_t n>
double unit_factor(const PlanCurve &plan, const std::string &column, const UnitFactor (&units)[n], const char *what)
{
  const std::string unit = ColumnName(column).unit;
  std::string names;
  for (const UnitFactor &known : units)
    {
      if (unit == known.unit)
        return known.factor;
      names += fmt::format("{}[{}]", names.empty() ? "" : ", ", known.unit);
    }
  reject(plan.path, 1,
         fmt::format("column \"{}\": {}; {} must be in one of {}, at the end of the column's name. Correct the header, "
                     "or curve.columns in {}.",
                     column, unit.empty() ? "no unit" : fmt::format("the unit is {}", unit), what, names, plan.where));
}

/// The header's columns in place of those of the plan that differ from them in the unit alone.
std::vector<std::string> as_in_header(const PlanCurve &plan, std::vector<std::string> columns)
{
  const std::string text = read_text(plan.path);
  const std::vector<std::string_view> lines = split_lines(text);
  const std::vector<std::string_view> header = CsvHeader(plan.path, lines.empty() ? "" : lines[0]).columns;
  for (std::string &column : columns)
    {
      const auto is_named_so = [&](std::string_view c) { return ColumnName(c).name == ColumnName(column).name; };
      const bool is_there = std::find(header.begin(), header.end(), column) != header.end();
      if (!is_there && std::count_if(header.begin(), header.end(), is_named_so) == 1)
        column = *std::find_if(header.begin(), header.end(), is_named_so);
    }
  return columns;
}

/// A laboratory file, in SI.
struct Table
{
  const PlanCurve &plan;
  CsvTable cells;
  std::vector<std::string> names;
  std::vector<double> factors;

  double operator()(std::size_t row, std::size_t column) const { return factors[column] * cells(row, column); }
  [[noreturn]] void refuse(std::size_t row, std::size_t column, const std::string &problem) const
  {
    reject(plan.path, cells.line(row), fmt::format("{} = {:g}; {}", names[column], cells(row, column), problem));
  }
};

Table read_table(const PlanCurve &plan)
{
  const CurveColumns &c = plan.columns;
  const bool drained = plan.test == LaboratoryTest::drained;
  const std::vector<std::string> names =
      as_in_header(plan, drained ? std::vector<std::string>{c.strain, c.volume, c.axial, c.radial}
                                 : std::vector<std::string>{c.strain, c.p, c.q});
  CsvTable cells(plan.path, names);
  if (cells.n_rows() < 2)
    reject(plan.path, 1, "holds fewer than two rows; a curve needs more.");
  std::vector<double> factors;
  for (std::size_t k = 0; k < names.size(); ++k)
    factors.push_back(k == 0 || (drained && k == 1) ? unit_factor(plan, names[k], strain_units, "a strain")
                                                    : unit_factor(plan, names[k], stress_units, "a stress"));
  Table table{plan, std::move(cells), names, factors};
  for (std::size_t row = 0; row < table.cells.n_rows(); ++row)
    for (std::size_t k = drained ? 2 : 1; k < names.size(); ++k)
      if (!(std::abs(table(row, k)) <= greatest_stress))
        table.refuse(row, k, "is no stress of a soil. Correct the number, or the unit in the header.");
  return table;
}

void check_strains(const Table &table, const Curve &curve)
{
  const PlanCurve &plan = table.plan;
  const char *direction = plan.direction == LoadDirection::compression ? "compression" : "extension";
  for (std::size_t row = 0; row < curve.strain.size(); ++row)
    {
      if (std::abs(curve.strain[row]) >= 1)
        table.refuse(row, 0, "is no strain: 1 is 100 percent. Is it given in percent? Correct the unit in the header.");
      if (row > 0 && curve.strain[row] <= curve.strain[row - 1])
        table.refuse(row, 0,
                     fmt::format("goes back from {:g} in the row before; must advance from row to row in {}. Remove "
                                 "unloading, or correct direction in {}.",
                                 table.cells(row - 1, 0), direction, plan.where));
    }
  if (curve.strain.back() < plan.strain_end * (1 - 1e-9))
    table.refuse(curve.strain.size() - 1, 0,
                 fmt::format("ends the curve at {:g} %, before strain_end = {:g} ({:g} %) of {}. Lower strain_end, or "
                             "correct the unit in the header.",
                             100 * curve.strain.back(), plan.strain_end, 100 * plan.strain_end, plan.where));
  if (curve.strain.front() > 0.5 * plan.strain_end)
    table.refuse(0, 0,
                 fmt::format("is more than half of strain_end = {:g} of {}: the curve has no beginning.",
                             plan.strain_end, plan.where));
}

/// Rows that are compared.
std::size_t n_compared(const Curve &curve, const PlanCurve &plan)
{
  const auto end = std::upper_bound(curve.strain.begin(), curve.strain.end(), plan.strain_end);
  return std::min<std::size_t>(curve.strain.size(), end - curve.strain.begin() + 1);
}

std::size_t row_of_largest(const std::vector<double> &values, std::size_t n)
{
  const auto less = [](double a, double b) { return std::abs(a) < std::abs(b); };
  return std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), less) - values.begin();
}

void check_volumes(const Table &table, const Curve &curve)
{
  const PlanCurve &plan = table.plan;
  const std::size_t n = n_compared(curve, plan), row = row_of_largest(curve.other, n);
  for (std::size_t r = 0; r < n; ++r)
    {
      if (std::abs(curve.other[r]) >= 1)
        table.refuse(r, 1, "is no volumetric strain: 1 is 100 percent. Correct the unit in the header.");
      if (curve.strain[r] > 0 && curve.strain[r] <= first_strain &&
          sign(plan.direction) * curve.other[r] < -0.1 * curve.strain[r])
        table.refuse(
            r, 1,
            fmt::format("at an axial strain of {:g} %: a drained test {} at first, and compression is positive "
                        "here. Is dilation positive in this file? Then change the sign of the column.",
                        100 * curve.strain[r], plan.direction == LoadDirection::compression ? "contracts" : "expands"));
    }
  if (plan.strain_end >= short_curve && std::abs(curve.other[row]) < least_volume * plan.strain_end)
    table.refuse(row, 1,
                 fmt::format("is the largest up to strain_end = {:g} of {}: less than {:g} of it. Is the column a "
                             "fraction under a header in percent? Correct the unit.",
                             plan.strain_end, plan.where, least_volume));
}

/// Major over minor principal stress, from p' and q.
double stress_ratio(double p, double q)
{
  const double axial = p + 2 * q / 3, radial = p - q / 3;
  return std::max(axial, radial) / std::min(axial, radial);
}

/// @param p  mean effective stress of each row, Pa
void check_stresses(const Table &table, const Curve &curve, const std::vector<double> &p)
{
  const PlanCurve &plan = table.plan;
  const bool drained = plan.test == LaboratoryTest::drained;
  const std::size_t column = 2, n = n_compared(curve, plan), largest = row_of_largest(curve.q, n);
  const std::string remedy = drained ? "Are the columns of axial and radial stress swapped, or their units wrong?"
                                     : "Correct the sign of q (axial minus radial stress), or its unit.";
  if (std::abs(curve.q[0]) > isotropy_tolerance * p[0])
    table.refuse(
        0, column,
        fmt::format("makes q = {:g} kPa at the start, with p' = {:g} kPa; |q| must be within {:g} % of p' because "
                    "the tests begin isotropic. {}",
                    curve.q[0] / 1e3, p[0] / 1e3, 100 * isotropy_tolerance, remedy));
  for (std::size_t row = 0; row < n; ++row)
    if (const double ratio = stress_ratio(p[row], curve.q[row]);
        !(ratio > 0 && ratio <= greatest_ratio) && p[row] > 0.02 * p[0])
      table.refuse(row, column,
                   fmt::format("makes q = {:g} kPa with p' = {:g} kPa, which no sand bears: a ratio of principal "
                               "stresses above {:g}. {}",
                               curve.q[row] / 1e3, p[row] / 1e3, greatest_ratio, remedy));
  if (sign(plan.direction) * curve.q[largest] < 0)
    table.refuse(largest, column,
                 fmt::format("makes q = {:g} kPa, the largest of the curve; must be {} in {}. {}",
                             curve.q[largest] / 1e3, sign(plan.direction) > 0 ? "> 0" : "< 0",
                             sign(plan.direction) > 0 ? "compression" : "extension", remedy));
  if (plan.strain_end >= short_curve && stress_ratio(p[largest], curve.q[largest]) < least_ratio)
    table.refuse(
        largest, column,
        fmt::format("makes q = {:g} kPa, the largest of the curve, with p' = {:g} kPa; principal stresses must "
                    "come to a ratio of {:g} because any sand does. {}",
                    curve.q[largest] / 1e3, p[largest] / 1e3, least_ratio, remedy));
}

/// The radial stress, or the first p', is the pressure of the test.
void check_pressure(const Table &table, const Curve &curve, double pressure)
{
  const bool drained = table.plan.test == LaboratoryTest::drained;
  const std::size_t column = drained ? 3 : 1, n = drained ? n_compared(curve, table.plan) : 1;
  for (std::size_t row = 0; row < n; ++row)
    if (std::abs(table(row, column) - pressure) > pressure_tolerance * pressure)
      table.refuse(row, column,
                   fmt::format("is {:g} kPa{}, but the test of {} {} {:g} kPa; must be within {:g} %. Correct pressure "
                               "there, the unit in the header, or swapped columns.",
                               table(row, column) / 1e3, row == 0 ? " at the start" : "", table.plan.where,
                               drained ? "has a lateral stress of" : "begins at", pressure / 1e3,
                               100 * pressure_tolerance));
}
} // namespace

Curve read_laboratory(const PlanCurve &plan, double pressure)
{
  const Table table = read_table(plan);
  const bool drained = plan.test == LaboratoryTest::drained;
  Curve curve;
  std::vector<double> p;
  for (std::size_t row = 0; row < table.cells.n_rows(); ++row)
    {
      curve.strain.push_back(sign(plan.direction) * table(row, 0));
      curve.q.push_back(drained ? table(row, 2) - table(row, 3) : table(row, 2));
      curve.other.push_back(table(row, 1));
      p.push_back(drained ? (table(row, 2) + 2 * table(row, 3)) / 3 : table(row, 1));
    }
  check_strains(table, curve);
  check_pressure(table, curve, pressure);
  check_stresses(table, curve, p);
  if (drained)
    check_volumes(table, curve);
  return curve;
}
} // namespace isostat
