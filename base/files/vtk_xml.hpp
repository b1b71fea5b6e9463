// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/dem/io/vtp_test.cpp
#pragma once
#include <filesystem>
#include <pugixml.hpp>

namespace isostat
{
/// The root element of a VTK XML file of a type ("PolyData", "Collection"), little endian with 64-bit array headers.
pugi::xml_node vtk_file(pugi::xml_document &document, const char *type);

/// Writes a document aside and renames it. Throws RunFailure.
void save_xml(const pugi::xml_document &document, const std::filesystem::path &path);
} // namespace isostat
