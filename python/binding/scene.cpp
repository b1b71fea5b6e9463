// SPDX-License-Identifier: BSD-3-Clause
// Scenes and contact laws.   tested: tests/python/scene_test.py
#include "dem/scene/scene.hpp"
#include "base/tell.hpp"
#include "dem/law/parameters.hpp"
#include "dem/prepare/specimen.hpp"
#include "python/binding/binding.hpp"

namespace isostat::python
{
namespace
{
py::dict parameters(const Law &law)
{
  py::dict found;
  for_each_parameter(*Law(law).operator->(),
                     [&](const std::string &name, auto &value) { found[name.c_str()] = value; });
  return found;
}
} // namespace

void bind_scene(py::module_ &module)
{
  py::class_<Law>(module, "Law", "A contact law with its parameters, in SI; friction as tan(phi).")
      .def_property_readonly(
          "name", [](const Law &law) { return law->name(); }, "As the key law of a scene.")
      .def_property_readonly("parameters", &parameters, "Numbers and switches by name, in SI.")
      .def(
          "__eq__", [](const Law &one, const Law &other) { return one == other; }, py::is_operator())
      .def("__repr__", [](const Law &law) {
        return "<isostat.Law " + std::string(law->name()) + " " + std::string(py::str(parameters(law))) + ">";
      });

  py::class_<Scene>(module, "Scene")
      .def(py::init([](const std::string &text, const std::string &name, const std::vector<std::string> &overrides,
                       bool is_file) {
             if (is_file)
               return read_scene(name, overrides);
             Scene scene = parse_scene(text, name, overrides);
             for (const std::string &warning : beyond_sand(scene))
               warn(warning);
             return scene;
           }),
           py::arg("text"), py::arg("name"), py::arg("overrides"), py::arg("is_file") = false)
      .def_readonly("title", &Scene::title, "What heads tables and figures.")
      .def_readonly("law", &Scene::contact, "The contact law.")
      .def_property_readonly(
          "folder", [](const Scene &scene) { return scene.output.folder; },
          "Where run() leaves results unless a folder is given: results/<name of the scene file>.")
      .def_property_readonly("recipe", &specimen_recipe,
                             "Everything that its prepared specimen depends on: the key of the cache and of a library.")
      .def_property_readonly("text", &to_toml, "The whole scene as TOML: every key with its value and unit.")
      .def(
          "__eq__", [](const Scene &one, const Scene &other) { return one == other; }, py::is_operator())
      .def("__hash__", [](const Scene &scene) { return py::hash(py::str(to_toml(scene))); })
      .def("__str__", &to_toml);

  module.def("default_scene", &default_scene, "A commented scene with all defaults, units and ranges, as text.");
  module.def("scene_manual", &scene_manual, "The table of all keys, as Markdown.");
}
} // namespace isostat::python
