// SPDX-License-Identifier: BSD-3-Clause
#include "fem/solve/newton_scene.hpp"

#include "base/scene/document.hpp"
#include "base/scene/ranges.hpp"

namespace isostat
{
namespace
{
using namespace ranges;

// clang-format off
constexpr Key keys[] = {
  {.path = "tolerance", .field = member<&NewtonSettings::tolerance>, .value = "1e-6", .range = fraction,
   .reason = "because it is a part of the forces",
   .text = "Of the residual over the force scale, the largest force so far. Grains need one above their noise, some "
           "5e-3."},
  {.path = "max_iterations", .field = member<&NewtonSettings::max_iterations>, .value = "25",
   .text = "Of Newton's method in a sub-step; 0: relaxation alone, for packings and past a peak."},
  {.path = "iterations_per_tangent", .field = member<&NewtonSettings::iterations_per_tangent>, .value = "1",
   .range = counts, .reason = one_or_more,
   .text = "1: Newton; more: the tangent is kept for so many iterations of a sub-step."},
  {.path = "relaxation_iterations", .field = member<&NewtonSettings::relaxation_iterations>, .value = "0",
   .text = "Of relaxation, which takes over a sub-step that Newton's method has not solved; 0: none. Then the sub-step "
           "is halved."},
  {.path = "max_halvings", .field = member<&NewtonSettings::max_halvings>, .value = "8", .range = {0, 40},
   .reason = "because smaller parts are below round-off",
   .text = "The smallest sub-step is the step times 2 to the power of minus this."},
};
// clang-format on
} // namespace

SceneFragment<NewtonSettings> newton_keys() { return {keys}; }

void check_newton(const SceneDocument &document, const std::string &prefix, const NewtonSettings &newton)
{
  if (newton.max_iterations == 0 && newton.relaxation_iterations == 0)
    document.refuse(prefix + ".max_iterations", "and relaxation_iterations = 0; one of both must be at least 1, or "
                                                "nothing looks for equilibrium. Set relaxation_iterations = 200.");
}
} // namespace isostat
