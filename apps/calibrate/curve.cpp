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
      const double strain = sign(plan.direction) * as_measured(history(row, eps_y));
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
  if (models.size() > 1)
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
