// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/snapshot_file.hpp"

#include "base/error.hpp"

#include <algorithm>
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

void write_law(Group group, const LawParams &law)
{
  group.set_attribute("young", law.young);
  group.set_attribute("stiffness_ratio", law.stiffness_ratio);
  group.set_attribute("friction", law.friction);
  group.set_attribute("rolling_stiffness", law.rolling_stiffness);
  group.set_attribute("rolling_limit", law.rolling_limit);
  group.set_attribute("twisting_stiffness", law.twisting_stiffness);
  group.set_attribute("feature_friction", std::uint64_t{law.features.friction});
  group.set_attribute("feature_rolling", std::uint64_t{law.features.rolling});
  group.set_attribute("feature_twisting", std::uint64_t{law.features.twisting});
}

LawParams read_law(const Group &group)
{
  LawParams law;
  law.young = group.attribute<double>("young");
  law.stiffness_ratio = group.attribute<double>("stiffness_ratio");
  law.friction = group.attribute<double>("friction");
  law.rolling_stiffness = group.attribute<double>("rolling_stiffness");
  law.rolling_limit = group.attribute<double>("rolling_limit");
  law.twisting_stiffness = group.attribute<double>("twisting_stiffness");
  law.features.friction = group.attribute<std::uint64_t>("feature_friction") != 0;
  law.features.rolling = group.attribute<std::uint64_t>("feature_rolling") != 0;
  law.features.twisting = group.attribute<std::uint64_t>("feature_twisting") != 0;
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
  using History = const Vec3 &;
  group.write("first", column<std::uint32_t>(rows, [](const Contact &c) { return c.first; }), "-");
  group.write("second", column<std::uint32_t>(rows, [](const Contact &c) { return c.second; }), "-");
  group.write("overlap", column<double>(rows, [](const Contact &c) { return c.overlap; }), "m");
  group.write("normal_force", column<double>(rows, [](const Contact &c) { return c.normal_force; }), "N");
  group.write("normal", vector_column(rows, [](const Contact &c) -> History { return c.history.normal; }), "-", 3);
  group.write("shear_force", vector_column(rows, [](const Contact &c) -> History { return c.history.shear_force; }),
              "N", 3);
  group.write("bending_moment",
              vector_column(rows, [](const Contact &c) -> History { return c.history.bending_moment; }), "N m", 3);
  group.write("twisting_moment",
              vector_column(rows, [](const Contact &c) -> History { return c.history.twisting_moment; }), "N m", 3);
}

std::vector<Contact> read_contacts(const Group &group, std::size_t n_grains)
{
  const std::vector<std::uint32_t> first = group.read<std::uint32_t>("first");
  const std::size_t n = first.size();
  const auto second = group.read<std::uint32_t>("second", {n});
  const auto overlap = group.read<double>("overlap", {n}), normal_force = group.read<double>("normal_force", {n});
  const auto normal = group.read<double>("normal", {n, 3}), shear_force = group.read<double>("shear_force", {n, 3});
  const auto bending = group.read<double>("bending_moment", {n, 3});
  const auto twisting = group.read<double>("twisting_moment", {n, 3});
  std::vector<Contact> rows(n);
  for (std::size_t i = 0; i < n; ++i)
    {
      if (!(first[i] < second[i] && second[i] < n_grains))
        throw InputError(
            fmt::format("{}: contact {} joins grains {} and {}; expected first < second < {} (the number of "
                        "grains). The file is damaged: write it again",
                        group.where(), i, first[i], second[i], n_grains));
      rows[i] = {first[i], second[i], overlap[i], normal_force[i], {}};
      rows[i].history = {Vec3(&normal[3 * i]), Vec3(&shear_force[3 * i]), Vec3(&bending[3 * i]),
                         Vec3(&twisting[3 * i])};
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
} // namespace

namespace
{
void write_cell(Group group, const PeriodicCell &cell)
{
  const auto matrix = [&](const char *name, const Mat3 &m, const char *unit) {
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rows = m;
    group.write(name, std::span(rows.data(), 9), unit, 3);
  };
  matrix("edges", cell.edges, "m");
  matrix("deformation", cell.deformation, "-");
  matrix("rotation", cell.rotation, "-");
  matrix("strain_step", cell.strain_step, "-");
  group.set_attribute("volume_strain", cell.volume_strain);
  group.set_attribute("reference_volume", cell.reference_volume);
  group.set_attribute("flips", cell.flips);
}

PeriodicCell read_cell(const Group &group)
{
  const auto matrix = [&](const char *name) {
    const std::vector<double> rows = group.read<double>(name, {3, 3});
    return Mat3(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data()));
  };
  PeriodicCell cell;
  cell.edges = matrix("edges");
  cell.deformation = matrix("deformation");
  cell.rotation = matrix("rotation");
  cell.strain_step = matrix("strain_step");
  cell.volume_strain = group.attribute<double>("volume_strain");
  cell.reference_volume = group.attribute<double>("reference_volume");
  cell.flips = group.attribute<std::uint64_t>("flips");
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
