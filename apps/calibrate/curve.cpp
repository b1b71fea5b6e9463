// SPDX-License-Identifier: BSD-3-Clause
#include "apps/calibrate/curve.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr double pressure_tolerance = 0.25; ///< of the first row: wrong units and wrong tests are further off

struct UnitFactor
{
  const char *unit;
  double factor;
};
constexpr UnitFactor strain_units[] = {{"%", 0.01}, {"-", 1}};
constexpr UnitFactor stress_units[] = {{"Pa", 1}, {"kPa", 1e3}, {"MPa", 1e6}};

/// "eps_a[%]", "sigma_r (kPa)" -> what its numbers are multiplied with.
template <std::size_t n>
double unit_factor(const PlanCurve &plan, const std::string &column, const UnitFactor (&units)[n], const char *what)
{
  const std::size_t open = column.find_last_of("[(");
  const bool closed = open != std::string::npos && (column.back() == ']' || column.back() == ')');
  const std::string unit = closed ? column.substr(open + 1, column.size() - open - 2) : "";
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
                     column, closed ? fmt::format("the unit is {}", unit) : "no unit", what, names, plan.where));
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
  const std::vector<std::string> names = drained ? std::vector<std::string>{c.strain, c.volume, c.axial, c.radial}
                                                 : std::vector<std::string>{c.strain, c.p, c.q};
  const auto strain = [&](const std::string &name) { return unit_factor(plan, name, strain_units, "a strain"); };
  const auto stress = [&](const std::string &name) { return unit_factor(plan, name, stress_units, "a stress"); };
  CsvTable cells(plan.path, names);
  if (cells.n_rows() < 2)
    reject(plan.path, 1, "holds fewer than two rows; a curve needs more.");
  if (drained)
    return {plan, std::move(cells), names, {strain(c.strain), strain(c.volume), stress(c.axial), stress(c.radial)}};
  return {plan, std::move(cells), names, {strain(c.strain), stress(c.p), stress(c.q)}};
}

double way(const PlanCurve &plan) { return sign(plan.direction); }

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
  for (std::size_t row = 0; plan.test == LaboratoryTest::drained && row < curve.other.size(); ++row)
    if (std::abs(curve.other[row]) >= 1)
      table.refuse(row, 1, "is no volumetric strain: 1 is 100 percent. Correct the unit in the header.");
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

/// @param column  radial stress or p', which begin at the pressure of the test
void check_pressure(const Table &table, std::size_t column, double pressure)
{
  const double first = table(0, column);
  if (std::abs(first - pressure) > pressure_tolerance * pressure)
    table.refuse(0, column,
                 fmt::format("is {:g} kPa at the start, but the test of {} begins at {:g} kPa; must be within {:g} %. "
                             "Correct pressure there, or the unit in the header.",
                             first / 1e3, table.plan.where, pressure / 1e3, 100 * pressure_tolerance));
}

double interpolated(const std::vector<double> &x, const std::vector<double> &y, double at)
{
  const auto above = std::lower_bound(x.begin(), x.end(), at);
  const auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, above - x.begin()));
  if (k == x.size())
    return y.back();
  const double t = (at - x[k - 1]) / (x[k] - x[k - 1]);
  return y[k - 1] + t * (y[k] - y[k - 1]);
}

Curve at_strains(const Curve &curve, const std::vector<double> &strains)
{
  Curve result{strains, {}, {}};
  for (const double strain : strains)
    {
      result.q.push_back(interpolated(curve.strain, curve.q, strain));
      result.other.push_back(interpolated(curve.strain, curve.other, strain));
    }
  return result;
}

double largest(const std::vector<double> &values, const PlanCurve &plan, const char *what)
{
  double most = 0;
  for (const double value : values)
    most = std::max(most, std::abs(value));
  if (most == 0)
    throw InputError(fmt::format("{}: {} is zero throughout ({}); must vary because misfits are shares of its largest "
                                 "value. Give another curve.",
                                 plan.path, what, plan.where));
  return most;
}

/// Mean and standard deviation over the models, one quantity.
void statistics(const std::vector<Curve> &models, std::vector<double> Curve::*quantity, Comparison &result)
{
  const double n = static_cast<double>(models.size());
  for (std::size_t i = 0; i < result.laboratory.strain.size(); ++i)
    {
      double mean = 0, squares = 0;
      for (const Curve &model : models)
        mean += (model.*quantity)[i] / n;
      for (const Curve &model : models)
        squares += std::pow((model.*quantity)[i] - mean, 2);
      (result.mean.*quantity).push_back(mean);
      (result.deviation.*quantity).push_back(n > 1 ? std::sqrt(squares / (n - 1)) : 0);
    }
}
} // namespace

