// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/vtp.hpp"

#include "base/files/vtk_xml.hpp"
#include "dem/measure/redundancy.hpp"

#include <cstring>
#include <fmt/format.h>
#include <numbers>
#include <numeric>
#include <span>

namespace isostat
{
namespace
{
std::string base64(const std::string &bytes)
{
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3)
    {
      std::uint32_t group = 0;
      for (std::size_t k = 0; k < 3; ++k)
        group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
      for (std::size_t k = 0; k < 4; ++k)
        text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
  return text;
}

template <typename T>
constexpr const char *vtk_type = nullptr;
template <>
constexpr const char *vtk_type<double> = "Float64";
template <>
constexpr const char *vtk_type<std::int64_t> = "Int64";
template <>
constexpr const char *vtk_type<std::uint32_t> = "UInt32";
template <>
constexpr const char *vtk_type<std::uint8_t> = "UInt8";

/// One array, inline: its length in bytes (UInt64) and its bytes, encoded together.
template <typename T>
void add_array(pugi::xml_node parent, const char *name, const std::vector<T> &values, int n_components = 1)
{
  const std::uint64_t n_bytes = values.size() * sizeof(T);
  std::string bytes(sizeof n_bytes + n_bytes, '\0');
  std::memcpy(bytes.data(), &n_bytes, sizeof n_bytes);
  if (n_bytes > 0)
    std::memcpy(bytes.data() + sizeof n_bytes, values.data(), n_bytes);
  pugi::xml_node array = parent.append_child("DataArray");
  array.append_attribute("type") = vtk_type<T>;
  array.append_attribute("Name") = name;
  array.append_attribute("NumberOfComponents") = n_components;
  array.append_attribute("format") = "binary";
  array.text() = base64(bytes).c_str();
}

/// The first three of each four-wide record.
std::vector<double> vectors(const AlignedVector<double> &records, std::size_t n)
{
  std::vector<double> values;
  values.reserve(3 * n);
  for (std::size_t i = 0; i < n; ++i)
    values.insert(values.end(), &records[4 * i], &records[4 * i] + 3);
  return values;
}

std::vector<std::int64_t> counting(std::int64_t n, std::int64_t first)
{
  std::vector<std::int64_t> values(n);
  std::iota(values.begin(), values.end(), first);
  return values;
}

/// Piece with its points (x y z each); `Verts` or `Lines` and the data follow.
pugi::xml_node add_piece(pugi::xml_node data, const std::vector<double> &points, std::size_t n_verts,
                         std::size_t n_lines)
{
  pugi::xml_node piece = data.append_child("Piece");
  piece.append_attribute("NumberOfPoints") = static_cast<unsigned long long>(points.size() / 3);
  piece.append_attribute("NumberOfVerts") = static_cast<unsigned long long>(n_verts);
  piece.append_attribute("NumberOfLines") = static_cast<unsigned long long>(n_lines);
  piece.append_attribute("NumberOfStrips") = 0;
  piece.append_attribute("NumberOfPolys") = 0;
  add_array(piece.append_child("Points"), "position", points, 3);
  return piece;
}

/// What bounds the grains, as field data.
void add_bounds(pugi::xml_node data, const Snapshot &s)
{
  const Vec3 &a = s.box.lower, &b = s.box.upper;
  std::vector<double> values = {a[0], a[1], a[2], b[0], b[1], b[2]};
  if (s.cell)
    values.assign(s.cell->edges.data(), s.cell->edges.data() + 9);
  pugi::xml_node field = data.append_child("FieldData");
  add_array(field, s.cell ? "cell" : "box", values);
  field.first_child().append_attribute("NumberOfTuples") = static_cast<unsigned long long>(values.size());
}

/// Lines of force chains, two points each, and what they carry.
struct Chains
{
  std::vector<double> points, normal_force, shear_force;
  std::vector<std::uint8_t> sliding, rolling;

