// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/base/files/json_test.cpp
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace isostat
{
/// A JSON value; members of an object keep the order in which they were given. This header only names the type: to
/// build or read a value include <nlohmann/json.hpp>, in a .cpp because that header is long.
using Json = nlohmann::ordered_json;

/// Writes `value` aside, then replaces `path`. A number is written with the fewest digits that read back as the
/// same double; nan and infinity, which JSON does not know, become null; bytes that are not UTF-8 become U+FFFD.
/// Throws RunFailure and leaves `path` as it was if it cannot be written.
void write_json(const std::filesystem::path &path, const Json &value);

/// Throws InputError if the file is missing or is not JSON.
Json read_json(const std::filesystem::path &path);
} // namespace isostat
