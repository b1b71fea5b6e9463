// SPDX-License-Identifier: BSD-3-Clause
// Keys written once, in several kinds of scene and in fragments made of others.
#include "base/scene/fragment.hpp"

#include "base/error.hpp"
#include "base/scene/reader.hpp"
#include "base/scene/writer.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
struct Spring
{
  double stiffness = 2;
};
struct Body
{
  Spring spring;
  double mass = 1;
};
struct Train
{
  Spring coupling;
  std::vector<Body> bodies;
};

constexpr Range positive{0, 1e9, true};
constexpr Key spring_keys[] = {{.path = "stiffness",
                                .value = "2",
                                .range = positive,
                                .text = "Force per length.",
                                .field = [](Spring &s) -> Field { return &s.stiffness; }}};
SceneFragment<Spring> spring() { return {spring_keys}; }

constexpr Key mass_keys[] = {
    {.path = "mass", .value = "1", .text = "Mass.", .field = [](Body &b) -> Field { return &b.mass; }}};
SceneFragment<Body> body()
{
  static const KeyTable table{mass_keys, splice("", spring(), 0, [](Body &b) -> Spring & { return b.spring; })};
  return {table.keys()};
}

const SceneSchema &schema()
{
  static const KeyTable table{
      splice("coupling", spring(), 0, [](Train &t) -> Spring & { return t.coupling; }),
      splice("body", body(), 0, [](Train &, Body &b) -> Body & { return b; }),
  };
  static const Section sections[] = {{.name = "coupling", .text = "Between them."},
                                     {.name = "body", .text = "One.", .items = items_of<&Train::bodies>}};
  static const SceneSchema schema{.keys = table.keys(), .sections = sections, .groups = {}, .dimensions = {}};
  return schema;
}

Train parsed(const std::string &text)
{
  Train train;
  fill_scene(SceneDocument(schema(), text, "train.toml", {}), &train);
  return train;
}

TEST(SceneFragment, ReachesItsStructWhereverItLies)
{
  const Train train = parsed("[coupling]\nstiffness = 3\n[[body]]\nstiffness = 4\n[[body]]\nmass = 5\n");
  EXPECT_EQ(train.coupling.stiffness, 3);
  ASSERT_EQ(train.bodies.size(), 2u);
  EXPECT_EQ(train.bodies[0].spring.stiffness, 4);
  EXPECT_EQ(train.bodies[1].spring.stiffness, 2);
  EXPECT_EQ(train.bodies[1].mass, 5);
}

TEST(SceneFragment, IsWrittenAndCheckedAsKeysOfTheScene)
{
  const std::string text = "\n[coupling]\nstiffness = 3\n\n[[body]]\nmass = 5\nstiffness = 7\n";
  const Train train = parsed(text);
  EXPECT_EQ(write_scene(schema(), &train), text);
  EXPECT_THROW(parsed("[[body]]\nstiffness = -1\n"), InputError);
  EXPECT_EQ(schema().nearest_path("body.stifness"), "body.stiffness");
}
} // namespace
} // namespace isostat
