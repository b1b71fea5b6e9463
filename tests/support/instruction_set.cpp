// SPDX-License-Identifier: BSD-3-Clause
// Part of every test program: ISOSTAT_INSTRUCTION_SET=AVX2 ctest ... tests as on a machine with fewer instructions.
#include "base/record/instruction_set.hpp"

namespace
{
[[maybe_unused]] const bool is_chosen = (isostat::use_instruction_set_of_environment(), true);
}
