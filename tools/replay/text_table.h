/// \file
/// Text tables from other tools: any line ends, any of the usual separators, an optional header;
/// and times of recordings: nanoseconds of a clock with any zero.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "filter/radial/median.h"
#include "scenarios/input/error.h"

namespace lcs::replay {

class Tally;

/// Formats problem and remedy. \param where the file, perhaps with its line; empty: told with them.
template <class... Arguments>
[[noreturn]] void refuse(const input::Source& where, fmt::format_string<Arguments...> text,
                         Arguments&&... arguments) {
  throw input::Error(where, fmt::format(text, std::forward<Arguments>(arguments)...));
}

struct TextTable {
  struct Column {
    std::string name;  ///< without '#', '%', unit and blanks round it
    std::string unit;  ///< in brackets behind the name, as "rad s^-1"; "": none stated
  };
  struct Row {
    int line = 0;  ///< from 1
    std::vector<std::string> fields;

    /// "" if the row is shorter.
    std::string_view field(std::size_t column) const;
    std::optional<double> number(std::size_t column) const;
    /// The numbers in columns; absent unless all are there.
    std::optional<std::vector<double>> numbers(std::span<const std::size_t> columns) const;
    /// The fields from `first` on; absent unless they are `count` numbers.
    std::optional<std::vector<double>> numbers(std::size_t first, std::size_t count) const;
  };

  fs::path file;
  char separator = ' ';        ///< comma, semicolon, tab; ' ': any number of blanks
  std::vector<Column> header;  ///< empty if there is no header
  bool is_comment = false;     ///< the header is behind '#', '%' or '//': perhaps it is none
  std::vector<Row> rows;

  /// For messages: "its columns are a, b, c", or how many there are without a header.
  std::string columns() const;
  /// "file:line"
  std::string at(const Row& row) const;

  /// \param name without regard to case.
  std::optional<std::size_t> find(std::string_view name) const;
  /// The column that the header calls a time: the stamp of a ROS header, or the first one.
  std::optional<std::size_t> time_column() const;
  /// Index of the column called `name`, or `otherwise` without a header.
  /// \throws input::Error if there is a header without it.
  std::size_t column(std::string_view name, std::size_t otherwise) const;
};

/// ASCII letters only.
std::string in_lower_case(std::string_view text);

/// The words of a column's name in lower case: "gyroRotationX" is gyro, rotation, x.
std::vector<std::string> words_in(std::string_view name);

/// Two quantities of three or four components, by words in the names of their columns.
struct Quantities {
  std::set<std::string> first, second, others;  ///< "": a name of the component alone

  /// 0 to 2 for x, y, z of the first, 3 to 6 for x, y, z, w of the second; absent for other
  /// columns.
  std::optional<std::size_t> place_of(std::string_view name) const;
};

/// Reads fields between commas, semicolons (with decimal commas), tabs or blanks, whichever the
/// first row of numbers has. Of the lines before that row the last one that has as many fields is
/// the header; empty lines and further lines that begin with '#' are skipped.
/// \throws input::Error if the file cannot be read, or is of a tool whose tables are not read.
TextTable read_table(const fs::path& file);

/// The largest distance from the clock's zero (146 years), so that differences do not overflow.
inline constexpr std::int64_t kFarthest_ns = std::numeric_limits<std::int64_t>::max() / 2;

inline bool is_time(std::int64_t t_ns) {
  return t_ns >= -kFarthest_ns && t_ns <= kFarthest_ns;
}

/// A span of ns.
inline double seconds(std::int64_t span_ns) {
  return 1e-9 * static_cast<double>(span_ns);
}

/// \name Units of time, in ns.
///@{
inline constexpr std::int64_t kNanosecond_ns = 1, kMicrosecond_ns = 1000,
                              kMillisecond_ns = 1'000'000, kSecond_ns = 1'000'000'000;
/// \param name s, ms, us or ns, or a longer form of it; absent for another.
std::optional<std::int64_t> time_unit_named(std::string_view name);
///@}

/// Parses a number of units, as "1305031102.175304" or "1.5e-01"; absent if malformed or too far
/// from zero. Exact to the nanosecond; further digits are dropped.
std::optional<std::int64_t> time_in(std::string_view text, std::int64_t unit_ns);

/// Parses UTC, as "2011-09-26" and "13:02:25.964389445", to nanoseconds since 1970, rounded; absent
/// for an invalid time or a date outside the years 1900 to 2099. A leap second becomes the first
/// second of the next minute.
std::optional<std::int64_t> calendar_time_in(std::string_view date, std::string_view clock);

/// The rate of the rows of a table, as far as it is known without their times.
struct ExpectedRate {
  double least_hz, most_hz;         ///< that such a sensor can have
  std::optional<double> stated_hz;  ///< by the recording
  std::string stated_by = {};       ///< file that states it
};
inline const ExpectedRate kCameraRate{0.4, 390, {}}, kImuRate{12, 11'000, {}};
inline const ExpectedRate kStateRate{1, 990, {}};  ///< of wheels, and of truths

/// The unit of a table's times, as far as it is known before the table is read.
struct TableTimes {
  std::string asked;  ///< s, ms, us or ns; "": as the table states it
  ExpectedRate rate;
  std::optional<std::int64_t> layouts;  ///< unit in ns that its layout has

  /// In ns: the first that gives the expected rate, of `asked`, the header's unit, and `layouts`;
  /// else the only one that gives it, which is told. \throws input::Error if a stated unit
  /// contradicts the rate, or no unit gives it.
  std::int64_t unit_ns(const TextTable& table, std::size_t column, Tally& tally) const;
};

/// A column of times, and perhaps one of their fractions beside seconds, as ROS has them.
struct TimeColumn {
  std::size_t column = 0;
  std::int64_t unit_ns = 1;
  std::optional<std::size_t> rest = {};
  std::int64_t rest_ns = kNanosecond_ns;

  std::optional<std::int64_t> of(const TextTable::Row& row) const;
};
/// The column that the header calls so, else the first one.
/// \throws input::Error for a header without one, and as `TableTimes::unit_ns`.
TimeColumn time_column_of(const TextTable& table, const TableTimes& times, Tally& tally);

/// Whether fractions of seconds, as 12.5, lack leading zeros: 12.05 was meant. Then they have
/// different counts of digits, and as whole numbers they give a more regular rate.
bool lack_zeros(const std::vector<std::string_view>& times);
/// \throws input::Error if the times in a column do.
void require_zeros(const TextTable& table, std::size_t column);

/// The upper median; absent for an empty list.
template <class Number>
std::optional<Number> usual(std::vector<Number> values) {
  return values.empty() ? std::nullopt : std::optional(median(values));
}

/// The rate of times in ns by their usual difference; absent for fewer than two.
std::optional<double> usual_rate_hz(const std::vector<std::int64_t>& t_ns);

}  // namespace lcs::replay
