// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/vtk_xml.hpp"

#include "base/files/replace_file.hpp"

#include <sstream>

namespace isostat
{
pugi::xml_node vtk_file(pugi::xml_document &document, const char *type)
{
  pugi::xml_node root = document.append_child("VTKFile");
  root.append_attribute("type") = type;
  root.append_attribute("version") = "1.0";
  root.append_attribute("byte_order") = "LittleEndian";
  root.append_attribute("header_type") = "UInt64";
  return root;
}

void save_xml(const pugi::xml_document &document, const std::filesystem::path &path)
{
  std::ostringstream text;
  document.save(text, " ");
  write_replacing(path, text.str());
}
} // namespace isostat
