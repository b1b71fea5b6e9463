// SPDX-License-Identifier: BSD-3-Clause
// What a program reports of a run, as data from which summary.txt, summary.json and the report follow.
// tested: tests/apps/summary_test.py
#pragma once
#include "base/files/json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace isostat
{
/// Units of texts, in SI.
inline constexpr double kPa = 1e3, kN = 1e3, mm = 1e-3, ms = 1e-3, percent = 0.01;

/// A value of summary.json, in SI, under its key. A text shows it in another unit: 200 in kPa.
template <typename T>
struct Value
{
  std::string key; ///< "plate.length": a member of a member
  T value;
  double unit = 1;
};

/// Rows of a text, and values for programs. What a text shows is formatted from the value that it sets.
class Summary
{
public:
  /// @param title  that of the scene, a value as well; without one the text has the other one
  /// @param null_keys  "p0 p_end": null unless something sets them
  Summary(const std::string &title, std::string other_title, const std::string &null_keys);

  Json &operator[](std::string key);

  /// The text, whose values it sets.
  template <typename... Args>
  std::string text(fmt::format_string<const Args &...> format, const Args &...args)
  {
    (set(args), ...);
    return fmt::format(format, args...);
  }
  /// A row `  label   text`; without a label a remark.
  template <typename... Args>
  void row(std::string label, fmt::format_string<const Args &...> format, const Args &...args)
  {
    rows_.emplace_back(std::move(label), text(format, args...));
  }

  /// summary.txt: the title, then the rows.
  std::string text() const;
  /// summary.json: the values, and the pairs of label and text as `rows`, which the report shows.
  Json json() const;

private:
  template <typename T>
  void set(const T &)
  {}
  template <typename T>
  void set(const Value<T> &value)
  {
    (*this)[value.key] = value.value;
  }

  std::string title_;
  Json values_;
  std::vector<std::pair<std::string, std::string>> rows_;
};
} // namespace isostat

template <typename T>
struct fmt::formatter<isostat::Value<T>> : fmt::formatter<T>
{
  template <typename Context>
  auto format(const isostat::Value<T> &shown, Context &context) const
  {
    if constexpr (std::is_floating_point_v<T>)
      return fmt::formatter<T>::format(shown.value / shown.unit, context);
    else
      return fmt::formatter<T>::format(shown.value, context);
  }
};
