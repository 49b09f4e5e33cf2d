#include "tools/files/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <utility>

#include "scenarios/input/input_file.h"
#include "scenarios/input/message.h"
#include "scenarios/input/sha256.h"
#include "tools/files/output_file.h"

namespace lcs::files {
namespace {

constexpr std::string_view kComment = "# ";
constexpr int kHeadLines = 3;

std::string check_of(const std::string& head, std::string_view row) {
  constexpr std::size_t kDigits = 12;
  return input::sha256(head + std::string(row)).substr(0, kDigits);
}

}  // namespace

JournalReader::JournalReader(fs::path file, std::string_view sign, std::string remedy)
    : file_(std::move(file)), sign_(sign), remedy_(std::move(remedy)) {}

bool JournalReader::read_head() {
  if (!head_.empty()) return true;
  const std::string text = text_from(0, kHeadLines);
  const std::string first = sign_ + '\n';
  if (text.compare(0, first.size(), first, 0, std::min(text.size(), first.size())) != 0) {
    refuse(1, fmt::format("does not begin with '{}'", sign_));
  }
  std::size_t ends[kHeadLines + 1] = {0};
  for (int i = 1; i <= kHeadLines; ++i) {
    const std::size_t end = text.find('\n', ends[i - 1]);
    if (end == text.npos) return false;
    ends[i] = end + 1;
  }
  const std::string_view made_of = std::string_view(text).substr(ends[1], ends[2] - 1 - ends[1]);
  if (!made_of.starts_with(kComment)) refuse(2, "this line states nothing");
  try {
    provenance_ = Provenance::from(parse_json<Json>(made_of.substr(kComment.size())));
  } catch (const std::runtime_error& error) {
    refuse(2, error.what());
  }
  head_ = text.substr(0, ends[kHeadLines]);
  used_ = head_.size();
  line_ = kHeadLines;
  return true;
}

std::string JournalReader::text_from(std::size_t begin, std::ptrdiff_t lines) const {
  constexpr std::size_t kBlock = 1 << 20;
  const input::InputFile input(file_, {16 * input::kGibibyte, remedy_});
  std::string text;
  for (std::string block; !(block = input.bytes_at(begin + text.size(), kBlock)).empty();) {
    text += block;
    lines -= std::ranges::count(block, '\n');
    if (lines <= 0) break;
  }
  return text;
}

void JournalReader::refuse(int line, const std::string& what) const {
  throw input::Error({file_.string(), line}, fmt::format("{}; {}", what, remedy_));
}

void JournalReader::read(const Take& take) {
  if (!read_head()) return;
  const std::string text = text_from(used_, std::numeric_limits<std::ptrdiff_t>::max());
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != text.npos; begin = end + 1) {
    const std::string_view row = std::string_view(text).substr(begin, end - begin);
    const std::size_t comma = std::min(row.rfind(','), row.size());
    ++line_;
    if (row.substr(std::min(comma + 1, row.size())) != check_of(head_, row.substr(0, comma))) {
      refuse(line_, fmt::format("the row '{}' was changed after it was written, as its check says",
                                input::one_line(row)));
    }
    take(std::string(row.substr(0, comma)), line_);
  }
  used_ += begin;
}

Journal::Journal(fs::path file, std::string_view sign, const Provenance& provenance,
                 std::string_view columns, std::string remedy, const JournalReader::Take& take)
    : path_(std::move(file)),
      head_(fmt::format("{}\n{}{}\n{}\n", sign, kComment, json_text(provenance.json()), columns)) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path_, error);
  JournalReader reader(path_, sign, std::move(remedy));
  if (fs::is_symlink(status)) reader.refuse(0, "this is a link, which is not followed");
  if (fs::exists(status) && reader.read_head()) {
    if (const std::string what = difference(reader.provenance(), provenance); !what.empty()) {
      reader.refuse(0, "this is the journal of other work: " + what);
    }
    if (!reader.head().ends_with(fmt::format("\n{}\n", columns))) {
      reader.refuse(kHeadLines, fmt::format("the columns are not '{}'", columns));
    }
    reader.read(take);
    head_ = reader.head();
    size_ = reader.size();
  } else if (!head_.starts_with(beginning(path_, head_.size() + 1))) {
    reader.refuse(0, "the head of the journal is cut off");  // or belongs to other work
  }
  constexpr int kFlags = O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
  file_ = input::Descriptor(::open(path_.c_str(), kFlags, 0666));
  if (!file_.is_open() || ::ftruncate(file_.get(), static_cast<off_t>(size_)) != 0) {
    fail_to("write", path_, errno);
  }
  if (size_ == 0) append(head_);
}

void Journal::add(std::string_view row) {
  append(fmt::format("{},{}\n", row, check_of(head_, row)));
}

void Journal::append(std::string_view text) {
  for (std::string_view rest = text; !rest.empty();) {
    const ssize_t written = ::write(file_.get(), rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error = errno;
      // A full disk has room for less. If this fails, too, the next process does it.
      if (::ftruncate(file_.get(), static_cast<off_t>(size_)) != 0) fail_to("write", path_, errno);
      fail_to("write", path_, error);
    }
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  size_ += text.size();
}

}  // namespace lcs::files