  void add_line(const Vec3 &from, const Vec3 &to, const Contact &contact, const YieldState &yield)
  {
    for (const Vec3 &x : {from, to})
      {
        points.insert(points.end(), x.begin(), x.end());
        normal_force.push_back(contact.normal_force);
        shear_force.push_back(contact.history.shear_force.norm());
        sliding.push_back(yield.sliding);
        rolling.push_back(yield.rolling);
      }
  }

  void add(const Snapshot &s, const Contact &c)
  {
    const YieldState yield = s.law->yield(s.closed(c), yield_round_off);
    const Vec3 from = s.grains.centre(c.first), to = s.grains.centre(c.second), &normal = c.history.normal;
    const double first = s.grains.radius(c.first) - 0.5 * c.overlap,
                 second = s.grains.radius(c.second) - 0.5 * c.overlap;
    // Another image of the second grain is further away than the sum of both radii.
    if (!s.cell || (to - from - (first + second) * normal).norm() < first + second)
      return add_line(from, to, c, yield);
    add_line(from, from + first * normal, c, yield);
    add_line(to - second * normal, to, c, yield);
  }
};
} // namespace

std::vector<double> grain_pressure(const Snapshot &snapshot)
{
  const Packing &grains = snapshot.grains;
  std::vector<double> pressure(grains.n_grains(), 0.0);
  const auto add = [&](std::uint32_t i, double overlap, double force) {
    const double r = grains.radius(i);
    pressure[i] += force * (r - 0.5 * overlap) / (4 * std::numbers::pi * r * r * r);
  };
  for (const Contact &c : snapshot.contacts)
    {
      add(c.first, c.overlap, c.normal_force);
      add(c.second, c.overlap, c.normal_force);
    }
  for (const WallContact &c : snapshot.wall_contacts)
    add(c.grain, c.overlap, c.normal_force);
  return pressure;
}

void write_grains_vtp(const std::filesystem::path &path, const Snapshot &snapshot)
{
  const Packing &grains = snapshot.grains;
  const std::size_t n = grains.n_grains();
  pugi::xml_document document;
  pugi::xml_node poly = vtk_file(document, "PolyData").append_child("PolyData");
  add_bounds(poly, snapshot);
  pugi::xml_node piece = add_piece(poly, vectors(grains.position, n), n, 0);
  pugi::xml_node verts = piece.append_child("Verts");
  add_array(verts, "connectivity", counting(n, 0));
  add_array(verts, "offsets", counting(n, 1));
  pugi::xml_node data = piece.append_child("PointData");
  add_array(data, "id", grains.id);
  add_array(data, "radius", grains.radii());
  add_array(data, "velocity", vectors(grains.velocity, n), 3);
  add_array(data, "spin", vectors(grains.spin, n), 3);
  add_array(data, "coordination", contacts_of_grains(snapshot, true));
  add_array(data, "pressure", grain_pressure(snapshot));
  save_xml(document, path);
}

void write_force_chains_vtp(const std::filesystem::path &path, const Snapshot &snapshot)
{
  Chains chains;
  for (const Contact &c : snapshot.contacts)
    chains.add(snapshot, c);
  const std::size_t n_points = chains.normal_force.size();
  std::vector<std::int64_t> ends = counting(static_cast<std::int64_t>(n_points), 0), offsets;
  for (std::size_t k = 2; k <= n_points; k += 2)
    offsets.push_back(static_cast<std::int64_t>(k));
  pugi::xml_document document;
  pugi::xml_node poly = vtk_file(document, "PolyData").append_child("PolyData");
  pugi::xml_node piece = add_piece(poly, chains.points, 0, offsets.size());
  pugi::xml_node lines = piece.append_child("Lines");
  add_array(lines, "connectivity", ends);
  add_array(lines, "offsets", offsets);
  pugi::xml_node data = piece.append_child("PointData");
  add_array(data, "normal_force", chains.normal_force);
  add_array(data, "shear_force", chains.shear_force);
  add_array(data, "sliding", chains.sliding);
  add_array(data, "rolling", chains.rolling);
  save_xml(document, path);
}
} // namespace isostat
