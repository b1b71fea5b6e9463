// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/python/soil_point_test.py
#pragma once
#include <pybind11/pybind11.h>

namespace isostat::python
{
/// isostat.column.SoilPoint, an element test of the material of a layer. After ColumnScene.
void add_soil_point(pybind11::module_ &module);
} // namespace isostat::python
