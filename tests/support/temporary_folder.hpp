// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/state/snapshot.hpp"
#include "tests/support/refusal.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <unistd.h>

namespace isostat
{
/// A folder of its own for each test, gone at the end.
class TemporaryFolder : public testing::Test
{
protected:
  TemporaryFolder()
  {
    std::string name = (std::filesystem::temp_directory_path() / "isostat_test_XXXXXX").string();
    folder = mkdtemp(name.data());
  }
  ~TemporaryFolder() override { std::filesystem::remove_all(folder); }

  std::filesystem::path put(const std::string &name, const std::string &text) const
  {
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }
  static std::string get(const std::filesystem::path &path)
  {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static void cut_to_half(const std::filesystem::path &path)
  {
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  }

  std::filesystem::path folder;
};

/// Three grains, two contacts with history, one wall contact; numbers that do not end in binary, a signed zero.
inline Snapshot small_snapshot()
{
  Snapshot s;
  s.grains = make_packing({Vec3(0.1, 0.2, 0.3), Vec3(0.4, 0.2, 0.3), Vec3(0.4, 0.5, 0.3)}, {0.16, 0.15, 0.16}, 2650.1);
  s.grains.id = {7, 3, 4000000000u};
  for (std::size_t i = 0; i < 3; ++i)
    {
      s.grains.set_linear_velocity(i, Vec3(0.1, -1.0 / 3, -0.0) * (i + 1));
      s.grains.set_angular_velocity(i, Vec3(1e-300, 1e300 / 7, -0.7) / (i + 1));
    }
  s.box = {Vec3(-0.05, -0.1, 0), Vec3(1.0 / 3 + 0.4, 0.9, 1.1)};
  s.law->friction = 0.7;
  s.law->young = 1.1e9;
  s.law.as<LinearRolling>().twisting = false;
  s.contacts = {{0, 1, 0.01, 12.3, {Vec3::UnitX(), Vec3(0, 8.61, 0), Vec3(0, 0, 0.1), Vec3(0.2, 0, 0)}},
                {1, 2, 0.02, 4.5, {Vec3::UnitY(), Vec3(0.1, 0, 1.0 / 3), Vec3(0, 0, -0.1), Vec3(0, -0.2, 0)}}};
  s.wall_contacts = {{0, 0, 0.01, 3.3}};
  s.time = 0.1 + 0.2;
  s.step = (std::uint64_t{1} << 53) + 1;
  s.strain = Vec3(0.005, -0.01, 0.005);
  return s;
}
} // namespace isostat
