// SPDX-License-Identifier: BSD-3-Clause
#include "fem/motion/motion_header.hpp"

#include "base/files/csv_table.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <span>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
struct Token
{
  std::string text;       ///< in capitals, units in one spelling
  bool bracketed = false; ///< behind an opening bracket
  bool labels = false;    ///< before a colon or an equals sign
  bool number = false;
};

struct Named
{
  std::string_view name;
  double factor; ///< to m/s2, m or s
};
constexpr Named lengths[] = {{"NM", 1e-9}, {"UM", 1e-6}, {"MM", 1e-3},   {"CM", 0.01},  {"DM", 0.1},
                             {"M", 1},     {"KM", 1e3},  {"IN", 0.0254}, {"FT", 0.3048}};
constexpr Named gravities[] = {{"G", standard_gravity},
                               {"GS", standard_gravity},
                               {"G'S", standard_gravity},
                               {"%G", 0.01 * standard_gravity},
                               {"MG", 0.001 * standard_gravity},
                               {"GRAVITY", standard_gravity},
                               {"MILLIG", 0.001 * standard_gravity},
                               {"MILLI-G", 0.001 * standard_gravity}};
constexpr Named gals[] = {{"GAL", 0.01}, {"GALS", 0.01}, {"MGAL", 1e-5}};
constexpr Named times[] = {{"MS", 1e-3}, {"US", 1e-6}, {"MIN", 60}, {"H", 3600}};

/// Spellings of units, in this order.
constexpr std::array<std::string_view, 2> spellings[] = {{"\xE2\x81\xBB\xC2\xB2", "-2"},
                                                         {"\xC2\xB2", "2"},
                                                         {"\xE2\x81\xBB\xC2\xB9", "-1"},
                                                         {"^", ""},
                                                         {"**", ""},
                                                         {"MILLIS", "MS"},
                                                         {"MSEC", "MS"},
                                                         {"SECONDS", "S"},
                                                         {"SECOND", "S"},
                                                         {"SECS", "S"},
                                                         {"SEC", "S"},
                                                         {"CENTIM", "CM"},
                                                         {"METERS", "M"},
                                                         {"METRES", "M"},
                                                         {"METER", "M"},
                                                         {"METRE", "M"},
                                                         {"CMM", "CM"},
                                                         {"INCHES", "IN"},
                                                         {"INCH", "IN"},
                                                         {"FEET", "FT"},
                                                         {"/(S*S)", "/S2"},
                                                         {"/SQ S", "/S2"},
                                                         {"/SQ.S", "/S2"},
                                                         {"/SQ. S", "/S2"},
                                                         {"/S-S", "/S2"},
                                                         {" PER ", "/"},
                                                         {" / S", "/S"},
                                                         {" SQUARED", "2"},
                                                         {"/S/S", "/S2"},
                                                         {"/SS", "/S2"},
                                                         {" S-2", "/S2"},
                                                         {".S-2", "/S2"},
                                                         {"*S-2", "/S2"},
                                                         {"MS-2", "M/S2"},
                                                         {" S-1", "/S"},
                                                         {"MS-1", "M/S"}};

std::optional<double> factor_of(std::string_view name, std::span<const Named> of)
{
  const auto found = std::ranges::find(of, name, &Named::name);
  return found == of.end() ? std::nullopt : std::optional(found->factor);
}

/// Of a unit such as CM/S2 or GAL, which means nothing else.
std::optional<double> plain_factor(std::string_view text)
{
  return text.ends_with("/S2") ? factor_of(text.substr(0, text.size() - 3), lengths) : factor_of(text, gals);
}

bool is_velocity(std::string_view text)
{
  return text.ends_with("/S") && factor_of(text.substr(0, text.size() - 2), lengths);
}

/// A unit per time that is none of those above: RAD/S2, CM/S'S.
bool is_other_rate(std::string_view text)
{
  constexpr std::string_view beginnings[] = {"CM/", "MM/", "M/S", "IN/S", "FT/S", "RAD/S", "DEG/S"};
  return text.ends_with("/S2") ||
         std::ranges::any_of(beginnings, [&](std::string_view b) { return text.starts_with(b); });
}

