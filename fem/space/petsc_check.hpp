// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/fem/solve/statics_test.cpp
#pragma once
#include "base/error.hpp"

#include <fmt/format.h>
#include <petscsys.h>

namespace isostat
{
/// @param system  whose call it was, for the message     @throws RunFailure  PETSc reports an error
inline void petsc_check(PetscErrorCode code, const char *system)
{
  if (!code)
    return;
  const char *text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  throw RunFailure(fmt::format("{}: PETSc error {}: {}", system, static_cast<int>(code), text));
}
} // namespace isostat
