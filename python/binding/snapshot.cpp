// SPDX-License-Identifier: BSD-3-Clause
// Packings as arrays.   tested: tests/python/snapshot_test.py
#include "base/error.hpp"
#include "dem/measure/summary.hpp"
#include "dem/prepare/packing_check.hpp"
#include "python/binding/binding.hpp"
#include "python/binding/given.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

namespace isostat::python
{
namespace
{
using Self = py::object; ///< the owner of the arrays
using OptionalDoubles = std::optional<Doubles>;

const Snapshot &of(const Self &self) { return self.cast<const Snapshot &>(); }

template <auto values>
py::array of_grains(const Self &self)
{
  const Packing &grains = of(self).grains;
  return records(grains.*values, grains.n_grains(), self);
}

template <typename Value>
py::array of_contacts(const Self &self, std::size_t columns, const Value *(*first)(const Contact &))
{
  const auto &contacts = of(self).contacts;
  static const Contact none{};
  return view(first(contacts.empty() ? none : contacts[0]), contacts.size(), columns, sizeof(Contact), self);
}

template <Vec3 ContactHistory::*vector>
py::array history(const Self &self)
{
  return of_contacts<double>(self, 3, [](const Contact &c) { return (c.history.*vector).data(); });
}

/// Of three lengths or of edges in columns.   @throws InputError
PeriodicCell periodic_cell(const Doubles &cell)
{
  if (cell.ndim() == 1 && cell.size() == 3 && cell.at(0) > 0 && cell.at(1) > 0 && cell.at(2) > 0 &&
      std::isfinite(cell.at(0) * cell.at(1) * cell.at(2)))
    return PeriodicCell::with_edges({cell.at(0), cell.at(1), cell.at(2)});
  PeriodicCell found;
  if (cell.ndim() == 2 && cell.shape(0) == 3 && cell.shape(1) == 3)
    found.edges = py::cast<Mat3>(cell);
  found.reference_volume = found.edges.determinant();
  if (cell.size() != 9 || !(found.reference_volume > 0 && std::isfinite(found.reference_volume)))
    throw InputError("cell: must be three lengths, or three edges in the columns of a (3, 3) array that form a "
                     "right-handed cell, in m.");
  return found;
}

/// @throws InputError  not one of the two
void set_domain(Snapshot &snapshot, const OptionalDoubles &box, const OptionalDoubles &cell)
{
  if (box.has_value() == cell.has_value())
    throw InputError("give either box = [lower, upper] or cell, in m.");
  if (cell)
    {
      snapshot.cell = periodic_cell(*cell);
      return;
    }
  const std::vector<Vec3> corners = points(*box, "box");
  if (corners.size() != 2 || !((corners[1] - corners[0]).array() > 0).all())
    throw InputError("box: must be [lower, upper], two corners with lower < upper, in m.");
  snapshot.box = {corners[0], corners[1]};
}

/// As read_packing() does.
void check_spheres(const Snapshot &snapshot, bool anyway)
{
  if (!(snapshot.volume() > snapshot.grains.solid_volume()))
    throw InputError("box or cell: is smaller than the spheres in it. Are the radii in m?");
  try
    {
      warn_of(check_packing(snapshot, "spheres", [](const std::string &unit) {
        return unit == "m" ? std::string("give anyway=True")
                           : fmt::format("multiply centres, radii and box or cell by {}", unit == "mm" ? 1e-3 : 1e-6);
      }));
    }
  catch (const InputError &error)
    {
      if (!anyway)
        throw;
      warn_of({error.what()});
    }
}

/// Vectors of the grains where there are any.   @throws InputError  not one for each, not finite
std::vector<Vec3> motion(const OptionalDoubles &given, const char *name, std::size_t n)
{
  std::vector<Vec3> found = given ? points(*given, name) : std::vector<Vec3>();
  if (given && (found.size() != n || !std::ranges::all_of(found, [](const Vec3 &v) { return v.allFinite(); })))
    throw InputError(fmt::format("{}: must be finite, and as many as centres, of which there are {}.", name, n));
  return found;
}

/// @tparam checked  by check_spheres(), which takes `anyway`
template <bool checked>
Snapshot from_spheres(const Given<Doubles, "centres"> &centres, const Given<std::vector<double>, "radii"> &given_radii,
                      Given<double, "density"> density, const Given<OptionalDoubles, "box"> &box,
                      const Given<OptionalDoubles, "cell"> &cell,
                      const Given<std::optional<std::vector<std::uint32_t>>, "ids"> &ids,
                      const Given<OptionalDoubles, "velocities"> &velocities,
                      const Given<OptionalDoubles, "spins"> &spins, const Given<const Law *, "law"> &law,
                      Given<bool, "anyway"> anyway)
{
  const std::vector<Vec3> x = points(centres, "centres");
  const std::vector<double> &radii = given_radii;
  if (x.size() != radii.size() || x.empty())
    throw InputError(fmt::format("radii: must be as many as centres, and one at least; there are {} radii, {} centres.",
                                 radii.size(), x.size()));
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!(radii[i] > 0 && std::isfinite(radii[i])) || !x[i].allFinite())
      throw InputError("sphere " + std::to_string(i) +
                       ": a radius must be positive and finite, in m, and a centre finite.");
  if (!(density > 0 && std::isfinite(density)))
    throw InputError("density: must be positive and finite, in kg/m3.");
  const std::vector<Vec3> v = motion(velocities, "velocities", x.size()), w = motion(spins, "spins", x.size());
  Snapshot snapshot;
  snapshot.grains = make_packing(x, radii, density);
  if (ids.value)
    {
      if (std::set<std::uint32_t>(ids.value->begin(), ids.value->end()).size() != x.size() ||
          ids.value->size() != x.size())
        throw InputError("ids: must be as many as centres, each once.");
      snapshot.grains.id = *ids.value;
    }
  for (std::size_t i = 0; i < v.size(); ++i)
    snapshot.grains.set_linear_velocity(i, v[i]);
  for (std::size_t i = 0; i < w.size(); ++i)
    snapshot.grains.set_angular_velocity(i, w[i]);
  snapshot.law = *law.value;
  set_domain(snapshot, box, cell);
  if (checked)
    check_spheres(snapshot, anyway);
  return snapshot;
}

void add_grains(py::class_<Snapshot, std::shared_ptr<Snapshot>> &snapshot)
{
  snapshot
      .def(
          "__len__", [](const Snapshot &s) { return s.grains.n_grains(); }, "Number of grains.")
      .def_property_readonly("positions", &of_grains<&Packing::position>, "Centres, (n, 3), m.")
      .def_property_readonly(
          "velocities", &of_grains<&Packing::velocity>,
          "Of the half step before, (n, 3), m/s; in a cell without the part of its homogeneous motion.")
      .def_property_readonly("spins", &of_grains<&Packing::spin>,
                             "Of the half step before, (n, 3), rad/s; as velocities.")
      .def_property_readonly(
          "radii",
          [](const Self &self) {
            const Packing &grains = of(self).grains;
            return view(grains.position.data() + 3, grains.n_grains(), 0, 4 * sizeof(double), self);
          },
          "(n), m.")
      .def_property_readonly(
          "ids",
          [](const Self &self) {
            const Packing &grains = of(self).grains;
            return view(grains.id.data(), grains.n_grains(), 0, sizeof(grains.id[0]), self);
          },
          "Number of each grain in its specimen, (n).")
      .def_property_readonly(
          "masses",
          [](const Snapshot &s) {
            return computed<double>(s.grains.n_grains(), [&](auto i) { return s.grains.mass(i); });
          },
          "(n), kg; computed.")
      .def_property_readonly(
          "inertias",
          [](const Snapshot &s) {
            return computed<double>(s.grains.n_grains(), [&](auto i) { return s.grains.inertia(i); });
          },
          "Moments of inertia, (n), kg m2; computed.")
      .def_property_readonly(
          "density", [](const Snapshot &s) { return s.grains.density; }, "Of the grains, kg/m3.")
      .def_property_readonly(
          "d50", [](const Snapshot &s) { return s.grains.d50(); }, "Median diameter by volume, m.");
}

void add_contacts(py::class_<Snapshot, std::shared_ptr<Snapshot>> &snapshot)
{
  static_assert(offsetof(Contact, second) == offsetof(Contact, first) + sizeof(std::uint32_t));
  snapshot
      .def_property_readonly(
          "contact_pairs",
          [](const Self &self) {
            return of_contacts<std::uint32_t>(self, 2, [](const Contact &c) { return &c.first; });
          },
          "Indices of the two grains of each contact, (c, 2), first < second.")
      .def_property_readonly(
          "overlaps",
          [](const Self &self) { return of_contacts<double>(self, 0, [](const Contact &c) { return &c.overlap; }); },
          "(c), m.")
      .def_property_readonly(
          "normal_forces",
          [](const Self &self) {
            return of_contacts<double>(self, 0, [](const Contact &c) { return &c.normal_force; });
          },
          "(c), N, repulsion positive.")
      .def_property_readonly("normals", &history<&ContactHistory::normal>, "From first to second grain, (c, 3).")
      .def_property_readonly("shear_forces", &history<&ContactHistory::shear_force>, "On the second grain, (c, 3), N.")
      .def_property_readonly("bending_moments", &history<&ContactHistory::bending_moment>,
                             "Of rolling, on the second grain, (c, 3), N m.")
      .def_property_readonly("twisting_moments", &history<&ContactHistory::twisting_moment>,
                             "On the second grain, (c, 3), N m.")
      .def_property_readonly(
          "wall_contacts",
          [](const Snapshot &s) {
            py::list rows;
            for (const WallContact &c : s.wall_contacts)
              rows.append(py::make_tuple(c.grain, c.wall, c.overlap, c.normal_force));
            return rows;
          },
          "(grain, wall, overlap in m, normal force in N); walls 0..5 are x-, x+, y-, y+, z-, z+.");
}
} // namespace

