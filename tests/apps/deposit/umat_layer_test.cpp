// SPDX-License-Identifier: BSD-3-Clause
// A layer whose law is a library, in a scene.
#include "tests/apps/deposit/scene_texts.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
TEST(UmatLayer, ComesBack)
{
  const std::string text =
      "[[layer]]\nthickness = \"5 m\"\nmaterial = \"umat\"\ncells = 5\numat.library = \"a \\\"b\\\".so\"\n"
      "umat.props = [1e9, -0.1, 0, 3]\numat.statev = [0.7]\n" +
      dry + dynamic;
  const ColumnScene scene = parse_column_scene(text, "s"), back = parse_column_scene(to_toml(scene), "resolved");
  const UmatParameters &law = scene.layers[0].umat;
  EXPECT_EQ(law, (UmatParameters{"a \"b\".so", {1e9, -0.1, 0, 3}, {0.7}, 0}));
  EXPECT_EQ(back, scene) << to_toml(scene);
  EXPECT_EQ(parse_column_scene(text, "s", {"layer.0.umat.nstatv=7"}).layers[0].umat.nstatv, 7u);
}

TEST(UmatLayer, Mistakes)
{
  const std::string umat = "[[layer]]\nthickness = \"5 m\"\nmaterial = \"umat\"\ncells = 5\n"; // lines 1 to 4
  expect_refused(umat + dry + dynamic, {"layer.0.umat.library; is missing. Give for example umat.library = "});
  const std::string whole = umat + "umat.library = \"a.so\"\n";
  EXPECT_EQ(test::refusal([&] { parse_column_scene(whole + dry + dynamic, "s"); }), "accepted");
  expect_refused(whole + "umat.props = 3\n" + dry + dynamic,
                 {"column.toml:6: layer.0.umat.props = 3; must be a list [...] of plain numbers"});
  expect_refused(whole + "umat.props = [\"3 Pa\"]\n" + dry + dynamic, {"column.toml:6:", "must be a plain number"});
  expect_refused(whole + "umat.statev = [1, 2]\numat.nstatv = 1\n" + dry + dynamic,
                 {"column.toml:7: layer.0.umat.nstatv = 1; must be at least 2, the number of values in umat.statev"});
  expect_refused(whole + "umat.nstatv = 0\n" + dry + dynamic, {"must be in [1, 10000000]", "leave it out"});
  expect_refused(layer + "umat.library = \"a.so\"\n" + dry + dynamic,
                 {"layer.0.umat", "does not belong to a layer of material \"elastic\""});
}
} // namespace
} // namespace isostat
