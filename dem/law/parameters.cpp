// SPDX-License-Identifier: BSD-3-Clause
#include "dem/law/parameters.hpp"

#include <algorithm>

namespace isostat
{
std::string detail::parameter_name(const Key &key, bool is_switch)
{
  std::string name = (is_switch ? "feature_" : "") + std::string(key.path);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

std::vector<double> parameter_values(const ContactLaw &law)
{
  std::vector<double> values;
  const std::unique_ptr<ContactLaw> copy = law.clone();
  for_each_parameter(*copy, [&](const std::string &, auto value) { values.push_back(value); });
  return values;
}

bool Law::operator==(const Law &other) const
{
  return std::string_view(law_->name()) == other->name() && parameter_values(*law_) == parameter_values(other);
}
} // namespace isostat
