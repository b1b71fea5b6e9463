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
                                .field = member<&Spring::stiffness>,
                                .value = "2",
                                .range = positive,
                                .text = "Force per length."}};
SceneFragment<Spring> spring() { return {spring_keys}; }

constexpr Key mass_keys[] = {{.path = "mass", .field = member<&Body::mass>, .value = "1", .text = "Mass."}};
SceneFragment<Body> body()
{
  static const KeyTable table{mass_keys, splice<&Body::spring>("", spring())};
  return {table.keys()};
}

const SceneSchema &schema()
{
  static const KeyTable table{
      splice<&Train::coupling>("coupling", spring()),
      KeyRun(body().keys, "body"),
  };
  static const Section sections[] = {{.name = "coupling", .text = "Between them."},
                                     {.name = "body", .text = "One.", .items = items_of<&Train::bodies>}};
  static const SceneSchema schema{.keys = table.keys(), .sections = sections, .groups = {}, .dimensions = {}};
  return schema;
}

Train parsed(const std::string &text)
{
  Train train;
  fill_scene(SceneDocument(schema(), text, "train.toml", {}), train);
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
  EXPECT_EQ(write_scene(schema(), train), text);
  EXPECT_THROW(parsed("[[body]]\nstiffness = -1\n"), InputError);
  EXPECT_EQ(schema().nearest_path("body.stifness"), "body.stiffness");
}

struct Circle
{
  double radius = 3;
};
struct Square
{
  double edge = 4, radius = 5; ///< of its corners
};
struct Shape
{
  enum class Kind
  {
    circle,
    square
  } kind;
  Circle circle;
  Square square;
};
struct Drawing
{
  std::vector<Shape> shapes;
};

constexpr Key shape_keys[] = {
    {.path = "edge", .field = member<&Shape::square, &Square::edge>, .value = "4", .kinds = 2, .text = "Size."},
    {.path = "radius", .field = member<&Shape::circle, &Circle::radius>, .value = "3", .kinds = 1, .text = "Size."},
    {.path = "radius", .field = member<&Shape::square, &Square::radius>, .value = "5", .kinds = 2, .text = "Corners."}};
constexpr const char *shape_names[] = {"circle", "square"};
constexpr Key kind_keys[] = {{.path = "kind",
                              .field = member<&Shape::kind>,
                              .presence = Presence::required,
                              .value = "circle",
                              .choices = shape_names,
                              .kinds = 3,
                              .text = "Which."}};

const SceneSchema &drawing_schema()
{
  static const KeyTable table{KeyRun(kind_keys, "shape"), KeyRun(shape_keys, "shape")};
  static constexpr Section sections[] = {
      {.name = "shape", .text = "s", .kind_key = "kind", .items = items_of<&Drawing::shapes>}};
  static const SceneSchema schema{.keys = table.keys(), .sections = sections, .groups = {}, .dimensions = {}};
  return schema;
}

Drawing drawing(const std::string &text)
{
  Drawing scene;
  fill_scene(SceneDocument(drawing_schema(), text, "drawing.toml", {}), scene);
  return scene;
}

TEST(SceneFragment, BelongsToItsKind)
{
  const Drawing scene = drawing("[[shape]]\nkind = \"square\"\nedge = 9\n[[shape]]\nkind = \"circle\"\n");
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(scene.shapes[0].square.edge, 9);
  EXPECT_EQ(scene.shapes[0].square.radius, 5);
  EXPECT_EQ(scene.shapes[1].circle.radius, 3);
  EXPECT_EQ(write_scene(drawing_schema(), scene), "\n[[shape]]\nkind = \"square\"\nedge = 9\nradius = 5\n\n"
                                                  "[[shape]]\nkind = \"circle\"\nradius = 3\n");
  EXPECT_THROW(drawing("[[shape]]\nkind = \"circle\"\nedge = 9\n"), InputError);
}
} // namespace
} // namespace isostat
