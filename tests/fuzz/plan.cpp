// SPDX-License-Identifier: BSD-3-Clause
// Text as a plan of a calibration.
#include "apps/calibrate/plan.hpp"
#include "tests/fuzz/scene_target.hpp"

const isostat::fuzz::SceneTarget isostat::fuzz::scene_target = {try_scene<parse_plan>, plan_schema};
