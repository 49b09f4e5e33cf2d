#include "tools/replay/recorded.h"

#include <map>
#include <stdexcept>
#include <tuple>

#include "scenarios/input/error.h"
#include "tools/files/csv.h"

namespace lcs::replay {
namespace {

/// A number of any size: digits without leading zeros, and those behind a point.
struct Number {
  std::string whole, fraction;

  std::string text() const { return fraction.empty() ? whole : whole + "." + fraction; }
  bool operator==(const Number&) const = default;
  bool operator<(const Number& other) const {
    return std::forward_as_tuple(whole.size(), whole, fraction) <
           std::forward_as_tuple(other.whole.size(), other.whole, other.fraction);
  }
};

struct Name {
  fs::path file;
  std::string words;   ///< with '#' in place of each number
  std::string digits;  ///< of all numbers
  std::vector<Number> numbers;
};

Name name_of(const fs::path& file) {
  const std::string stem = file.stem().string();
  const auto end_of_digits = [&](std::size_t from) {
    return std::min(stem.find_first_not_of("0123456789", from), stem.size());
  };
  Name name{file, "", "", {}};
  for (std::size_t at = 0; at < stem.size();) {
    std::size_t end = end_of_digits(at);
    if (end == at) {
      name.words += stem[at++];
      continue;
    }
    name.digits += stem.substr(at, end - at);
    while (at + 1 < end && stem[at] == '0') ++at;
    Number number{stem.substr(at, end - at), ""};
    // One point begins a fraction; several points, as in 2024.05.01, do not.
    const std::size_t end_of_fraction =
        end < stem.size() && stem[end] == '.' ? end_of_digits(end + 1) : 0;
    const bool is_next_point = end_of_fraction < stem.size() && stem[end_of_fraction] == '.';
    if (end_of_fraction > end + 1 && !is_next_point && !name.words.ends_with("#.")) {
      number.fraction = stem.substr(end + 1, end_of_fraction - end - 1);
      end = end_of_fraction;
    }
    name.numbers.push_back(number);
    name.words += '#';
    at = end;
  }
  return name;
}

std::vector<Name> names_of(const std::vector<fs::path>& files) {
  std::vector<Name> names;
  std::ranges::transform(files, std::back_inserter(names), name_of);
  return names;
}

[[noreturn]] void refuse_name(const Name& of, const std::string& why) {
  throw input::Error({of.file.parent_path().string(), 0},
                     "the order of its pictures is not certain: {}; take away all but the pictures "
                     "of one camera, or give a table with their names and times (times)",
                     why);
}

std::string both(const Name& a, const Name& b) {
  return fmt::format("{} and {}", a.file.filename().string(), b.file.filename().string());
}

/// The places of numbers that are not the same in all names. \pre names have the same words
std::vector<std::size_t> varying(const std::vector<Name>& names) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < names.front().numbers.size(); ++i) {
    const bool is_one = std::ranges::all_of(
        names, [&](const Name& name) { return name.numbers[i] == names.front().numbers[i]; });
    if (!is_one) places.push_back(i);
  }
  return places;
}

/// Whether the numbers are year, month, day, hour, minute, second, as phones name pictures: then
/// the first one counts most.
bool is_calendar(const Name& name) {
  constexpr std::size_t kToSeconds = 14;
  if (name.digits.size() < kToSeconds) return false;
  const auto part = [&](std::size_t at) { return name.digits.substr(at, 2); };
  return calendar_time_in(fmt::format("{}{}-{}-{}", part(0), part(2), part(4), part(6)),
                          fmt::format("{}:{}:{}", part(8), part(10), part(12)))
      .has_value();
}

constexpr std::int64_t kFirstEpoch_s = 1'000'000'000, kLastEpoch_s = 2'000'000'000;  // 2001, 2033

