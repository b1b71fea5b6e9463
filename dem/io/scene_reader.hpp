// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/io/scene_document.hpp"
#include "dem/io/scene_schema.hpp"

namespace isostat
{
/// Fills a scene from a document: every key of the document is known and belongs there, every value has the form, unit
/// and range of the schema, what is left out takes its default. Rules between keys are left to check_scene.
/// @throws InputError      tested: tests/dem/scene_test.cpp, tests/dem/io/scene_error_test.cpp
Scene fill_scene(const SceneDocument &document);

/// Stores one value in its field.  @throws InputError through document.refuse(path, ...)
void read_value(const SceneDocument &document, const Key &key, const std::string &path, const toml::node &node,
                const Field &field);

/// Rules that bind several keys: those that exclude each other, limits in order, what needs the periodic cell.
/// @throws InputError      tested: tests/dem/scene_test.cpp, tests/dem/io/scene_error_test.cpp
void check_scene(const SceneDocument &document, const Scene &scene);
} // namespace isostat
