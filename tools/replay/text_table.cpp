#include "tools/replay/text_table.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ctime>
#include <numeric>
#include <ranges>

#include "scenarios/input/input_file.h"
#include "tools/files/csv.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {
namespace {

/// The first of the separators in a line; ' ' stands for any number of blanks.
char separator_in(std::string_view line) {
  for (const char separator : {';', ',', '\t'}) {
    if (line.find(separator) != line.npos) return separator;
  }
  return ' ';
}

std::vector<std::string> fields_in(std::string_view line, char separator) {
  std::vector<std::string> fields;
  const auto parts = separator == ' ' ? files::words_of(line) : files::split(line, separator);
  for (const std::string_view field : parts) {
    fields.emplace_back(files::trimmed(field));
    // Tables with semicolons come from countries that write 0,5.
    if (separator == ';') std::ranges::replace(fields.back(), ',', '.');
  }
  return fields;
}

/// Removes the blanks before and inside brackets: "time [s] x [m s^-1]" has two fields.
std::string with_units_joined(std::string_view line) {
  std::string joined;
  int depth = 0;
  for (const char c : line) {
    if (c == '[' || c == '(') {
      while (!joined.empty() && joined.back() == ' ') joined.pop_back();
      ++depth;
    }
    joined += depth > 0 && c == ' ' ? '~' : c;
    if ((c == ']' || c == ')') && depth > 0) --depth;
  }
  return joined;
}

std::vector<TextTable::Column> columns_in(std::string_view line, char separator) {
  line.remove_prefix(std::min(line.find_first_not_of("#% \t"), line.size()));
  std::vector<TextTable::Column> columns;
  for (const std::string& field : fields_in(with_units_joined(line), separator)) {
    const std::size_t unit = field.find_first_of("[(");
    const std::size_t end = field.find_first_of("])", std::min(unit, field.size()));
    TextTable::Column column{std::string(files::trimmed(field.substr(0, unit))), ""};
    while (column.name.starts_with('#')) column.name = files::trimmed(column.name.substr(1));
    if (unit != field.npos) column.unit = field.substr(unit + 1, end - unit - 1);
    std::ranges::replace(column.unit, '~', ' ');
    columns.push_back(column);
  }
  return columns;
}

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
}

/// Begins with a number; or with a word, and most fields are numbers; or with the name of a
/// picture, and another field is a number.
bool is_row(std::string_view line) {
  const char c = line.front();
  if (std::isdigit(static_cast<unsigned char>(c)) || c == '-' || c == '+' || c == '.') return true;
  const std::vector<std::string> fields = fields_in(line, separator_in(line));
  const auto numbers = std::ranges::count_if(
      fields, [](const std::string& field) { return files::number_in<double>(field).has_value(); });
  if (is_comment(line)) return false;
  return is_picture(fields[0]) ? numbers > 0 : numbers > 2 && 2 * numbers > std::ssize(fields);
}

/// A table of a tool that needs more than other names of columns.
struct Foreign {
  std::string_view words;  ///< in a line before its rows
  const char *name, *header;
};
constexpr Foreign kForeign[] = {
    {"x_world_device", "Project Aria's, with poses of the device",
     "uid,time [us],utc,p_RS_R_x,p_RS_R_y,p_RS_R_z,q_RS_x,q_RS_y,q_RS_z,q_RS_w and its other "
     "names"},
    {"vehiclename", "AirSim's, with poses of the vehicle (x ahead, y right, z down)",
     "name,time,p_RS_R_x,p_RS_R_y,p_RS_R_z,q_RS_w,q_RS_x,q_RS_y,q_RS_z,file, with its tabs"},
    {"qz,tx_m", "Argoverse 2's, with poses of the vehicle (x ahead, y left, z up)",
     "time [ns],q_RS_w,q_RS_x,q_RS_y,q_RS_z,p_RS_R_x,p_RS_R_y,p_RS_R_z"},
    {"image_id, qw", "COLMAP's: it has no times, and poses of the world in the camera",
     "time,x,y,z,qx,qy,qz,qw over inverse poses, or give the folder of its pictures and fps"},
    {"tscale", "Gyroflow's, in other axes and units (orientation, tscale, gscale, ascale)",
     "time [s],w_RS_S_x,w_RS_S_y,w_RS_S_z,a_RS_S_x [g],a_RS_S_y [g],a_RS_S_z [g] over its readings "
     "in these"},
};

void refuse_foreign(const fs::path& file, const std::vector<std::string>& before) {
  for (const std::string& line : before) {
    for (const Foreign& one : kForeign) {
      if (in_lower_case(line).find(one.words) == line.npos) continue;
      refuse({file}, "this table is {}; for its header write {}{}", one.name, one.header,
             std::string_view(one.header).find("p_RS") < 60
                 ? ", and give the camera's place there by a calibration"
                 : "");
    }
  }
}

