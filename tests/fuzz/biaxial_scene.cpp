// SPDX-License-Identifier: BSD-3-Clause
// Text as a scene of a biaxial block.
#include "apps/biaxial/scene.hpp"
#include "tests/fuzz/scene_target.hpp"

const isostat::fuzz::SceneTarget isostat::fuzz::scene_target = {try_scene<parse_biaxial_scene>, biaxial_schema};
