// SPDX-License-Identifier: BSD-3-Clause
#include "fem/solve/solver_state.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
bool is_first(const FiniteElementSpace &space)
{
  int rank = 0;
  if (space.shared_out())
    MPI_Comm_rank(space.communicator(), &rank);
  return rank == 0;
}
} // namespace

FieldWriter::FieldWriter(std::uint64_t step, const Material &material, const FiniteElementSpace &space)
    : space_(space), gathered_(space)
{
  state.step = step;
  state.material = material.pack();
  if (!space.shared_out() && state.material.points.empty())
    return;
  if (space.shared_out() && std::ranges::any_of(state.material.points, &std::vector<std::byte>::empty))
    throw InputError("checkpoint: a material that keeps its points in one piece (that of a layer with material = "
                     "\"user\") cannot be saved from a mesh that is shared out over ranks; set mesh.distributed = "
                     "false");
  state.material.points = gathered_.point_bytes(std::move(state.material.points));
}

void FieldWriter::operator()(const char *name, const Vector &values)
{
  state.vectors[name] = values.size() == 0 ? std::vector<double>{} : gathered_.unknowns(values);
}

void FieldWriter::operator()(const char *name, const std::vector<Stress> &stresses)
{
  std::vector<double> values;
  for (const Stress &stress : stresses)
    values.insert(values.end(), stress.begin(), stress.end());
  state.vectors[name] = gathered_.points(values);
}

void FieldWriter::operator()(const char *name, const std::vector<double> &of_points)
{
  state.vectors[name] = gathered_.points(of_points);
}

void FieldWriter::sum(const char *name, double part)
{
  if (space_.shared_out())
    MPI_Allreduce(MPI_IN_PLACE, &part, 1, MPI_DOUBLE, MPI_SUM, space_.communicator());
  state.numbers[name] = part;
}

FieldReader::FieldReader(const SolverState &state, const FiniteElementSpace &space, bool only_check)
    : state_(state), gathered_(space), first_(is_first(space)), only_check_(only_check)
{}

void FieldReader::operator()(const char *name, double &value) const
{
  const double found = number(name);
  if (!only_check_)
    value = found;
}

void FieldReader::operator()(const char *name, Vector &values) const
{
  const std::vector<double> &found = stored(name, values.size() == 0 ? 0 : gathered_.n_numbers(values));
  if (!only_check_ && values.size() > 0)
    gathered_.set_unknowns(found, values);
}

void FieldReader::operator()(const char *name, std::vector<Stress> &stresses) const
{
  const std::vector<double> &found = stored(name, 6 * gathered_.n_points());
  std::vector<double> mine(6 * stresses.size());
  gathered_.set_points(found, mine);
  for (std::size_t k = 0; !only_check_ && k < mine.size(); ++k)
    stresses[k / 6][k % 6] = mine[k];
}

void FieldReader::operator()(const char *name, std::vector<double> &of_points) const
{
  const std::vector<double> &found = stored(name, of_points.empty() ? 0 : gathered_.n_points());
  if (!only_check_)
    gathered_.set_points(found, of_points);
}

void FieldReader::constant(const char *name, double value) const
{
  if (const double found = number(name); found != value)
    throw InputError(fmt::format("checkpoint: its {} is {:.17g}, this run's {:.17g}; resume with the scene of the "
                                 "first run",
                                 name, found, value));
}

void FieldReader::sum(const char *name, double &part) const
{
  const double found = number(name);
  if (!only_check_)
    part = first_ ? found : 0;
}

MaterialState FieldReader::material() const
{
  const MaterialState &all = state_.material;
  if (all.points.empty())
    return all;
  if (all.points.size() != gathered_.n_points())
    throw InputError(fmt::format("checkpoint: its soil has {} points, this mesh {}; resume with the scene of the first "
                                 "run",
                                 all.points.size(), gathered_.n_points()));
  return {all.common, gathered_.own_point_bytes(all.points)};
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
