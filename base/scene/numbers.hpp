// SPDX-License-Identifier: BSD-3-Clause
// Parameters that come from a program rather than from a scene, by the keys that scenes have for them.
#pragma once
#include "base/scene/schema.hpp"

#include <vector>

namespace isostat
{
/// The numbers of a struct that are set, in the order of its keys; as the program keeps them.
std::vector<double> numbers_of(std::span<const Key> keys, StructRef place);

/// "friction_angle = 40 deg", with the unit of the key.   @param value  as the program keeps it
std::string number_in_words(const Key &key, double value);

/// @param who  begins the message, "iwan: "
/// @throws InputError  "iwan: exponent = 2; must be in [0, 1] because ...; give a value in that range"
/// tested: tests/fem/material/mohr_coulomb_test.cpp, tests/dem/rve/rve_test.cpp
void check_numbers(std::span<const Key> keys, StructRef place, std::string_view who);
} // namespace isostat
