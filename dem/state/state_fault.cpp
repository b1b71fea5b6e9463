// SPDX-License-Identifier: BSD-3-Clause
#include "dem/state/state_fault.hpp"

#include "dem/domain/lattice.hpp"
#include "dem/law/history.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr double most_slender = 1000; ///< edge of a cell, over the cube root of its volume

std::string grain_fault(const Packing &grains)
{
  if (grains.n_grains() == 0)
    return "it has no grains; expected at least one";
  for (std::size_t i = 0; i < grains.n_grains(); ++i)
    {
      for (const auto &[name, records] : {std::pair("position", &grains.position),
                                          std::pair("velocity", &grains.velocity), std::pair("spin", &grains.spin)})
        for (std::size_t k = 4 * i; k < 4 * i + 4; ++k)
          if (!std::isfinite((*records)[k]))
            return fmt::format("grain {} (id {}) has a value of {} in its {}; expected finite numbers", i, grains.id[i],
                               (*records)[k], name);
      const double r = grains.radius(i), inverse_mass = grains.velocity[4 * i + 3],
                   inverse_inertia = grains.spin[4 * i + 3];
      if (!(r > 0 && inverse_mass > 0 && inverse_inertia > 0))
        return fmt::format("grain {} (id {}) has radius {} m, 1/mass {} 1/kg, 1/inertia {} 1/(kg m2); expected all > 0",
                           i, grains.id[i], r, inverse_mass, inverse_inertia);
    }
  return {};
}

std::string place_fault(const Packing &grains, const PeriodicCell &cell)
{
  for (std::size_t i = 0; i < grains.n_grains(); ++i)
    if (const double away = edges_away(cell.edges, grains.centre(i)); !(away <= max_edges_away))
      return fmt::format("grain {} (id {}) is {:.3g} edges away from the periodic cell; expected at most {:.0g}", i,
                         grains.id[i], away, max_edges_away);
  return {};
}

std::string contact_fault(const Snapshot &state)
{
  for (std::size_t i = 0; i < state.contacts.size(); ++i)
    {
      const Contact &c = state.contacts[i];
      const ContactHistory &h = c.history;
      bool finite = std::isfinite(c.overlap) && std::isfinite(c.normal_force);
      for (const HistoryVector &v : history_vectors)
        finite &= (h.*v.place).allFinite();
      for (const double number : h.own)
        finite &= std::isfinite(number);
      if (!finite)
        return fmt::format("contact {} (grains {} and {}) holds a value that is not finite", i, c.first, c.second);
    }
  for (std::size_t i = 0; i < state.wall_contacts.size(); ++i)
    if (!(std::isfinite(state.wall_contacts[i].overlap) && std::isfinite(state.wall_contacts[i].normal_force)))
      return fmt::format("wall contact {} (grain {}) holds a value that is not finite", i,
                         state.wall_contacts[i].grain);
  return {};
}

std::string cell_fault(const PeriodicCell &cell)
{
  const double size = std::cbrt(cell.volume());
  if (!(cell.edges.allFinite() && cell.deformation.allFinite() && cell.strain_step.allFinite() &&
        std::isfinite(cell.volume_strain) && std::isfinite(size) && size > 0 && std::isfinite(cell.reference_volume) &&
        cell.reference_volume > 0))
    return fmt::format("the periodic cell has a volume of {} m3; expected finite edges and a volume > 0",
                       cell.volume());
  if (const double longest = cell.edges.colwise().norm().maxCoeff(); longest > most_slender * size)
    return fmt::format("the periodic cell has an edge of {} m and a volume of {} m3; expected edges up to {} times the "
                       "cube root of the volume",
                       longest, cell.volume(), most_slender);
  if (!((cell.rotation.transpose() * cell.rotation - Mat3::Identity()).norm() < 1e-6))
    return "the periodic cell's rotation is none";
  return {};
}
} // namespace

std::string state_fault(const Snapshot &state)
{
  std::vector<double> values = parameter_values(state.law);
  values.push_back(state.time);
  for (const double value : values)
    if (!std::isfinite(value))
      return fmt::format("a law parameter or the time is {}; expected finite numbers", value);
  if (!(std::isfinite(state.grains.density) && state.grains.density > 0))
    return fmt::format("grain density = {} kg/m3; expected > 0", state.grains.density);
  if (state.cell)
    {
      if (std::string found = cell_fault(*state.cell); !found.empty())
        return found;
    }
  else if (!(state.box.lower.allFinite() && state.box.upper.allFinite() && (state.box.edges().array() > 0).all()))
    return fmt::format("the box has edges {} x {} x {} m; expected all > 0", state.box.edges().x(),
                       state.box.edges().y(), state.box.edges().z());
  const HomogeneousMotion &walls = state.wall_motion;
  if (!state.strain.allFinite() || !Eigen::Map<const Vec3>(walls.rate).allFinite() ||
      !Eigen::Map<const Vec3>(walls.shift).allFinite())
    return "its strain or the motion of its walls is not finite";
  std::string found = grain_fault(state.grains);
  if (found.empty() && state.cell)
    found = place_fault(state.grains, *state.cell);
  return found.empty() ? contact_fault(state) : found;
}
} // namespace isostat
