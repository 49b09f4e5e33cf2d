#include "tools/replay/times.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "scenarios/input/error.h"
#include "tools/files/csv.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {
namespace {

std::optional<int> whole_within(std::string_view text, int least, int most) {
  const auto number = files::number_in<int>(text);
  return number && *number >= least && *number <= most ? number : std::nullopt;
}

constexpr std::int64_t kTick_ns = 100'000;  // of Xsens, whose columns alone state it

struct TimeUnit {
  std::int64_t ns;
  std::vector<std::string_view> names;  ///< the shortest first
};
const std::vector<TimeUnit>& time_units() {
  static const std::vector<TimeUnit> kUnits{
      {kSecond_ns, {"s", "sec", "secs", "second", "seconds"}},
      {kMillisecond_ns, {"ms", "msec", "millis", "milliseconds"}},
      {kMicrosecond_ns, {"us", "usec", "microseconds", "µs"}},
      {kNanosecond_ns, {"ns", "nsec", "nsecs", "nanosec", "nanoseconds"}},
      {kTick_ns, {"100 us"}}};
  return kUnits;
}

/// The unit of a column of times: in brackets, or the last word of a name as "timestamp_ns".
std::string unit_in(const TextTable::Column& column) {
  if (!column.unit.empty()) return column.unit;
  if (words_in(column.name) == std::vector<std::string>{"sample", "time", "fine"}) return "100 us";
  const std::size_t last = column.name.find_last_of("_ ");
  const std::string word = last == column.name.npos ? "" : column.name.substr(last + 1);
  return time_unit_named(word) ? word : "";
}

/// The median difference of consecutive times in their own unit; absent for fewer than two.
std::optional<double> usual_period(const TextTable& table, std::size_t column) {
  constexpr std::size_t kSuffices = 2000;
  std::vector<double> periods;
  std::optional<long double> last;  // a double has too few digits for epoch times
  for (std::size_t i = 0; i < table.rows.size() && i < kSuffices; ++i) {
    const auto time = files::number_in<long double>(TextTable::field(table.rows[i], column));
    if (time && last && *time > *last) periods.push_back(static_cast<double>(*time - *last));
    if (time) last = time;
  }
  return usual(std::move(periods));
}

bool is_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
}

/// Counts differences of sorted times, in ns, that are not near the usual one.
std::size_t irregular_in(std::vector<double> times) {
  std::ranges::sort(times);
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  const double one = usual(steps).value_or(0);
  return static_cast<std::size_t>(std::ranges::count_if(
      steps, [&](double step) { return step < 0.5 * one || step > 1.5 * one; }));
}

/// Refuses counts of 100 ns since the year 1601 or 1.
void require_no_ticks(const TextTable& table, std::size_t column) {
  constexpr std::int64_t kSpan = 20'000'000'000'000'000;
  if (table.rows.empty()) return;
  const TextTable::Row& row = table.rows.front();
  const auto ticks = files::number_in<std::int64_t>(TextTable::field(row, column));
  for (const std::int64_t at_1970 : {116'444'736'000'000'000, 621'355'968'000'000'000}) {
    if (!ticks || *ticks < at_1970 || *ticks > at_1970 + kSpan) continue;
    throw input::Error({table.file.string(), row.line},
                       "its times are ticks of 100 ns (Windows, HoloLens); write (t - {}) * 100, "
                       "which are ns since 1970",
                       at_1970);
  }
}

}  // namespace

std::optional<std::int64_t> TimeColumn::of(const TextTable::Row& row) const {
  const auto t_ns = time_in(TextTable::field(row, column), unit_ns);
  if (!rest) return t_ns;
  const auto more_ns = time_in(TextTable::field(row, *rest), rest_ns);
  return t_ns && more_ns ? std::optional(*t_ns + *more_ns) : std::nullopt;
}

