// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/box_motion.hpp"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace isostat
{
namespace
{
/// Also below a plate.
bool is_at_surface(const MeshSpec &mesh, const Place &place)
{
  return std::abs(mesh.depth(place)) < 1e-9 * mesh.soil.height();
}

/// u and its x where `size` of u is largest, the smallest x of several on a rank; over all ranks that of
/// the first.
template <typename Size>
std::array<double, 2> extreme(const FiniteElementSpace &space, const Vector &displacement,
                              const std::vector<Place> &places, unsigned component, const Size &size)
{
  struct
  {
    double size = 0;
    int rank = 0;
  } best;
  MPI_Comm_rank(space.communicator(), &best.rank);
  double found[2] = {0, 0};
  for (std::size_t i = component; i < places.size(); i += 3)
    if (const double u = displacement.local_element(i); is_at_surface(space.mesh(), places[i]))
      if (size(u) > best.size || (size(u) == best.size && size(u) > 0 && places[i][0] < found[1]))
        {
          best.size = size(u);
          found[0] = u;
          found[1] = places[i][0];
        }
  if (space.shared_out())
    {
      MPI_Allreduce(MPI_IN_PLACE, &best, 1, MPI_DOUBLE_INT, MPI_MAXLOC, space.communicator());
      MPI_Bcast(found, 2, MPI_DOUBLE, best.rank, space.communicator());
    }
  return {found[0], found[1]};
}
} // namespace

BoxMotion box_motion(const FiniteElementSpace &space, const Vector &displacement)
{
  const std::vector<Place> places = space.node_places();
  const auto along = [&](unsigned component, auto size) {
    return extreme(space, displacement, places, component, size);
  };
  BoxMotion motion;
  const long node = space.find_dof(space.mesh().on_line(0), 0);
  motion.on_line = node < 0 ? 0 : displacement.local_element(static_cast<unsigned>(node));
  if (space.shared_out())
    MPI_Allreduce(MPI_IN_PLACE, &motion.on_line, 1, MPI_DOUBLE, MPI_SUM, space.communicator());
  const auto put = [&](double &u, double &x, std::array<double, 2> found) { u = found[0], x = found[1]; };
  put(motion.largest, motion.largest_x, along(0, [](double u) { return std::abs(u); }));
  put(motion.deepest, motion.deepest_x, along(2, [](double u) { return -u; }));
  put(motion.highest, motion.highest_x, along(2, [](double u) { return u; }));
  motion.deepest = 0 - motion.deepest; // never -0
  return motion;
}

std::string to_text(const BoxMotion &m, const MeshSpec &mesh)
{
  return fmt::format("  settled                  {:.3g} mm at most, before it moved\n"
                     "  surface moved            {:+.4f} m along x at x = {:.4g} m, most {:+.4f} m at {:.4g} m\n"
                     "  surface sank             {:.4f} m at x = {:.4g} m, rose {:.4f} m at {:.4g} m\n",
                     1e3 * m.settled, m.on_line, mesh.line[0], m.largest, m.largest_x, m.deepest, m.deepest_x,
                     m.highest, m.highest_x);
}

Json to_json(const BoxMotion &m, const MeshSpec &mesh)
{
  return {{"settled", m.settled},        {"x", mesh.line[0]},        {"along_x", m.on_line},
          {"largest", m.largest},        {"largest_x", m.largest_x}, {"settlement", m.deepest},
          {"settlement_x", m.deepest_x}, {"heave", m.highest},       {"heave_x", m.highest_x}};
}
} // namespace isostat
