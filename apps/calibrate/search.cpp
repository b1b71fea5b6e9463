// SPDX-License-Identifier: BSD-3-Clause
#include "apps/calibrate/search.hpp"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <boost/random/uniform_01.hpp>
#include <exception>
#include <fmt/format.h>
#include <nlopt.hpp>

namespace isostat
{
namespace
{
nlopt::algorithm algorithm(SearchMethod method)
{
  switch (method)
    {
    case SearchMethod::bobyqa:
      return nlopt::LN_BOBYQA;
    case SearchMethod::sbplx:
      return nlopt::LN_SBPLX;
    case SearchMethod::crs2:
      return nlopt::GN_CRS2_LM;
    }
  return nlopt::LN_BOBYQA;
}

/// NLopt passes on only that something was thrown: what it was is kept here.
struct Guarded
{
  const Objective &objective;
  std::exception_ptr thrown;
  std::string budget;

  static double call(const std::vector<double> &shares, std::vector<double> &, void *data)
  {
    auto &self = *static_cast<Guarded *>(data);
    try
      {
        return self.objective(shares);
      }
    catch (const BudgetUsed &used)
      {
        self.budget = used.what;
      }
    catch (...)
      {
        self.thrown = std::current_exception();
      }
    throw nlopt::forced_stop();
  }
};
} // namespace

std::vector<std::vector<double>> sobol_design(std::size_t dimensions, std::size_t n)
{
  boost::random::sobol sequence(dimensions);
  boost::random::uniform_01<double> share;
  std::vector<std::vector<double>> points(n, std::vector<double>(dimensions));
  for (std::vector<double> &point : points)
    for (double &x : point)
      x = share(sequence);
  return points;
}

std::string search(const SearchSettings &settings, const std::vector<double> &start, const Objective &objective)
{
  constexpr unsigned long lot = 1; // of CRS2
  nlopt::srand(lot);
  const std::size_t n = start.size();
  nlopt::opt optimiser(algorithm(settings.method), static_cast<unsigned>(n));
  optimiser.set_lower_bounds(std::vector<double>(n, 0));
  optimiser.set_upper_bounds(std::vector<double>(n, 1));
  optimiser.set_initial_step(std::vector<double>(n, settings.first_step));
  optimiser.set_xtol_abs(settings.tolerance);
  Guarded guarded{objective, nullptr, ""};
  optimiser.set_min_objective(Guarded::call, &guarded);
  std::vector<double> shares = start;
  double value = 0;
  try
    {
      optimiser.optimize(shares, value);
    }
  catch (const nlopt::forced_stop &)
    {
      if (guarded.thrown)
        std::rethrow_exception(guarded.thrown);
      return guarded.budget;
    }
  catch (const nlopt::roundoff_limited &)
    {
      return "no step of the method makes the misfit smaller";
    }
  return fmt::format("steps became smaller than {:g} of the bounds", settings.tolerance);
}
} // namespace isostat
