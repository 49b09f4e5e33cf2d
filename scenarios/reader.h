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

#include <Eigen/Core>
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

/// \name One value.
/// \param path as in "ego.speed", for the message.
///@{
double as_quantity(const Value& value, const std::string& path, const Quantity& quantity);
std::int64_t as_integer(const Value& value, const std::string& path, std::int64_t low,
                        std::int64_t high);
/// The threshold of FAST in grey levels; none for "auto".
std::optional<int> as_threshold(const Value& value, const std::string& path);
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
  /// The one of these keys that is given, if any is.
  std::optional<std::string> at_most_one_of(std::initializer_list<std::string_view> keys);
  /// As `at_most_one_of`, but `finish` complains when all are absent.
  std::optional<std::string> exactly_one_of(std::initializer_list<std::string_view> keys);

  /// \name Replace `out` when the key is given.
  ///@{
  template <class Out>
  requires std::assignable_from<Out&, double>
  void read(std::string_view key, const Quantity& quantity, Out& out) {
    if (const Value* value = find(key)) out = as_quantity(*value, path_of(key), quantity);
  }
  template <int N>
  void read(std::string_view key, const Quantity& quantity, Eigen::Matrix<double, N, 1>& out) {
    const Value* value = find(key);
    if (!value) return;
    const std::vector<Value>& list = as_list(*value, path_of(key), N);
    for (int i = 0; i < N; ++i) {
      out[i] = as_quantity(list[i], path_of(key) + "." + std::to_string(i), quantity);
    }
  }
  template <int N>
  void read(std::string_view key, const Quantity& quantity,
            std::optional<Eigen::Matrix<double, N, 1>>& out) {
    if (find(key)) read(key, quantity, out.emplace());
  }
  void read(std::string_view key, bool& out);
  void read(std::string_view key, int low, int high, int& out);
  void read(std::string_view key, std::string& out);
  ///@}

  /// The position of the key's word among `words`, none when the key is absent.
  /// \param other what may be given too, as the message says it.
  std::optional<std::size_t> choice(std::string_view key, const std::vector<std::string>& words,
                                    std::string_view other = "");

  /// Checks the map as a whole: no key that was not asked for, none missing that was required.
  void finish() const;

 private:
  const Value& map_;
  std::string path_;
  std::vector<std::string> known_;
  std::vector<std::string> missing_;
};

}  // namespace lcs::scenario
