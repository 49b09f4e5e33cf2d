/// \file
/// Reads the keys of one YAML map, each with its unit and range at one place, and rejects all other
/// keys.
///
///     Reader reader(value, "ego");
///     if (const Value* at = reader.find("at")) at_s = as_quantity(*at, "ego.at", kTime);
///     reader.finish();  // unknown or missing keys
///
/// Every queried key counts as known. All functions throw `Error` with the line of the value.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/input/document.h"

namespace lcs::input {

// ---- Numbers with units, as written in scenario files: "0.5 m/s", "3 cm/s", "9 deg", "200 ms"

/// Physical dimension. Numbers without a unit are in the base unit given here.
enum class Dimension {
  number,        ///< no unit
  length,        ///< m
  time,          ///< s
  speed,         ///< m/s
  acceleration,  ///< m/s^2
  frequency,     ///< Hz
  angle,         ///< deg
  angular_rate,  ///< deg/s
  illuminance,   ///< lx
  intensity,     ///< cd, luminous intensity of a lamp
  pixels,        ///< px, in the image
};

/// The base unit; "" for `number`.
std::string_view base_unit(Dimension dimension);

/// Converts from base units to SI: degrees to radians; all other base units are SI.
double to_si(double in_base_unit, Dimension dimension);

/// The SI value of a text such as "0.5 m/s" or "0.5". "7 cm" and "0.07 m" give the same bits.
/// \throws std::invalid_argument "problem; remedy" unless the text is a finite number in a unit of
/// this dimension.
double parse_quantity(std::string_view text, Dimension dimension);

/// The units of a dimension, the base unit first.
std::vector<std::string> units_of(Dimension dimension);

/// An SI value with its unit, to 12 digits, in the format of `parse_quantity`. \param unit of this
/// dimension; "": its base unit.
std::string quantity_text(double si, Dimension dimension, std::string_view unit = "");

/// The shortest text that parses to the same double, for messages.
std::string number_text(double value);

/// Accepted interval of a number, in its base unit.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;  ///< excludes `low` itself
  bool high_open = false;
};

/// Dimension and accepted range of a number.
struct Quantity {
  Dimension dimension = Dimension::number;
  Range range;
};

/// The range in words: "above 0 and at most 100 m/s"; "" if unbounded.
std::string range_text(const Quantity& quantity);

/// \name Conversions of one value.
/// \param path for the message, for example "ego.speed".
///@{
double as_quantity(const Value& value, const std::string& path, const Quantity& quantity);
/// \param other alternative to a number, for the message, for example " or auto".
std::int64_t as_integer(const Value& value, const std::string& path, std::int64_t low,
                        std::int64_t high, const std::string& other = "");
/// Index of the value in `words`. \param other alternative, for the message, for example "a path".
std::size_t as_choice(const Value& value, const std::string& path,
                      const std::vector<std::string>& words, const std::string& other = "");
std::uint64_t as_seed(const Value& value, const std::string& path);
const std::string& as_text(const Value& value, const std::string& path);
const std::vector<Value>& as_list(const Value& value, const std::string& path,
                                  std::optional<std::size_t> size = std::nullopt);
///@}

class Reader {
 public:
  /// \throws Error unless the value is a map.
  Reader(const Value& value, std::string path);

  const std::string& path() const { return path_; }
  const Source& where() const { return map_.where; }
  /// "ego.speed", for messages about a key.
  std::string path_of(std::string_view key) const;

  /// The value of a key, or null if absent.
  const Value* find(std::string_view key);
  /// Whether a key was asked for, by `find` or another call.
  bool knows(std::string_view key) const;
  /// As `find`, but `finish` throws if the key is absent.
  const Value* require(std::string_view key);
  /// The key among these that is given, if any. \throws Error if two are given; it names first the
  /// key that was queried first.
  std::optional<std::string> at_most_one_of(std::vector<std::string_view> keys);
  /// As `at_most_one_of`, but `finish` throws if all are absent.
  void exactly_one_of(std::initializer_list<std::string_view> keys);

  /// \throws Error at the value of a given key. \param what follows the key's path.
  [[noreturn]] void refuse(std::string_view key, const std::string& what);

  /// \throws Error for a key that was not queried, or a required key that is absent.
  void finish() const;

 private:
  const Value& map_;
  std::string path_;
  std::vector<std::string> known_;
  std::vector<std::string> missing_;
};

}  // namespace lcs::input
