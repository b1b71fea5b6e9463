// SPDX-License-Identifier: BSD-3-Clause
#include "fem/solve/solver_state.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
FieldWriter::FieldWriter(std::uint64_t step, const Material &material, bool shared_out)
{
  if (shared_out)
    throw InputError("checkpoint: a mesh that is shared out over ranks cannot be saved; run it on one rank");
  state.step = step;
  state.material = material.pack();
}

void FieldWriter::operator()(const char *name, double value) { state.numbers[name] = value; }

void FieldWriter::operator()(const char *name, const Vector &values)
{
  state.vectors[name].assign(values.begin(), values.end());
}

void FieldWriter::operator()(const char *name, const std::vector<Stress> &stresses)
{
  std::vector<double> &values = state.vectors[name];
  for (const Stress &stress : stresses)
    values.insert(values.end(), stress.begin(), stress.end());
}

void FieldWriter::operator()(const char *name, const std::vector<double> &values) { state.vectors[name] = values; }

void FieldReader::operator()(const char *name, double &value) const
{
  const double found = number(name);
  if (!only_check_)
    value = found;
}

void FieldReader::operator()(const char *name, Vector &values) const
{
  const std::vector<double> &found = stored(name, values.locally_owned_size());
  if (!only_check_)
    std::copy(found.begin(), found.end(), values.begin());
}

void FieldReader::operator()(const char *name, std::vector<Stress> &stresses) const
{
  const std::vector<double> &found = stored(name, 6 * stresses.size());
  for (std::size_t k = 0; !only_check_ && k < found.size(); ++k)
    stresses[k / 6][k % 6] = found[k];
}

void FieldReader::operator()(const char *name, std::vector<double> &values) const
{
  const std::vector<double> &found = stored(name, values.size());
  if (!only_check_)
    values = found;
}

void FieldReader::constant(const char *name, double value) const
{
  if (const double found = number(name); found != value)
    throw InputError(fmt::format("checkpoint: its {} is {:.17g}, this run's {:.17g}; resume with the scene of the "
                                 "first run",
                                 name, found, value));
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
