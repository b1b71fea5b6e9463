// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/json.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/replace_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace isostat
{
void write_json(const std::filesystem::path &path, const Json &value)
{
  write_replacing(path, value.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

Json read_json(const std::filesystem::path &path)
{
  const std::string text = read_text(path);
  try
    {
      return Json::parse(text);
    }
  catch (const Json::parse_error &error)
    {
      throw InputError(
          fmt::format("{}: is not JSON at byte {}; repair it, or run again what writes it", path.string(), error.byte));
    }
}
} // namespace isostat
