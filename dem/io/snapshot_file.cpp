// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/snapshot_file.hpp"

#include "base/error.hpp"
#include "dem/contact/law_parameters.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <fmt/format.h>

namespace isostat
{
namespace
{
using hdf5::Group;

/// One field of all rows as a column.
template <typename T, typename Row, typename Field>
std::vector<T> column(const std::vector<Row> &rows, Field field)
{
  std::vector<T> values(rows.size());
  std::transform(rows.begin(), rows.end(), values.begin(), field);
  return values;
}

template <typename Row, typename Field>
std::vector<double> vector_column(const std::vector<Row> &rows, Field field)
{
  std::vector<double> values;
  values.reserve(3 * rows.size());
  for (const Row &row : rows)
    for (double component : field(row))
      values.push_back(component);
  return values;
}

void write_law(Group group, Law law)
{
  if (!is_default(law))
    group.set_attribute("name", std::string(law->name()));
  for_each_parameter(*law.operator->(), [&]<typename Value>(const std::string &name, Value value) {
    if constexpr (std::is_same_v<Value, bool>)
      group.set_attribute(name, std::uint64_t{value});
    else
      group.set_attribute(name, value);
  });
}

Law read_law(const Group &group)
{
  Law law = group.has_attribute("name") ? law_named(group.attribute<std::string>("name")) : Law();
  for_each_parameter(*law.operator->(), [&]<typename Value>(const std::string &name, Value &value) {
    if constexpr (std::is_same_v<Value, bool>)
      value = group.attribute<std::uint64_t>(name) != 0;
    else
      value = group.attribute<double>(name);
  });
  return law;
}

void write_grains(Group group, const Packing &grains)
{
  const std::size_t n = 4 * grains.n_grains();
  assert(grains.position.size() >= n && grains.velocity.size() >= n && grains.spin.size() >= n);
  const auto records = [&](const char *name, const AlignedVector<double> &values, const char *unit,
                           const char *columns) {
    group.write(name, std::span(values.data(), n), unit, 4);
    group.set_attribute("columns", std::string(columns), name);
  };
  records("position", grains.position, "m", "x y z radius");
  records("velocity", grains.velocity, "m/s, 1/kg", "vx vy vz 1/mass");
  records("spin", grains.spin, "rad/s, 1/(kg m2)", "wx wy wz 1/inertia");
  group.write("id", grains.id, "-");
}

Packing read_grains(const Group &group, double density)
{
  const std::vector<std::uint32_t> id = group.read<std::uint32_t>("id");
  const std::size_t n = id.size();
  Packing grains = make_packing(std::vector<Vec3>(n, Vec3::Zero()), std::vector<double>(n, 1.0), density);
  grains.id = id;
  const auto records = [&](const char *name, AlignedVector<double> &values) {
    const std::vector<double> stored = group.read<double>(name, {n, 4});
    std::copy(stored.begin(), stored.end(), values.begin());
  };
  records("position", grains.position);
  records("velocity", grains.velocity);
  records("spin", grains.spin);
  return grains;
}

void write_contacts(Group group, const std::vector<Contact> &rows)
{
  group.write("first", column<std::uint32_t>(rows, [](const Contact &c) { return c.first; }), "-");
  group.write("second", column<std::uint32_t>(rows, [](const Contact &c) { return c.second; }), "-");
  group.write("overlap", column<double>(rows, [](const Contact &c) { return c.overlap; }), "m");
  group.write("normal_force", column<double>(rows, [](const Contact &c) { return c.normal_force; }), "N");
  for (const HistoryVector &v : history_vectors)
    group.write(v.name, vector_column(rows, [&](const Contact &c) -> const Vec3 & { return c.history.*v.place; }),
                v.unit, 3);
  if (const std::size_t n = rows.empty() ? 0 : rows[0].history.own.size(); n > 0)
    {
      std::vector<double> own;
      for (const Contact &c : rows)
        own.insert(own.end(), c.history.own.begin(), c.history.own.end());
      group.write("own", own, "-", n);
    }
}

std::vector<Contact> read_contacts(const Group &group, std::size_t n_grains)
{
  const std::vector<std::uint32_t> first = group.read<std::uint32_t>("first");
  const std::size_t n = first.size();
  const auto second = group.read<std::uint32_t>("second", {n});
  const auto overlap = group.read<double>("overlap", {n}), normal_force = group.read<double>("normal_force", {n});
  std::array<std::vector<double>, history_vectors.size()> vectors;
  for (std::size_t v = 0; v < vectors.size(); ++v)
    vectors[v] = group.read<double>(history_vectors[v].name, {n, 3});
  const std::vector<double> own = group.has("own") ? group.read<double>("own") : std::vector<double>();
  std::vector<Contact> rows(n);
  for (std::size_t i = 0; i < n; ++i)
    {
      if (!(first[i] < second[i] && second[i] < n_grains))
        throw InputError(
            fmt::format("{}: contact {} joins grains {} and {}; expected first < second < {} (the number of "
                        "grains). The file is damaged: write it again",
                        group.where(), i, first[i], second[i], n_grains));
      rows[i] = {first[i], second[i], overlap[i], normal_force[i], {}};
      for (std::size_t v = 0; v < vectors.size(); ++v)
        rows[i].history.*history_vectors[v].place = Vec3(&vectors[v][3 * i]);
      rows[i].history.own.assign(own.begin() + i * (own.size() / n), own.begin() + (i + 1) * (own.size() / n));
    }
  return rows;
}

void write_wall_contacts(Group group, const std::vector<WallContact> &rows)
{
  group.write("grain", column<std::uint32_t>(rows, [](const WallContact &c) { return c.grain; }), "-");
  group.write("wall", column<std::uint32_t>(rows, [](const WallContact &c) { return c.wall; }), "-");
  group.write("overlap", column<double>(rows, [](const WallContact &c) { return c.overlap; }), "m");
  group.write("normal_force", column<double>(rows, [](const WallContact &c) { return c.normal_force; }), "N");
}

std::vector<WallContact> read_wall_contacts(const Group &group, std::size_t n_grains)
{
  const std::vector<std::uint32_t> grain = group.read<std::uint32_t>("grain");
  const std::size_t n = grain.size();
  const auto wall = group.read<std::uint32_t>("wall", {n});
  const auto overlap = group.read<double>("overlap", {n}), normal_force = group.read<double>("normal_force", {n});
  std::vector<WallContact> rows(n);
  for (std::size_t i = 0; i < n; ++i)
    {
      if (!(grain[i] < n_grains && wall[i] < 6))
        throw InputError(
            fmt::format("{}: wall contact {} joins grain {} and wall {}; expected grain < {} and wall < 6. The "
                        "file is damaged: write it again",
                        group.where(), i, grain[i], wall[i], n_grains));
      rows[i] = {grain[i], static_cast<std::uint8_t>(wall[i]), overlap[i], normal_force[i]};
    }
  return rows;
}
void write_cell(Group group, const PeriodicCell &cell)
{
  PeriodicCell::for_each(cell, [&]<typename Value>(const char *name, const Value &value) {
    if constexpr (std::is_same_v<Value, Mat3>)
      {
        const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rows = value;
        group.write(name, std::span(rows.data(), 9), std::string_view(name) == "edges" ? "m" : "-", 3);
      }
    else
      group.set_attribute(name, value);
  });
}

PeriodicCell read_cell(const Group &group)
{
  PeriodicCell cell;
  PeriodicCell::for_each(cell, [&]<typename Value>(const char *name, Value &value) {
    if constexpr (std::is_same_v<Value, Mat3>)
      {
        const std::vector<double> rows = group.read<double>(name, {3, 3});
        value = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
      }
    else
      value = group.attribute<Value>(name);
  });
  return cell;
}
} // namespace

void write_snapshot(Group group, const Snapshot &snapshot)
{
  group.set_attribute("time", snapshot.time);
  group.set_attribute("step", snapshot.step);
  group.set_attribute("density", snapshot.grains.density);
  std::vector<double> box(6);
  for (int k = 0; k < 3; ++k)
    {
      box[k] = snapshot.box.lower[k];
      box[3 + k] = snapshot.box.upper[k];
    }
  group.write("box", box, "m", 3);
  group.write("strain", std::span(snapshot.strain.data(), 3), "-");
  write_law(group.create_group("law"), snapshot.law);
  write_grains(group.create_group("grains"), snapshot.grains);
  write_contacts(group.create_group("contacts"), snapshot.contacts);
  write_wall_contacts(group.create_group("wall_contacts"), snapshot.wall_contacts);
  if (snapshot.cell)
    write_cell(group.create_group("cell"), *snapshot.cell);
}

Snapshot read_snapshot(const Group &group)
{
  Snapshot snapshot;
  snapshot.time = group.attribute<double>("time");
  snapshot.step = group.attribute<std::uint64_t>("step");
  const std::vector<double> box = group.read<double>("box", {2, 3});
  snapshot.box = {Vec3(&box[0]), Vec3(&box[3])};
  snapshot.strain = Vec3(group.read<double>("strain", {3}).data());
  snapshot.law = read_law(group.group("law"));
  snapshot.grains = read_grains(group.group("grains"), group.attribute<double>("density"));
  const std::size_t n = snapshot.grains.n_grains();
  snapshot.contacts = read_contacts(group.group("contacts"), n);
  snapshot.wall_contacts = read_wall_contacts(group.group("wall_contacts"), n);
  if (group.has("cell"))
    snapshot.cell = read_cell(group.group("cell"));
  return snapshot;
}
} // namespace isostat
