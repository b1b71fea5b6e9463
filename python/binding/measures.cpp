// SPDX-License-Identifier: BSD-3-Clause
// Measures of a snapshot.   tested: tests/python/snapshot_test.py
#include "dem/measure/stiffness.hpp"
#include "dem/measure/summary.hpp"
#include "dem/measure/unbalanced.hpp"
#include "python/binding/binding.hpp"

namespace isostat::python
{
namespace
{
/// All of an object's ISOSTAT_FIELDS.
template <typename Fields>
py::dict as_dict(const Fields &fields)
{
  py::dict found;
  Fields::for_each(fields, [&](const std::string &name, const auto &value) { found[name.c_str()] = value; });
  return found;
}

py::dict network(const Snapshot &snapshot, double yield_margin)
{
  const ContactNetwork n = contact_network(snapshot, yield_margin);
  py::dict found;
  found["redundancy_index"] = n.redundancy_index();
  found["redundancy_index_eq2"] = n.redundancy_index_eq2();
  found["redundancy_index_without_twist"] = n.redundancy_index_without_twist();
  found["redundancy_index_sliding"] = n.redundancy_index_sliding();
  found["constraints_of_a_contact"] = n.law.number();
  found["isostatic_coordination_number"] = isostatic_coordination(n.law.number());
  found["coordination_number"] = n.coordination_number();
  found["mechanical_coordination_number"] = n.mechanical_coordination_number();
  found["contacts"] = n.classes.total();
  found["neither"] = n.fraction(n.classes.nsr);
  found["sliding"] = n.fraction(n.classes.s);
  found["rolling"] = n.fraction(n.classes.r);
  found["sliding_and_rolling"] = n.fraction(n.classes.sr);
  found["grains_without_contact"] = n.grains.without;
  return found;
}

py::dict fabric_anisotropies(const Snapshot &snapshot)
{
  const Anisotropies a = anisotropies(snapshot);
  py::dict found;
  found["contact"] = a.contact.tensor;
  found["normal_force"] = a.normal_force.tensor;
  found["tangential_force"] = a.tangential_force.tensor;
  found["mean_normal_force"] = a.mean_normal_force;
  return found;
}

py::dict measures(const Snapshot &snapshot)
{
  const Micromechanics m = micromechanics(snapshot);
  const std::vector<double> row = m.row();
  py::dict found;
  for (std::size_t k = 0; k < row.size(); ++k)
    found[Micromechanics::columns()[k].first.c_str()] = row[k];
  return found;
}
} // namespace

void bind_measures(py::module_ &module)
{
  auto snapshot = py::class_<Snapshot, std::shared_ptr<Snapshot>>(module.attr("Snapshot"));
  snapshot
      .def(
          "stress", [](const Snapshot &s) -> Mat3 { return contact_stress(s); },
          "Love-Weber stress of all contacts, (3, 3), Pa, tension positive.")
      .def("fabric", &contact_fabric, "Contact-normal fabric (1/N) sum n n, (3, 3), trace 1.")
      .def("network", &network, py::arg("yield_margin") = yield_round_off,
           "Redundancy index I_R of the packing's contact law, in which 1 is isostatic, with the constraints of a "
           "contact and\n"
           "the coordination number at which it is 1 if nothing yields; Eq. (2) of the paper and two other counts; "
           "coordination\n"
           "numbers; shares of contacts that slide and roll: whose force is below its limit by this share at most.")
      .def("anisotropies", &fabric_anisotropies,
           "Second-order anisotropies of contacts, normal and tangential forces, (3, 3) each, and the mean normal "
           "force, N.")
      .def(
          "stored_energy", [](const Snapshot &s) { return as_dict(stored_energy(s)); }, "By kind, J.")
      .def(
          "stiffness",
          [](const Snapshot &s, bool yielding_contacts_resist) {
            const py::gil_scoped_release free;
            return condensed_stiffness(s, yielding_contacts_resist ? Sliding::elastic : Sliding::plastic);
          },
          py::arg("yielding_contacts_resist") = true,
          "Instantaneous stiffness of a periodic packing, (6, 6), Pa: stress xx, yy, zz, yz, xz, xy for strain in\n"
          "the same order, shear as gamma. All contacts elastic; with yielding_contacts_resist=False those within 1 %\n"
          "of a limit yield on, as in continued loading; not symmetric, and wrong for unloading.")
      .def("measures", &measures,
           "Scalars that a packing alone gives, as columns of the history, by name; SI, compression positive. "
           "measure_units()\n"
           "lists them; strains and the stresses of box or cell are columns of the history only.");
  module.def(
      "measure_units",
      [] {
        py::dict units;
        for (const auto &[name, unit] : Micromechanics::columns())
          units[name.c_str()] = unit;
        return units;
      },
      "Unit of each of Snapshot.measures().");
}
} // namespace isostat::python
