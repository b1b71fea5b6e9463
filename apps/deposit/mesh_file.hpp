// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <string>

namespace isostat
{
class SceneDocument;
struct ColumnScene;
struct GivenMesh;

/// The mesh that `mesh.file` names, null without one; its layers get what follows from it and they leave out: mean
/// thickness, and elements through it of the mean size. What follows reads and checks them as if the scene had them.
/// @param scene_path  the file is looked for as found_file() does; `found`: where it is
/// @throws InputError  with file:line of the scene or of the mesh   tested: tests/apps/deposit/mesh_file_test.cpp
std::shared_ptr<const GivenMesh> expand_mesh_file(SceneDocument &document, const std::string &scene_path,
                                                  std::string &found);

/// Rules of a mesh from a file.   @throws InputError   tested: tests/apps/deposit/mesh_file_test.cpp
void check_mesh_file(const SceneDocument &document, const ColumnScene &scene);
} // namespace isostat
