// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/python/column_test.py
#pragma once
#include "fem/material/material.hpp"
#include "python/binding/arrays.hpp"

namespace isostat::python
{
/// Points whose law is an isostat.Material of Python (python/isostat/column.py), of which the state is a dictionary of
/// arrays. It is called without the GIL, as all of a solver is. Exceptions of Python pass through.
/// @throws RunFailure  naming the point, if a stress is not finite   @throws InputError  an array of another shape
class PythonMaterial : public Material
{
public:
  /// With the GIL.   @param layer  its name, for messages
  PythonMaterial(py::object law, std::string layer, std::size_t n_points);
  ~PythonMaterial() override;

  std::string name() const override;
  std::size_t n_points() const override { return n_points_; }
  void set_initial_stress(std::span<const Stress> effective) override;
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  void commit() override;
  void rollback() override;
  void stiffness(std::span<Stiffness> tangents) const override;
  void wave_moduli(std::span<WaveModuli> moduli) const override;
  MaterialState pack() const override;
  void unpack(const MaterialState &state) override;

private:
  using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
  Array shaped(const py::object &value, const char *what, std::vector<std::size_t> shape) const;

  py::object law_, committed_, trial_; ///< trial_: none if there is none
  std::string layer_;
  std::size_t n_points_;
};
} // namespace isostat::python
