// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/pvd.hpp"

#include "base/error.hpp"
#include "base/files/vtk_xml.hpp"

#include <fmt/format.h>

namespace isostat
{
PvdCollection::PvdCollection(std::filesystem::path path, std::size_t resume_entries) : path_(std::move(path))
{
  if (resume_entries == 0)
    return;
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_file(path_.c_str());
  if (!parsed)
    throw InputError(fmt::format("{}: cannot be resumed: {}; restore the file or start the run anew", path_.string(),
                                 parsed.description()));
  for (pugi::xml_node entry : document.child("VTKFile").child("Collection").children("DataSet"))
    if (entries_.size() < resume_entries)
      entries_.emplace_back(entry.attribute("timestep").value(), entry.attribute("file").value());
  if (entries_.size() < resume_entries)
    throw InputError(fmt::format("{}: {} entries, expected at least {}; restore the file or resume from an earlier "
                                 "checkpoint",
                                 path_.string(), entries_.size(), resume_entries));
}

void PvdCollection::append(double time, const std::string &file)
{
  entries_.emplace_back(fmt::format("{}", time), file);
  pugi::xml_document document;
  pugi::xml_node collection = vtk_file(document, "Collection").append_child("Collection");
  for (const auto &[timestep, name] : entries_)
    {
      pugi::xml_node entry = collection.append_child("DataSet");
      entry.append_attribute("timestep") = timestep.c_str();
      entry.append_attribute("part") = "0";
      entry.append_attribute("file") = name.c_str();
    }
  save_xml(document, path_);
}
} // namespace isostat
