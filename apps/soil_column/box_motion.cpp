// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/box_motion.hpp"

#include "apps/common/summary.hpp"
#include "apps/soil_column/peaks.hpp"

#include <cmath>
#include <tuple>

namespace isostat
{
namespace
{
/// Also below a plate.
bool is_at_surface(const MeshSpec &mesh, const Place &place)
{
  return std::abs(mesh.depth(place)) < 1e-9 * mesh.soil.height();
}

/// u and its x where `size` of u is largest, the smallest x of several; over all ranks.
template <typename Size>
std::tuple<double, double> extreme(const FiniteElementSpace &space, const Vector &displacement,
                                   const std::vector<Place> &places, unsigned component, const Size &size)
{
  double largest = 0, found = 0, x = 0;
  for (std::size_t i = component; i < places.size(); i += 3)
    if (const double u = displacement.local_element(i); is_at_surface(space.mesh(), places[i]))
      if (size(u) > largest || (size(u) == largest && size(u) > 0 && places[i][0] < x))
        {
          largest = size(u);
          found = u;
          x = places[i][0];
        }
  if (space.shared_out())
    take_max(largest, {&x, &found}, space.communicator());
  return {found, x};
}
} // namespace

BoxMotion box_motion(const FiniteElementSpace &space, const Vector &displacement)
{
  const std::vector<Place> places = space.node_places();
  const auto put = [&](double &u, double &x, unsigned component, const auto &size) {
    std::tie(u, x) = extreme(space, displacement, places, component, size);
  };
  BoxMotion motion;
  const long node = space.find_dof(space.mesh().on_line(0), 0);
  motion.on_line = node < 0 ? 0 : displacement.local_element(static_cast<unsigned>(node));
  space.sum_over_ranks({&motion.on_line, 1});
  put(motion.largest, motion.largest_x, 0, [](double u) { return std::abs(u); });
  put(motion.deepest, motion.deepest_x, 2, [](double u) { return -u; });
  put(motion.highest, motion.highest_x, 2, [](double u) { return u; });
  motion.deepest = 0 - motion.deepest; // never -0
  return motion;
}

void add_box_motion(const BoxMotion &m, const MeshSpec &mesh, Summary &summary)
{
  summary.row("settled", "{:.3g} mm at most, before it moved", Value{"surface_motion.settled", m.settled, mm});
  summary.row("surface moved", "{:+.4f} m along x at x = {:.4g} m, most {:+.4f} m at {:.4g} m",
              Value{"surface_motion.along_x", m.on_line}, Value{"surface_motion.x", mesh.line[0]},
              Value{"surface_motion.largest", m.largest}, Value{"surface_motion.largest_x", m.largest_x});
  summary.row("surface sank", "{:.4f} m at x = {:.4g} m, rose {:.4f} m at {:.4g} m",
              Value{"surface_motion.settlement", m.deepest}, Value{"surface_motion.settlement_x", m.deepest_x},
              Value{"surface_motion.heave", m.highest}, Value{"surface_motion.heave_x", m.highest_x});
}
} // namespace isostat
