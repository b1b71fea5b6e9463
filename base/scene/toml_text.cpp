// SPDX-License-Identifier: BSD-3-Clause
// Some wrong texts ("[" at the end of a line, a date before a blank) are mistakes of its own to toml++: it aborts in
// debug, and in release let the compiler assume that they cannot happen. TOML_ASSERT, its option for what is done then,
// counts without NDEBUG only. No other source calls its parser, or the linker could take another copy.
#undef NDEBUG
namespace
{
struct TomlAssertion
{};

constexpr void toml_assert(bool holds)
{
  if (!holds)
    throw TomlAssertion{};
}
} // namespace
#define TOML_ASSERT(condition) toml_assert(static_cast<bool>(condition))
#include "base/scene/toml_text.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
bool is_ascii(char c) { return static_cast<unsigned char>(c) < 0x80; }

/// Goes through a text once, knowing strings and comments only, and stops at letters for which toml++ has undefined
/// behaviour: it asks whether they are blanks, in a function that is defined for some of them.
class Scan
{
public:
  explicit Scan(std::string_view text) : text_(text) {}

  /// Whether there is such a letter; at() is where.
  bool finds_one()
  {
    for (at_ = text_.starts_with("\xEF\xBB\xBF") ? 3 : 0; at_ < text_.size(); ++at_)
      if (const char c = text_[at_]; c == '#')
        at_ = std::min(text_.find('\n', at_), text_.size());
      else if ((c == '"' || c == '\'') && string_may_begin())
        {
          if (!skip_string(c))
            return true;
        }
      else if (!is_ascii(c))
        return true;
    return false;
  }

  std::size_t at() const { return std::min(at_, text_.size()); }

private:
  /// Behind a word a quote is a letter of a wrong word, which toml++ reads on.
  bool string_may_begin() const
  {
    return at_ == 0 || !is_ascii(text_[at_ - 1]) ||
           std::string_view(" \t\r\n=,[{.").find(text_[at_ - 1]) != std::string_view::npos;
  }

  /// From an opening quote to the last closing one. The first letter behind a backslash, or behind the line break that
  /// a backslash hides, is treated as one outside of quotes: false if that letter is not ASCII.
  bool skip_string(char quote)
  {
    const bool multi_line = text_.substr(at_, 3) == std::string(3, quote);
    const std::string closing(multi_line ? 3 : 1, quote);
    for (at_ += closing.size(); at_ < text_.size(); ++at_)
      {
        if (text_[at_] == '\\' && quote == '"')
          {
            const std::size_t next = text_.find_first_not_of(" \t\r\n\v\f", at_ + 1);
            if (multi_line && next != std::string_view::npos && !is_ascii(text_[next]))
              return false;
            ++at_;
          }
        else if (text_.substr(at_, closing.size()) == closing)
          {
            at_ += closing.size() - 1;
            for (int more = 0; multi_line && more < 2 && text_.substr(at_ + 1, 1) == closing.substr(2); ++more)
              ++at_; // """ends with a quote""""
            return true;
          }
        else if (text_[at_] == '\n' && !multi_line)
          return true; // toml++ says that the string has no end
      }
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

[[noreturn]] void refuse(const std::string &name, std::size_t line, std::string_view problem)
{
  throw InputError(fmt::format("{}:{}: is not valid TOML: {}.", name, line, problem));
}

/// The first line with which the text makes toml++ give up without saying where.
std::size_t line_of_assertion(std::string_view text)
{
  std::size_t line = 1;
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n', end + 1), ++line)
    try
      {
        [[maybe_unused]] const toml::table table = toml::parse(text.substr(0, end + 1));
      }
    catch (const toml::parse_error &)
      {}
    catch (const TomlAssertion &)
      {
        break;
      }
  return line;
}
} // namespace

toml::table parse_toml(std::string_view text, const std::string &name)
{
  if (Scan scan(text); scan.finds_one())
    refuse(name, 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(scan.at()), '\n'),
           "a letter beyond ASCII outside of quotes, or after a backslash");
  try
    {
      return toml::parse(text, name);
    }
  catch (const toml::parse_error &error)
    {
      refuse(name, error.source().begin.line, error.description());
    }
  catch (const TomlAssertion &)
    {
      refuse(name, line_of_assertion(text), "a key, a value or a table header is cut off here");
    }
}
} // namespace isostat