constexpr std::int64_t kTick_ns = 100'000;  // of Xsens, whose columns alone state it

struct TimeUnit {
  std::int64_t ns;
  std::vector<std::string_view> names;  ///< the shortest first
};
const TimeUnit kTimeUnits[] = {{kSecond_ns, {"s", "sec", "secs", "second", "seconds"}},
                               {kMillisecond_ns, {"ms", "msec", "millis", "milliseconds"}},
                               {kMicrosecond_ns, {"us", "usec", "microseconds", "µs"}},
                               {kNanosecond_ns, {"ns", "nsec", "nsecs", "nanosec", "nanoseconds"}},
                               {kTick_ns, {"100 us"}}};

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
    const auto time = files::number_in<long double>(table.rows[i].field(column));
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
  const auto ticks = files::number_in<std::int64_t>(row.field(column));
  for (const std::int64_t at_1970 : {116'444'736'000'000'000, 621'355'968'000'000'000}) {
    if (!ticks || *ticks < at_1970 || *ticks > at_1970 + kSpan) continue;
    refuse({table.file, row.line},
           "its times are ticks of 100 ns (Windows, HoloLens); write (t - {}) * 100, which are ns "
           "since 1970",
           at_1970);
  }
}

}  // namespace

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::vector<std::string> words_in(std::string_view name) {
  std::vector<std::string> words;
  unsigned char before = ' ';
  for (const unsigned char c : name) {
    const bool begins = !std::isalpha(before) || (std::isupper(c) && std::islower(before));
    if (std::isalpha(c) && begins) words.emplace_back();
    if (std::isalpha(c)) words.back() += static_cast<char>(std::tolower(c));
    before = c;
  }
  return words;
}

std::optional<std::size_t> Quantities::place_of(std::string_view name) const {
  std::vector<std::string> words = words_in(name);
  if (words.empty()) return std::nullopt;
  const std::size_t axis = std::string_view("xyzw").find(words.back().back());
  words.back().pop_back();
  if (words.size() > 1 && words.back().empty()) words.pop_back();
  const auto any = [&](const std::set<std::string>& of) {
    return std::ranges::any_of(words, [&](const std::string& word) { return of.contains(word); });
  };
  const bool is_second = any(second);
  const std::size_t most = is_second ? 3 : 2;
  if (axis > most || any(others) || any(first) == is_second) return std::nullopt;
  return axis + (is_second ? 3 : 0);
}

std::string TextTable::columns() const {
  if (header.empty())
    return fmt::format("it has {} columns and no header", rows.front().fields.size());
  return fmt::format("its columns are {}",
                     fmt::join(header | std::views::transform(&Column::name), ", "));
}

std::string TextTable::at(const Row& row) const {
  return fmt::format("{}:{}", file.string(), row.line);
}

std::string_view TextTable::Row::field(std::size_t column) const {
  return column < fields.size() ? std::string_view(fields[column]) : "";
}

std::optional<double> TextTable::Row::number(std::size_t column) const {
  return files::number_in<double>(field(column));
}

std::optional<std::vector<double>> TextTable::Row::numbers(
    std::span<const std::size_t> columns) const {
  std::vector<double> numbers;
  for (const std::size_t column : columns) {
    const auto one = number(column);
    if (!one) return std::nullopt;
    numbers.push_back(*one);
  }
  return numbers;
}

std::optional<std::vector<double>> TextTable::Row::numbers(std::size_t first,
                                                           std::size_t count) const {
  if (fields.size() != first + count) return std::nullopt;
  std::vector<std::size_t> columns(count);
  std::iota(columns.begin(), columns.end(), first);
  return numbers(columns);
}

std::optional<std::size_t> TextTable::find(std::string_view name) const {
  const auto found = std::ranges::find(
      header, in_lower_case(name), [](const Column& column) { return in_lower_case(column.name); });
  if (found == header.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.begin());
}

std::optional<std::size_t> TextTable::time_column() const {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string name = in_lower_case(header[i].name);
    std::vector<std::string> words = words_in(name);
    const bool is_stamp = name.ends_with("header.stamp");
    // a unit alone, or behind t or ts
    if (words.size() > 1 && time_unit_named(words.back())) words.pop_back();
    const bool is_short =
        words.size() == 1 && (words[0] == "t" || words[0] == "ts" || time_unit_named(words[0]));
    const bool is_time = is_stamp || is_short || name.find("time") != name.npos ||
                         name.find("stamp") != name.npos || name.find("epoch") != name.npos;
    const bool is_span = name.find("exposure") != name.npos;
    if (is_stamp || (is_time && !is_span && !found)) found = i;
    if (is_stamp) break;
  }
  return found;
}

