// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "dem/io/sphere_table.hpp"
#include "dem/io/vtp.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <pugixml.hpp>
#include <sstream>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;

struct Arrays
{
  fs::path path;
  std::size_t header_bytes = 4; ///< of the length in front of binary data

  [[noreturn]] void refuse(const std::string &what) const
  {
    throw InputError(fmt::format("{}: {}", path.string(), what));
  }

  std::string decoded(const std::string &text) const
  {
    std::string bytes;
    std::uint32_t bits = 0, n_bits = 0;
    for (const char c : text)
      {
        const int digit = c >= 'A' && c <= 'Z'   ? c - 'A'
                          : c >= 'a' && c <= 'z' ? c - 'a' + 26
                          : c >= '0' && c <= '9' ? c - '0' + 52
                          : c == '+'             ? 62
                          : c == '/'             ? 63
                                                 : -1;
        if (digit < 0)
          continue; // blanks and the filling at the end
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        if ((n_bits += 6) >= 8)
          bytes += static_cast<char>(bits >> (n_bits -= 8) & 255);
      }
    if (bytes.size() < header_bytes)
      refuse("an array without content; is the file cut off?");
    return bytes.substr(header_bytes);
  }

  template <typename T>
  std::vector<double> of_type(const std::string &bytes) const
  {
    std::vector<double> values(bytes.size() / sizeof(T));
    for (std::size_t i = 0; i < values.size(); ++i)
      {
        T value;
        std::memcpy(&value, &bytes[i * sizeof(T)], sizeof(T));
        values[i] = static_cast<double>(value);
      }
    return values;
  }

  /// The numbers of a DataArray.
  std::vector<double> numbers(const pugi::xml_node &array) const
  {
    const std::string type = array.attribute("type").value(), format = array.attribute("format").value();
    const std::string name = array.attribute("Name").value(), text = array.text().get();
    if (format == "ascii")
      {
        std::vector<double> values;
        for (const std::string_view line : split_lines(text))
          for (const std::string_view word : split_words(line))
            if (double value = 0; parse(word, value))
              values.push_back(value);
            else
              refuse(fmt::format("\"{}\" in the array {}; expected numbers", word, name));
        return values;
      }
    if (format != "binary")
      refuse(fmt::format("the array {} is stored as {}; expected ascii, or binary without compression. Save it from "
                         "ParaView with data mode ASCII",
                         name, format));
    const std::string bytes = decoded(text);
    if (type == "Float64")
      return of_type<double>(bytes);
    if (type == "Float32")
      return of_type<float>(bytes);
    if (type == "Int64" || type == "UInt64")
      return of_type<std::int64_t>(bytes);
    if (type == "UInt32")
      return of_type<std::uint32_t>(bytes);
    if (type == "Int32")
      return of_type<std::int32_t>(bytes);
    refuse(fmt::format("the array {} is of type {}; expected Float64, Float32 or whole numbers", name, type));
  }

  /// One of these names; empty if there is none.
  std::vector<double> named(const pugi::xml_node &parent, const char *name) const
  {
    const pugi::xml_node array = parent.find_child_by_attribute("DataArray", "Name", name);
    return array ? numbers(array) : std::vector<double>();
  }
};

std::vector<Vec3> vectors(const std::vector<double> &values)
{
  std::vector<Vec3> v(values.size() / 3);
  for (std::size_t i = 0; i < v.size(); ++i)
    v[i] = Vec3(&values[3 * i]);
  return v;
}

/// The points of a piece with what they carry.
SphereTable read_points(const Arrays &arrays, const pugi::xml_node &piece)
{
  const pugi::xml_node data = piece.child("PointData"), points = piece.child("Points").child("DataArray");
  if (!points)
    arrays.refuse("no points; expected a DataArray in Points");
  SphereTable table;
  table.centres = vectors(arrays.numbers(points));
  table.radii = arrays.named(data, "radius");
  table.velocities = vectors(arrays.named(data, "velocity"));
  table.spins = vectors(arrays.named(data, "spin"));
  table.densities = arrays.named(data, "density");
  table.masses = arrays.named(data, "mass");
  for (const double id : arrays.named(data, "id"))
    {
      if (!is_count(id))
        arrays.refuse(fmt::format("id = {}; expected whole numbers from 0, below 2^32", id));
      table.ids.push_back(static_cast<std::uint32_t>(id));
    }
  const std::size_t n = table.centres.size();
  if (n != piece.attribute("NumberOfPoints").as_ullong())
    arrays.refuse(fmt::format("{} points, but {} are promised; is the file cut off?", n,
                              piece.attribute("NumberOfPoints").value()));
  const auto fits = [&](std::size_t size) { return size == 0 || size == n; };
  if (table.radii.size() != n || !fits(table.velocities.size()) || !fits(table.spins.size()) ||
      !fits(table.ids.size()) || !fits(table.densities.size()) || !fits(table.masses.size()))
    arrays.refuse(
        fmt::format("{} points with {} radii; expected point data `radius` (m), one for each point, and as many "
                    "of id, velocity, spin, density and mass if there are any",
                    n, table.radii.size()));
  return table;
}
} // namespace

ForeignPacking read_grains_vtp(const fs::path &path, const ReadOptions &options)
{
  pugi::xml_document document;
  const std::string text = read_text(path);
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  const pugi::xml_node file = document.child("VTKFile"), data = file.child("PolyData");
  Arrays arrays{path};
  if (!parsed || !data)
    arrays.refuse(
        fmt::format("no VTK PolyData ({}); expected an XML file <VTKFile type=\"PolyData\"> of grains as points",
                    parsed ? "another type" : parsed.description()));
  if (file.attribute("compressor"))
    arrays.refuse(
        "compressed; expected ascii, or binary without compression. Save it from ParaView with data mode ASCII");
  arrays.header_bytes = std::string(file.attribute("header_type").value()) == "UInt64" ? 8 : 4;
  if (std::string(file.attribute("byte_order").value()) == "BigEndian")
    arrays.refuse("its bytes are in the order of another processor (BigEndian); expected LittleEndian, or ascii");
  if (data.child("Piece").next_sibling("Piece"))
    arrays.refuse("several pieces; expected one with all grains. Save it from ParaView after the filter Merge Blocks");
  const SphereTable table = read_points(arrays, data.child("Piece"));
  table.check(path);
  const std::vector<double> box = arrays.named(data.child("FieldData"), "box"),
                            cell = arrays.named(data.child("FieldData"), "cell");
  ForeignPacking found;
  found.state.law = options.law;
  found.state.grains = table.packing(table.density(path, options.density, options.scale));
  if ((!cell.empty() && cell.size() != 9) || (!box.empty() && box.size() != 6))
    arrays.refuse(fmt::format("field data `box` of {} or `cell` of {} numbers; expected 6 (lower and upper corner, m) "
                              "or 9 (three edges, m)",
                              box.size(), cell.size()));
  if (!cell.empty())
    {
      found.state.cell.emplace();
      found.state.cell->edges = Eigen::Map<const Mat3>(cell.data());
      found.state.cell->reference_volume = found.state.cell->edges.determinant();
      if (!(found.state.cell->reference_volume > 0))
        arrays.refuse("the field data `cell` span no volume; expected nine numbers, three right-handed edges (m)");
      return found;
    }
  if (!box.empty())
    found.state.box = {Vec3(box.data()), Vec3(box.data() + 3)};
  else
    {
      found.state.box = table.bounding_box();
      found.notes.emplace_back("The file has no field data `box` or `cell`: the bounding box of the spheres is taken.");
    }
  table.check_inside(path, found.state.box);
  return found;
}
} // namespace isostat
