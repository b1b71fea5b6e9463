// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/summary.hpp"

#include <algorithm>
#include <sstream>

namespace isostat
{
Summary::Summary(const std::string &title, std::string other_title, const std::string &null_keys)
    : title_(title.empty() ? std::move(other_title) : title)
{
  values_["title"] = title;
  std::istringstream keys(null_keys);
  for (std::string key; keys >> key;)
    values_[key] = nullptr;
}

Json &Summary::operator[](std::string key)
{
  std::ranges::replace(key, '.', '/');
  return values_[Json::json_pointer("/" + key)];
}

std::string Summary::text() const
{
  std::string text = fmt::format("\n{}\n", title_);
  for (const auto &[label, value] : rows_)
    text += fmt::format("  {}\n", label.empty() ? value : fmt::format("{:<25}{}", label, value));
  return text;
}

Json Summary::json() const
{
  Json json = values_;
  json["rows"] = rows_;
  return json;
}
} // namespace isostat
