// SPDX-License-Identifier: BSD-3-Clause
// The message for a user whose input is refused or whose run fails.
#pragma once
#include "base/error.hpp"

#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace isostat::test
{
/// The message with which a scene is refused, or a run fails; "accepted" if not.   @param parse  reads the scene
template <typename Error = InputError, typename Parse>
std::string refusal(const Parse &parse)
{
  try
    {
      parse();
    }
  catch (const Error &error)
    {
      return error.what();
    }
  return "accepted";
}

inline void expect_parts(const std::string &message, const std::vector<std::string> &parts)
{
  for (const std::string &part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << message << "\n  lacks: " << part;
}
} // namespace isostat::test

namespace isostat
{
/// Runs `action`, expects an `Error`, and returns its message.
template <typename Error, typename Action>
std::string message_of(const Action &action)
{
  try
    {
      action();
    }
  catch (const Error &error)
    {
      return error.what();
    }
  catch (const std::exception &other)
    {
      ADD_FAILURE() << "another error: " << other.what();
      return {};
    }
  ADD_FAILURE() << "no error";
  return {};
}
} // namespace isostat
