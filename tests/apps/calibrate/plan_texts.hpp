// SPDX-License-Identifier: BSD-3-Clause
// A plan for the tests of calibrate, and its parts.
#pragma once
#include <string>

namespace isostat::test
{
inline const std::string parameter_texts = R"([[parameter]]
key = "contact.friction"
bounds = ["10 deg", "35 deg"]
[[parameter]]
key = "contact.rolling.limit"
bounds = [0.1, 0.9]
)";
inline const std::string curve_text = R"([[curve]]
file = "TMD3.csv"
test = "drained"
)";

/// Title and scene on lines 1 and 2, two parameters from line 3 on, then what is added to the second, and one curve.
inline std::string plan_text(const std::string &second_parameter = "")
{
  const std::string added = second_parameter.empty() ? "\n" : second_parameter;
  return "title = \"two\"\nscene = \"sand.toml\"\n" + parameter_texts + added + curve_text;
}
} // namespace isostat::test
