// SPDX-License-Identifier: BSD-3-Clause
#include "fem/solve/solver_state.hpp"

#include "base/error.hpp"
#include "fem/ranks/failure.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
int rank_in(const FiniteElementSpace &space)
{
  int rank = 0;
  if (space.shared_out())
    MPI_Comm_rank(space.communicator(), &rank);
  return rank;
}
} // namespace

FieldWriter::FieldWriter(std::uint64_t step, const Material &material, const FiniteElementSpace &space)
    : space_(space), order_(space)
{
  state.step = step;
  state.material = material.pack();
  const auto &points = state.material.points;
  const bool by_point =
      points.size() == space.n_points() && std::ranges::none_of(points, &std::vector<std::byte>::empty);
  if (space.shared_out() && !space.on_every_rank(by_point))
    throw InputError("checkpoint: a material that keeps its points as a whole cannot be saved from a mesh that is "
                     "shared out over ranks");
  if (!points.empty() || space.shared_out())
    state.material.points = order_.point_bytes(std::move(state.material.points));
}

void FieldWriter::operator()(const char *name, const Vector &values)
{
  state.vectors[name] = values.size() == 0 ? std::vector<double>{} : order_.unknowns(values);
}

void FieldWriter::operator()(const char *name, const std::vector<Stress> &stresses)
{
  std::vector<double> values;
  for (const Stress &stress : stresses)
    values.insert(values.end(), stress.begin(), stress.end());
  state.vectors[name] = order_.points(values);
}

void FieldWriter::operator()(const char *name, const std::vector<double> &of_points)
{
  state.vectors[name] = order_.points(of_points);
}

void FieldWriter::sum(const char *name, double part)
{
  space_.sum_over_ranks({&part, 1});
  state.numbers[name] = part;
}

FieldReader::FieldReader(const SolverState &state, const FiniteElementSpace &space)
    : state_(state), space_(space), order_(space)
{}

void FieldReader::operator()(const char *name, double &value) const
{
  const double found = number(name);
  if (!only_check_)
    value = found;
}

void FieldReader::operator()(const char *name, Vector &values) const
{
  const std::vector<double> &found = stored(name, values.size() == 0 ? 0 : order_.n_numbers(values));
  if (!only_check_ && values.size() > 0)
    order_.set_unknowns(found, values);
}

void FieldReader::operator()(const char *name, std::vector<Stress> &stresses) const
{
  const std::vector<double> &found = stored(name, 6 * order_.n_points());
  std::vector<double> mine(6 * stresses.size());
  order_.set_points(found, mine);
  for (std::size_t k = 0; !only_check_ && k < mine.size(); ++k)
    stresses[k / 6][k % 6] = mine[k];
}

void FieldReader::operator()(const char *name, std::vector<double> &of_points) const
{
  const std::vector<double> &found = stored(name, of_points.empty() ? 0 : order_.n_points());
  if (!only_check_)
    order_.set_points(found, of_points);
}

void FieldReader::constant(const char *name, double &value) const
{
  const double found = number(name);
  if (!(std::abs(found - value) <= 1e-12 * std::abs(value)))
    throw InputError(fmt::format("checkpoint: its {} is {:.17g}, this run's {:.17g}; resume with the scene of the "
                                 "first run",
                                 name, found, value));
  if (!only_check_)
    value = found;
}

void FieldReader::sum(const char *name, double &part) const
{
  const double found = number(name);
  if (!only_check_)
    part = rank_in(space_) == 0 ? found : 0;
}

MaterialState FieldReader::own_points() const
{
  const MaterialState &all = state_.material;
  if (all.points.empty())
    return all;
  if (all.points.size() != order_.n_points())
    throw InputError(fmt::format("checkpoint: the soil in it has {} points, this mesh {}; resume with the scene of the "
                                 "first run",
                                 all.points.size(), order_.n_points()));
  return {all.common, order_.own_point_bytes(all.points)};
}

void FieldReader::unpack(Material &material) const
{
  fail_together(space_.communicator(), failure_of([&] { material.unpack(own_points()); }));
}

double FieldReader::number(const char *name) const
{
  const auto found = state_.numbers.find(name);
  if (found == state_.numbers.end())
    throw InputError(fmt::format("checkpoint: no \"{}\"; it is not one of this solver", name));
  return found->second;
}

const std::vector<double> &FieldReader::stored(const char *name, std::size_t size) const
{
  const auto found = state_.vectors.find(name);
  if (found == state_.vectors.end() || found->second.size() != size)
    throw InputError(fmt::format("checkpoint: \"{}\" has {} values, this mesh needs {}; resume with the scene of the "
                                 "first run",
                                 name, found == state_.vectors.end() ? 0 : found->second.size(), size));
  return found->second;
}
} // namespace isostat
