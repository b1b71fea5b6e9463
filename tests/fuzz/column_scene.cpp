// SPDX-License-Identifier: BSD-3-Clause
// Text as a scene of a soil column.
#include "apps/deposit/scene.hpp"
#include "tests/fuzz/scene_target.hpp"

const isostat::fuzz::SceneTarget isostat::fuzz::scene_target = {try_scene<parse_column_scene>, column_schema};
