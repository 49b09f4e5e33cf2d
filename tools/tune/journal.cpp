#include "tools/tune/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <system_error>

#include "tools/files/csv.h"
#include "tools/files/output_file.h"
#include "tools/files/sha256.h"
#include "tools/input/input_file.h"
#include "tools/input/message.h"

namespace lcs::tune {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSign = "# Written by `lcs tune`: the sets of numbers that it has tried";
constexpr const char* kRemedy = "choose another folder with --out, or remove the file";
/// Appended to an incomplete line.
constexpr std::string_view kCutOff = " # cut off";
constexpr std::size_t kCheckDigits = 12;
constexpr double Worth::*kFigures[] = {&Worth::f1, &Worth::false_moving, &Worth::false_static,
                                       &Worth::false_capped, &Worth::false_corners};
constexpr const char* kColumns = "f1,false_moving,false_static,false_capped,false_corners,check";

std::string line_of(const Fact& fact) {
  return fmt::format("# {}: {}\n", fact.name, fact.text);
}

/// Removes the first line of a text and returns it; absent if there is no line end.
std::optional<std::string> take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == text.npos) return std::nullopt;
  std::string line(text.substr(0, end));
  text.remove_prefix(end + 1);
  return line;
}

/// All differences between two heads, such as "seed: 1 -> 2".
std::string differences(const std::vector<Fact>& before, const std::vector<Fact>& now) {
  constexpr const char* kNothing = "nothing";
  const auto in = [&](const std::vector<Fact>& facts, const std::string& name) {
    for (const Fact& fact : facts) {
      if (fact.name == name) return fact.text;
    }
    return std::string(kNothing);
  };
  std::vector<std::string> all;
  for (const Fact& fact : now) {
    const std::string text = in(before, fact.name);
    if (text != fact.text) all.push_back(fmt::format("{}: {} -> {}", fact.name, text, fact.text));
  }
  for (const Fact& fact : before) {
    if (in(now, fact.name) != kNothing) continue;
    all.push_back(fmt::format("{}: {} -> {}", fact.name, fact.text, kNothing));
  }
  return fmt::format("{}", fmt::join(all, ", "));
}

}  // namespace

Journal::Journal(const fs::path& file, const std::vector<Fact>& facts,
                 const std::vector<std::string>& keys)
    : path_(file), columns_(keys.size() + std::size(kFigures) + 1) {
  head_ = fmt::format("{}\n", kSign);
  for (const Fact& fact : facts) head_ += line_of(fact);
  head_ += fmt::format("{},{}\n", fmt::join(keys, ","), kColumns);
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path_, error);
  if (fs::is_symlink(status)) refuse(0, "this is a link, and lcs tune writes through none");
  if (fs::exists(status)) {
    read(facts);
  } else {
    create();
  }
  file_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file_ < 0) bench::fail_to("write", path_, errno);
}

void Journal::create() const {
  fs::path beside = path_;
  beside += fmt::format(".{}.partial", ::getpid());
  std::error_code error;
  try {
    bench::write_file(beside, head_);
    fs::rename(beside, path_);
  } catch (...) {
    fs::remove(beside, error);
    throw;
  }
}

Journal::~Journal() {
  if (file_ >= 0) ::close(file_);
}

void Journal::refuse(int line, const std::string& what) const {
  throw input::Error({path_.string(), line}, fmt::format("{}; {}", what, kRemedy));
}

void Journal::read(const std::vector<Fact>& facts) {
  constexpr input::FileKind kJournal{input::kGibibyte, kRemedy};
  const std::string all = input::read_file(path_, kJournal);
  std::string_view text = all;
  if (take_line(text) != kSign) refuse(1, "this is no journal of lcs tune");
  std::vector<Fact> before;
  std::string_view rest = text;
  while (rest.starts_with("# ")) {
    const auto line = take_line(rest);
    if (!line) break;
    const std::size_t colon = line->find(": ");
    if (colon == line->npos)
      refuse(static_cast<int>(before.size()) + 2, "this line states nothing");
    before.push_back({line->substr(2, colon - 2), line->substr(colon + 2)});
  }
  if (rest.find('\n') == rest.npos) refuse(0, "the head of the journal is cut off");
  if (const std::string other = differences(before, facts); !other.empty()) {
    refuse(0, fmt::format("this is the journal of another search: {}", other));
  }
  if (!all.starts_with(head_)) {
    refuse(static_cast<int>(before.size()) + 2, "the head of the journal is not as it was written");
  }
  text = std::string_view(all).substr(head_.size());
  int line = static_cast<int>(facts.size()) + 2;
  while (const auto row = take_line(text)) {
    ++line;
    if (!row->ends_with(kCutOff)) read_row(*row, line);
  }
  is_cut_off_ = !text.empty();
}

void Journal::read_row(const std::string& row, int line) {
  const auto refuse_row = [&](const std::string& what) {
    refuse(line, fmt::format("the row '{}' {}", input::one_line(row), what));
  };
  const auto cells = bench::fields_of(row);
  if (cells.size() != columns_) {
    refuse_row(fmt::format("has {} cells, and not {}", cells.size(), columns_));
  }
  std::vector<std::string> values;
  Worth worth;
  const std::size_t keys = columns_ - 1 - std::size(kFigures);
  for (std::size_t i = 0; i + 1 < columns_; ++i) {
    const auto number = bench::number_in<double>(cells[i]);
    if (!number) refuse_row(fmt::format("has '{}', which is no number", input::one_line(cells[i])));
    if (i < keys) {
      values.emplace_back(cells[i]);
    } else {
      worth.*kFigures[i - keys] = *number;
    }
  }
  const std::size_t end = row.rfind(',');
  if (row.substr(end + 1) != check_of(row.substr(0, end))) {
    refuse_row("was changed after it was written, as its check says");
  }
  known_[values] = worth;
}

std::string Journal::check_of(const std::string& row) const {
  return bench::sha256(head_ + row).substr(0, kCheckDigits);
}

std::optional<Worth> Journal::find(const std::vector<std::string>& values) const {
  const auto found = known_.find(values);
  return found == known_.end() ? std::nullopt : std::optional(found->second);
}

void Journal::add(const std::vector<std::string>& values, const Worth& worth) {
  std::string row = fmt::format("{}", fmt::join(values, ","));
  for (double Worth::*figure : kFigures) row += fmt::format(",{}", worth.*figure);
  const std::string line = fmt::format("{},{}\n", row, check_of(row));
  const std::string text = is_cut_off_ ? fmt::format("{}\n{}", kCutOff, line) : line;
  for (std::string_view rest = text; !rest.empty();) {
    const ssize_t written = ::write(file_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) bench::fail_to("write", path_, errno);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  is_cut_off_ = false;
  known_[values] = worth;
}

}  // namespace lcs::tune
