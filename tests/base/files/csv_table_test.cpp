// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/csv_table.hpp"

#include "base/error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using namespace std::string_literals;

class CsvFile : public TemporaryFolder
{
protected:
  CsvTable read(const std::string &text) const { return CsvTable(put("table.csv", text), {"b (m)", "a"}); }
  std::string refusal(const std::string &text) const
  {
    return message_of<InputError>([&] { read(text); });
  }
};

TEST(CsvFields, QuotesCommasAndBlanks)
{
  EXPECT_THAT(split_commas("\"a (m)\", \"b, c\" ,d e, \"f\"\"g\" ,\"\""),
              ElementsAre("a (m)", "b, c", "d e", "f\"\"g", ""));
  EXPECT_THAT(split_commas("\"open,5\" tall,\"x"), ElementsAre("\"open", "5\" tall", "\"x"));
  EXPECT_THAT(split_commas("a,,"), ElementsAre("a", "", ""));
  EXPECT_THAT(split_words("\"\" \"t (s)\"\t\"a\",1"), ElementsAre("", "t (s)", "a", "1"));
  EXPECT_THAT(split_words("a\"b \"c"), ElementsAre("a\"b", "\"c"));
}

TEST_F(CsvFile, HeadersAndRowNamesOfOtherPrograms)
{
  for (const std::string text : {
           "a,other,b (m)\n1,7,0.5\n2,8,-3\n",                                        // plain
           "\"a\",\"other\",\"b (m)\"\r\n1,7,0.5\r\n2,\"8\",\"-3\"\r\n",              // R, row.names = FALSE
           "\"\",\"a\",\"other\",\"b (m)\"\n\"1\",1,7,0.5\n\"17\",2,8,-3\n",          // R
           "\"a\",\"other, too\",\"b (m)\"\n\"x, y\",1,7,0.5\n\"z\",2,8,-3\n",        // R's write.table
           ",a,other,b (m)\n0,1,7,0.5\n1,2,8,-3\n",                                   // pandas
           "\xEF\xBB\xBF\"a\" , \"other\", \"b (m)\"\n 1, 7, 0.5\n\n2,\"8, 9\",-3\n", // byte-order mark, blanks
       })
    {
      const CsvTable table = read(text);
      ASSERT_EQ(table.n_rows(), 2u) << text;
      EXPECT_THAT((std::vector{table(0, 0), table(0, 1), table(1, 0), table(1, 1)}), ElementsAre(0.5, 1, -3, 2))
          << text;
    }
}

TEST_F(CsvFile, OtherSeparators)
{
  EXPECT_THAT(refusal("a;b (m)\n1;2\n"), AllOf(HasSubstr("table.csv:1:"), HasSubstr("semicolons; expected commas")));
  EXPECT_THAT(refusal("a\tb (m)\n1\t2\n"), HasSubstr("tabs; expected commas"));
  EXPECT_THAT(refusal("a,b (m)\n1,2,3\n"), HasSubstr("table.csv:2: 3 values; the header names 2 columns"));
  EXPECT_THAT(refusal("\"\",a,b (m)\n1,2\n"), HasSubstr("table.csv:2: 2 values; the header names 3 columns"));
}

TEST_F(CsvFile, TextInUtf16)
{
  for (const std::string &text : {"\xFF\xFE"s + "a\0,\0"s, "\xFE\xFF"s + "\0a\0,"s, "a\0,\0"s, "\0a\0,"s})
    EXPECT_THAT(refusal(text), AllOf(HasSubstr("table.csv:1: the text is UTF-16"), HasSubstr("Save it as UTF-8")));
}
} // namespace
} // namespace isostat
