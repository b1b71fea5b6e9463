// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace isostat
{
/// Bytes of a file with a seal at their end: a word by which it is known, their number, and their check sum (hash.hpp),
/// 32 bytes in all. HDF5, and what reads it, takes no notice of what follows the end that the file itself names;
/// so the library, which crashes on some wrong bytes, is not asked to open them.
/// tested: tests/base/files/seal_test.cpp, fuzz_stored_packing
std::string sealed(std::string bytes);

/// The bytes without their seal; all of them if there is none, as in files of other programs, or changed by one.
/// @param path  for the message
/// @throws InputError  they are not those that were sealed; or an HDF5 file has lost its seal in part, or with the end
/// of its content, or something was added behind it
std::string_view unsealed(std::string_view bytes, const std::filesystem::path &path);

/// As unsealed(), of a file, in blocks of 1 MB. A file that was found whole is not read again until its size or the
/// time of its last change differ: a column asks one library for each of its packings.
void check_seal(const std::filesystem::path &path);
} // namespace isostat
