#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "scenarios/input/message.h"
#include "scenarios/input/reader.h"

namespace lcs::input {
namespace {

/// SI = number * numerator / denominator. A ratio, because 7 / 100 is the double nearest to 0.07,
/// and 7 * 0.01 is not.
struct Unit {
  std::string_view name;
  Dimension dimension;
  double numerator;
  double denominator;
};

constexpr double pi = std::numbers::pi;

/// The first unit of a dimension is its base unit.
constexpr std::array units = {
    Unit{"m", Dimension::length, 1, 1},
    Unit{"cm", Dimension::length, 1, 100},
    Unit{"mm", Dimension::length, 1, 1000},
    Unit{"km", Dimension::length, 1000, 1},
    Unit{"s", Dimension::time, 1, 1},
    Unit{"ms", Dimension::time, 1, 1000},
    Unit{"min", Dimension::time, 60, 1},
    Unit{"m/s", Dimension::speed, 1, 1},
    Unit{"cm/s", Dimension::speed, 1, 100},
    Unit{"mm/s", Dimension::speed, 1, 1000},
    Unit{"km/h", Dimension::speed, 1000, 3600},
    Unit{"m/s^2", Dimension::acceleration, 1, 1},
    Unit{"cm/s^2", Dimension::acceleration, 1, 100},
    Unit{"mm/s^2", Dimension::acceleration, 1, 1000},
    Unit{"Hz", Dimension::frequency, 1, 1},
    Unit{"kHz", Dimension::frequency, 1000, 1},
    Unit{"deg", Dimension::angle, pi, 180},
    Unit{"rad", Dimension::angle, 1, 1},
    Unit{"deg/s", Dimension::angular_rate, pi, 180},
    Unit{"rad/s", Dimension::angular_rate, 1, 1},
    Unit{"lx", Dimension::illuminance, 1, 1},
    Unit{"klx", Dimension::illuminance, 1000, 1},
    Unit{"cd", Dimension::intensity, 1, 1},
    Unit{"px", Dimension::pixels, 1, 1},
};

/// The first unit whose member has this value; null without one.
template <class Member>
const Unit* find(Member Unit::*member, const Member& value) {
  const auto found = std::ranges::find(units, value, member);
  return found == units.end() ? nullptr : &*found;
}

const Unit* base(Dimension dimension) {
  return find(&Unit::dimension, dimension);
}

/// A dimension as cited in messages: "a speed".
std::string_view noun(Dimension dimension) {
  // in the order of `Dimension`
  constexpr std::string_view kNouns[] = {"a number without a unit",
                                         "a length",
                                         "a time",
                                         "a speed",
                                         "an acceleration",
                                         "a frequency",
                                         "an angle",
                                         "an angular rate",
                                         "an illuminance",
                                         "a luminous intensity",
                                         "a number of pixels"};
  return kNouns[static_cast<std::size_t>(dimension)];
}

/// "give a speed in m/s, cm/s, mm/s or km/h"
std::string remedy(Dimension dimension) {
  const std::string in = joined(units_of(dimension), " or ");
  return fmt::format("give {}{}{}", noun(dimension), in.empty() ? "" : " in ", in);
}

std::string_view trim(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(blank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blank) - begin + 1);
}

[[noreturn]] void refuse(std::string_view text, std::string_view problem, Dimension dimension) {
  throw std::invalid_argument(fmt::format("'{}' {}; {}", text, problem, remedy(dimension)));
}

}  // namespace

std::string_view base_unit(Dimension dimension) {
  const Unit* unit = base(dimension);
  return unit ? unit->name : std::string_view();
}

double to_si(double in_base_unit, Dimension dimension) {
  const Unit* unit = base(dimension);
  return unit ? in_base_unit * unit->numerator / unit->denominator : in_base_unit;
}

double parse_quantity(std::string_view text, Dimension dimension) {
  const std::string_view trimmed = trim(text);
  double number = 0;
  const char* const end = trimmed.data() + trimmed.size();
  // from_chars, not strtod: independent of the locale.
  const auto [rest, error] = std::from_chars(trimmed.data(), end, number);
  if (error == std::errc::result_out_of_range) refuse(text, "does not fit a double", dimension);
  if (error != std::errc()) refuse(text, "is not a number", dimension);
  if (!std::isfinite(number)) refuse(text, "is not finite", dimension);

  const std::string_view name = trim({rest, static_cast<std::size_t>(end - rest)});
  if (name.empty()) return to_si(number, dimension);
  const Unit* unit = find(&Unit::name, name);
  if (!unit) refuse(text, fmt::format("has the unknown unit '{}'", name), dimension);
  if (unit->dimension != dimension) {
    refuse(text, fmt::format("is {}", noun(unit->dimension)), dimension);
  }
  const double si = number * unit->numerator / unit->denominator;
  if (!std::isfinite(si)) refuse(text, "does not fit a double", dimension);
  return si;
}

std::vector<std::string> units_of(Dimension dimension) {
  std::vector<std::string> names;
  for (const Unit& unit : units) {
    if (unit.dimension == dimension) names.emplace_back(unit.name);
  }
  return names;
}

std::string quantity_text(double si, Dimension dimension, std::string_view unit) {
  const Unit* in = unit.empty() ? base(dimension) : find(&Unit::name, unit);
  const double number = in ? si * in->denominator / in->numerator : si;
  std::array<char, 64> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number,
                                 std::chars_format::general, 12);
  double rounded = 0;
  std::from_chars(buffer.data(), end.ptr, rounded);
  std::string text = number_text(rounded == 0 ? 0 : rounded);
  if (in) text.append(" ").append(in->name);
  return text;
}

std::string number_text(double value) {
  const double size = std::abs(value);
  const bool plain = value == 0 || (size >= 1e-4 && size < 1e7);
  std::array<char, 64> buffer{};
  char* const end = buffer.data() + buffer.size();
  const auto result = plain ? std::to_chars(buffer.data(), end, value, std::chars_format::fixed)
                            : std::to_chars(buffer.data(), end, value);
  return {buffer.data(), result.ptr};
}

}  // namespace lcs::input