std::size_t TextTable::column(std::string_view name, std::size_t otherwise) const {
  if (header.empty()) return otherwise;
  if (const auto found = find(name)) return *found;
  refuse({file, 1},
         "the header names no column {}: {}; give each column the name that the layout has for it",
         name, columns());
}

TextTable read_table(const fs::path& file) {
  // An hour of a 1 kHz IMU takes 400 MB.
  constexpr input::FileKind kSensorTable{input::kGibibyte,
                                         "give a table of rows, as the layout has it"};
  input::InputFile input(file, kSensorTable);
  TextTable table{file, ' ', {}, false, {}};
  std::vector<std::string> before;  // lines before the first row
  for (std::string text; input.next_line(text);) {
    const std::string_view line = files::trimmed(text);
    if (line.empty()) continue;
    if (table.rows.empty() && !is_row(line)) {
      before.emplace_back(line);
      continue;
    }
    if (line.starts_with('#')) continue;
    if (table.rows.empty()) table.separator = separator_in(line);
    table.rows.push_back({input.here().line, fields_in(line, table.separator)});
  }
  if (before.empty()) return table;
  refuse_foreign(file, before);
  if (table.rows.empty()) table.separator = separator_in(before.back());
  for (const std::string& line : before) {
    std::vector<TextTable::Column> columns = columns_in(line, table.separator);
    const bool is_bare = !is_comment(line);
    const bool fits = !table.rows.empty() && columns.size() == table.rows[0].fields.size();
    if (!fits && !is_bare && !table.rows.empty()) continue;
    table.header = std::move(columns);
    table.is_comment = !is_bare;
  }
  return table;
}

std::optional<std::int64_t> TimeColumn::of(const TextTable::Row& row) const {
  const auto t_ns = time_in(row.field(column), unit_ns);
  if (!rest) return t_ns;
  const auto more_ns = time_in(row.field(*rest), rest_ns);
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
    const auto rest_ns = time_in(last.field(i), *unit_ns);
    const bool is_rest = rest_ns && *rest_ns < kSecond_ns && is_digits(last.field(*seconds));
    if (is_rest) return {*seconds, kSecond_ns, i, *unit_ns};
  }
  const auto column = table.time_column();
  if (!column && !table.header.empty() && !table.is_comment) {
    refuse({table.file, 1},
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
  for (const TextTable::Row& row : table.rows) times.push_back(row.field(column));
  if (!lack_zeros(times)) return;
  refuse({table.file, table.rows.front().line},
         "the fractions of its seconds lack leading zeros: 12.5 stands for 12.000000005; write "
         "them with as many digits each");
}

std::optional<std::int64_t> time_unit_named(std::string_view name) {
  for (const TimeUnit& unit : kTimeUnits) {
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
  const std::string text = fmt::format("{} {}", date, clock);
  std::tm at{};
  const char* const end = ::strptime(text.c_str(), "%Y-%m-%d %H:%M:", &at);
  const auto second = files::number_in<double>(end ? text.substr(end - text.c_str()) : "");
  const int day = at.tm_mday, year = 1900 + at.tm_year;
  const std::int64_t minute_s = ::timegm(&at);  // of 31 February the day is 3 March
  if (!second || !(*second >= 0 && *second < 61) || at.tm_mday != day) return std::nullopt;
  const bool has_blank = std::ranges::count(text, ' ') > 1;  // as 2011- 9-26
  if (has_blank || year < 1900 || year > 2099) return std::nullopt;
  return minute_s * kSecond_ns + std::llround(*second * 1e9);
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
      tally.tell("{} has {:.3g} rows a second, and {} states {:g} Hz", file, hz, rate.stated_by,
                 *rate.stated_hz);
    }
    return unit_ns;
  };
  const auto fitting = std::ranges::find_if(
      kTimeUnits, [&](const TimeUnit& unit) { return unit.ns != kTick_ns && fits(unit.ns); });
  const std::string expected =
      rate.stated_hz
          ? fmt::format("{} states {:g} Hz", rate.stated_by, *rate.stated_hz)
          : fmt::format("a sensor of its kind has {:g} to {:g} Hz", rate.least_hz, rate.most_hz);
  const auto contradict = [&](const std::string& by, std::int64_t unit_ns) {
    refuse({file, table.rows.front().line},
           "its times are {}, which gives {:.3g} rows a second, and {}; {}", by, rate_hz(unit_ns),
           expected,
           fitting == std::end(kTimeUnits)
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
  if (fitting == std::end(kTimeUnits)) {
    refuse({file, table.rows.front().line},
           "no unit of time gives its rows the rate that they can have: {}; give time_unit (s, ms, "
           "us or ns)",
           expected);
  }
  tally.add(
      "tables of times do not state their unit, and are read in the unit that fits their rate",
      fmt::format("{} in {}: {:.3g} Hz", file, fitting->names.front(), rate_hz(fitting->ns)));
  return chosen(fitting->ns);
}

}  // namespace lcs::replay
