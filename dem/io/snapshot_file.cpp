// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/snapshot_file.hpp"

#include "base/error.hpp"
#include "base/record/file_format.hpp"
#include "dem/law/parameters.hpp"

#include <algorithm>
#include <cassert>
#include <fmt/format.h>
#include <functional>
#include <limits>

namespace isostat
{
namespace
{
using hdf5::Group;

constexpr std::uint64_t snapshot_file_schema_version = 1;

/// One field of all rows as a column, whole numbers with 32 bits, and back.
template <typename Row, typename T>
void write_column(Group &group, const char *name, const std::vector<Row> &rows, T Row::*field, const char *unit)
{
  std::vector<std::conditional_t<std::is_integral_v<T>, std::uint32_t, T>> values(rows.size());
  std::transform(rows.begin(), rows.end(), values.begin(), std::mem_fn(field));
  group.write(name, values, unit);
}

template <typename Row, typename T>
void read_column(const Group &group, const char *name, std::vector<Row> &rows, T Row::*field)
{
  using Stored = std::conditional_t<std::is_integral_v<T>, std::uint32_t, T>;
  const std::vector<Stored> values = group.read<Stored>(name, {rows.size()});
  for (std::size_t i = 0; i < rows.size(); ++i)
    if constexpr (std::is_integral_v<T>) // what does not fit stays out of range
      rows[i].*field = static_cast<T>(std::min<Stored>(values[i], std::numeric_limits<T>::max()));
    else
      rows[i].*field = values[i];
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

/// One over the fourth number of each record: masses and moments of inertia.
std::vector<double> inverses(const AlignedVector<double> &records, std::size_t n_grains)
{
  std::vector<double> values(n_grains);
  for (std::size_t i = 0; i < n_grains; ++i)
    values[i] = 1 / records[4 * i + 3];
  return values;
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
  group.write("mass", inverses(grains.velocity, grains.n_grains()), "kg");
  group.write("inertia", inverses(grains.spin, grains.n_grains()), "kg m2");
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
  write_column(group, "first", rows, &Contact::first, "-");
  write_column(group, "second", rows, &Contact::second, "-");
  write_column(group, "overlap", rows, &Contact::overlap, "m");
  write_column(group, "normal_force", rows, &Contact::normal_force, "N");
  for (const HistoryVector &v : history_vectors)
    {
      std::vector<double> values;
      for (const Contact &c : rows)
        values.insert(values.end(), (c.history.*v.place).begin(), (c.history.*v.place).end());
      group.write(v.name, values, v.unit, 3);
    }
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
  std::vector<Contact> rows(group.shape("first")[0]);
  read_column(group, "first", rows, &Contact::first);
  read_column(group, "second", rows, &Contact::second);
  read_column(group, "overlap", rows, &Contact::overlap);
  read_column(group, "normal_force", rows, &Contact::normal_force);
  for (const HistoryVector &v : history_vectors)
    {
      const std::vector<double> values = group.read<double>(v.name, {rows.size(), 3});
      for (std::size_t i = 0; i < rows.size(); ++i)
        rows[i].history.*v.place = Vec3(&values[3 * i]);
    }
  const std::vector<double> own = group.has("own") ? group.read<double>("own") : std::vector<double>();
  for (std::size_t i = 0; i < rows.size(); ++i)
    {
      const auto [first, second] = std::pair(rows[i].first, rows[i].second);
      if (!(first < second && second < n_grains))
        throw InputError(
            fmt::format("{}: contact {} joins grains {} and {}; expected first < second < {} (the number of "
                        "grains). The file is damaged: write it again",
                        group.where(), i, first, second, n_grains));
      const std::size_t n_own = own.size() / rows.size();
      rows[i].history.own.assign(own.begin() + i * n_own, own.begin() + (i + 1) * n_own);
    }
  return rows;
}

void write_wall_contacts(Group group, const std::vector<WallContact> &rows)
{
  write_column(group, "grain", rows, &WallContact::grain, "-");
  write_column(group, "wall", rows, &WallContact::wall, "-");
  write_column(group, "overlap", rows, &WallContact::overlap, "m");
  write_column(group, "normal_force", rows, &WallContact::normal_force, "N");
}

std::vector<WallContact> read_wall_contacts(const Group &group, std::size_t n_grains)
{
  std::vector<WallContact> rows(group.shape("grain")[0]);
  read_column(group, "grain", rows, &WallContact::grain);
  read_column(group, "wall", rows, &WallContact::wall);
  read_column(group, "overlap", rows, &WallContact::overlap);
  read_column(group, "normal_force", rows, &WallContact::normal_force);
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (!(rows[i].grain < n_grains && rows[i].wall < 6))
      throw InputError(
          fmt::format("{}: wall contact {} joins grain {} and wall {}; expected grain < {} and wall < 6. The file is "
                      "damaged: write it again",
                      group.where(), i, rows[i].grain, rows[i].wall, n_grains));
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
  Eigen::Matrix<double, 6, 1> box;
  box << snapshot.box.lower, snapshot.box.upper;
  group.write("box", std::span(box.data(), 6), "m", 3);
  if (const HomogeneousMotion &u = snapshot.wall_motion; u != HomogeneousMotion{})
    {
      group.write("wall_motion_rate", std::span(u.rate, 3), "1/s");
      group.write("wall_motion_shift", std::span(u.shift, 3), "m/s");
    }
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
  if (group.has("wall_motion_rate"))
    {
      std::ranges::copy(group.read<double>("wall_motion_rate", {3}), snapshot.wall_motion.rate);
      std::ranges::copy(group.read<double>("wall_motion_shift", {3}), snapshot.wall_motion.shift);
    }
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

void write_snapshot_file(const std::filesystem::path &path, const Snapshot &snapshot)
{
  hdf5::File file = hdf5::File::create(path);
  set_format(file.root(), snapshot_format, snapshot_file_schema_version);
  write_snapshot(file.root().create_group("snapshot"), snapshot);
  file.commit();
}

Snapshot read_snapshot_file(const std::filesystem::path &path)
{
  const hdf5::File file = hdf5::File::open(path);
  const Group root = file.root();
  refuse_newer(root, snapshot_file_schema_version);
  return read_snapshot(format_of(root).empty() && root.has("grains") ? root : root.group("snapshot"));
}
} // namespace isostat