std::vector<Token> tokens_of(std::string_view line)
{
  constexpr std::string_view separators = " \t,;:=()[]{}\"_|<>";
  std::string text = upper_case(line);
  for (const auto &[from, to] : spellings)
    for (std::size_t at = text.find(from); at != std::string_view::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  std::vector<Token> tokens;
  for (std::size_t begin = text.find_first_not_of(separators); begin != std::string_view::npos;)
    {
      const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
      Token token{text.substr(begin, end - begin)};
      double value = 0;
      token.bracketed = begin > 0 && std::string_view("([{").find(text[begin - 1]) != std::string_view::npos;
      token.number = parse(token.text, value);
      if (!token.number && token.text.size() > 1 && token.text.back() == '.')
        token.text.pop_back();
      begin = text.find_first_not_of(separators, end);
      token.labels = text.substr(end, begin - end).find_first_of(":=") != std::string::npos;
      tokens.push_back(std::move(token));
    }
  return tokens;
}

bool is_acceleration(const Token &token) { return token.text.starts_with("ACC"); }

bool is_other_quantity(std::string_view word)
{
  word = word.substr(word.rfind('-') + 1);
  constexpr std::string_view beginnings[] = {"VELOC", "DISPL", "STRESS", "PRESSURE", "ROTATION",
                                             "JERK",  "TILT",  "FORCE",  "VOLTAGE",  "COUNT"};
  return word == "VEL" || word == "DISP" || word == "KPA" || word == "MPA" ||
         word.find("STRAIN") != std::string_view::npos ||
         std::ranges::any_of(beginnings, [&](std::string_view b) { return word.starts_with(b); });
}

struct StatedUnit
{
  std::string name;
  double factor;
  HeaderLine line;
};

/// What header lines say, one after the other.
class Statements
{
public:
  explicit Statements(const fs::path &path) : path_(path) {}

  void read(const HeaderLine &line)
  {
    const std::vector<Token> tokens = tokens_of(line.text);
    const bool names_quantity =
        std::ranges::any_of(tokens, [](const Token &t) { return is_acceleration(t) || is_other_quantity(t.text); });
    const std::size_t n_before = units_.size();
    bool units = false, other_first = false, acceleration = false;
    for (std::size_t k = 0; k < tokens.size(); ++k)
      {
        const Token &token = tokens[k];
        const bool before_number = k + 1 < tokens.size() && tokens[k + 1].number && !tokens[k + 1].bracketed;
        acceleration = acceleration || is_acceleration(token);
        if (is_other_quantity(token.text) && !before_number &&
            !(k + 1 < tokens.size() && (tokens[k + 1].text == "DROP" || tokens[k + 1].text == "BASE")))
          {
            other_first = other_first || !acceleration;
            other_ = other_ ? other_ : std::optional(line);
          }
        if (!is_of_a_value(tokens, k, names_quantity))
          read_unit(line, tokens, k, units);
        constexpr std::string_view fillers[] = {"UNITS", "UNIT", "OF", "IN", "ARE", "IS", "AND", "S", "MS"};
        const bool filler = std::ranges::find(fillers, token.text) != std::end(fillers);
        units = (token.text.starts_with("UNIT") || units) && filler;
      }
    if (other_first && units_.size() > n_before)
      refuse(line);
    acceleration_ = acceleration_ || acceleration;
    if (line.names_columns && !tokens.empty() &&
        (tokens[0].text.starts_with("PERIOD") || tokens[0].text.starts_with("FREQ")))
      refuse(line);
  }

  RecordUnit unit(AccelerationUnit unit) const
  {
    if (other_ && units_.empty() && !acceleration_)
      refuse(*other_);
    constexpr Named words[] = {{"m/s2", 1}, {"cm/s2", 0.01}, {"g", standard_gravity}};
    const bool is_given = unit != AccelerationUnit::stated;
    const Named &asked = words[is_given ? static_cast<std::size_t>(unit) - 1 : 2];
    if (units_.empty())
      return {asked.factor, !is_given};
    const auto differs = [&](double other) {
      return [=](const StatedUnit &u) { return std::abs(u.factor / other - 1) > 1e-9; };
    };
    const StatedUnit &first = units_.front();
    const auto second = std::ranges::find_if(units_, differs(first.factor));
    if (is_given && std::ranges::all_of(units_, differs(asked.factor)))
      reject(path_, first.line.number,
             fmt::format(
                 "\"{}\" says {}, and the scene says unit = \"{}\"; they must agree. Take unit out of the scene, or "
                 "correct the header",
                 first.line.text, first.name, asked.name));
    if (!is_given && second != units_.end())
      reject(path_, second->line.number,
             fmt::format(
                 "\"{}\" says {}, and line {} says {}; expected one unit. Give motion.unit in the scene, or correct "
                 "the header",
                 second->line.text, second->name, first.line.number, first.name));
    return {is_given ? asked.factor : first.factor, false};
  }

private:
  [[noreturn]] void refuse(const HeaderLine &line) const
  {
    reject(path_, line.number,
           fmt::format("\"{}\": not accelerations; expected accelerations in m/s2, cm/s2 (Gal) or g. Give the file of "
                       "accelerations, or take this line off if it says something else",
                       line.text));
  }

  /// "PGA 0.3 g", "PGV (cm/s) = 12", "Vs30 (m/s) 760", but not "090 (CM/S/S)".
  static bool is_of_a_value(const std::vector<Token> &tokens, std::size_t k, bool names_quantity)
  {
    const bool behind = k > 0 && tokens[k - 1].number, before = k + 1 < tokens.size() && tokens[k + 1].number;
    const bool is_angle =
        behind && tokens[k].bracketed && names_quantity && tokens[k - 1].text.find('.') == std::string::npos;
    return (behind && !is_angle) || (before && (tokens[k].labels || !plain_factor(tokens[k].text)));
  }

  void read_unit(const HeaderLine &line, const std::vector<Token> &tokens, std::size_t k, bool units)
  {
    const Token &token = tokens[k];
    const bool last = k + 1 == tokens.size(),
               behind_quantity = k > 0 && (is_acceleration(tokens[k - 1]) || tokens[k - 1].text == "IN");
    std::optional<double> factor = plain_factor(token.text);
    if (!factor && (token.bracketed || units || behind_quantity || (line.names_columns && k > 0)))
      factor = factor_of(token.text, gravities);
    if (factor)
      {
        std::string name = token.text;
        for (char &c : name)
          c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        units_.push_back({std::move(name), *factor, line});
        return;
      }
    constexpr std::string_view others[] = {"PA", "KPA", "MPA", "N", "KN", "V", "D", "%", "-", "RAD", "DEG", "COUNTS"};
    const bool ends_table =
        line.names_columns && k > 0 && last &&
        (factor_of(token.text, lengths) || std::ranges::find(others, token.text) != std::end(others));
    const bool is_time = token.text == "S" || factor_of(token.text, times);
    const bool is_filler = token.text == "OF" || token.text == "IN" || token.text == "ARE" || token.text == "IS" ||
                           token.text == "AND" || token.text.starts_with("UNIT") || token.number;
    const bool is_called_unit =
        units && k > 0 && (tokens[k - 1].labels || tokens[k - 1].text == "OF" || factor_of(token.text, lengths));
    if (is_velocity(token.text) || is_other_rate(token.text) || ends_table ||
        (is_called_unit && !is_time && !is_filler))
      refuse(line);
  }

  const fs::path &path_;
  std::vector<StatedUnit> units_;
  std::optional<HeaderLine> other_; ///< the first that names another quantity
  bool acceleration_ = false;
};
} // namespace

std::string upper_case(std::string_view text)
{
  std::string upper(text);
  for (char &c : upper)
    c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return upper;
}

RecordUnit record_unit(const fs::path &path, const std::vector<HeaderLine> &header, AccelerationUnit unit)
{
  Statements statements(path);
  for (const HeaderLine &line : header)
    statements.read(line);
  return statements.unit(unit);
}

double time_factor(std::string_view names_of_columns)
{
  for (const Token &token : tokens_of(names_of_columns))
    if (const std::optional<double> factor = factor_of(token.text, times); factor && token.text != "H")
      return *factor;
  return 1;
}
void check_assumed(const fs::path &path, const Motion &motion, const RecordUnit &unit)
{
  constexpr double strongest_shaking = 3; // g
  if (const double peak = motion.peak() / standard_gravity; unit.assumed && peak > strongest_shaking)
    reject(path, 1,
           fmt::format(
               "neither the header nor the scene states the unit, and the largest value, {:.4g}, is more than {} g; "
               "give motion.unit in the scene",
               peak, strongest_shaking));
}

} // namespace isostat
