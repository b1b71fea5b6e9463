// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/pvd.hpp"

#include "base/files/vtk_xml.hpp"
#include "base/tell.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>

namespace isostat
{
namespace
{
/// The number at the end of its name: 12 of "paraview/grains_0012.vtp".
std::size_t number_of(const std::filesystem::path &file)
{
  const std::string stem = file.stem().string();
  const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
  std::size_t number = 0;
  std::from_chars(stem.data() + digits, stem.data() + stem.size(), number);
  return number;
}
} // namespace

PvdCollection::PvdCollection(std::filesystem::path path, std::size_t resume_entries) : path_(std::move(path))
{
  if (resume_entries == 0)
    return;
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_file(path_.c_str());
  for (pugi::xml_node entry : document.child("VTKFile").child("Collection").children("DataSet"))
    if (const std::string file = entry.attribute("file").value(); number_of(file) < resume_entries)
      entries_.emplace_back(entry.attribute("timestep").value(), file);
  n_lost_ = resume_entries - std::min(resume_entries, entries_.size());
  if (n_lost_ > 0)
    warn(fmt::format("{}: {} of {} files of the run are not in this list any more{}; ParaView still opens them "
                     "one by one",
                     path_.string(), n_lost_, resume_entries,
                     parsed ? "" : fmt::format(" ({})", parsed.description())));
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
