// SPDX-License-Identifier: BSD-3-Clause
// The section [contact]: parts of a law that are left out, and a law that is not the default.
#include "base/error.hpp"
#include "dem/contact/hertz_mindlin/law.hpp"
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/scene/scene.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
const std::string smallest = "[grading]\n[specimen]\nrelative_density = 0.5\n";

TEST(Scene, WhatIsMissingInContactIsSwitchedOff)
{
  const auto features = [](const std::string &contact) {
    const Scene scene = parse_scene(smallest + "[contact]\n" + contact, "scene.toml");
    const auto &law = scene.contact.as<LinearRolling>();
    return LawFeatures{law.friction > 0, law.rolling, law.twisting};
  };
  EXPECT_EQ(features(""), (LawFeatures{false, false, false}));
  EXPECT_EQ(features("friction = \"18 deg\""), (LawFeatures{true, false, false}));
  EXPECT_EQ(features("friction = \"18 deg\"\nrolling = {}"), (LawFeatures{true, true, false}));
  EXPECT_EQ(features("friction = \"18 deg\"\ntwisting = { stiffness = 2 }"), (LawFeatures{true, false, true}));
  EXPECT_EQ(features("friction = \"0 deg\"\nrolling = { limit = 0.1 }"), (LawFeatures{false, true, false}));
}

TEST(Scene, ALawHasItsOwnKeysAndDefaults)
{
  const std::string head = smallest + "[contact]\nlaw = \"hertz-mindlin\"\n";
  const HertzMindlin quartz = parse_scene(head, "scene.toml").contact.as<HertzMindlin>();
  EXPECT_EQ(quartz.young, 64.96e9);
  EXPECT_EQ(quartz.poisson, 0.12);
  EXPECT_EQ(quartz.active(), (LawFeatures{false, false, false}));
  const Scene scene = parse_scene(head + "poisson = 0.3\nfriction = \"18 deg\"\nrolling = { limit = 0.1 }\n", "s.toml");
  EXPECT_EQ(scene.contact.as<HertzMindlin>().rolling_limit, 0.1);
  EXPECT_EQ(parse_scene(to_toml(scene), "again.toml"), scene);
  EXPECT_THROW(parse_scene(head + "stiffness_ratio = 0.3\n", "scene.toml"), InputError);
  EXPECT_THROW(parse_scene(head + "poisson = 0.6\n", "scene.toml"), InputError);
  EXPECT_THROW(parse_scene(smallest + "[contact]\npoisson = 0.3\n", "scene.toml"), InputError);
}
} // namespace
} // namespace isostat
