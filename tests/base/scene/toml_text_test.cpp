// SPDX-License-Identifier: BSD-3-Clause
#include "base/scene/toml_text.hpp"

#include "tests/support/refusal.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
std::string complaint(const std::string &text)
{
  return test::refusal([&] { parse_toml(text, "file.toml"); });
}
} // namespace

// Each of these aborts or is undefined in toml++ 3.3 and 3.4.
TEST(TomlText, ATableHeaderThatIsCutOff)
{
  for (const char *header : {"[\n", "[[\n", "[ \t\n", "[[ \n", "[#\n", "[,]\n", "[=", "[[.a]]", "\t [\r\n", "[\x01]"})
    EXPECT_THAT(complaint(std::string("a = 1\n") + header), testing::StartsWith("file.toml:2: is not valid TOML: "))
        << header;
  EXPECT_THAT(complaint("a = [\n[\n1\n]\n]\n"), "accepted"); // brackets of arrays
  EXPECT_THAT(complaint("a = [{b = \"]\"},\n{b = ']'}] # ]\n[c]\n"), "accepted");
  EXPECT_THAT(complaint("a = \"\"\"\n[\n\\\"\"\"\"\"\"\n['[']\n[\"\\\"[\"]\n[a]"), testing::HasSubstr("redefine"));
}

TEST(TomlText, LettersBeyondAscii)
{
  for (const char *letter : {"\u00e4", "\u0416", "\u00a0", "\u2003", "\u3042", "\ufb01", "\U0001F600"})
    {
      const std::string problem = "file.toml:2: is not valid TOML: a letter beyond ASCII ";
      for (const std::string before :
           {"", "[a", "a ", "a = ", "a = 1", "a = +nan\"x", "a = [1", "a = \"b\"", "a = '''\n'''"})
        EXPECT_THAT(complaint("\n" + before + letter), testing::HasSubstr("a letter beyond ASCII ")) << before;
      EXPECT_THAT(complaint("\na = \"\"\"b\\" + (letter + std::string("\"\"\""))), testing::StartsWith(problem));
      EXPECT_THAT(complaint("\na = \"\"\"b\\  \n  " + (letter + std::string("\"\"\""))), testing::StartsWith(problem));
      EXPECT_EQ(complaint(fmt::format("a = \"{0}\" # {0}\nb = '{0}'\n\"{0}\" = '''{0}\\'''", letter)), "accepted");
    }
  EXPECT_EQ(parse_toml("\xEF\xBB\xBF"
                       "a = 1",
                       "")["a"]
                .value<int>(),
            1)
      << "a mark of the byte order";
}

TEST(TomlText, ValuesThatAreCutOff)
{
  for (const char *value : {"{b =1979-05-27 1}", "[0.938, }-0.0]", "[,]", "{b=}", "1979-05-27 ]", "[1 2]", "{,}"})
    EXPECT_THAT(complaint(std::string("\na = ") + value), testing::StartsWith("file.toml:2: is not valid TOML: "))
        << value;
}

TEST(TomlText, StringsEndWhereTomlEndsThem)
{
  EXPECT_EQ(parse_toml("a = \"\"\"b\"\"\"\"\"\n[c]", "")["a"].value<std::string>(), "b\"\"");
  EXPECT_EQ(parse_toml("a = '''b''''\n[c]", "")["a"].value<std::string>(), "b'");
  EXPECT_EQ(parse_toml("a = ''\nb = \"\\\\\"\n[c]", "")["b"].value<std::string>(), "\\");
  EXPECT_THAT(complaint("a = \"b\n[\n"), testing::StartsWith("file.toml:")) << "an open string";
  EXPECT_THAT(complaint("a = \"b\\"), testing::StartsWith("file.toml:1:"));
  EXPECT_EQ(complaint(""), "accepted");
}
} // namespace isostat
