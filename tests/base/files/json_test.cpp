// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/json.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/replace_file.hpp"
#include "tests/support/temporary_folder.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace isostat
{
namespace
{
class JsonFiles : public TemporaryFolder
{};

TEST_F(JsonFiles, MembersKeepTheirOrder)
{
  write_json(folder / "a.json", {{"title", "a \"b\"\n"}, {"cells", 3}, {"depths", {1.5, 2.5}}, {"base", nullptr}});
  EXPECT_EQ(read_text(folder / "a.json"), "{\n  \"title\": \"a \\\"b\\\"\\n\",\n  \"cells\": 3,\n  \"depths\": [\n"
                                          "    1.5,\n    2.5\n  ],\n  \"base\": null\n}\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.json.tmp"));
}

TEST_F(JsonFiles, NumbersReadBackAsTheSameDoubles)
{
  const std::vector<double> numbers = {0.1, 1.0 / 3, 6.02214076e23, 5e-324, -0.0, std::nextafter(1e5, 2e5)};
  write_json(folder / "a.json", numbers);
  EXPECT_EQ(read_json(folder / "a.json").get<std::vector<double>>(), numbers);
}

TEST_F(JsonFiles, NotANumberBecomesNull)
{
  write_json(folder / "a.json", {{"x", std::nan("")}, {"y", std::numeric_limits<double>::infinity()}});
  const Json read = read_json(folder / "a.json");
  EXPECT_TRUE(read["x"].is_null() && read["y"].is_null());
}

TEST_F(JsonFiles, BytesThatAreNotUtf8AreReplaced)
{
  write_json(folder / "a.json", {{"path", "\xff.toml"}});
  EXPECT_EQ(read_json(folder / "a.json")["path"].get<std::string>(), "\xef\xbf\xbd.toml");
}

TEST_F(JsonFiles, DamagedOrMissingFilesAreRefused)
{
  write_replacing(folder / "a.json", "{\"x\": 1,");
  for (const char *name : {"a.json", "b.json"})
    EXPECT_THAT(message_of<InputError>([&] { read_json(folder / name); }), testing::HasSubstr(name));
}
} // namespace
} // namespace isostat
