// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <string_view>
#include <toml++/toml.h>

namespace isostat
{
/// The tree of a TOML text, for any bytes: toml++ 3.3 and 3.4 alone abort or are undefined for some wrong ones.
/// @param name  of the file, for messages and for the places of nodes
/// @throws InputError "name:line: is not valid TOML: ..."
/// tested: tests/base/scene/toml_text_test.cpp, tests/dem/scene/scene_error_test.cpp, tests/fuzz/scene.cpp
toml::table parse_toml(std::string_view text, const std::string &name);
} // namespace isostat