void bind_snapshot(py::module_ &module)
{
  py::class_<Snapshot, std::shared_ptr<Snapshot>> snapshot(
      module, "Snapshot",
      "Grains and the contacts in force at one moment. Arrays are read-only views of its memory: nothing is copied, "
      "and\n"
      "they keep it alive. SI; stress and strain tensors are tension positive, p' and q compression positive.");
  snapshot
      .def_static(
          "from_spheres", &from_spheres<true>, py::arg("centres"), py::arg("radii"), py::kw_only(),
          py::arg("density") = 2650.0, py::arg("box") = py::none(), py::arg("cell") = py::none(),
          py::arg("ids") = py::none(), py::arg("velocities") = py::none(), py::arg("spins") = py::none(),
          py::arg("law") = Law(), py::arg("anyway") = false,
          "Spheres without contacts. Refuses numbers that are no spheres in a larger domain, and, unless "
          "`anyway`,\nwhat read_packing() refuses: lengths in mm, deep overlaps, spheres outside the box, densities "
          "not in kg/m3.\n\ncentres: (n, 3), m. radii: (n), m. density: of the grains, kg/m3.\n"
          "box: two corners, m; or cell: of a periodic packing, three lengths or the edges in columns, (3, 3), m.\n"
          "ids: (n), whole numbers; default: counted from 0. velocities: (n, 3), m/s, spins: (n, 3), rad/s; default: "
          "at "
          "rest.\n"
          "Contacts form when a run begins, without shear forces: begin with a `rebalance` stage.")
      .def_readonly("time", &Snapshot::time, "s.")
      .def_readonly("step", &Snapshot::step, "Time steps since the run began.")
      .def_readonly("strain", &Snapshot::strain, "Logarithmic, along x, y, z since shearing began, tension positive.")
      .def_readonly("law", &Snapshot::law, "The contact law.")
      .def_property_readonly("volume", &Snapshot::volume, "Of box or cell, m3.")
      .def_property_readonly(
          "void_ratio", [](const Snapshot &s) { return void_ratio(s.volume(), s.grains.solid_volume()); }, "e.")
      .def_property_readonly(
          "box",
          [](const Snapshot &s) -> py::object {
            if (s.cell)
              return py::none();
            Eigen::Matrix<double, 2, 3, Eigen::RowMajor> corners;
            corners << s.box.lower.transpose(), s.box.upper.transpose();
            return py::cast(corners);
          },
          "Lower and upper corner, (2, 3), m; None of a periodic cell.")
      .def_property_readonly(
          "cell", [](const Snapshot &s) -> py::object { return s.cell ? py::cast(s.cell->edges) : py::none(); },
          "Edges of the periodic cell in columns, (3, 3), m; None of a box.")
      .def("__repr__", [](const Snapshot &s) {
        return "<isostat.Snapshot of " + std::to_string(s.grains.n_grains()) + " grains, " +
               std::to_string(s.contacts.size()) + " contacts>";
      });
  add_grains(snapshot);
  add_contacts(snapshot);
  module.def("_spheres", &from_spheres<false>, py::arg("centres"), py::arg("radii"), py::kw_only(), py::arg("density"),
             py::arg("box"), py::arg("cell"), py::arg("ids"), py::arg("velocities"), py::arg("spins"),
             py::arg("law") = Law(), py::arg("anyway") = false);
}
} // namespace isostat::python
