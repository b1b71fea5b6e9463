// SPDX-License-Identifier: BSD-3-Clause
// Pieces of column scenes for the tests.
#pragma once
#include "apps/deposit/scene.hpp"
#include "tests/support/refusal.hpp"

#include <string>
#include <vector>

namespace isostat
{
using Overrides = std::vector<std::string>;

inline const std::string layer_without_cells =
    "[[layer]]\nthickness = \"5 m\"\nmaterial = \"elastic\"\nshear_velocity = \"200 m/s\"\n";
inline const std::string layer = layer_without_cells + "cells = 10\n"; // lines 1 to 5
inline const std::string sand =
    "[[layer]]\nthickness = \"5 m\"\nmaterial = \"iwan\"\nshear_velocity = \"200 m/s\"\ncells = 5\n"; // lines 1 to 5
inline const std::string dry = "[water]\ndrainage = \"dry\"\n";
inline const std::string undrained = "[water]\ndrainage = \"undrained\"\n";
inline const std::string dynamic = "[analysis]\nduration = \"20 s\"\n";
inline const std::string smallest = layer + dry + dynamic;

inline const std::string consolidation =
    layer + "permeability = \"1e-6 m/s\"\n" + // lines 1 to 6
    "[load]\nkind = \"step\"\namplitude = \"100 kPa\"\n"
    "[analysis]\nkind = \"consolidation\"\nfirst_time = \"1 s\"\nlast_time = \"2 h\"\n";

/// The scene is refused, and each of the parts is in the message.
inline void expect_refused(const std::string &text, const std::vector<std::string> &parts,
                           const Overrides &overrides = {})
{
  test::expect_parts(test::refusal([&] { parse_column_scene(text, "column.toml", overrides); }), parts);
}
} // namespace isostat