TimeColumn time_column_of(const TextTable& table, const TableTimes& times, Tally& tally) {
  std::optional<std::size_t> seconds;
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    const std::vector<std::string> words = words_in(table.header[i].name);
    const auto unit_ns = words.empty() ? std::nullopt : time_unit_named(words.back());
    if (unit_ns == kSecond_ns) seconds = i;
    if (!seconds || !unit_ns || *unit_ns >= kMillisecond_ns || table.rows.empty()) continue;
    const TextTable::Row& last = table.rows.back();
    const auto rest_ns = time_in(TextTable::field(last, i), *unit_ns);
    const bool is_rest =
        rest_ns && *rest_ns < kSecond_ns && is_digits(TextTable::field(last, *seconds));
    if (is_rest) return {*seconds, kSecond_ns, i, *unit_ns};
  }
  const auto column = table.time_column();
  if (!column && !table.header.empty() && !table.is_comment) {
    throw input::Error(
        {table.file.string(), 1},
        "the header names no time: {}; call the column of times time [s], [ms], [us] or [ns]",
        table.columns());
  }
  return {column.value_or(0), times.unit_ns(table, column.value_or(0), tally)};
}

bool lack_zeros(const std::vector<std::string_view>& times) {
  const auto fraction_of = [](std::string_view time) {
    const std::size_t point = time.find('.');
    return point == time.npos ? "" : time.substr(point + 1);
  };
  std::size_t most = 0;
  for (const std::string_view time : times) most = std::max(most, fraction_of(time).size());
  std::vector<double> written, padded;
  for (const std::string_view time : times) {
    const std::string_view fraction = fraction_of(time);
    const bool has_zero = fraction.size() > 1 && fraction.size() < most && fraction[0] == '0';
    if (has_zero || !is_digits(fraction)) return false;
    const std::string zeros(most - fraction.size(), '0');
    const std::string_view whole = time.substr(0, time.find('.'));
    const std::string full = fmt::format("{}.{}{}", whole, zeros, fraction);
    written.push_back(static_cast<double>(time_in(time, kSecond_ns).value_or(0)));
    padded.push_back(static_cast<double>(time_in(full, kSecond_ns).value_or(0)));
  }
  return irregular_in(std::move(padded)) < irregular_in(std::move(written));
}

void require_zeros(const TextTable& table, std::size_t column) {
  std::vector<std::string_view> times;
  for (const TextTable::Row& row : table.rows) times.push_back(TextTable::field(row, column));
  if (!lack_zeros(times)) return;
  throw input::Error({table.file.string(), table.rows.front().line},
                     "the fractions of its seconds lack leading zeros: 12.5 stands for "
                     "12.000000005; write them with as many digits each");
}

std::optional<std::int64_t> time_unit_named(std::string_view name) {
  for (const TimeUnit& unit : time_units()) {
    if (std::ranges::count(unit.names, name) > 0) return unit.ns;
  }
  return std::nullopt;
}

std::optional<std::int64_t> time_in(std::string_view text, std::int64_t unit_ns) {
  const std::size_t point = text.find('.');
  const std::string_view fraction = point == text.npos ? "" : text.substr(point + 1);
  std::string_view whole = text.substr(0, point);
  const bool is_negative = whole.starts_with('-');
  if (is_negative) whole.remove_prefix(1);
  if (is_digits(whole) && (fraction.empty() || is_digits(fraction))) {
    // not through a double, whose precision at such times is above a nanosecond
    const auto units = files::number_in<std::int64_t>(whole);
    if (!units || *units > kFarthest_ns / unit_ns) return std::nullopt;
    std::int64_t t_ns = *units * unit_ns, place_ns = unit_ns;
    for (const char digit : fraction) t_ns += (digit - '0') * (place_ns /= 10);
    if (!is_time(t_ns)) return std::nullopt;
    return is_negative ? -t_ns : t_ns;
  }
  const auto number = files::number_in<double>(text);
  const double t_ns = number.value_or(0) * static_cast<double>(unit_ns);
  if (!number || std::abs(t_ns) >= static_cast<double>(kFarthest_ns)) return std::nullopt;
  return std::llround(t_ns);
}

std::optional<std::int64_t> calendar_time_in(std::string_view date, std::string_view clock) {
  const std::vector<std::string_view> days = files::split(date, '-');
  const std::vector<std::string_view> times = files::split(clock, ':');
  if (days.size() != 3 || times.size() != 3) return std::nullopt;
  const auto year = whole_within(days[0], 1900, 2099), month = whole_within(days[1], 1, 12);
  const auto day = whole_within(days[2], 1, 31), hour = whole_within(times[0], 0, 23);
  const auto minute = whole_within(times[1], 0, 59);
  const auto second = files::number_in<double>(times[2]);
  if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
  const std::chrono::year_month_day on{std::chrono::year(*year), std::chrono::month(*month),
                                       std::chrono::day(*day)};
  if (!on.ok() || !(*second >= 0 && *second < 61)) return std::nullopt;
  const std::chrono::sys_time<std::chrono::nanoseconds> at =
      std::chrono::sys_days(on) + std::chrono::hours(*hour) + std::chrono::minutes(*minute);
  return at.time_since_epoch().count() + std::llround(*second * 1e9);
}