/// Seconds since 1970 and nanoseconds, as ROS names pictures: 1403636579_763555584. Absent for
/// other numbers.
std::optional<std::int64_t> seconds_and_nanoseconds(const Name& name) {
  if (name.numbers.size() != 2 || name.digits.size() != name.numbers[0].whole.size() + 9) {
    return std::nullopt;
  }
  const auto seconds = time_in(name.numbers[0].text(), kSecond_ns);
  const auto rest = time_in(name.numbers[1].text(), kNanosecond_ns);
  if (!seconds || !rest || *seconds / kSecond_ns < kFirstEpoch_s ||
      *seconds / kSecond_ns > kLastEpoch_s) {
    return std::nullopt;
  }
  return *seconds + *rest;
}

/// Sorts by one number first, then by the others from the first one on.
void sort_by(std::vector<Name>& names, std::size_t first) {
  std::ranges::stable_sort(names, [&](const Name& a, const Name& b) {
    return std::tie(a.numbers[first], a.numbers) < std::tie(b.numbers[first], b.numbers);
  });
}

void require_one_kind(const std::vector<Name>& names) {
  std::map<std::vector<std::string>, const Name*> seen;
  for (const Name& name : names) {
    if (name.numbers.empty() != names.front().numbers.empty()) {
      const Name& bare = name.numbers.empty() ? name : names.front();
      refuse_name(name,
                  fmt::format("{} has no number, and others have", bare.file.filename().string()));
    }
    std::vector<std::string> numbers;
    for (const Number& number : name.numbers) numbers.push_back(number.text());
    const auto [other, is_new] = seen.emplace(numbers, &name);
    if (!is_new && !numbers.empty()) {
      refuse_name(name, fmt::format("{} have the same number", both(*other->second, name)));
    }
    if (name.words != names.front().words && name.numbers.size() > 1) {
      refuse_name(name, fmt::format("{} have different numbers of numbers or words between them",
                                    both(names.front(), name)));
    }
  }
}

/// Sorts names of one kind.
void sort_by_numbers(std::vector<Name>& names) {
  const std::vector<std::size_t> places = varying(names);
  sort_by(names, places.empty() ? 0 : places.front());
  for (std::size_t i = 1; i < places.size(); ++i) {
    std::vector<Name> other = names;
    sort_by(other, places[i]);
    const auto differ =
        std::mismatch(names.begin(), names.end(), other.begin(),
                      [](const Name& a, const Name& b) { return a.file == b.file; });
    if (differ.first == names.end()) continue;
    if (std::ranges::all_of(names, is_calendar)) return;
    if (std::ranges::all_of(
            names, [](const Name& name) { return seconds_and_nanoseconds(name).has_value(); }))
      return;
    refuse_name(names.front(),
                fmt::format("{} of {} numbers in the names vary, and another one gives "
                            "another order: {} may be the next",
                            places.size(), names.front().numbers.size(),
                            both(*differ.first, *differ.second)));
  }
}

/// 1.9 and 1.10 are in one order as fractions, and in the other as numbers behind a point.
void require_fractions(const std::vector<Name>& names, std::size_t place) {
  constexpr std::size_t kEpoch = 9;  // digits of seconds since 1970, from 1973 on
  for (std::size_t i = 1; i < names.size(); ++i) {
    const Number &a = names[i - 1].numbers[place], &b = names[i].numbers[place];
    if (a.whole == b.whole && a.whole.size() < kEpoch && a.fraction.size() > b.fraction.size()) {
      refuse_name(
          names[i],
          fmt::format(
              "{} may be fractions or two numbers each, and have not the same count of digits",
              both(names[i - 1], names[i])));
    }
  }
  std::vector<std::string> texts;
  for (const Name& name : names) texts.push_back(name.numbers[place].text());
  if (!lack_zeros({texts.begin(), texts.end()})) return;
  refuse_name(
      names.front(),
      "the fractions of seconds in the names lack leading zeros: 12.5 stands for 12.000000005");
}

/// The unit of numbers that are times, in ns; absent if they are none.
std::optional<std::int64_t> unit_of(const Number& number, const std::string& time_unit) {
  if (const auto asked = time_unit_named(time_unit)) return asked;
  if (!number.fraction.empty()) return kSecond_ns;
  // from September 2001 to May 2033
  if (number.whole.front() != '1' && number.whole.front() != '2') return std::nullopt;
  const std::size_t digits = number.whole.size();
  return digits == 13   ? std::optional(kMillisecond_ns)
         : digits == 16 ? std::optional(kMicrosecond_ns)
         : digits == 19 ? std::optional(kNanosecond_ns)
                        : std::nullopt;
}

