// SPDX-License-Identifier: BSD-3-Clause
#include "apps/micromechanics/analysis.hpp"

#include "dem/measure/energy.hpp"
#include "dem/measure/fabric.hpp"
#include "dem/measure/redundancy.hpp"
#include "dem/measure/stress.hpp"
#include "dem/measure/summary.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isostat
{
namespace
{
const char *const axis_name = "xyz";

/// One row in the making.
class Row
{
public:
  void add(const std::string &name, const std::string &unit, double value) { values.push_back({name, unit, value}); }

  /// The components on and above the diagonal.
  void add_symmetric(const std::string &name, const std::string &unit, const Mat3 &tensor)
  {
    for (int i = 0; i < 3; ++i)
      for (int k = i; k < 3; ++k)
        add(name + axis_name[i] + axis_name[k], unit, tensor(i, k));
  }

  void add_anisotropy(const std::string &name, const Anisotropy &anisotropy)
  {
    add_symmetric(name + "_", "-", anisotropy.tensor);
    add(name + "_intensity", "-", anisotropy.intensity());
  }

  std::vector<Measure> values;
};

void add_stresses(Row &row, const Snapshot &snapshot)
{
  const Mat3 contact = -contact_stress(snapshot), kinetic = -kinetic_stress(snapshot);
  const Vec3 wall = -wall_stress(snapshot);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      row.add(std::string("S_") + axis_name[i] + axis_name[k] + "_LW", "Pa", contact(i, k));
  for (int i = 0; i < 3; ++i)
    row.add(std::string("S_") + axis_name[i] + axis_name[i] + "_wall", "Pa", wall[i]);
  row.add_symmetric("S_kinetic_", "Pa", kinetic);
}

void add_fabric(Row &row, const Snapshot &snapshot)
{
  const Mat3 fabric = contact_fabric(snapshot);
  row.add("Fxy", "-", fabric(0, 1));
  row.add("Fxz", "-", fabric(0, 2));
  row.add("Fyz", "-", fabric(1, 2));
  const Anisotropies a = anisotropies(snapshot);
  row.add_anisotropy("a_c", a.contact);
  row.add_anisotropy("a_n", a.normal_force);
  row.add_anisotropy("a_t", a.tangential_force);
  row.add("f0", "N", a.mean_normal_force);
  row.add("outside_expansion", "-", static_cast<double>(a.outside_expansion));
  const ForceChains chains = force_chains(snapshot);
  row.add("fn_mean", "N", chains.mean_normal_force);
  row.add("strong_fraction", "-", chains.strong_fraction);
  row.add_symmetric("F_strong_", "-", chains.strong);
  row.add_symmetric("F_weak_", "-", chains.weak);
}

void add_energies(Row &row, const Snapshot &snapshot)
{
  const StoredEnergy stored = stored_energy(snapshot);
  StoredEnergy::for_each(stored, [&](const std::string &name, double energy) { row.add("E_" + name, "J", energy); });
}

double mean_normal_force(const Snapshot &snapshot)
{
  double sum = 0;
  for (const Contact &c : snapshot.contacts)
    sum += c.normal_force;
  return snapshot.contacts.empty() ? 0 : sum / static_cast<double>(snapshot.contacts.size());
}

void count(std::vector<std::size_t> &bins, double value)
{
  const auto bin = static_cast<std::size_t>(
      std::clamp(value / ForceDistribution::bin_width, 0.0, ForceDistribution::most_bins - 1.0));
  ++bins[bin];
}
} // namespace

std::vector<Measure> measures(const Snapshot &snapshot)
{
  Row row;
  row.add("step", "-", static_cast<double>(snapshot.step));
  row.add("time", "s", snapshot.time);
  for (int k = 0; k < 3; ++k)
    row.add(std::string("eps_") + axis_name[k], "-", 0 - snapshot.strain[k]); // 0 - : no negative zero
  const std::vector<double> scalars = micromechanics(snapshot).row();
  for (std::size_t k = 0; k < scalars.size(); ++k)
    row.add(Micromechanics::columns()[k].first, Micromechanics::columns()[k].second, scalars[k]);
  const ContactNetwork network = contact_network(snapshot);
  row.add("N", "-", static_cast<double>(network.grains.all));
  row.add("N1", "-", static_cast<double>(network.grains.single));
  add_stresses(row, snapshot);
  add_fabric(row, snapshot);
  add_energies(row, snapshot);
  return row.values;
}

ForceDistribution force_distribution(const Snapshot &snapshot)
{
  ForceDistribution result;
  result.normal.assign(ForceDistribution::most_bins, 0);
  result.tangential.assign(ForceDistribution::most_bins, 0);
  const double mean = mean_normal_force(snapshot);
  if (mean > 0)
    for (const Contact &c : snapshot.contacts)
      {
        count(result.normal, c.normal_force / mean);
        count(result.tangential, c.history.shear_force.norm() / mean);
      }
  return result;
}

Rose rose(const Snapshot &snapshot, int first_axis, int second_axis)
{
  std::vector<double> counts(Rose::n_bins, 0.0), forces(Rose::n_bins, 0.0);
  for (const Contact &c : snapshot.contacts)
    {
      const double turn =
          std::atan2(c.history.normal[second_axis], c.history.normal[first_axis]) / (2 * std::numbers::pi); // -1/2..1/2
      for (double side : {1.0, 1.5})                                                                        // n and -n
        {
          const double place = (turn + side - std::floor(turn + side)) * Rose::n_bins;
          const std::size_t bin = std::min(static_cast<std::size_t>(place), Rose::n_bins - 1);
          counts[bin] += 1;
          forces[bin] += c.normal_force;
        }
    }
  Rose result{std::vector<double>(Rose::n_bins, 0.0), std::vector<double>(Rose::n_bins, 0.0)};
  const double mean_count = 2.0 * static_cast<double>(snapshot.contacts.size()) / Rose::n_bins;
  const double mean_force = mean_normal_force(snapshot);
  for (std::size_t bin = 0; bin < Rose::n_bins; ++bin)
    if (counts[bin] > 0)
      {
        result.density[bin] = counts[bin] / mean_count;
        result.normal_force[bin] = mean_force > 0 ? forces[bin] / counts[bin] / mean_force : 0;
      }
  return result;
}

std::vector<std::size_t> coordination_distribution(const Snapshot &snapshot)
{
  std::vector<std::size_t> contacts(snapshot.grains.n_grains(), 0);
  for (const Contact &c : snapshot.contacts)
    {
      ++contacts[c.first];
      ++contacts[c.second];
    }
  const std::size_t most = contacts.empty() ? 0 : *std::max_element(contacts.begin(), contacts.end());
  std::vector<std::size_t> grains(most + 1, 0);
  for (std::size_t n : contacts)
    ++grains[n];
  return grains;
}
} // namespace isostat