std::optional<double> usual_rate_hz(const std::vector<std::int64_t>& t_ns) {
  std::vector<std::int64_t> periods;
  for (std::size_t i = 1; i < t_ns.size(); ++i) periods.push_back(t_ns[i] - t_ns[i - 1]);
  const auto period_ns = usual(std::move(periods));
  if (!period_ns) return std::nullopt;
  return 1e9 / static_cast<double>(*period_ns);
}

std::int64_t TableTimes::unit_ns(const TextTable& table, std::size_t column, Tally& tally) const {
  require_zeros(table, column);
  const std::optional<double> period = usual_period(table, column);
  const std::string file = table.file.string();
  const auto rate_hz = [&](std::int64_t unit_ns) {
    return static_cast<double>(kSecond_ns) / (*period * static_cast<double>(unit_ns));
  };
  const auto fits = [&](std::int64_t unit_ns) {
    if (!period) return true;
    constexpr double kFactor = 30;  // pictures may be left out of a recording
    const double hz = rate_hz(unit_ns);
    if (!rate.stated_hz) return hz > rate.least_hz && hz < rate.most_hz;
    return hz < kFactor * *rate.stated_hz && kFactor * hz > *rate.stated_hz;
  };
  const auto chosen = [&](std::int64_t unit_ns) {
    constexpr double kSame = 0.2;
    const double hz = period ? rate_hz(unit_ns) : 0;
    if (rate.stated_hz && period && std::abs(hz / *rate.stated_hz - 1) > kSame) {
      tally.tell(fmt::format("{} has {:.3g} rows a second, and {} states {:g} Hz", file, hz,
                             rate.stated_by, *rate.stated_hz));
    }
    return unit_ns;
  };
  const auto fitting = std::ranges::find_if(
      time_units(), [&](const TimeUnit& unit) { return unit.ns != kTick_ns && fits(unit.ns); });
  const std::string expected =
      rate.stated_hz
          ? fmt::format("{} states {:g} Hz", rate.stated_by, *rate.stated_hz)
          : fmt::format("a sensor of its kind has {:g} to {:g} Hz", rate.least_hz, rate.most_hz);
  const auto contradict = [&](const std::string& by, std::int64_t unit_ns) {
    throw input::Error(
        {file, table.rows.front().line},
        "its times are {}, which gives {:.3g} rows a second, and {}; {}", by, rate_hz(unit_ns),
        expected,
        fitting == time_units().end()
            ? "correct one of the two"
            : fmt::format("if they are in {0}, give time_unit: {0}", fitting->names.front()));
  };
  // The user's unit may be meant for another table: then this table's own unit fits.
  const std::string stated = column < table.header.size() ? unit_in(table.header[column]) : "";
  const auto by_user = time_unit_named(asked), by_header = time_unit_named(stated);
  for (const auto& unit_ns : {by_user, by_header, by_user ? layouts : std::nullopt}) {
    if (unit_ns && fits(*unit_ns)) return chosen(*unit_ns);
  }
  if (by_user && !rate.stated_hz) return *by_user;
  if (by_user) contradict("in " + asked + " by time_unit", *by_user);
  if (by_header) contradict("in " + stated + " by its header", *by_header);
  require_no_ticks(table, column);
  if (layouts && fits(*layouts)) return chosen(*layouts);
  if (fitting == time_units().end()) {
    throw input::Error({file, table.rows.front().line},
                       "no unit of time gives its rows the rate that they can have: {}; give "
                       "time_unit (s, ms, us or ns)",
                       expected);
  }
  tally.add(
      "tables of times do not state their unit, and are read in the unit that fits their rate",
      fmt::format("{} in {}: {:.3g} Hz", file, fitting->names.front(), rate_hz(fitting->ns)));
  return chosen(fitting->ns);
}

}  // namespace lcs::replay