Curve read_laboratory(const PlanCurve &plan, double pressure)
{
  const Table table = read_table(plan);
  Curve curve;
  for (std::size_t row = 0; row < table.cells.n_rows(); ++row)
    {
      const bool drained = plan.test == LaboratoryTest::drained;
      curve.strain.push_back(way(plan) * table(row, 0));
      curve.q.push_back(drained ? table(row, 2) - table(row, 3) : table(row, 2));
      curve.other.push_back(table(row, 1));
    }
  check_strains(table, curve);
  check_pressure(table, plan.test == LaboratoryTest::drained ? 3 : 1, pressure);
  return curve;
}

Curve read_model(const std::filesystem::path &folder, const PlanCurve &plan)
{
  enum
  {
    eps_x,
    eps_y,
    eps_z,
    p,
    q
  };
  const CsvTable history(folder / "history.csv", {"eps_x (-)", "eps_y (-)", "eps_z (-)", "p (Pa)", "q (Pa)"});
  const auto as_measured = [&](double strain) { return plan.logarithmic ? strain : -std::expm1(-strain); };
  Curve curve;
  for (std::size_t row = 0; row < history.n_rows(); ++row)
    {
      const double strain = way(plan) * as_measured(history(row, eps_y));
      if (!curve.strain.empty() && strain <= curve.strain.back())
        continue; // two rows of one step
      const double volume = as_measured(history(row, eps_x) + history(row, eps_y) + history(row, eps_z));
      curve.strain.push_back(strain);
      curve.q.push_back(history(row, q));
      curve.other.push_back(plan.test == LaboratoryTest::drained ? volume : history(row, p));
    }
  return curve;
}

std::vector<double> compared_strains(const Curve &laboratory, const PlanCurve &plan, const MisfitSettings &settings)
{
  std::vector<double> strains;
  for (std::uint64_t i = 1; i <= settings.points; ++i)
    {
      const double share = static_cast<double>(i) / static_cast<double>(settings.points);
      const double strain = plan.strain_end * (settings.spacing == StrainSpacing::quadratic ? share * share : share);
      if (strain >= laboratory.strain.front())
        strains.push_back(strain);
    }
  return strains;
}

Comparison compare(const Curve &laboratory, const std::vector<Curve> &models, const PlanCurve &plan,
                   const MisfitSettings &settings)
{
  const std::vector<double> strains = compared_strains(laboratory, plan, settings);
  Comparison result;
  result.laboratory = at_strains(laboratory, strains);
  result.mean.strain = result.deviation.strain = strains;
  std::vector<Curve> there;
  for (const Curve &model : models)
    {
      if (model.strain.size() < 2 || model.strain.back() < 0.99 * plan.strain_end)
        throw InputError(fmt::format("the run ended at a strain of {:g}, before {:g}",
                                     model.strain.empty() ? 0 : model.strain.back(), plan.strain_end));
      there.push_back(at_strains(model, strains));
    }
  statistics(there, &Curve::q, result);
  statistics(there, &Curve::other, result);
  result.q_scale = largest(result.laboratory.q, plan, "q");
  result.other_scale =
      largest(result.laboratory.other, plan, plan.test == LaboratoryTest::drained ? "the volumetric strain" : "p'");
  double squares = 0, errors = 0;
  for (std::size_t i = 0; i < strains.size(); ++i)
    {
      squares += std::pow((result.mean.q[i] - result.laboratory.q[i]) / result.q_scale, 2) +
                 std::pow((result.mean.other[i] - result.laboratory.other[i]) / result.other_scale, 2);
      errors += std::pow(result.deviation.q[i] / result.q_scale, 2) +
                std::pow(result.deviation.other[i] / result.other_scale, 2);
    }
  const double n = 2 * static_cast<double>(strains.size());
  result.misfit = std::sqrt(squares / n);
  result.scatter = std::sqrt(errors / n / static_cast<double>(models.size()));
  return result;
}

double total_misfit(const std::vector<double> &misfits, const std::vector<PlanCurve> &plan)
{
  double sum = 0, weights = 0;
  for (std::size_t k = 0; k < plan.size(); ++k)
    if (!plan[k].blind)
      {
        sum += plan[k].weight * misfits[k] * misfits[k];
        weights += plan[k].weight;
      }
  return std::sqrt(sum / weights);
}
} // namespace isostat
