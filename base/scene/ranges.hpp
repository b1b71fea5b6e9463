// SPDX-License-Identifier: BSD-3-Clause
// Ranges and reasons that many keys share.   tested: tests/dem/scene/scene_error_test.cpp
#pragma once
#include "base/scene/schema.hpp"

namespace isostat::ranges
{
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr Range positive{0, infinity, true};
inline constexpr Range not_negative{0, infinity};
inline constexpr Range counts{1, 1e6};
inline constexpr Range fraction{0, 1, true, true};      ///< (0, 1)
inline constexpr Range to_one{0, 1, true, false};       ///< (0, 1]
inline constexpr Range to_ten{0, 10, true, false};      ///< (0, 10]
inline constexpr Range right_angle{0, 90, false, true}; ///< degrees
inline constexpr Range stresses{1, 1e12};
inline constexpr const char *because_stresses = "because less is negligible, and no soil bears a TPa";
inline constexpr Range moduli{1, 1e15};
inline constexpr const char *because_moduli =
    "because no grain is as soft, and none a thousand times as stiff as diamond";
inline constexpr const char *one_or_more = "because there is at least one, and a million is beyond any use";
inline constexpr const char *because_tan = "because tan() is used";
} // namespace isostat::ranges
