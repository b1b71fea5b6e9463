// SPDX-License-Identifier: BSD-3-Clause
#include "base/scene/toml_text.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr std::string_view blanks = " \t";
constexpr std::string_view white_space = " \t\r\n";

bool is_key_start(char c)
{
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("_-\"'").find(c) != std::string_view::npos;
}

bool is_ascii(char c) { return static_cast<unsigned char>(c) < 0x80; }

/// Goes through a text once, knowing strings and comments only, and stops at what toml++ must not see.
class Scan
{
public:
  explicit Scan(std::string_view text) : text_(text) {}

  /// What is wrong, empty if nothing is; at() is where.
  std::string_view problem()
  {
    for (at_ = text_.starts_with("\xEF\xBB\xBF") ? 3 : 0; at_ < text_.size(); ++at_)
      {
        const char c = text_[at_];
        if (c == '#')
          at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
        else if (c == '"' || c == '\'')
          {
            if (!skip_string(c))
              return "a letter beyond ASCII after a backslash";
          }
        else if (!is_ascii(c))
          return "a letter beyond ASCII outside of quotes";
        else if (c == '[' && line_is_blank_ && depth_ == 0)
          {
            if (!skip_header_start())
              return "a table header is cut off here";
            in_header_ = true;
          }
        else if (!in_header_)
          depth_ = std::max(0, depth_ + (c == '[' || c == '{') - (c == ']' || c == '}'));
        in_header_ = in_header_ && c != '\n';
        line_is_blank_ = c == '\n' || (line_is_blank_ && blanks.find(c) != std::string_view::npos);
      }
    return {};
  }

  std::size_t at() const { return std::min(at_, text_.size()); }

private:
  /// From an opening quote to the last closing one. toml++ asks of the first letter behind a backslash, or behind the
  /// line break that a backslash hides, whether it is a blank: false if that letter is not ASCII.
  bool skip_string(char quote)
  {
    const bool multi_line = text_.substr(at_, 3) == std::string(3, quote);
    const std::string closing(multi_line ? 3 : 1, quote);
    for (at_ += closing.size(); at_ < text_.size(); ++at_)
      {
        if (text_[at_] == '\\' && quote == '"')
          {
            const std::size_t next = text_.find_first_not_of(white_space, at_ + 1);
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

  /// The brackets of "[table]" or "[[table]]", up to before the key: false if none begins there.
  bool skip_header_start()
  {
    const std::size_t start = at_;
    const auto next = [&] { return std::min(text_.find_first_not_of(blanks, at_ + 1), text_.size()); };
    if (next() < text_.size() && text_[next()] == '[')
      at_ = next();
    const std::size_t key = next();
    if (key == text_.size() || text_[key] == ']' || is_key_start(text_[key])) // of a missing key toml++ speaks itself
      return true;
    at_ = start;
    return false;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0; ///< open brackets of arrays and inline tables
  bool in_header_ = false, line_is_blank_ = true;
};

[[noreturn]] void refuse(const std::string &name, std::size_t line, std::string_view problem)
{
  throw InputError(fmt::format("{}:{}: is not valid TOML: {}.", name, line, problem));
}
} // namespace

toml::table parse_toml(std::string_view text, const std::string &name)
{
  Scan scan(text);
  if (const std::string_view problem = scan.problem(); !problem.empty())
    refuse(name, 1 + std::count(text.begin(), text.begin() + scan.at(), '\n'), problem);
  try
    {
      return toml::parse(text, name);
    }
  catch (const toml::parse_error &error)
    {
      refuse(name, error.source().begin.line, error.description());
    }
}
} // namespace isostat
