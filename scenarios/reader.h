/// \file
/// Reads the keys of one YAML map, each in one place with its unit and range, and refuses what is
/// left.
///
///     Reader reader(value, "ego");
///     reader.read("speed", {Dimension::speed, {0, 100}}, speed_mps);  // absent: speed_mps stays
///     reader.finish();                                                // unknown or missing keys
///
/// Every key that is asked for is a known one. All functions throw `Error` with the line of the
/// value.
#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/document.h"
#include "scenarios/quantity.h"

namespace lcs::scenario {

/// Numbers that a key takes, in its base unit.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;  ///< `low` itself is refused
  bool high_open = false;
};

/// What a number means and which ones are taken.
struct Quantity {
  Dimension dimension = Dimension::number;
  Range range;
};

/// The range in words: "above 0 and at most 100 m/s"; "" for any number.
std::string range_text(const Quantity& quantity);

/// \name One value.
/// \param path as in "ego.speed", for the message.
///@{
double as_quantity(const Value& value, const std::string& path, const Quantity& quantity);
/// \param other what may be given too, as " or auto".
std::int64_t as_integer(const Value& value, const std::string& path, std::int64_t low,
                        std::int64_t high, const std::string& other = "");
/// The position of the value among `words`. \param other what may be given too, as "a path".
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

  /// The value under a key, null when absent.
  const Value* find(std::string_view key);
  /// As `find`, but `finish` complains when it is absent.
  const Value* require(std::string_view key);
  /// The one of these keys that is given, if any is. A message names first the key that was asked
  /// for first.
  std::optional<std::string> at_most_one_of(std::vector<std::string_view> keys);
  /// As `at_most_one_of`, but `finish` complains when all are absent.
  std::optional<std::string> exactly_one_of(std::initializer_list<std::string_view> keys);

  /// Replaces `out` when the key is given.
  template <class Out>
  requires std::assignable_from<Out&, double>
  void read(std::string_view key, const Quantity& quantity, Out& out) {
    if (const Value* value = find(key)) out = as_quantity(*value, path_of(key), quantity);
  }

  /// `as_choice` of the key's value; none when the key is absent.
  std::optional<std::size_t> choice(std::string_view key, const std::vector<std::string>& words);

  /// Checks the map as a whole: no key that was not asked for, none missing that was required.
  void finish() const;

 private:
  const Value& map_;
  std::string path_;
  std::vector<std::string> known_;
  std::vector<std::string> missing_;
};

}  // namespace lcs::scenario
