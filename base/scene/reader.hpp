// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/document.hpp"
#include "base/scene/schema.hpp"

namespace isostat
{
/// The text of a scene file.  @throws InputError if it is not there or cannot be read
std::string read_scene_text(const std::string &path);

/// The absolute path of a file that a scene names. It counts from the folder of the scene file or, if it is not there,
/// from the working directory.
/// @throws InputError  tested: tests/apps/deposit/scene_error_test.cpp
std::string found_file(const SceneDocument &document, const std::string &key, const std::string &scene_path,
                       const std::string &file);

/// Where a run goes whose scene does not say it: results/<scene file name without ending>.
std::string results_folder(const std::string &scene_path);

/// Fills a scene from a document: every key of the document is known and belongs there, every value has the form, unit
/// and range of the schema, what is left out takes its default. Rules between keys are left to check_groups and to the
/// owner of the schema.
/// @param scene  of the type that the schema's keys and arrays of tables were made for; with its defaults
/// @throws InputError      tested: tests/dem/scene/scene_test.cpp, tests/dem/scene/scene_error_test.cpp
void fill_scene(const SceneDocument &document, StructRef scene);

/// Stores one value in its field.  @throws InputError through document.refuse(path, ...)
void read_value(const SceneDocument &document, const Key &key, const std::string &path, const toml::node &node,
                const Field &field);

/// Keys of one group exclude each other, and of some groups one must be given. @param scene  as filled
/// @throws InputError      tested: tests/dem/scene/scene_error_test.cpp, tests/apps/deposit/scene_error_test.cpp
void check_groups(const SceneDocument &document, StructRef scene);

/// Number of the kind of a table, by its filled kind key.  @param place  entry of an array of tables, else the scene
std::size_t kind_number(const SceneSchema &schema, const Section &section, StructRef place);
/// Does the key belong to a table of this kind?
bool takes_key(const Key &key, std::size_t kind);
} // namespace isostat
