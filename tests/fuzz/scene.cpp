// SPDX-License-Identifier: BSD-3-Clause
// Text as a scene of an element test.
#include "dem/scene/scene.hpp"
#include "dem/scene/schema.hpp"
#include "tests/fuzz/scene_target.hpp"

const isostat::fuzz::SceneTarget isostat::fuzz::scene_target = {try_scene<parse_scene>, scene_schema};