std::vector<std::int64_t> times_of(const std::vector<Name>& names, std::size_t place,
                                   const std::string& time_unit) {
  std::vector<std::int64_t> times;
  for (const Name& name : names) {
    const Number& number = name.numbers[place];
    if (const auto both = seconds_and_nanoseconds(name); both && time_unit.empty()) {
      times.push_back(*both);
      continue;
    }
    const auto unit_ns = unit_of(number, time_unit);
    const auto t_ns = unit_ns ? time_in(number.text(), *unit_ns) : std::nullopt;
    if (!t_ns) return {};
    times.push_back(*t_ns);
  }
  const std::optional<double> rate_hz = usual_rate_hz(times);
  if (!time_unit.empty() || !rate_hz) return times;
  const bool is_camera = *rate_hz > kCameraRate.least_hz && *rate_hz < kCameraRate.most_hz;
  return is_camera ? times : std::vector<std::int64_t>{};
}

}  // namespace

bool is_picture(const fs::path& file) {
  static const std::set<std::string> kKinds = {".png",  ".jpg", ".jpeg", ".bmp", ".tif",
                                               ".tiff", ".pgm", ".ppm",  ".webp"};
  return kKinds.contains(in_lower_case(file.extension().string()));
}

std::vector<fs::path> pictures_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const bool is_hidden = entry->path().filename().string().starts_with('.');  // ._1.png of a Mac
    if (!is_hidden && entry->is_regular_file() && is_picture(entry->path())) {
      files.push_back(entry->path());
    }
  }
  if (error) {
    throw std::runtime_error(
        fmt::format("{}: {}; give a folder of pictures", folder.string(), error.message()));
  }
  if (files.empty()) {
    throw std::runtime_error(
        fmt::format("{} holds no pictures; give a folder of PNG, JPEG, BMP, TIFF, WebP, PGM or PPM",
                    folder.string()));
  }
  return files;
}

std::vector<std::size_t> numbers_in(const std::vector<fs::path>& files) {
  constexpr std::size_t kMost = 100'000'000;
  const std::vector<Name> names = names_of(files);
  const bool have_one =
      std::ranges::all_of(names, [](const Name& n) { return n.numbers.size() == 1; });
  const bool are_alike =
      std::ranges::all_of(names, [&](const Name& n) { return n.words == names.front().words; });
  if (names.empty() || (!have_one && !are_alike)) return {};
  const std::vector<std::size_t> places = have_one ? std::vector{0UL} : varying(names);
  if (places.size() != 1 || std::ranges::all_of(names, is_calendar)) return {};
  std::vector<std::size_t> numbers;
  for (const Name& name : names) {
    const Number& number = name.numbers[places.front()];
    const auto whole = files::number_in<std::size_t>(number.whole);
    if (!number.fraction.empty() || !whole || *whole > kMost) return {};
    numbers.push_back(*whole);
  }
  const bool are_unique = std::set(numbers.begin(), numbers.end()).size() == numbers.size();
  return are_unique ? numbers : std::vector<std::size_t>{};
}

OrderedPictures in_order(std::vector<fs::path> files, const std::string& time_unit) {
  std::ranges::sort(files);
  std::vector<Name> names = names_of(files);
  require_one_kind(names);
  OrderedPictures ordered;
  if (!names.front().numbers.empty()) {
    const bool is_one_kind = std::ranges::all_of(
        names, [&](const Name& name) { return name.words == names.front().words; });
    if (is_one_kind) {
      sort_by_numbers(names);
    } else {
      sort_by(names, 0);
    }
    const std::vector<std::size_t> places = is_one_kind ? varying(names) : std::vector{0UL};
    for (const std::size_t place : places) {
      if (time_unit.empty()) require_fractions(names, place);
      if (ordered.t_ns.empty()) ordered.t_ns = times_of(names, place, time_unit);
    }
  }
  for (Name& name : names) ordered.files.push_back(std::move(name.file));
  return ordered;
}

}  // namespace lcs::replay
